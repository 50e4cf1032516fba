"""A circle that a hand draws once is found where it is, and nothing else is taken for one; a size scales it about its middle."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmm_core.corpus.heldout import Command
from mmm_core.evaluation.manner import judge_manner
from mmm_core.motion.drawn_circles import drawn_circle, farther_hand, loop_width_m, width_m
from mmm_core.motion.performing import Stretch, motion_of, performed
from tests.support.shipped import shipped_engine

_REST, _RAISED = np.array([0.2, -0.6, 0.0]), np.array([0.2, 0.0, 0.45])


def _way(start: np.ndarray, end: np.ndarray, n: int) -> np.ndarray:
    return start + np.linspace(0, 1, n)[:, None] * (end - start)


def _hand(radius_m: float, frames: int, squeeze: float = 1.0, share: float = 1.0) -> np.ndarray:
    """A hand that rises, draws a circle, or a share of it, and sinks."""
    turn = np.linspace(0, 2 * np.pi * share, frames)
    drawn = _RAISED + radius_m * np.stack([np.sin(turn), squeeze * (1 - np.cos(turn)), 0 * turn], -1)
    return np.concatenate([_way(_REST, _RAISED, 12), drawn, _way(drawn[-1], _REST, 12)])


@settings(max_examples=30)
@given(radius_m=st.floats(0.08, 0.3), frames=st.integers(14, 36))
def test_a_circle_is_found_with_its_width(radius_m: float, frames: int) -> None:
    hand = _hand(radius_m, frames)
    found = drawn_circle(hand)
    assert found is not None
    assert abs(found[0] - 12) <= 3 and abs(found[1] - (11 + frames)) <= 3
    assert width_m(hand[found[0] : found[1] + 1]) == pytest.approx(2 * radius_m, rel=0.15)


@pytest.mark.parametrize(
    "hand",
    [
        _hand(0.2, 24, share=0.5),
        _hand(0.2, 24, squeeze=0.3),
        _hand(0.03, 24),
        np.concatenate([_way(_REST, _RAISED, 20), _way(_RAISED, _REST, 20)]),
        np.repeat(_RAISED[None], 40, 0),
        np.zeros((4, 3)),
    ],
    ids=["half", "ellipse", "tiny", "up and down", "held", "short"],
)
def test_what_is_no_circle_is_not_found(hand: np.ndarray) -> None:
    assert drawn_circle(hand) is None


@pytest.mark.parametrize("squeeze", [1.0, 0.5, 0.0], ids=["circle", "ellipse", "line"])
def test_a_loop_is_as_wide_as_a_circle_of_its_area(squeeze: float) -> None:
    assert loop_width_m(_hand(0.2, 24, squeeze=squeeze)) == pytest.approx(0.4 * np.sqrt(squeeze), rel=0.1, abs=0.02)


@pytest.mark.parametrize("factor", [1.4, 0.6])
def test_a_drawn_circle_takes_the_size_asked_for_and_stays_in_place(factor: float) -> None:
    plain = shipped_engine().generate("draw a circle in the air", seed=0).motion
    sized = motion_of(performed(plain.features, [Stretch(0, len(plain.features), size=factor)])[0])
    before, after = (farther_hand(motion.joints_m) for motion in (plain, sized))
    found = drawn_circle(before)
    assert found is not None
    part = slice(found[0], found[1] + 1)
    assert width_m(after[part]) == pytest.approx(factor * width_m(before[part]), rel=0.1)
    assert np.linalg.norm(after[part].mean(0) - before[part].mean(0)) < 0.1
    fastest = [float(np.linalg.norm(np.diff(hand, axis=0), axis=-1).max()) for hand in (before, after)]
    assert fastest[1] < 1.3 * max(1.0, factor) * fastest[0]
    size = "large" if factor > 1 else "small"
    assert judge_manner(Command("draw_circle", "arm", size=size), sized, plain) == {"size": True}
