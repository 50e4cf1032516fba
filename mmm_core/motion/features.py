"""HumanML3D's 263 features a frame <-> joints, head and forearm rotations. NumPy only.

Layout (Guo et al., CVPR 2022): [0] half yaw step, [1:3] root step x, z in the root's frame, [3] root height, [4:67]
joints 1..21 in the root's frame, [67:193] their 6-D rotations, [193:259] velocities of all 22 joints in the root's frame,
[259:263] foot contacts (left ankle, left foot, right ankle, right foot). Steps lead to the next frame: yaw and place are
sums shifted by one frame. Row T - 1 has no next frame and repeats the step before it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.skeleton import (
    MIRROR,
    Array,
    facing_yaw_rad,
    forward_kinematics,
    from_six_d,
    local_rotations,
    quat_wxyz,
    rotation_y,
    six_d,
    twist_about_bone_rad,
)

RestPose = Literal["mmmd", "humanml3d"]
"""Definition that a model's features follow: "mmmd" is this module's, "humanml3d" that of `humanml3d_features`."""
CONTACT_SPEED_M = 0.045
"""Metres in a frame below which a foot joint stands; HumanML3D compares the square of the step with 0.002."""


@dataclass(frozen=True)
class RecoveredMotion:
    """Motion recovered from features.

    Attributes:
        joints_m: (T, 22, 3) joints on the common body.
        head_quat_wxyz: (T, 4) world orientation of the head.
        forearm_twist_rad: (T, 2) twist of the left and right forearm.
    """

    joints_m: Array
    head_quat_wxyz: Array
    forearm_twist_rad: Array


@dataclass(frozen=True)
class FeatureLayout:
    """Facts of a skeleton of J joints that its features depend on.

    Attributes:
        n_joints: J; a row has 12 J - 1 values.
        left_feet: ankle and toe of the left foot.
        right_feet: ankle and toe of the right foot.
        contact_m2: square of a foot joint's step in a frame, m2, below which the foot stands.
    """

    n_joints: int
    left_feet: tuple[int, int]
    right_feet: tuple[int, int]
    contact_m2: float

    @property
    def n_features(self) -> int:
        return 12 * self.n_joints - 1


HUMANML3D = FeatureLayout(22, (7, 10), (8, 11), CONTACT_SPEED_M**2)


def features_from_joints(
    joints_m: Array,
    head_R_world: Array | None = None,
    forearm_twist_rad: Array | None = None,
) -> NDArray[np.float32]:
    """(T, 263) features of joints (T, 22, 3); the start is moved to the origin, facing +z.

    Without `head_R_world` (T, 3, 3) and `forearm_twist_rad` (T, 2) the head and forearms show no twist.
    """
    yaw = facing_yaw_rad(joints_m)
    rotations = local_rotations(joints_m, yaw, head_R_world, forearm_twist_rad)
    return features_from_rotations(joints_m, yaw, rotations[:, 1:], HUMANML3D)


def features_from_rotations(
    joints_m: Array, yaw_rad: Array, rotations: Array, layout: FeatureLayout
) -> NDArray[np.float32]:
    """(T, 12 J - 1) features of joints (T, J, 3), the root's yaw (T,) and the others' rotations (T, J - 1, 3, 3)."""
    T, J = len(joints_m), layout.n_joints
    to_root = np.swapaxes(rotation_y(yaw_rad), -1, -2)  # (T, 3, 3) world -> root frame
    place = joints_m[:, 0] * np.array([1.0, 0.0, 1.0])
    local = np.einsum("tij,tkj->tki", to_root, joints_m - place[:, None])
    step = np.diff(joints_m, axis=0, append=joints_m[-1:] * 2 - joints_m[-2:-1] if T > 1 else joints_m)
    following = np.minimum(np.arange(T) + 1, T - 1)
    root_step = np.einsum("tij,tj->ti", to_root[following], step[:, 0])
    feet = np.square(step[:, layout.left_feet + layout.right_feet]).sum(-1)
    return np.concatenate([
        -0.5 * np.diff(yaw_rad, append=yaw_rad[-1:])[:, None],
        root_step[:, [0, 2]],
        joints_m[:, 0, 1, None],
        local[:, 1:].reshape(T, 3 * (J - 1)),
        six_d(rotations).reshape(T, 6 * (J - 1)),
        np.einsum("tij,tkj->tki", to_root, step).reshape(T, 3 * J),
        feet < layout.contact_m2,
    ], 1).astype(np.float32)  # fmt: skip


@dataclass(frozen=True)
class Root:
    """Yaw and position of a motion's next frame, with which a motion can be recovered chunk by chunk."""

    yaw_rad: float = 0.0
    x_m: float = 0.0
    z_m: float = 0.0


