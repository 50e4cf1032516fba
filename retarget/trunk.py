"""Waist and neck: angles of the trunk and the head on the joints that a robot has.

The waist takes the chest's turn and bend against the pelvis. The neck takes what is left of the head's orientation
above the robot's own chest: a robot without a waist then bows with its head.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.human import HumanPose
from retarget.kinematics import Kinematics, rotate

Array = NDArray[np.float64]
_UP, _LEFT = np.array([0.0, 0, 1]), np.array([0.0, 1, 0])


def solve_waist(kinematics: Kinematics, human: HumanPose, q_rad: Array) -> None:
    """Write the waist joints of `q_rad` (T, J), where the robot has any."""
    _write(kinematics, "waist_yaw", _UP, human.trunk_yaw_rad, q_rad)
    _write(kinematics, "waist_pitch", _LEFT, human.trunk_pitch_rad, q_rad)


def solve_neck(kinematics: Kinematics, human: HumanPose, q_rad: Array) -> None:
    """Write the neck joints of `q_rad` (T, J); its waist joints must be final."""
    robot = kinematics.robot
    waist = tuple(j for r in ("waist_yaw", "waist_pitch") if (j := robot.joint_with_role(r)) is not None)
    chain = tuple(sorted(waist, key=lambda j: len(kinematics.chains[j])))
    forward = human.head_rotation[..., 0]
    for j in chain:  # into the frame of the robot's chest
        forward = rotate(kinematics.axes[j], -q_rad[:, j], forward)
    _write(kinematics, "head_yaw", _UP, np.arctan2(forward[:, 1], forward[:, 0]), q_rad)
    _write(kinematics, "head_pitch", _LEFT, -np.arcsin(np.clip(forward[:, 2], -1, 1)), q_rad)


def _write(kinematics: Kinematics, role: str, axis: Array, angle_rad: Array, q_rad: Array) -> None:
    joint = kinematics.robot.joint_with_role(role)
    if joint is not None:
        sign = 1.0 if kinematics.axes[joint] @ axis >= 0 else -1.0
        q_rad[:, joint] = sign * np.unwrap(angle_rad)
