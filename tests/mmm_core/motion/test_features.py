"""Features and back, on made-up and on real motion."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mmm_core.motion.features import features_from_joints, joints_from_positions, mirror, recover
from mmm_core.motion.skeleton import (
    MIRROR,
    REST_DIRECTIONS,
    facing_yaw_rad,
    forward_kinematics,
    from_six_d,
    local_rotations,
    matrix_from_quat,
    normalise,
    quat_wxyz,
    rotation_about,
    rotation_y,
    six_d,
    smallest_rotation,
    twist_about_bone_rad,
)

SHARED = Path(os.environ.get("MMMD_SHARED", Path(__file__).parents[4] / "shared"))
finite = st.floats(-1, 1, allow_nan=False)
angles = st.floats(-3.0, 3.0)


def random_motion(seed: int, T: int = 30) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joints on the common body, head rotation, forearm twist: small smooth rotations, a turning and walking root."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, T)[:, None, None]
    axis = normalise(rng.normal(size=(1, 22, 3)))
    angle = (rng.uniform(-0.9, 0.9, (1, 22, 1)) * np.sin(2 * np.pi * t * rng.uniform(0.3, 1.5)))[..., 0]
    local = rotation_about(np.broadcast_to(axis, (T, 22, 3)), angle)
    local[:, 0] = rotation_y(np.linspace(0, rng.uniform(-2, 2), T))
    root = np.stack([t[:, 0, 0], 0.9 + 0.02 * t[:, 0, 0], -0.4 * t[:, 0, 0] ** 2], -1)
    joints, world = forward_kinematics(local, root)
    twist = 0.8 * np.sin(3 * t[:, 0] + np.array([0.0, 1.0]))
    return joints, world[:, 15], twist


@given(st.integers(0, 200))
def test_features_give_back_joints_head_and_twist(seed: int) -> None:
    joints, head, twist = random_motion(seed)
    got = recover(features_from_joints(joints, head, twist))
    yaw0 = facing_yaw_rad(joints)[0]
    back = rotation_y(np.array(yaw0))
    world = np.einsum("ij,tkj->tki", back, got.joints_m) + joints[0, 0] * [1, 0, 1]
    assert np.abs(world - joints).max() < 2e-3  # the features are float32 and summed over 30 frames
    assert np.abs(back @ matrix_from_quat(got.head_quat_wxyz) - head).max() < 1e-3
    assert np.abs(got.forearm_twist_rad - twist).max() < 1e-3


def test_position_channels_say_the_same_as_the_rotations() -> None:
    joints, head, twist = random_motion(3)
    features = features_from_joints(joints, head, twist)
    assert np.abs(joints_from_positions(features) - recover(features).joints_m).max() < 2e-3


@given(st.integers(0, 100))
def test_the_mirror_of_features_is_the_features_of_the_mirror(seed: int) -> None:
    joints, head, twist = random_motion(seed)
    flipped = joints[:, MIRROR] * np.array([-1, 1, 1])
    M = np.diag([-1.0, 1, 1])
    expected = features_from_joints(flipped, M @ head @ M, -twist[:, ::-1])
    got = mirror(features_from_joints(joints, head, twist))
    assert np.abs(got - expected).max() < 1e-4
    assert np.allclose(mirror(got), features_from_joints(joints, head, twist), atol=1e-6)


@given(arrays(np.float64, 3, elements=finite).filter(lambda v: np.linalg.norm(v) > 0.1), angles)
def test_rotation_representations_agree(axis: np.ndarray, angle: float) -> None:
    R = rotation_about(normalise(axis), np.array(angle))
    assert np.allclose(R @ R.T, np.eye(3), atol=1e-9)
    assert np.allclose(from_six_d(six_d(R)), R, atol=1e-9)
    assert np.allclose(matrix_from_quat(quat_wxyz(R)), R, atol=1e-6)


def test_half_turns_have_a_quaternion() -> None:
    for axis in np.eye(3):
        R = rotation_about(axis, np.array(np.pi))
        assert np.allclose(matrix_from_quat(quat_wxyz(R[None])), R, atol=1e-6)


@given(arrays(np.float64, (2, 3), elements=finite).filter(lambda v: (np.linalg.norm(v, axis=1) > 0.1).all()))
def test_the_smallest_rotation_turns_a_into_b(pair: np.ndarray) -> None:
    a, b = normalise(pair)
    if a @ b > -0.999:
        R = smallest_rotation(a, b)
        assert np.allclose(R @ a, b, atol=1e-6)
        assert np.isclose(np.trace(R), 1 + 2 * (a @ b), atol=1e-6), "its angle is the angle between them"


@given(angles, st.sampled_from([20, 21]))
def test_a_twist_is_read_back_and_moves_no_bone(angle: float, joint: int) -> None:
    swing = smallest_rotation(REST_DIRECTIONS[joint], normalise(np.array([0.3, 0.5, 0.6])))
    local = swing @ rotation_about(REST_DIRECTIONS[joint], np.array(angle))
    assert np.isclose(twist_about_bone_rad(local[None], joint)[0], angle, atol=1e-6)
    assert np.allclose(local @ REST_DIRECTIONS[joint], swing @ REST_DIRECTIONS[joint])


@pytest.mark.skipif(not (SHARED / "data").is_dir(), reason="the shared motion data is not beside this checkout")
def test_real_motion_survives_features() -> None:
    with np.load(SHARED / "data/motions_common_skeleton.npz") as data:
        for name in list(data.files)[::20]:
            joints = data[name][:200].astype(np.float64)
            yaw = facing_yaw_rad(joints)
            direct, _ = forward_kinematics(local_rotations(joints, yaw), joints[:, 0])
            assert np.abs(direct - joints).max() < 1e-3, name
