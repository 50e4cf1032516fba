"""BVH export: a joint tree and its rotations, as Blender and other programs import it. NumPy only.

Lengths are centimetres, y is up, the person starts facing +z; the format has no place to say so. Bone rotations are
those of the motion, so that the head's orientation and the forearms' twist survive. Each bone that leaves a joint with
several bones (pelvis, spine3) has a node of its own there, named `PARENT_CHILD`: they do not move rigidly together.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

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

CM_PER_M = 100.0
_CHILDREN = tuple(tuple(j for j, p in enumerate(PARENTS) if p == parent) for parent in range(len(PARENTS)))
_ROTATION_CHANNELS = "Yrotation Xrotation Zrotation"


def save_bvh(motion: Motion, path: Path | str) -> None:
    """Write a motion; an older file stays whole if writing fails.

    Raises:
        ValueError: the motion has no frames.
        OSError: the file cannot be written.
    """
    if len(motion.joints_m) == 0:
        raise ValueError("a motion without frames has no BVH")
    path = Path(path)
    partial = path.with_name(path.name + ".part")
    try:
        partial.write_text(bvh_text(motion), "ascii")
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def bvh_text(motion: Motion) -> str:
    """The file's text. Bone lengths are the motion's own (their median); orientation wins where they disagree."""
    joints = np.asarray(motion.joints_m, np.float64)
    local = local_rotations(
        joints,
        facing_yaw_rad(joints),
        matrix_from_quat(motion.head_quat_wxyz),
        motion.forearm_twist_rad.astype(np.float64),
    )
    lengths_m = np.zeros(len(PARENTS))
    lengths_m[1:] = np.median(np.linalg.norm(joints[:, 1:] - joints[:, list(PARENTS[1:])], axis=-1), axis=0)
    offsets_cm = CM_PER_M * lengths_m[:, None] * REST_DIRECTIONS
    lines = ["HIERARCHY", f"ROOT {JOINT_NAMES[0]}", "{", "  OFFSET 0 0 0"]
    lines.append(f"  CHANNELS 6 Xposition Yposition Zposition {_ROTATION_CHANNELS}")
    order: list[int] = []
    for child in _CHILDREN[0]:
        _write_bone(child, np.zeros(3), offsets_cm, 1, lines, order)
    lines += ["}", "MOTION", f"Frames: {len(joints)}", f"Frame Time: {1 / motion.fps:.6f}"]
    angles_deg = np.rad2deg(np.concatenate([_euler_yxz(local[:, j]) for j in (0, *order)], axis=1))
    rows = np.concatenate([CM_PER_M * joints[:, 0], angles_deg], axis=1)
    lines += [" ".join(f"{value:.5f}" for value in row) for row in rows]
    return "\n".join(lines) + "\n"


def _write_bone(joint: int, at_cm: Array, offsets_cm: Array, depth: int, lines: list[str], order: list[int]) -> None:
    """The node that turns the bone ending in `joint`; it sits at the bone's start, `at_cm` from the node above."""
    parent = PARENTS[joint]
    name = JOINT_NAMES[parent]
    if len(_CHILDREN[parent]) > 1:
        name = f"{name}_{JOINT_NAMES[joint]}"
    pad = "  " * depth
    lines += [
        f"{pad}JOINT {name}",
        f"{pad}{{",
        f"{pad}  OFFSET {_numbers(at_cm)}",
        f"{pad}  CHANNELS 3 {_ROTATION_CHANNELS}",
    ]
    order.append(joint)
    for child in _CHILDREN[joint]:
        _write_bone(child, offsets_cm[joint], offsets_cm, depth + 1, lines, order)
    if not _CHILDREN[joint]:
        lines += [f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET {_numbers(offsets_cm[joint])}", f"{pad}  }}"]
    lines.append(f"{pad}}}")


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.5f}" for value in values)


def _euler_yxz(R: Array) -> Array:
    """(T, 3) angles y, x, z with R = Ry Rx Rz, without jumps in time; (T, 3, 3) rotations.

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
