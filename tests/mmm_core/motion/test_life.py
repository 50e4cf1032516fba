"""Movements of trunk and head laid over a motion: small, mirrored exactly, the same in a preview, ahead of the arms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from mmm_core.corpus.synthesis import synthesise
from mmm_core.motion.features import recover
from mmm_core.motion.life import OPENING_FRAMES, Life, alive
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.posture_features import posture_features
from mmm_core.motion.skeleton import MIRROR, matrix_from_quat
from tests.support.sizes import few_and_long

Array = NDArray[np.floating]
STILL = replace(Life(), chest_sway=(0.0, 0.0, 0.0), head_sway=(0.0, 0.0, 0.0))
LOWER = [0, 1, 2, 3, 4, 5, 7, 8, 10, 11]


def gesture(seed: int) -> Motion:
    """A motion of the corpus."""
    features = synthesise(np.random.default_rng((5, seed))).body.features()
    seen = recover(features)
    return Motion(
        seen.joints_m.astype(np.float32), FPS, seen.head_quat_wxyz.astype(np.float32),
        seen.forearm_twist_rad.astype(np.float32), features, np.zeros(0, np.int32), "wave", seed, "accepted", 1.0,
    )  # fmt: skip


def mirrored(m: Motion) -> Motion:
    """Left for right."""
    return replace(
        m,
        joints_m=m.joints_m[:, list(MIRROR)] * np.array([-1, 1, 1], np.float32),
        head_quat_wxyz=m.head_quat_wxyz * np.array([1, 1, -1, -1], np.float32),
        forearm_twist_rad=-m.forearm_twist_rad[:, ::-1],
    )


def lifted(n_before: int, n_up: int, n_after: int) -> Motion:
    """A person who stands, lifts the right hand sideways to the shoulder's height and lets it down, each in a second."""
    still = gesture(3)
    joints = np.repeat(still.joints_m[:1], n_before + n_up + n_after + 40, 0)
    u = np.arange(1, 21) / 20
    rise = u**3 * (10 - 15 * u + 6 * u**2)
    angle = np.pi / 2 * np.concatenate([np.zeros(n_before), rise, np.ones(n_up), 1 - rise, np.zeros(n_after)])
    arm = np.stack([-np.sin(angle), -np.cos(angle), 0 * angle], -1)
    joints[:, 19], joints[:, 21] = joints[:, 17] + 0.262 * arm, joints[:, 17] + 0.514 * arm
    n = len(joints)
    identity = np.tile(np.array([1, 0, 0, 0], np.float32), (n, 1))
    return Motion(
        joints.astype(np.float32), FPS, identity, np.zeros((n, 2), np.float32), np.zeros((n, 263), np.float32),
        np.zeros(0, np.int32), "raise your right hand", 0, "accepted", 1.0,
    )  # fmt: skip


def chest_pitch_deg(m: Motion) -> Array:
    return posture_features(m.joints_m, m.head_quat_wxyz).trunk_pitch_deg


@pytest.mark.parametrize("seed", few_and_long(range(3), range(12)))
def test_the_mirrored_motion_becomes_the_mirror_image_to_the_last_bit(seed: int) -> None:
    m = gesture(seed)
    image, of_image = mirrored(alive(m)), alive(mirrored(m), is_mirrored=True)
    assert np.array_equal(image.joints_m, of_image.joints_m)
    assert np.array_equal(image.head_quat_wxyz, of_image.head_quat_wxyz)


