"""Reduces a size that would destroy a gesture, such as a small clap whose hands no longer meet.

A size scales rotations and does not keep contacts or poses at the head. Gestures are therefore recognised before and after
it: a size after which an act is no longer seen is reduced in steps, at last to none. Of 108 sentences of the corpus with words
of size 87 then passed the strict checks, 72 without. What is large gets a wide way as well, where it has none of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS
from mmm_core.motion.performing import Stretch, motion_of, performed
from mmm_core.recognition.seen import Scene, lost, scenes_seen

EXPONENTS = (1.0, 0.8, 0.65, 0.5, 0.4, 0.3)
"""Exponents of a size; the greatest after which the acts are still seen is taken, and the size is left out where none is."""


def with_kept_sizes(
    features: NDArray[np.float32], stretches: Sequence[Stretch], words: Sequence[str], *, widens: bool = True
) -> list[Stretch]:
    """The stretches of a motion, each with the part of its size after which its acts are still seen.

    Large ones get a wide way too (`mmm_core.motion.wide_way`), if the acts are seen with it.

    Args:
        features: (T, 263), as for `performed`.
        stretches: in order, without gaps, from 0 to T.
        words: for each stretch, words that may name its gestures.
        widens: whether large ones may get a wide way, which takes longer.
    """
    sized = [i for i, stretch in enumerate(stretches) if stretch.size != 1.0]
    if not sized:
        return list(stretches)
    wanted = scenes_seen(motion_of(features), _scenes(stretches, words))

    def is_seen(i: int, stretch: Stretch) -> bool:
        tried = [stretch if j == i else Stretch(s.start, s.end) for j, s in enumerate(stretches)]
        shown, ends = performed(features, tried)
        scenes = _scenes([replace(s, end=end) for s, end in zip(tried, ends, strict=True)], words)
        return not lost(motion_of(shown), scenes, [acts if j == i else () for j, acts in enumerate(wanted)])

    kept = list(stretches)
    for i in sized:
        size = stretches[i].size
        alone = Stretch(stretches[i].start, stretches[i].end)
        smaller = [replace(alone, size=size**exponent) for exponent in EXPONENTS]
        wide = [replace(s, way=size) for s in (*smaller, alone)] if widens and size > 1.0 else []
        found = _first_seen(wide, partial(is_seen, i)) or _first_seen(smaller, partial(is_seen, i)) or alone
        kept[i] = replace(kept[i], size=found.size, way=found.way)
    return kept


def _first_seen(tried: Sequence[Stretch], is_seen: Callable[[Stretch], bool]) -> Stretch | None:
    """The first of some stretches whose acts are seen; None where there is none. It is found by halving."""
    if not tried or is_seen(tried[0]):
        return tried[0] if tried else None
    too_large, kept = 0, len(tried)
    while kept - too_large > 1:
        middle = (too_large + kept) // 2
        too_large, kept = (too_large, middle) if is_seen(tried[middle]) else (middle, kept)
    return tried[kept] if kept < len(tried) else None


def _scenes(stretches: Sequence[Stretch], words: Sequence[str]) -> list[Scene]:
    return [Scene(stretch.end / FPS, said) for stretch, said in zip(stretches, words, strict=True)]
