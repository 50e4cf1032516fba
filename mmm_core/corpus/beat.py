"""The beat of clean gestures: strokes begin where tokens begin, and are all alike.

A stroke that takes a whole number of tokens is a row of ids that comes again, and one that is never larger, slower or turned
otherwise by chance is the same row each time: a model can learn it. What makes a motion alive (sway, breath, small differences)
carries no meaning, and can be added to the motion afterwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.motion import FPS

BEAT_S = FRAMES_PER_TOKEN / FPS
"""Seconds: one token."""


class Calm(np.random.Generator):
    """A generator that always says the middle: no chance in poses, strokes and paces.

    Where a gesture is made in one of two ways by chance, it is always the same one, or `otherwise` always the other.
    """

    def __init__(self, rng: np.random.Generator, otherwise: bool = False) -> None:
        super().__init__(rng.bit_generator)
        self._otherwise = otherwise

    def uniform(self, low: Any = 0.0, high: Any = 1.0, size: Any = None) -> Any:
        """The middle between `low` and `high`."""
        middle = (low + high) / 2
        return middle if size is None else np.full(size, middle)

    def normal(self, loc: Any = 0.0, scale: Any = 1.0, size: Any = None) -> Any:
        """`loc`."""
        return loc if size is None else np.full(size, loc)

    def random(self, size: Any = None, *args: Any, **kwargs: Any) -> Any:
        """A half, or otherwise little."""
        drawn = 0.1 if self._otherwise else 0.5
        return drawn if size is None else np.full(size, drawn)

    def integers(self, low: Any, high: Any = None, *args: Any, **kwargs: Any) -> Any:
        """The middle of what could come, rounded down, or otherwise up."""
        least, end = (0, low) if high is None else (low, high)
        return (least + end - 1 + self._otherwise) // 2
