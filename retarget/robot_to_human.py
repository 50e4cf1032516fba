"""The inverse of retargeting: from a robot's joint angles to the 22 joints and the head of a person, for checks and pictures.

The person's chest turns like the robot's, the arms point in the robot's directions, and bones have a person's lengths. Body parts
that the robot lacks (legs, a waist, a neck joint) stand still.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import N_FEATURES, Motion
from mmm_core.motion.skeleton import BONE_LENGTHS_M, REST_DIRECTIONS, quat_wxyz, standing_joints
from retarget.pipeline import Retargeter
from retarget.robot.kinematics import Kinematics

Array = NDArray[np.float64]
_TO_HUMAN = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
"""Rotation from robot axes (forward, left, up) to a person's (left, up, forward)."""
_ARMS = {"left": (16, 18, 20), "right": (17, 19, 21)}
_ABOVE_CHEST = (6, 9, 12, 13, 14, 15, 16, 17)
"""Joints that turn with the chest, about the first joint of the spine."""


def joints_of_path(kinematics: Kinematics, q_rad: Array) -> tuple[Array, Array]:
    """Joints (T, 22, 3) in metres, y up, and head orientation (T, 4) of a robot's path (T, J)."""
    T = len(q_rad)
    joints = np.repeat(standing_joints(), T, 0)
    points = {p.name: p for p in kinematics.key_points}
    chest = _orientation(kinematics, points["chest"].chain if "chest" in points else (), q_rad)
    base = joints[:, 3:4]
    above = joints[:, _ABOVE_CHEST] - base
    joints[:, _ABOVE_CHEST] = base + np.einsum("tij,tkj->tki", chest, above)
    for side, (shoulder, elbow, wrist) in _ARMS.items():
        start = joints[:, shoulder]
        for joint, (a, b) in ((elbow, ("shoulder", "elbow")), (wrist, ("elbow", "wrist"))):
            bone = kinematics.place(points[f"{side}_{b}"], q_rad) - kinematics.place(points[f"{side}_{a}"], q_rad)
            bone = bone @ _TO_HUMAN.T / np.linalg.norm(bone, axis=-1, keepdims=True)
            start = joints[:, joint] = start + BONE_LENGTHS_M[joint] * bone
    head = _orientation(kinematics, points["head"].chain if "head" in points else (), q_rad)
    joints[:, 15] = joints[:, 12] + BONE_LENGTHS_M[15] * (head @ REST_DIRECTIONS[15])
    return joints.astype(np.float64), quat_wxyz(head).astype(np.float64)


def shown_on_a_person(retargeter: Retargeter, motion: Motion) -> Motion:
    """A motion retargeted to a robot and transferred back to a person; an empty motion stays empty."""
    if not len(motion.joints_m):
        return motion
    path = retargeter.retarget(motion)
    return as_motion(retargeter.kinematics, path.q_rad, path.rate_hz, motion)


def as_motion(kinematics: Kinematics, q_rad: Array, fps: float, motion: Motion) -> Motion:
    """`motion` with the joints and the head of a robot's poses (T, J)."""
    joints, head = joints_of_path(kinematics, q_rad)
    T = len(joints)
    return replace(
        motion, joints_m=joints.astype(np.float32), fps=fps, head_quat_wxyz=head.astype(np.float32),
        forearm_twist_rad=np.zeros((T, 2), np.float32), features=np.zeros((T, N_FEATURES), np.float32),
        tokens=np.zeros(0, np.int32),
    )  # fmt: skip


def _orientation(kinematics: Kinematics, chain: tuple[int, ...], q_rad: Array) -> Array:
    """(T, 3, 3) rotation of the end of a chain against the zero pose, in a person's axes."""
    columns = np.stack([kinematics.turn(chain, q_rad, axis) for axis in np.eye(3)], -1)
    return _TO_HUMAN @ columns @ _TO_HUMAN.T
