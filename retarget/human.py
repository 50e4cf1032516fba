"""What a human motion says to a robot: chest frame, arm directions in it, trunk and head angles.

Human frame: x left, y up, z forward. Robot frame: x forward, y left, z up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion import Motion
from mmm_core.skeleton import matrix_from_quat
from retarget.errors import MotionError
from retarget.kinematics import cross

Array = NDArray[np.float64]
_TO_ROBOT = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
_L_HIP, _R_HIP, _SPINE1, _NECK = 1, 2, 3, 12
_ARMS = {"left": (16, 18, 20), "right": (17, 19, 21)}
_SHORTEST_BONE_M = 0.02


@dataclass(frozen=True)
class HumanPose:
    """(T, ...) what is read from a motion, in the robot's axes.

    Attributes:
        upper, fore: per side, (T, 3) unit directions in the chest frame.
        forearm_twist_rad: per side, (T,).
        trunk_yaw_rad, trunk_pitch_rad: (T,) chest against pelvis: to the left, forward.
        head_rotation: (T, 3, 3) head against the pelvis's facing.
    """

    upper: dict[str, Array]
    fore: dict[str, Array]
    forearm_twist_rad: dict[str, Array]
    trunk_yaw_rad: Array
    trunk_pitch_rad: Array
    head_rotation: Array


def read_human(motion: Motion) -> HumanPose:
    """Directions and angles of a motion.

    Raises:
        MotionError: no frames, or bones without length.
    """
    joints = motion.joints_m.astype(np.float64)
    if len(joints) == 0:
        raise MotionError("joints", "no frames", "at least one frame; a rejected text has none")
    for side, (shoulder, elbow, wrist) in _ARMS.items():
        for a, b in ((shoulder, elbow), (elbow, wrist)):
            shortest = float(np.linalg.norm(joints[:, b] - joints[:, a], axis=-1).min())
            if shortest < _SHORTEST_BONE_M:
                raise MotionError(
                    f"{side} arm", f"a bone of {shortest:.4f} m", f"bones of at least {_SHORTEST_BONE_M} m"
                )
    pelvis = _frame(joints[:, _L_HIP] - joints[:, _R_HIP], np.broadcast_to([0.0, 1, 0], joints[:, 0].shape))
    across = joints[:, 13] - joints[:, 14] + 0.5 * (joints[:, 16] - joints[:, 17])
    chest = _frame(across, joints[:, _NECK] - joints[:, _SPINE1])
    relative = np.swapaxes(pelvis, -1, -2) @ chest
    forward, up = relative[..., 2], relative[..., 1]
    yaw = np.arctan2(forward[:, 0], forward[:, 2])
    facing = np.stack([np.sin(yaw), np.zeros_like(yaw), np.cos(yaw)], -1)
    pitch = np.arctan2((up * facing).sum(-1), up[:, 1])
    head = np.swapaxes(pelvis, -1, -2) @ matrix_from_quat(motion.head_quat_wxyz.astype(np.float64))
    to_chest = np.swapaxes(chest, -1, -2)

    def direction(a: int, b: int) -> Array:
        bone = joints[:, b] - joints[:, a]
        bone = bone / np.linalg.norm(bone, axis=-1, keepdims=True)
        return np.einsum("ij,tjk,tk->ti", _TO_ROBOT, to_chest, bone)

    return HumanPose(
        {side: direction(shoulder, elbow) for side, (shoulder, elbow, _) in _ARMS.items()},
        {side: direction(elbow, wrist) for side, (_, elbow, wrist) in _ARMS.items()},
        {side: motion.forearm_twist_rad[:, i].astype(np.float64) for i, side in enumerate(_ARMS)},
        yaw,
        pitch,
        _TO_ROBOT @ head @ _TO_ROBOT.T,
    )


def _frame(left: Array, up: Array) -> Array:
    """(T, 3, 3) rotations whose columns are left, up, forward; `up` is made square to `left`."""
    x: Array = left / np.maximum(np.linalg.norm(left, axis=-1, keepdims=True), 1e-9)
    z: Array = cross(x, up)
    z = z / np.maximum(np.linalg.norm(z, axis=-1, keepdims=True), 1e-9)
    return np.stack([x, cross(z, x), z], -1)
