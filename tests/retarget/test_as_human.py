"""A robot's path on a person says what the person said."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import matrix_from_quat, standing_joints
from retarget.human.human import read_human
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot_to_human import joints_of_path
from tests.retarget.random_motions import random_motion


def trunk_joints(retargeter: Retargeter) -> list[int]:
    """Where waist and neck stand among a robot's joints."""
    found = [i for i, joint in enumerate(retargeter.robot.joints) if joint.role.startswith(("waist", "head", "neck"))]
    assert found, retargeter.robot.name
    return found


@pytest.mark.parametrize("robot", ["reference", "op3"])
def test_arms_of_the_path_point_where_the_robots_arms_point(robot: str) -> None:
    retargeter = Retargeter(load_robot(robot))
    q = np.zeros((3, retargeter.robot.n_joints))
    elbow = retargeter.robot.joint_with_role("left_elbow")
    assert elbow is not None
    joint = retargeter.robot.joints[elbow]
    q[:, elbow] = np.linspace(0.2 * joint.position_min_rad, 0.5 * joint.position_max_rad, 3)
    joints, head = joints_of_path(retargeter.kinematics, q)
    places = {p.name: retargeter.kinematics.place(p, q) for p in retargeter.kinematics.key_points}
    bone = places["left_wrist"] - places["left_elbow"]
    seen = joints[:, 20] - joints[:, 18]
    expected = bone[:, [1, 2, 0]] / np.linalg.norm(bone, axis=-1, keepdims=True)
    np.testing.assert_allclose(seen / np.linalg.norm(seen, axis=-1, keepdims=True), expected, atol=1e-9)
    np.testing.assert_allclose(matrix_from_quat(head), np.broadcast_to(np.eye(3), (3, 3, 3)), atol=1e-9)


def test_reading_it_again_gives_the_path_again() -> None:
    """Retargeting what a path shows gives directions that differ little from the path's own.

    But for few frames: a path may end on a joint's limit, where rounding makes the way that it came by one beyond the limit.
    """
    retargeter = Retargeter(load_robot("reference"))
    path = retargeter.retarget(random_motion(3, 60, "smooth"))
    joints, head = joints_of_path(retargeter.kinematics, path.q_rad)
    shown = Motion(
        joints.astype(np.float32), path.rate_hz, head.astype(np.float32), np.zeros((len(joints), 2), np.float32),
        np.zeros((len(joints), 263), np.float32), np.zeros(0, np.int32), "", 0, "accepted", 1.0,
    )  # fmt: skip
    human = read_human(shown)
    again = retargeter.solve(human, None)
    joints_again, _ = joints_of_path(retargeter.kinematics, again)
    for a, b in ((16, 18), (18, 20), (17, 19), (19, 21)):
        first, second = joints[:, b] - joints[:, a], joints_again[:, b] - joints_again[:, a]
        cosine = (first * second).sum(-1) / np.linalg.norm(first, axis=-1) / np.linalg.norm(second, axis=-1)
        apart_deg = np.rad2deg(np.arccos(np.clip(cosine, -1, 1)))
        assert np.percentile(apart_deg, 90) < 1.0
        assert apart_deg.mean() < 3.0
    trunk = trunk_joints(retargeter)
    np.testing.assert_allclose(np.rad2deg(again[:, trunk]), np.rad2deg(path.q_rad[:, trunk]), atol=0.5)


@pytest.mark.parametrize("robot", ["reference", "poppy_torso", "toddlerbot", "op3"])
def test_a_person_who_stands_upright_makes_an_upright_robot(robot: str) -> None:
    """The neck of the skeleton stands before its spine; no waist is to bend for that, and no head to be lifted."""
    retargeter = Retargeter(load_robot(robot))
    ahead = np.tile(np.array([1.0, 0, 0, 0], np.float32), (5, 1))
    motion = Motion(
        np.repeat(standing_joints(), 5, 0).astype(np.float32), 20.0, ahead, np.zeros((5, 2), np.float32),
        np.zeros((5, 263), np.float32), np.zeros(0, np.int32), "", 0, "accepted", 1.0,
    )  # fmt: skip
    human = read_human(motion)
    np.testing.assert_allclose(human.chest_rotation, np.broadcast_to(np.eye(3), (5, 3, 3)), atol=1e-6)
    q = retargeter.solve(human, None)
    np.testing.assert_allclose(np.rad2deg(q[:, trunk_joints(retargeter)]), 0.0, atol=0.5)
