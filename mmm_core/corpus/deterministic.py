"""Makes deterministic clips: one motion for each gesture, with captions in the words that the engine passes to the model.

A masked model decodes many tokens at once, each by itself. If one sentence has many motions (longer and shorter pauses, other
tempos, three or four strokes), tokens of different motions meet in a row, and strokes come out halved. So these clips have no
randomness: pauses have their usual length, a sentence that names no number means the usual one, and words of tempo, size and hold
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
"""Share of gestures drawn without a style that get one, if their family has styles: every style of a gesture is another motion to
learn, and `draw_gesture` gives a style to only 7 gestures in 100."""


def synthesise_deterministic(rng: np.random.Generator, weights: Mapping[str, float] | None = None) -> SynthClip:
    """A clip of one gesture drawn at random; its captions are sentences in the words that the engine passes to the model.

    Args:
        rng: draws the gesture and the sentences; the motion depends on nothing but the gesture.
        weights: weights of the families, as in `synthesis.draw_gesture`.
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
    """The words that the engine passes to the model for a sentence, or None if these do not determine the gesture.

    They do not if the engine reads several commands, if the sentence names no number and the gesture has an unusual one, or if
    the engine takes words of height for words of size ("halfway"), so that the words left are those of the usual height.
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
    """The number of strokes that a sentence without a number means: the middle one of the family's usual numbers."""
    counts = sorted(FAMILIES[family].counts)
    return counts[(len(counts) - 1) // 2]
