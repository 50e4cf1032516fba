"""A large gesture whose hand cannot go farther where it ends swings out on its way, and ends as before."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from mmm_core.corpus.heldout import Command
from mmm_core.evaluation.manner import judge_manner
from mmm_core.generate.kept_sizes import with_kept_sizes
from mmm_core.motion.features import recover
from mmm_core.motion.performing import Stretch, performed
from tests.support.shipped import shipped_engine

FPS = 20.0


def features_of(text: str) -> NDArray[np.float32]:
    return shipped_engine().generate(text, seed=0).motion.features


def joints_of(features: NDArray[np.float32]) -> NDArray[np.float64]:
    return np.asarray(recover(features).joints_m, np.float64)


def farthest_m(joints: NDArray[np.float64]) -> float:
    hands = joints[:, 20:] - joints[:, [9]]
    return float(np.linalg.norm(hands - hands[0], axis=-1).max())


@pytest.mark.parametrize(
    "text", ["yawn behind your hand", "put your hand over your mouth", "open your arms wide", "swing a golf club"]
)
def test_hands_go_farther_and_end_where_they_ended(text: str) -> None:
    features = features_of(text)
    wide, ends = performed(features, [Stretch(0, len(features), way=1.4)])
    before, after = joints_of(features), joints_of(wide)
    assert farthest_m(after) > 1.15 * farthest_m(before)
    assert ends == [len(wide)]
    n_after_way = len(features) // 3
    np.testing.assert_allclose(after[-n_after_way:], before[-n_after_way:], atol=1e-4)
    np.testing.assert_allclose(after[0], before[0], atol=1e-4)


@pytest.mark.parametrize(("text", "times"), [("saw wood", 1.4**0.5), ("bow", 1.0)])
def test_large_strokes_take_longer_unless_a_tempo_is_asked_for(text: str, times: float) -> None:
    """Sawing with long strokes at the same pace, a robot's arm was no farther out than before: it could not accelerate enough."""
    features = features_of(text)
    n = len(features)
    large, _ = performed(features, [Stretch(0, n, size=1.4)])
    small, _ = performed(features, [Stretch(0, n, size=0.6)])
    fast, _ = performed(features, [Stretch(0, n, size=1.4, tempo=1.6)])
    assert len(large) == pytest.approx(times * n, abs=1) and len(small) == n
    assert len(fast) == pytest.approx(n / 1.6, abs=1)


def test_no_hand_is_much_faster_on_its_wide_way() -> None:
    for text in ("yawn behind your hand", "put your hand over your mouth", "flex your right arm"):
        features = features_of(text)
        wide, _ = performed(features, [Stretch(0, len(features), way=1.4)])
        fastest = [
            float(np.linalg.norm(np.diff(joints_of(f)[:, 20:], axis=0), axis=-1).max()) * FPS for f in (features, wide)
        ]
        assert fastest[1] < 1.6 * fastest[0], text


@pytest.mark.parametrize("text", ["nod", "bow", "wave your left hand", "stand still"])
def test_what_has_no_way_or_repeats_a_stroke_stays_as_it_is(text: str) -> None:
    features = features_of(text)
    wide, _ = performed(features, [Stretch(0, len(features), way=1.4)])
    plain, _ = performed(features, [Stretch(0, len(features))])
    np.testing.assert_array_equal(wide, plain)


@pytest.mark.parametrize(("tempo", "hold_s"), [(0.5, 0.0), (2.5, 0.0), (1.0, 3.0), (1.6, 1.0)])
def test_a_wide_way_goes_with_tempo_and_hold(tempo: float, hold_s: float) -> None:
    for text in ("yawn behind your hand", "open your arms wide", "throw a ball"):
        features = features_of(text)
        wide, ends = performed(features, [Stretch(0, len(features), tempo=tempo, hold_s=hold_s, way=1.4)])
        assert np.isfinite(wide).all() and ends == [len(wide)]
        assert farthest_m(joints_of(wide)) >= 0.99 * farthest_m(joints_of(features)), text


def test_of_two_commands_one_alone_gets_a_wide_way() -> None:
    rows = [features_of("yawn behind your hand"), features_of("put your hand over your mouth")]
    features = np.concatenate(rows)
    n = len(rows[0])
    stretches = [Stretch(0, n, way=1.4), Stretch(n, len(features))]
    wide, ends = performed(features, stretches)
    assert ends[1] - ends[0] == len(rows[1])
    np.testing.assert_allclose(joints_of(wide)[ends[0] :], joints_of(features)[n:], atol=1e-4)


def test_a_huge_yawn_is_larger_and_still_a_yawn() -> None:
    text = "yawn behind your hand"
    features = features_of(text)
    kept = with_kept_sizes(features, [Stretch(0, len(features), size=1.45)], [text])
    assert kept[0].way == 1.45
    engine = shipped_engine()
    shown, plain = (engine.generate(t, seed=0).motion for t in (f"exactly: {text} (1.45 times as large)", text))
    assert judge_manner(Command("yawn", "arm", size="large"), shown, plain) == {"size": True}


def test_a_length_that_is_asked_for_leaves_no_time_for_a_wide_way() -> None:
    features = features_of("yawn behind your hand")
    asked = [Stretch(0, len(features), size=1.45)]
    assert with_kept_sizes(features, asked, ["yawn behind your hand"], widens=False)[0].way == 1.0
    assert len(shipped_engine().generate("yawn hugely", seed=0, seconds=3.0).motion.joints_m) == 60
