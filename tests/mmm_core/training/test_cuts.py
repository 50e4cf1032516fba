"""Cuts of a recording: their number and lengths, and that a faster motion goes the same way with the same poses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.synthesis import synthesise
from mmm_core.motion.features import recover
from mmm_core.training.batches import Clip
from mmm_core.training.cuts import FASTEST, LATEST_FRAME, LEFT_OUT, at_speed, cuts_of


@pytest.fixture(scope="module", name="features")
def _features() -> np.ndarray:
    return synthesise(np.random.default_rng(4)).features


@given(seed=st.integers(0, 2**32), n=st.integers(1, 6), length=st.integers(1, 190))
def test_cuts_are_whole_tokens_of_about_the_clip(features: np.ndarray, seed: int, n: int, length: int) -> None:
    clip = Clip(np.resize(features, (length, features.shape[1])), ["a person waves"], True)
    first, *more = cuts_of(clip, n, np.random.default_rng(seed))
    assert len(first.features) == length // 4 * 4
    assert len(more) == n - 1 or length < 40
    shortest = ((1 - LEFT_OUT) * length - LATEST_FRAME) / FASTEST - 5
    for one in more:
        assert one.captions == clip.captions and one.is_real
        assert len(one.features) % 4 == 0 and shortest <= len(one.features) <= min(196, FASTEST * length + 1)
        assert len(one.features) >= 8 and np.isfinite(one.features).all()


def test_cuts_are_the_same_for_the_same_seed_and_differ_from_each_other(features: np.ndarray) -> None:
    clip = Clip(features, ["a person waves"], True)
    once, again = (cuts_of(clip, 5, np.random.default_rng(7)) for _ in range(2))
    assert all(np.array_equal(a.features, b.features) for a, b in zip(once, again, strict=True))
    assert len({one.features.tobytes() for one in once}) == 5


@pytest.mark.parametrize("speed", [1 / FASTEST, 0.95, 1.0, 1.1, FASTEST])
def test_a_motion_at_another_speed_has_the_same_poses_sooner_or_later(features: np.ndarray, speed: float) -> None:
    """The root covers the same distance and angle, and at equal places in the motion the joints are in equal positions."""
    moving = features.copy()
    moving[:, 0], moving[:, 2] = 0.004, 0.02  # turns and walks
    faster = at_speed(moving, speed)
    assert abs(len(faster) - len(moving) / speed) <= 1
    was, now = recover(moving).joints_m, recover(faster).joints_m
    at = np.minimum(np.arange(len(now)) * speed, len(was) - 1)
    nearest = np.round(at).astype(int)
    on_a_frame = np.abs(at - nearest) < 0.05
    assert on_a_frame.sum() >= 3
    assert np.abs(now[on_a_frame] - was[nearest[on_a_frame]]).max() < 0.03
    assert np.allclose(faster[:, 193:259].mean(0), speed * moving[:, 193:259].mean(0), atol=2e-3)
