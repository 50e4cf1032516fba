"""Puts a motion together from several: each body part turns as in one of them. Only root and rotation channels are read."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.features import HUMANML3D, features_from_rotations, root_path
from mmm_core.motion.skeleton import Array, forward_kinematics, from_six_d, rotation_y

BodyPart = Literal["left_arm", "right_arm", "head", "trunk"]
PARTS: dict[BodyPart, tuple[int, ...]] = {
    "left_arm": (13, 16, 18, 20),
    "right_arm": (14, 17, 19, 21),
    "head": (12, 15),
    "trunk": (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11),
}
"""Joints of each part: collar to wrist, neck and head, spine with legs. The root goes with the trunk."""
FADE_FRAMES = 4
"""Frames, one token, over which a part passes from one motion to another."""


def put_together(
    features: NDArray[np.float32], parts: Mapping[BodyPart, NDArray[np.float32]], start: int, end: int
) -> NDArray[np.float32]:
    """Features (T, 263) whose parts turn, from frame `start` to `end`, as in the motions (T, 263) named for them.

    A part without a motion stays as it is. `start` and `end` are faded, except at the motion's own beginning and end.
    """
    weights = _weights(len(features), start, end)[:, None]
    mixed = np.asarray(features, np.float64).copy()
    six = mixed[:, 67:193].reshape(-1, 21, 6)
    for part, own in parts.items():
        joints = np.array(PARTS[part]) - 1
        turned = np.asarray(own, np.float64)[:, 67:193].reshape(-1, 21, 6)[:, joints]
        six[:, joints] += weights[..., None] * (turned - six[:, joints])
        if part == "trunk":
            mixed[:, :4] += weights * (own[:, :4] - mixed[:, :4])
    mixed[:, 67:193] = six.reshape(-1, 126)
    return of_rotations(mixed)


def of_rotations(features: Array) -> NDArray[np.float32]:
    """Features (T, 263) with the same root and rotations, whose other channels are computed from these by forward kinematics."""
    yaw, root = root_path(features)
    rotations = from_six_d(features[:, 67:193].reshape(-1, 21, 6))
    joints, _ = forward_kinematics(np.concatenate([rotation_y(yaw)[:, None], rotations], 1), root)
    return features_from_rotations(joints, yaw, rotations, HUMANML3D)


def _weights(n_frames: int, start: int, end: int) -> Array:
    """(T,) weights: 1 between `start` and `end`, 0 elsewhere, with a ramp inside each edge that is not the motion's own."""
    frames = np.arange(n_frames)
    rising = np.ones(n_frames) if start <= 0 else np.clip((frames - start + 1) / FADE_FRAMES, 0.0, 1.0)
    falling = np.ones(n_frames) if end >= n_frames else np.clip((end - frames) / FADE_FRAMES, 0.0, 1.0)
    return np.minimum(rising, falling)
