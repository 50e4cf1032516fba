"""A gesture that its words decide alone: one motion for each gesture, and the words that the engine gives the model for it.

A masked model decodes many tokens at once, each by itself. Where one sentence has many motions (longer and shorter pauses, other
tempos, three or four strokes), tokens of different ones meet in a row, and strokes come out halved. So nothing of these clips is
left to chance: pauses are of usual length, a sentence that names no number has the usual one, and words of tempo, size and hold
are left out, since the engine applies them to the finished motion (`mmm_core.motion.performing`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.synthesis import ClipSpec, SynthClip, draw_gesture, has_styles, in_a_style, synthesise_spec
from mmm_core.language.count_words import count_asked
from mmm_core.language.reading import read

STYLED_SHARE = 0.2
"""Share of gestures without a style that get one where they can: every style of a gesture is a motion to learn, and `draw_gesture`
gives one to 7 in 100."""


def synthesise_deterministic(rng: np.random.Generator, weights: Mapping[str, float] | None = None) -> SynthClip:
    """A clip of one gesture drawn at random, whose captions are what the engine gives the model for sentences that ask for it.

    Args:
        rng: draws the gesture and the sentences; the motion depends on the gesture alone.
        weights: how often each family is drawn, as of `synthesis.draw_gesture`.
    """
    while True:
        drawn = draw_gesture(rng, weights=weights)
        if not drawn.style and has_styles(FAMILIES[drawn.family]) and rng.random() < STYLED_SHARE:
            drawn = in_a_style(drawn, rng)
        gesture = replace(drawn, hold_s=0.0) if drawn.style else replace(drawn, hold_s=0.0, tempo=1.0, size=1.0)
        clip = synthesise_spec(ClipSpec((gesture,)), rng, BEAT_S, deterministic=True)
        captions = [] if clip is None else [w for c in clip.captions if (w := words_given(c, gesture)) is not None]
        if clip is not None and captions:
            return replace(clip, captions=captions)


def words_given(caption: str, gesture: Gesture) -> str | None:
    """The words that the engine gives the model for a sentence.

    None where it reads several commands in it, where no number is named and the gesture has not the usual number of strokes, and
    where it takes the words of a height for those of a size ("halfway"), which leaves the words of the usual height.
    """
    steps = read(caption).steps
    if len(steps) != 1 or len(steps[0]) != 1:
        return None
    if (
        FAMILIES[gesture.family].counts
        and count_asked(caption) is None
        and gesture.count != usual_count(gesture.family)
    ):
        return None
    if gesture.height and steps[0][0].manner.size != 1.0:
        return None
    return steps[0][0].text


def usual_count(family: str) -> int:
    """The number of strokes where none is named: the middle one of the numbers that need not be said."""
    counts = sorted(FAMILIES[family].counts)
    return counts[(len(counts) - 1) // 2]
