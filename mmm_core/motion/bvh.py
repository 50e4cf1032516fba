"""BVH export: a joint tree and its rotations, as Blender and other programs import it. NumPy only.

Lengths are centimetres, y is up, the person starts facing +z; the format has no field for these conventions. Bone rotations
are those of the motion, so that the head's orientation and the forearms' twist survive. There are two trees:

- `mmmd`: this project's joints, which are exact. The bones that leave a joint with several (pelvis, spine3) do not move
  rigidly together, so each has a node of its own there, named `PARENT_CHILD`.
- `cmu` and `mixamo` (`bvh_standard.py`): the bones and names that retargeting programs know, in a T pose at rest.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

import numpy as np

from mmm_core.motion.bvh_node import CM_PER_M, Node, bone_lengths_m
from mmm_core.motion.bvh_standard import standard_nodes
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import (
    JOINT_NAMES,
    PARENTS,
    REST_DIRECTIONS,
    Array,
    facing_yaw_rad,
    local_rotations,
    matrix_from_quat,
)

BvhNames = Literal["mmmd", "cmu", "mixamo"]
_CHILDREN = tuple(tuple(j for j, p in enumerate(PARENTS) if p == parent) for parent in range(len(PARENTS)))
_ROTATION_CHANNELS = "Yrotation Xrotation Zrotation"


def save_bvh(motion: Motion, path: Path | str, names: BvhNames = "mmmd") -> None:
    """Write a motion; an older file stays whole if writing fails.

    Args:
        motion: at least one frame.
        path: the file to write.
        names: the joint tree, with its names.

    Raises:
        ValueError: the motion has no frames.
        OSError: the file cannot be written.
    """
    if len(motion.joints_m) == 0:
        raise ValueError("a motion without frames has no BVH")
    path = Path(path)
    partial = path.with_name(path.name + ".part")
    try:
        partial.write_text(bvh_text(motion, names), "ascii")
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def bvh_text(motion: Motion, names: BvhNames = "mmmd") -> str:
    """The file's text. Bone lengths are medians over the motion; where joints and orientations disagree, orientations win."""
    joints = np.asarray(motion.joints_m, np.float64)
    nodes = _own_nodes(motion) if names == "mmmd" else standard_nodes(motion, names)
    lines, order = ["HIERARCHY"], list[int]()
    _write_node(0, nodes, 0, lines, order)
    lines += ["MOTION", f"Frames: {len(joints)}", f"Frame Time: {1 / motion.fps:.6f}"]
    angles_deg = np.rad2deg(np.concatenate([_euler_yxz(nodes[n].turn) for n in order], axis=1))
    rows = np.concatenate([CM_PER_M * joints[:, 0], angles_deg], axis=1)
    lines += [" ".join(f"{value:.5f}" for value in row) for row in rows]
    return "\n".join(lines) + "\n"


def _own_nodes(motion: Motion) -> list[Node]:
    """One node for each bone, placed where the bone starts; the node turns that bone."""
    joints = np.asarray(motion.joints_m, np.float64)
    local = local_rotations(
        joints,
        facing_yaw_rad(joints),
        matrix_from_quat(motion.head_quat_wxyz),
        motion.forearm_twist_rad.astype(np.float64),
    )
    offsets_cm = CM_PER_M * bone_lengths_m(joints)[:, None] * REST_DIRECTIONS
    nodes = [Node(JOINT_NAMES[0], -1, np.zeros(3), local[:, 0])]
    for joint, parent in enumerate(PARENTS[1:], 1):
        several = len(_CHILDREN[parent]) > 1
        name = f"{JOINT_NAMES[parent]}_{JOINT_NAMES[joint]}" if several else JOINT_NAMES[parent]
        end = None if _CHILDREN[joint] else offsets_cm[joint]
        nodes.append(Node(name, parent, offsets_cm[parent] if parent else np.zeros(3), local[:, joint], end))
    return nodes


def _write_node(i: int, nodes: list[Node], depth: int, lines: list[str], order: list[int]) -> None:
    node, pad = nodes[i], "  " * depth
    place = "3" if depth else "6 Xposition Yposition Zposition"
    lines += [
        f"{pad}{'JOINT' if depth else 'ROOT'} {node.name}",
        f"{pad}{{",
        f"{pad}  OFFSET {_numbers(node.offset_cm)}",
        f"{pad}  CHANNELS {place} {_ROTATION_CHANNELS}",
    ]
    order.append(i)
    for child, other in enumerate(nodes):
        if other.parent == i:
            _write_node(child, nodes, depth + 1, lines, order)
    if node.end_cm is not None:
        lines += [f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET {_numbers(node.end_cm)}", f"{pad}  }}"]
    lines.append(f"{pad}}}")


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.5f}" for value in values)


def _euler_yxz(R: Array) -> Array:
    """(T, 3) angles y, x, z of rotations (T, 3, 3), with R = Ry Rx Rz and without jumps in time.

    Every rotation has two such triples; the one nearer to the frame before is taken, then full turns are unwrapped.
    """
    x = np.arcsin(np.clip(-R[:, 1, 2], -1.0, 1.0))
    y = np.arctan2(R[:, 0, 2], R[:, 2, 2])
    z = np.arctan2(R[:, 1, 0], R[:, 1, 1])
    first = np.stack([y, x, z], -1)
    second = np.stack([y + np.pi, np.pi - x, z + np.pi], -1)
    out = first.copy()
    for t in range(1, len(R)):
        candidates = np.stack([first[t], second[t]])
        candidates += 2 * np.pi * np.round((out[t - 1] - candidates) / (2 * np.pi))
        out[t] = candidates[np.abs(candidates - out[t - 1]).sum(1).argmin()]
    return out