def root_path(features: Array, start: Root | None = None) -> tuple[Array, Array]:
    """Yaw (T,) and root position (T, 3) by summing the steps from `start`, by default the origin, facing +z."""
    yaw, root = _root_with_next(features, start or Root())
    return yaw[:-1], root[:-1]


def root_after(features: Array, start: Root | None = None) -> Root:
    """Yaw and position of the frame after `features`."""
    yaw, root = _root_with_next(features, start or Root())
    return Root(float(yaw[-1]), float(root[-1, 0]), float(root[-1, 2]))


def _root_with_next(features: Array, start: Root) -> tuple[Array, Array]:
    """Yaw (T + 1,) and root position (T + 1, 3); the last row is the frame that follows."""
    yaw = start.yaw_rad + np.concatenate([[0.0], np.cumsum(-2.0 * features[:, 0])])
    root = np.zeros((len(features) + 1, 3))
    root[1:, [0, 2]] = features[:, 1:3]
    root = np.cumsum(np.einsum("tij,tj->ti", rotation_y(yaw), root), 0) + np.array([start.x_m, 0.0, start.z_m])
    root[:, 1] = np.append(features[:, 3], features[-1:, 3])
    return yaw, root


def recover(features: Array, start: Root | None = None) -> RecoveredMotion:
    """Joints, head and forearms from (T, 263) features, through the rotation channels: bones keep their length."""
    features = np.asarray(features, np.float64)
    yaw, root = root_path(features, start)
    local = np.empty((len(features), 22, 3, 3))
    local[:, 0] = rotation_y(yaw)
    local[:, 1:] = from_six_d(features[:, 67:193].reshape(-1, 21, 6))
    joints, world = forward_kinematics(local, root)
    twist = np.stack([twist_about_bone_rad(local[:, j], j) for j in (20, 21)], -1)
    return RecoveredMotion(joints, quat_wxyz(world[:, 15]), twist)


def recover_from_positions(features: Array, start: Root | None = None) -> RecoveredMotion:
    """Joints, head and forearms from the position channels, for data with other rest directions than ours (HumanML3D).

    The head's turn and the forearms' twist cannot be seen in positions: the head follows the neck, the twist is 0.
    """
    features = np.asarray(features, np.float64)
    joints = joints_from_positions(features, start)
    yaw, _ = root_path(features, start)
    local = local_rotations(joints, yaw, None, None)
    _, world = forward_kinematics(local, joints[:, 0])
    return RecoveredMotion(joints, quat_wxyz(world[:, 15]), np.zeros((len(joints), 2)))


def joints_from_positions(features: Array, start: Root | None = None) -> Array:
    """(T, J, 3) joints from the position channels, as the reference recovers them; 263 features give 22, KIT's 251 21."""
    features = np.asarray(features, np.float64)
    n_joints = joints_of(features.shape[1])
    yaw, root = root_path(features, start)
    local = features[:, 4 : 4 + 3 * (n_joints - 1)].reshape(-1, n_joints - 1, 3)
    world = np.einsum("tij,tkj->tki", rotation_y(yaw), local)
    world[..., [0, 2]] += root[:, None, [0, 2]]
    return np.concatenate([root[:, None], world], 1)


def joints_of(n_features: int) -> int:
    """Joints of a feature row: 4 + 9 (J - 1) + 3 J + 4 values, so 22 for 263 and 21 for KIT's 251.

    Raises:
        ValueError: no number of joints has `n_features` features.
    """
    n_joints, rest = divmod(n_features + 1, 12)
    if rest or n_joints < 2:
        raise ValueError(f"{n_features} features belong to no skeleton; expected 12 J - 1: 263 (22 joints), 251 (21)")
    return n_joints


def mirror(features: Array) -> NDArray[np.float32]:
    """Features of the motion seen in a mirror: left and right change places."""
    out = np.array(features, np.float32)
    out[:, 0] *= -1
    out[:, 1] *= -1
    order = np.array(MIRROR)
    flip = np.array([-1, 1, 1], np.float32)
    joints = features[:, 4:67].reshape(-1, 21, 3)[:, order[1:] - 1] * flip
    out[:, 4:67] = joints.reshape(-1, 63)
    # M R M with M = diag(-1, 1, 1) flips the signs of row 0 and of column 0
    six = features[:, 67:193].reshape(-1, 21, 6)[:, order[1:] - 1] * np.array([1, -1, -1, -1, 1, 1], np.float32)
    out[:, 67:193] = six.reshape(-1, 126)
    velocity = features[:, 193:259].reshape(-1, 22, 3)[:, order] * flip
    out[:, 193:259] = velocity.reshape(-1, 66)
    out[:, 259:263] = features[:, [261, 262, 259, 260]]
    return out
