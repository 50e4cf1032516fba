"""The joint trees that retargeting programs know: Mixamo's, and that of the CMU recordings' BVH conversion.

A node stands in each of our 22 joints and turns all bones that leave it. Pelvis and chest take the rotation that fits their
three bones best (Kabsch, least squares), since several bones of one node are rigid to each other. The motion's bones are not
quite rigid there, so its joints and those of the file differ by millimetres. At rest the skeleton stands in a T pose, arms
along x.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from mmm_core.motion.bvh_node import CM_PER_M, Node, bone_lengths_m
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import (
    PARENTS,
    REST_DIRECTIONS,
    Array,
    facing_yaw_rad,
    local_rotations,
    matrix_from_quat,
    normalise,
    smallest_rotation,
)

StandardNames = Literal["cmu", "mixamo"]
_SIDED = {
    1: "UpLeg", 4: "Leg", 7: "Foot", 10: "ToeBase", 13: "Shoulder", 16: "Arm", 18: "ForeArm", 20: "Hand",
}  # fmt: skip
"""Names of the left bones by the joint in which they start; a right bone starts in the joint with the next number."""
_MIDDLE: dict[StandardNames, dict[int, str]] = {
    "cmu": {0: "Hips", 3: "LowerBack", 6: "Spine", 9: "Spine1", 12: "Neck", 15: "Head"},
    "mixamo": {0: "Hips", 3: "Spine", 6: "Spine1", 9: "Spine2", 12: "Neck", 15: "Head"},
}
_PREFIX: dict[StandardNames, str] = {"cmu": "", "mixamo": "mixamorig:"}
_T_POSE = {4: (0.0, -1, 0), 5: (0.0, -1, 0), 7: (0.0, -1, 0), 8: (0.0, -1, 0), 18: (1.0, 0, 0),
           19: (-1.0, 0, 0), 20: (1.0, 0, 0), 21: (-1.0, 0, 0)}  # fmt: skip
"""Direction of the bone that ends in a joint, where it differs from our own rest pose."""
_ENDS_CM = {10: (0.0, 0, 6), 11: (0.0, 0, 6), 15: (0.0, 18, 0), 20: (16.0, 0, 0), 21: (-16.0, 0, 0)}
"""Centimetres from ankle joint to toes, from head joint to crown and from wrist to finger tips, of an adult."""
_PELVIS, _CHEST, _NECK, _HEAD = 0, 9, 12, 15


def standard_nodes(motion: Motion, names: StandardNames) -> list[Node]:
    """A node for each of our joints, in their order, with the names of a standard skeleton."""
    joints = np.asarray(motion.joints_m, np.float64)
    rest = REST_DIRECTIONS.copy()
    for joint, direction in _T_POSE.items():
        rest[joint] = direction
    offsets_m = bone_lengths_m(joints)[:, None] * rest
    turns = _world_rotations(motion, joints, rest, offsets_m)
    nodes: list[Node] = []
    for joint, parent in enumerate(PARENTS):
        local = turns[:, joint] if parent < 0 else np.swapaxes(turns[:, parent], -1, -2) @ turns[:, joint]
        end = np.array(_ENDS_CM[joint]) if joint in _ENDS_CM else None
        nodes.append(Node(_name(joint, names), parent, CM_PER_M * offsets_m[joint], local, end))
    return nodes


def _name(joint: int, names: StandardNames) -> str:
    middle = _MIDDLE[names].get(joint)
    if middle is None:
        middle = f"Left{_SIDED[joint]}" if joint in _SIDED else f"Right{_SIDED[joint - 1]}"
    return _PREFIX[names] + middle


def _world_rotations(motion: Motion, joints: Array, rest: Array, offsets_m: Array) -> Array:
    """(T, 22, 3, 3) world rotation of the node in each joint."""
    head = matrix_from_quat(np.asarray(motion.head_quat_wxyz, np.float64))
    local = local_rotations(joints, facing_yaw_rad(joints), head, motion.forearm_twist_rad.astype(np.float64))
    bones = np.empty_like(local)  # rotation of the bone that ends in each joint, from the T pose
    ours = np.empty_like(local)
    ours[:, 0] = local[:, 0]
    for joint, parent in enumerate(PARENTS[1:], 1):
        ours[:, joint] = ours[:, parent] @ local[:, joint]
        bones[:, joint] = ours[:, joint] @ smallest_rotation(rest[joint], REST_DIRECTIONS[joint])
    turns = np.empty_like(local)
    for joint in range(len(PARENTS)):
        below = [j for j, parent in enumerate(PARENTS) if parent == joint]
        if len(below) > 1:
            turns[:, joint] = _best_rotation(offsets_m[below], joints[:, below] - joints[:, [joint]])
        else:  # toes and hands turn with foot and forearm
            turns[:, joint] = bones[:, below[0] if below else joint]
    along = normalise(joints[:, _HEAD] - joints[:, _NECK])
    in_chest = np.einsum("tab,ta->tb", turns[:, _CHEST], along)
    turns[:, _NECK] = turns[:, _CHEST] @ smallest_rotation(rest[_HEAD], in_chest)
    turns[:, _HEAD] = head
    return turns


def _best_rotation(at_rest: Array, now: Array) -> Array:
    """(T, 3, 3) rotations R with the least squares of R `at_rest` (N, 3) - `now` (T, N, 3)."""
    u, _, v = np.linalg.svd(np.einsum("tna,nb->tab", now, at_rest))
    sign = np.sign(np.linalg.det(u @ v))
    u[:, :, 2] *= sign[:, None]
    return u @ v