@pytest.mark.parametrize("seed", few_and_long(range(2), range(6)))
def test_motions_that_share_their_opening_still_share_it(seed: int) -> None:
    """A preview and its motion: what comes after the opening, and how long it is, changes none of its frames."""
    m, other = gesture(seed), gesture(seed + 1)
    n = OPENING_FRAMES
    longer = replace(
        m, **{key: np.concatenate([getattr(m, key)[:n], getattr(other, key)[n:]]) for key in
              ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features")},
    )  # fmt: skip
    a, b = alive(m), alive(longer)
    assert np.array_equal(a.joints_m[:n], b.joints_m[:n]) and np.array_equal(a.head_quat_wxyz[:n], b.head_quat_wxyz[:n])
    assert not np.array_equal(a.joints_m[:n], m.joints_m[:n])


@pytest.mark.parametrize("seed", few_and_long(range(3), range(12)))
def test_ends_legs_and_arms_against_the_chest_stay_and_nothing_turns_far(seed: int) -> None:
    m = gesture(seed)
    a = alive(m)
    for k in (0, -1):
        assert np.allclose(a.joints_m[k], m.joints_m[k], atol=1e-6)
    assert np.array_equal(a.joints_m[:, LOWER], m.joints_m[:, LOWER])
    before, after = (posture_features(x.joints_m, x.head_quat_wxyz) for x in (m, a))
    for side in ("left", "right"):
        assert np.allclose(before.upper[side], after.upper[side], atol=1e-4)
        assert np.allclose(before.fore[side], after.fore[side], atol=1e-4)
    turned = np.swapaxes(matrix_from_quat(m.head_quat_wxyz), 1, 2) @ matrix_from_quat(a.head_quat_wxyz)
    cosine = (np.trace(turned, axis1=1, axis2=2) - 1) / 2
    most_deg = 2 * np.sqrt(3) * Life().most  # chest and head on it, each about three axes
    assert np.rad2deg(np.arccos(np.clip(cosine, -1, 1))).max() < most_deg
    assert np.allclose(np.linalg.norm(a.head_quat_wxyz, axis=-1), 1, atol=1e-5)


def test_the_seed_alone_chooses_the_sway() -> None:
    m = gesture(1)
    assert np.array_equal(alive(m).joints_m, alive(m).joints_m)
    assert not np.array_equal(alive(m).joints_m, alive(replace(m, seed=99)).joints_m)


def test_the_head_goes_before_the_hand_and_comes_back_while_it_stays() -> None:
    m = lifted(20, 40, 40)
    a = alive(m, life=STILL)
    yaw = -posture_features(a.joints_m, a.head_quat_wxyz).head_yaw_deg
    up = m.joints_m[:, 21, 1]
    hand = int(np.argmax(up > (up.min() + up.max()) / 2))
    out = yaw[:50]
    assert out.max() > 3.0, "the head does not turn to the hand"
    head = int(np.argmax(out > out.max() / 2))
    assert head <= hand - 2, f"the head is half way at frame {head}, the hand at {hand}"
    assert yaw[75] < out.max() / 2, "the head does not come back"


def test_the_chest_goes_along_and_settles_when_the_arm_comes_down() -> None:
    m = lifted(20, 40, 40)
    pitch = chest_pitch_deg(alive(m, life=STILL)) - chest_pitch_deg(m)
    assert pitch[45:75].mean() < -1.0, "the trunk does not balance the arm"
    assert pitch[85:102].max() > 1.0, "the chest does not sink"
    assert abs(pitch[-1]) < 0.05


def test_little_is_left_where_nothing_moves() -> None:
    """A statue that sways by more than a few degrees is none."""
    m = lifted(20, 40, 40)
    still = replace(m, joints_m=np.repeat(m.joints_m[:1], len(m.joints_m), 0))
    seen = posture_features(alive(still).joints_m, alive(still).head_quat_wxyz)
    assert max(np.ptp(seen.trunk_yaw_deg), np.ptp(seen.trunk_roll_deg), np.ptp(seen.trunk_pitch_deg)) < 3.0


def test_a_motion_too_short_or_of_another_rate_comes_back() -> None:
    m = gesture(2)
    cut = replace(m, **{k: getattr(m, k)[:6] for k in ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features")})
    assert alive(cut) is cut
    other = replace(m, fps=30.0)
    assert alive(other) is other
