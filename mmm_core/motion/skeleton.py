"""The 22 joints, the common body they are drawn with, and rotations about them. NumPy only.

Frame: metres, y up, z forward, x to the person's left. A rotation `R_a_b` maps b's coordinates to a's.
The rotation of joint j is that of the bone which ends in j: `R_world_j @ rest_direction[j]` points from parent to j
(HumanML3D's convention). Rest directions are ours: each has its antipode where that bone never points, so that the
smallest rotation to a bone's direction never jumps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]

JOINT_NAMES = (
    "pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2", "left_ankle", "right_ankle",
    "spine3", "left_foot", "right_foot", "neck", "left_collar", "right_collar", "head", "left_shoulder",
    "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
)  # fmt: skip
PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
MIRROR = (0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10, 12, 14, 13, 15, 17, 16, 19, 18, 21, 20)
"""Joint that takes each joint's place in a mirror."""

_LEVELS = ([1, 2, 3], [4, 5, 6], [7, 8, 9], [10, 11, 12, 13, 14], [15, 16, 17], [18, 19], [20, 21])
"""Joints by their distance from the pelvis: those of one level are turned at once."""

BONE_LENGTHS_M = np.array([
    0, 0.105, 0.105, 0.115, 0.385, 0.385, 0.138, 0.405, 0.405, 0.056, 0.14, 0.14, 0.21, 0.135, 0.135, 0.09, 0.125,
    0.125, 0.262, 0.262, 0.252, 0.252,
])  # fmt: skip
"""Length of the bone that ends in each joint: the common body of docs/DATA.md."""

_LEFT_REST = {
    "hip": (0.97, -0.2, 0.0), "knee": (0, -1, 0.15), "ankle": (0, -1, -0.15), "foot": (0.1, -0.4, 0.9),
    "collar": (0.5, 0.86, 0), "shoulder": (1, 0, 0), "elbow": (0.5, -0.75, 0.35), "wrist": (0.2, -0.3, 0.93),
}  # fmt: skip
_MIDDLE_REST = {
    "spine1": (0, 1, 0.1), "spine2": (0, 1, 0.1), "spine3": (0, 1, 0), "neck": (0, 1, 0.05), "head": (0, 0.94, 0.33),
}  # fmt: skip


def _rest_directions() -> Array:
    rows = np.zeros((22, 3))
    for j, name in enumerate(JOINT_NAMES[1:], 1):
        side, _, part = name.partition("_")
        rows[j] = _LEFT_REST[part] if part else _MIDDLE_REST[name]
        if side == "right":
            rows[j, 0] *= -1
    return rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-9)


REST_DIRECTIONS = _rest_directions()


def normalise(v: Array) -> Array:
    """Unit vectors along the last axis; a zero vector stays zero."""
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)


def across_shoulders(joints_m: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3) from right to left of (..., 22, 3) joints, through the collar bones, which shoulders pull along by half."""
    collars = joints_m[..., 13, :] - joints_m[..., 14, :]
    return collars + 0.5 * (joints_m[..., 16, :] - joints_m[..., 17, :])


def rotation_y(angle_rad: Array) -> Array:
    """(..., 3, 3) rotations about the vertical by `angle_rad` (...); positive turns z towards x, the person's left."""
    c, s, o = np.cos(angle_rad), np.sin(angle_rad), np.zeros_like(angle_rad)
    return np.stack([np.stack([c, o, s], -1), np.stack([o, o + 1, o], -1), np.stack([-s, o, c], -1)], -2)


def rotation_about(axis: Array, angle_rad: Array) -> Array:
    """(..., 3, 3) rotations about unit `axis` (..., 3) by `angle_rad` (...), Rodrigues' formula."""
    x, y, z = np.moveaxis(np.broadcast_to(axis, (*np.shape(angle_rad), 3)), -1, 0)
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    d = 1 - c
    xy, xz, yz = x * y * d, x * z * d, y * z * d
    rows = [
        c + x * x * d, xy - z * s, xz + y * s, xy + z * s, c + y * y * d, yz - x * s, xz - y * s, yz + x * s, c + z * z * d,
    ]  # fmt: skip
    return np.stack(rows, -1).reshape(*np.shape(c), 3, 3)


def smallest_rotation(a: Array, b: Array) -> Array:
    """(..., 3, 3) smallest rotations that turn unit vectors `a` (..., 3) into `b` (..., 3).

    Undefined for opposite vectors, where the result is finite and near a half turn.
    """
    a, b = np.broadcast_arrays(a, b)
    (a1, a2, a3), (b1, b2, b3) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    x, y, z = a2 * b3 - a3 * b2, a3 * b1 - a1 * b3, a1 * b2 - a2 * b1
    c = a1 * b1 + a2 * b2 + a3 * b3
    k = 1.0 / np.maximum(1.0 + c, 1e-6)
    xy, xz, yz = x * y * k, x * z * k, y * z * k
    rows = [c + x * x * k, xy - z, xz + y, xy + z, c + y * y * k, yz - x, xz - y, yz + x, c + z * z * k]
    return np.stack(rows, -1).reshape(*np.shape(c), 3, 3)


def six_d(R: Array) -> Array:
    """(..., 3, 3) -> (..., 6): the first two columns (Zhou et al., CVPR 2019)."""
    return np.concatenate([R[..., :, 0], R[..., :, 1]], -1)


