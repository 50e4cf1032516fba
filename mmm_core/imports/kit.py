"""KIT-ML's skeleton (21 joints, 251 features, 12.5 fps, lengths in millimetres) and its conversion to our 22 joints.

Plappert et al. 2016 (the KIT Motion-Language Dataset) in the form of Guo et al. 2022. Chains: trunk 0-4, right arm 5-7,
left arm 8-10, right leg 11-15, left leg 16-20.
"""

from __future__ import annotations

import numpy as np

from mmm_core.motion.features import FeatureLayout
from mmm_core.motion.skeleton import Array, normalise

KIT_FPS = 12.5
KIT_UNIT_M = 0.001
KIT = FeatureLayout(21, (19, 20), (14, 15), 0.05)
"""Layout of KIT's features; its contact threshold is in KIT's units, as in the data set's own code."""

_SAME = {
    0: 0, 2: 11, 1: 16, 5: 12, 4: 17, 8: 13, 7: 18, 11: 15, 10: 20, 3: 1, 9: 2, 12: 3, 15: 4,
    17: 5, 19: 6, 21: 7, 16: 8, 18: 9, 20: 10,
}  # fmt: skip
"""KIT's joint for each of our joints that both skeletons have."""


def kit_facing_yaw_rad(joints: Array) -> Array:
    """(T,) angle about the vertical from +z to where hips and shoulders of (T, 21, 3) joints face, unwrapped."""
    across = normalise(joints[:, 16] - joints[:, 11]) + normalise(joints[:, 8] - joints[:, 5])
    forward = np.cross(across, np.array([0.0, 1.0, 0.0]))
    return np.unwrap(np.arctan2(forward[:, 0], forward[:, 2]))


def joints_from_kit(kit_joints: Array, unit_m: float = KIT_UNIT_M) -> Array:
    """(T, 22, 3) joints in metres from KIT's (T, 21, 3).

    KIT's skeleton lacks three joints: the middle of the spine is put half-way between its neighbours, each collar a third of
    the way from the neck to the shoulder.
    """
    joints = np.empty((len(kit_joints), 22, 3))
    for ours, theirs in _SAME.items():
        joints[:, ours] = kit_joints[:, theirs]
    joints[:, 6] = (joints[:, 3] + joints[:, 9]) / 2
    for collar, shoulder in ((13, 16), (14, 17)):
        joints[:, collar] = joints[:, 12] + (joints[:, shoulder] - joints[:, 12]) / 3
    return joints * unit_m
