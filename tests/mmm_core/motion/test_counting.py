"""Whole strokes of a motion are repeated or cut until there are as many as are asked for."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from mmm_core.motion.counting import counted, with_counts
from mmm_core.motion.motion import Motion
from mmm_core.motion.performing import Stretch, motion_of
from mmm_core.motion.repetitions import strokes_of
from tests.support.shipped import shipped_engine

OPENING = 8


@cache
def generated(text: str) -> Motion:
    return shipped_engine().generate(text, seed=3, candidates=1).motion


def strokes_in(features: np.ndarray) -> int:
    found = strokes_of(motion_of(features))
    return 0 if found is None else len(found.frames)


def fastest(features: np.ndarray) -> float:
    """Greatest step of a joint between two frames, metres."""
    return float(np.linalg.norm(np.diff(motion_of(features).joints_m, axis=0), axis=-1).max())


TEXTS, COUNTS = ("nod four times", "clap four times", "bow three times"), (1, 2, 3, 5, 8)


def test_strokes_are_as_many_as_asked_for() -> None:
    """All but two: strokes that run into each other cannot be told apart, and motions differ by the processor's arithmetic."""
    exact = [strokes_in(counted(generated(text).features, n, OPENING)) == n for text in TEXTS for n in COUNTS]
    assert sum(exact) >= len(exact) - 2


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("count", COUNTS)
def test_repeated_and_cut_strokes_leave_the_beginning_and_no_jump(text: str, count: int) -> None:
    features = generated(text).features
    shown = counted(features, count, OPENING)
    assert np.allclose(motion_of(shown).joints_m[:OPENING], motion_of(features).joints_m[:OPENING], atol=0.01), (
        "it begins as it did"
    )
    assert fastest(shown) <= 1.3 * fastest(features), "no seam is a jump"


def test_a_motion_that_has_as_many_strokes_stays() -> None:
    """All its strokes were replaced by one of them, again and again."""
    features = generated("clap four times").features
    assert counted(features, strokes_in(features), OPENING) is features


def test_a_motion_that_stands_still_stays() -> None:
    still = np.repeat(generated("nod four times").features[:1], 40, 0)
    assert counted(still, 3, OPENING) is still


def test_only_the_stretches_with_a_count_change_and_the_others_move_along() -> None:
    features = generated("nod four times").features
    T = len(features)
    twice = np.concatenate([features, features])
    shown, stretches = with_counts(twice, [Stretch(0, T), Stretch(T, 2 * T, tempo=0.6)], [2, None], OPENING)
    assert stretches[0].end == stretches[1].start < T and stretches[1].end == len(shown)
    assert stretches[1].tempo == 0.6
    assert np.array_equal(shown[stretches[1].start :], features)
