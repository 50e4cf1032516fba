"""HumanML3D's features of joints, as its notebook makes them: for imported checkpoints and data sets. No torch.

`features.features_from_joints` is this repository's definition, which the shipped model takes: the facing of each frame
comes from that frame alone, and rotations are relative to rest directions that never jump. The notebook (Guo et al., CVPR 2022,
`motion_representation.ipynb`, `process_file`) differs in conventions that a model trained on its files relies on:

- the forward vector is smoothed over time by a Gaussian of 20 frames, and across the hips it is taken with the wrong sign;
- the first frame faces +z by definition, whatever the smoothed vector says;
- half a step of yaw is the arc sine of a quaternion whose w stays positive, so the sign flips in the step that passes half
  a turn;
- rotations are relative to HumanML3D's own rest directions, and the arms' chains begin at the root's facing;
- a foot stands when the square of its step is below 0.002 m2.

Bone lengths stay those of the joints: the notebook's own change to one skeleton needs a recording that is not public.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from mmm_core.motion.features import HUMANML3D, features_from_rotations
from mmm_core.motion.skeleton import Array, normalise, rotation_y, smallest_rotation

SMOOTHING_FRAMES = 20
"""Frames of the standard deviation of the Gaussian over the forward vectors."""
_LAYOUT = replace(HUMANML3D, contact_m2=0.002)
_LEFT_HIP, _RIGHT_HIP, _LEFT_SHOULDER, _RIGHT_SHOULDER = 1, 2, 16, 17
_CHAINS = ((0, 2, 5, 8, 11), (0, 1, 4, 7, 10), (0, 3, 6, 9, 12, 15), (9, 14, 17, 19, 21), (9, 13, 16, 18, 20))
_X, _Y, _Z = np.eye(3)
_REST_DIRECTIONS = np.array([
    0 * _X, _X, -_X, _Y, -_Y, -_Y, _Y, -_Y, -_Y, _Y, _Z, _Z, _Y, _X, -_X, _Z, -_Y, -_Y, -_Y, -_Y, -_Y, -_Y,
])  # fmt: skip
"""HumanML3D's rest direction of the bone that ends in each joint: a T-pose, but with hanging arms."""


def humanml3d_features_from_joints(joints_m: Array) -> NDArray[np.float32]:
    """(T, 263) features of joints (T, 22, 3), as HumanML3D's notebook makes them of its own skeleton.

    The start is moved to the origin, facing +z, with the lowest joint of the motion on the floor. The notebook leaves out
    the last frame, since no frame follows it; here the last row repeats the step before it, as in `features_from_joints`.
    """
    joints = np.array(joints_m, np.float64)
    joints[..., 1] -= joints[..., 1].min()
    shoulders = joints[:, _LEFT_SHOULDER] - joints[:, _RIGHT_SHOULDER]
    hips = joints[:, _LEFT_HIP] - joints[:, _RIGHT_HIP]
    joints = joints @ rotation_y(-_yaw_rad(_forward(shoulders[:1] + hips[:1]))[0]).T
    yaw = _smoothed_yaw_rad(joints)
    features = features_from_rotations(joints, yaw, _rotations(joints, yaw)[:, 1:], _LAYOUT)
    features[:-1, 0] = np.arcsin(np.sin(-0.5 * np.diff(yaw)))  # yaw is not unwrapped: there the sign changes
    return features


def _smoothed_yaw_rad(joints: Array) -> Array:
    """(T,) facing in -pi to pi, from forward vectors smoothed over time; the first is 0."""
    shoulders = joints[:, _LEFT_SHOULDER] - joints[:, _RIGHT_SHOULDER]
    hips = joints[:, _LEFT_HIP] - joints[:, _RIGHT_HIP]
    forward = _forward(shoulders - hips)  # the sign of the hips is the notebook's
    yaw = _yaw_rad(gaussian_filter1d(forward, SMOOTHING_FRAMES, axis=0, mode="nearest"))
    yaw[0] = 0.0
    return yaw


def _forward(right_to_left: Array) -> Array:
    """(T, 3) forward vectors of directions across the body, from right to left."""
    return np.cross(normalise(right_to_left), _Y)


def _yaw_rad(forward: Array) -> Array:
    return np.arctan2(forward[:, 0], forward[:, 2])


def _rotations(joints: Array, yaw: Array) -> Array:
    """(T, 22, 3, 3) rotation of each joint in the frame of the one before it in its chain.

    The notebook begins every chain with the rotation that turns the facing to +z, the inverse of the root's own.
    """
    T = len(joints)
    to_root = np.swapaxes(rotation_y(yaw), -1, -2)
    local = np.broadcast_to(np.eye(3), (T, 22, 3, 3)).copy()
    for chain in _CHAINS:
        above = to_root
        for parent, joint in pairwise(chain):
            world = smallest_rotation(_REST_DIRECTIONS[joint], normalise(joints[:, joint] - joints[:, parent]))
            local[:, joint] = np.swapaxes(above, -1, -2) @ world
            above = world
    return local
