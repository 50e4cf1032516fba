"""Puts a recording of any person on the model's body: bone directions stay, lengths are replaced, feet go on the floor."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mmm_core.errors import MotionFileError
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import BONE_LENGTHS_M, JOINT_NAMES, PARENTS, Array

_FLOOR_PERCENTILE = 2.0
"""Percentile of the feet's heights that counts as the floor."""
_SHORTEST_BONE_M = 1e-3


def on_common_body(path: Path, motion: Motion) -> Array:
    """(T, 22, 3) joints on the common body, metres; the root's travel is scaled by the length of the legs.

    Raises:
        MotionFileError: a bone has no length; file and joint are named.
    """
    theirs = motion.joints_m.astype(np.float64)
    joints = np.empty_like(theirs)
    legs_m = np.linalg.norm(theirs[:, (4, 7)] - theirs[:, (1, 4)], axis=-1).sum(-1).mean()
    joints[:, 0] = theirs[:, 0] * (BONE_LENGTHS_M[4] + BONE_LENGTHS_M[7]) / max(float(legs_m), _SHORTEST_BONE_M)
    for j, parent in enumerate(PARENTS[1:], 1):
        bone = theirs[:, j] - theirs[:, parent]
        length_m = np.linalg.norm(bone, axis=-1, keepdims=True)
        if length_m.min() < _SHORTEST_BONE_M:
            raise MotionFileError(path, JOINT_NAMES[j], f"it lies on {JOINT_NAMES[parent]}", "two joints apart")
        joints[:, j] = joints[:, parent] + BONE_LENGTHS_M[j] * bone / length_m
    joints[..., 1] -= np.percentile(joints[:, (10, 11), 1], _FLOOR_PERCENTILE)
    return joints
