"""The beat of clean gestures: all strokes are equal and begin where tokens begin.

A stroke that lasts a whole number of tokens gives a repeating row of ids, and without random differences in size, pace and
direction the row is the same each time, so that a model can learn it. The details that make a motion lively (sway, breath, small
differences) carry no meaning, and can be added to the motion afterwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.motion import FPS

BEAT_S = FRAMES_PER_TOKEN / FPS
"""Seconds of a beat: one token."""


class Calm(np.random.Generator):
    """A generator that always returns the middle of its range, so that poses, strokes and paces have no randomness.

    Of a gesture that is made in one of two ways at random, it always chooses the first, or with `otherwise` the second.
    """

    def __init__(self, rng: np.random.Generator, otherwise: bool = False) -> None:
        super().__init__(rng.bit_generator)
        self._otherwise = otherwise

    def uniform(self, low: Any = 0.0, high: Any = 1.0, size: Any = None) -> Any:
        """The middle between `low` and `high`."""
        middle = (low + high) / 2
        return middle if size is None else np.full(size, middle)

    def normal(self, loc: Any = 0.0, scale: Any = 1.0, size: Any = None) -> Any:
        """The mean, `loc`."""
        return loc if size is None else np.full(size, loc)

    def random(self, size: Any = None, *args: Any, **kwargs: Any) -> Any:
        """0.5, or 0.1 with `otherwise`."""
        drawn = 0.1 if self._otherwise else 0.5
        return drawn if size is None else np.full(size, drawn)

    def integers(self, low: Any, high: Any = None, *args: Any, **kwargs: Any) -> Any:
        """The middle of the possible integers, rounded down, or up with `otherwise`."""
        least, end = (0, low) if high is None else (low, high)
        return (least + end - 1 + self._otherwise) // 2