def from_six_d(x: Array) -> Array:
    """(..., 6) -> (..., 3, 3): Gram-Schmidt on two columns."""
    a = normalise(x[..., :3])
    b = normalise(x[..., 3:] - (a * x[..., 3:]).sum(-1, keepdims=True) * a)
    return np.stack([a, b, np.cross(a, b)], -1)


def quat_wxyz(R: Array) -> Array:
    """(..., 3, 3) -> (..., 4) unit quaternions with w >= 0."""
    diagonal = np.stack([R[..., 0, 0], R[..., 1, 1], R[..., 2, 2]], -1)
    trace = diagonal.sum(-1)
    w = np.sqrt(np.maximum(1 + trace, 0))
    xyz = np.sqrt(np.maximum(1 + 2 * diagonal - trace[..., None], 0))
    signs = np.stack([R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], -1)
    q = np.concatenate([w[..., None], np.copysign(xyz, signs)], -1) / 2
    half_turn = w < 1e-3  # signs vanish there: take them from the largest component's row instead
    if half_turn.any():
        q[half_turn] = _half_turn_quat(R[half_turn])
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def _half_turn_quat(R: Array) -> Array:
    """Quaternions of half turns: the axis is a column of R + I."""
    columns = R + np.eye(3)
    best = np.argmax(np.einsum("nii->ni", columns), -1)
    axis = normalise(columns[np.arange(len(R)), :, best])
    return np.concatenate([np.zeros((len(R), 1)), axis], -1)


def matrix_from_quat(q_wxyz: Array) -> Array:
    """(..., 4) unit quaternions -> (..., 3, 3)."""
    w, x, y, z = np.moveaxis(q_wxyz, -1, 0)
    return np.stack([
        np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
        np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
        np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1),
    ], -2)  # fmt: skip


def facing_yaw_rad(joints_m: Array) -> Array:
    """(T,) angle about the vertical from +z to where hips and shoulders face, unwrapped."""
    across = normalise(joints_m[:, 1] - joints_m[:, 2]) + normalise(joints_m[:, 16] - joints_m[:, 17])
    forward = np.cross(across, np.array([0.0, 1.0, 0.0]))
    return np.unwrap(np.arctan2(forward[:, 0], forward[:, 2]))


def local_rotations(
    joints_m: Array,
    yaw_rad: Array,
    head_R_world: Array | None = None,
    forearm_twist_rad: Array | None = None,
) -> Array:
    """(T, 22, 3, 3) rotation of each joint's bone in its parent's frame; row 0 is the root's yaw in the world.

    Bones are turned by the smallest rotation from their rest direction, which shows no twist; the head takes its true
    orientation `head_R_world` (T, 3, 3) where that is known and the forearms a twist (T, 2), left and right.
    """
    T = len(joints_m)
    local = np.empty((T, 22, 3, 3))
    world = np.empty((T, 22, 3, 3))
    local[:, 0] = world[:, 0] = rotation_y(yaw_rad)
    bones = normalise(joints_m - joints_m[:, np.maximum(PARENTS, 0)])
    for level in _LEVELS:
        parents = world[:, [PARENTS[j] for j in level]]
        in_parent = np.einsum("tjab,tja->tjb", parents, bones[:, level])
        local[:, level] = smallest_rotation(REST_DIRECTIONS[level], in_parent)
        if 15 in level and head_R_world is not None:
            local[:, 15] = np.swapaxes(world[:, PARENTS[15]], -1, -2) @ head_R_world
        if 20 in level and forearm_twist_rad is not None:
            local[:, level] = local[:, level] @ rotation_about(REST_DIRECTIONS[level], forearm_twist_rad)
        world[:, level] = parents @ local[:, level]
    return local


def forward_kinematics(local: Array, root_m: Array) -> tuple[Array, Array]:
    """Joint positions (T, 22, 3) and world rotations (T, 22, 3, 3) of `local_rotations` on the common body."""
    world = np.empty_like(local)
    joints = np.empty((len(local), 22, 3))
    world[:, 0], joints[:, 0] = local[:, 0], root_m
    bones_m = BONE_LENGTHS_M[:, None] * REST_DIRECTIONS
    for level in _LEVELS:
        parents = [PARENTS[j] for j in level]
        world[:, level] = world[:, parents] @ local[:, level]
        joints[:, level] = joints[:, parents] + np.einsum("tjab,jb->tja", world[:, level], bones_m[level])
    return joints, world


def standing_joints(pelvis_m: float = 0.92) -> NDArray[np.float64]:
    """(1, 22, 3) joints of a person who stands upright on the common body, every bone along its rest direction, facing +z."""
    upright = np.broadcast_to(np.eye(3), (1, len(PARENTS), 3, 3))
    return np.asarray(forward_kinematics(upright, np.array([[0.0, pelvis_m, 0.0]]))[0], np.float64)


def twist_about_bone_rad(local: Array, joint: int) -> Array:
    """(T,) twist of `local` (T, 3, 3) about the rest direction of `joint`."""
    rest = REST_DIRECTIONS[joint]
    swing = smallest_rotation(rest, local @ rest)
    twist = np.swapaxes(swing, -1, -2) @ local
    side = normalise(np.cross(rest, np.array([0.0, 1.0, 0.0])))
    turned = twist @ side
    return np.arctan2((turned * np.cross(rest, side)).sum(-1), (turned * side).sum(-1))
