"""A person who stands still with the arms in given directions, to pose a robot by retargeting like any motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS, N_FEATURES, Motion
from mmm_core.motion.skeleton import BONE_LENGTHS_M, standing_joints
from retarget.pipeline import Retargeter

Array = NDArray[np.float64]
Direction = tuple[float, float, float]
_ARMS = ((1.0, (16, 18, 20)), (-1.0, (17, 19, 21)))
_FRAMES = 2


def standing_motion(upper: Direction, fore: Direction) -> Motion:
    """A motion of two equal frames, both arms alike.

    Args:
        upper: direction of the upper arms, (forward, outward, up) of any length.
        fore: direction of the forearms.
    """
    joints = standing_joints()
    for side, (shoulder, elbow, wrist) in _ARMS:
        for start, end, (forward, outward, up) in ((shoulder, elbow, upper), (elbow, wrist, fore)):
            bone = np.array([side * outward, up, forward])
            joints[:, end] = joints[:, start] + BONE_LENGTHS_M[end] * bone / np.linalg.norm(bone)
    head = np.tile(np.array([1.0, 0, 0, 0], np.float32), (_FRAMES, 1))
    return Motion(
        np.repeat(joints, _FRAMES, 0).astype(np.float32), FPS, head, np.zeros((_FRAMES, 2), np.float32),
        np.zeros((_FRAMES, N_FEATURES), np.float32), np.zeros(0, np.int64), "", 0, "accepted", 1.0,
    )  # fmt: skip


def standing_pose(retargeter: Retargeter, upper: Direction, fore: Direction) -> Array:
    """(J,) the robot's pose for a person with these arm directions, within its limits and without self-contact."""
    return retargeter.retarget(standing_motion(upper, fore)).q_rad[-1]
