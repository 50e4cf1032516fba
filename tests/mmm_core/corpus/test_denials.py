"""Sentences with a negative word around a gesture."""

from __future__ import annotations

import random
from collections import Counter

import pytest

from mmm_core.corpus.denials import KINDS, MEANT, NOTHING, Pattern, denial_patterns, draw_denial
from mmm_core.corpus.heldout import read_sentences


def test_each_pattern_has_a_gesture_and_is_there_once() -> None:
    patterns = denial_patterns()
    assert set(Counter(pattern.kind for pattern in patterns)) == set(KINDS)
    assert len({pattern.words.lower() for pattern in patterns}) == len(patterns) > 900
    assert all("{v}" in pattern.words or "{g}" in pattern.words for pattern in patterns)
    assert not [pattern for pattern in patterns if pattern.kind == MEANT and "{w}" in pattern.words]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("you needn't {v} for me", "you needn't wave your hand for me"),
        ("less {g}, more {h}", "less waving your hand, more bowing"),
    ],
)
def test_slots_are_filled(words: str, said: str) -> None:
    sentence, slots = Pattern(NOTHING, words).filled("wave your hand", "bow")
    assert sentence == said
    assert {said[slot.start : slot.end] for slot in slots} <= {"wave your hand", "waving your hand", "bow", "bowing"}


def test_no_slot_is_left_and_no_sentence_is_one_that_measures() -> None:
    rng, patterns = random.Random(3), denial_patterns()
    drawn = {draw_denial(rng, patterns, "clap", "bow politely")[0] for _ in range(2000)}
    assert not [said for said in drawn if "{v}" in said or "{g}" in said or "{w}" in said or "{h}" in said]
    measured = {
        sentence.text.lower()
        for name in ("test", "test_1", "test_2", "test_3", "test_4", "test_5")
        for sentence in read_sentences(f"words_{name}")
    }
    assert not measured & {said.lower() for said in drawn}
