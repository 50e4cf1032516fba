"""Maps other programs' skeletons to our 22 joints: their names, missing joints, units and rest poses."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import MotionFileError
from mmm_core.motion.motion import FPS, N_FEATURES, Motion
from mmm_core.motion.skeleton import (
    BONE_LENGTHS_M,
    JOINT_NAMES,
    across_shoulders,
    facing_yaw_rad,
    forward_kinematics,
    local_rotations,
    normalise,
    quat_wxyz,
    standing_joints,
)

Array = NDArray[np.float64]
_SPINE1, _NECK, _HEAD = 3, 12, 15
_MOST_LEAN_RAD = 0.5
"""Radians that an upright spine leans at most; a rest pose that leans more is not that of a standing person."""
_ARM_M = float(BONE_LENGTHS_M[18] + BONE_LENGTHS_M[20])

# Names in CMU's BVH conversions, Mixamo, DAZ and SMPL, without signs; names that come earlier in a row are preferred. A row
# takes no joint that a row above took: "LeftShoulder" is SMPL's shoulder, but the collar in a skeleton with a "LeftArm".
_SIDED = {
    "hip": ("upleg", "thigh", "hip", "upperleg", "femur"),
    "knee": ("leg", "shin", "knee", "lowleg", "lowerleg", "calf"),
    "ankle": ("ankle", "foot"),
    "foot": ("toebase", "toe", "toes", "foot", "ankleend", "footend"),
    "shoulder": ("arm", "upperarm", "shldr", "uparm", "shoulder"),
    "collar": ("collar", "clavicle", "shoulder"),
    "elbow": ("forearm", "elbow", "lowarm", "lowerarm"),
    "wrist": ("hand", "wrist", "elbowend", "forearmend"),
}
_MIDDLE = {"pelvis": ("hips", "pelvis", "hip", "root"), "neck": ("neck", "neck1"), "head": ("head", "neckend")}
_NEEDED = tuple(f"{side}_{part}" for side in ("left", "right") for part in ("hip", "shoulder", "elbow", "wrist"))


def find_joints(path: Path, names: Sequence[str], parents: Sequence[int]) -> dict[str, int]:
    """The index of a file's joint for each of our joints, by name; joints that the file lacks are left out.

    Raises:
        MotionFileError: arms or hips cannot be found.
    """
    plain = [re.sub("[^a-z0-9]", "", name.rsplit(":", 1)[-1].lower().removeprefix("mixamorig")) for name in names]
    found: dict[str, int] = {}

    def take(ours: str, candidates: Sequence[str]) -> None:
        for name in candidates:
            if name in plain and plain.index(name) not in found.values():
                found[ours] = plain.index(name)
                return

    for side in ("left", "right"):
        for part, theirs in _SIDED.items():
            take(f"{side}_{part}", [f"{prefix}{name}" for name in theirs for prefix in (side, side[0])])
    for ours, theirs in _MIDDLE.items():
        take(ours, theirs)
    missing = [ours for ours in ("pelvis", *_NEEDED) if ours not in found]
    if missing:
        raise MotionFileError(
            path, ", ".join(missing), f"joints {', '.join(names)}", "a skeleton with hips and two arms"
        )
    top = found.get("neck", found.get("head", found["left_shoulder"]))
    spine: list[int] = []
    joint = parents[top]
    while joint >= 0 and joint != found["pelvis"]:
        spine.insert(0, joint)
        joint = parents[joint]
    named = [[joint for joint in spine if plain[joint] in (f"spine{i}", f"spine{i}neck")] for i in (1, 2, 3)]
    if all(named):
        found |= {f"spine{i}": joints[0] for i, joints in enumerate(named, 1)}
    elif spine:
        found |= {"spine1": spine[0], "spine2": spine[len(spine) // 2], "spine3": spine[-1]}
    return found


def motion_of(
    path: Path,
    places: Mapping[str, Array],
    head_rotation: Array | None,
    fps: float,
    *,
    rest: Mapping[str, Array] | None = None,
    unit_known: bool = False,
) -> Motion:
    """A motion of 20 fps from the positions (T, 3) of our joints by name, y up.

    Missing joints are put where a person's would be. `rest` has the (1, 3) positions of the same joints in the skeleton's rest
    pose, upright; without it the skeleton is ours. Without `unit_known`, lengths are scaled to a person's arms. Without
    `head_rotation` (T, 3, 3) the head follows the neck.

    Raises:
        MotionFileError: values are not finite (the first such frame is named), arms have no length, `fps` is out of range, or
            there are no frames.
    """
    joints = _all_joints(places)
    if rest is not None:
        joints = _leaning_as_ours(joints, _all_joints(rest))
    if len(joints) == 0:
        raise MotionFileError(path, "frames", "none", "at least one frame")
    bad = ~np.isfinite(joints).all((1, 2))
    if bad.any():
        raise MotionFileError(
            path, "frames", f"{int(bad.sum())} not finite, the first is {int(bad.argmax())}", "numbers"
        )
    if not (np.isfinite(fps) and 1 <= fps <= 10_000):
        raise MotionFileError(path, "fps", str(fps), "1 to 10,000 frames per second")
    if not unit_known:
        arm = sum(
            float(np.median(np.linalg.norm(joints[:, b] - joints[:, a], axis=-1))) for a, b in ((16, 18), (18, 20))
        )
        if not arm > 0:
            raise MotionFileError(path, "left arm", "no length", "bones with a length")
        joints = joints * (_ARM_M / arm)
    joints, head_rotation = _at_our_rate(joints, head_rotation, fps)
    if head_rotation is None:
        local = local_rotations(joints, facing_yaw_rad(joints), None, None)
        head_rotation = np.asarray(forward_kinematics(local, joints[:, 0])[1][:, 15], np.float64)
    T = len(joints)
    return Motion(
        joints.astype(np.float32), FPS, quat_wxyz(head_rotation).astype(np.float32), np.zeros((T, 2), np.float32),
        np.zeros((T, N_FEATURES), np.float32), np.zeros(0, np.int64), path.stem, 0, "accepted", 1.0,
    )  # fmt: skip


def _all_joints(places: Mapping[str, Array]) -> Array:
    """(T, 22, 3) joints; missing ones are put between or beyond their neighbours."""
    p = dict(places)
    shoulders = (p["left_shoulder"] + p["right_shoulder"]) / 2
    p.setdefault("neck", p["head"] if "head" in p else shoulders)
    for i, name in enumerate(("spine1", "spine2", "spine3"), 1):
        p.setdefault(name, p["pelvis"] + i / 4 * (p["neck"] - p["pelvis"]))
    p.setdefault("head", p["neck"] + 0.2 * (p["neck"] - p["pelvis"]))
    for side in ("left", "right"):
        p.setdefault(f"{side}_collar", p["neck"] + 0.3 * (p[f"{side}_shoulder"] - p["neck"]))
        down = p["pelvis"] - p["neck"]
        for part, above in (("knee", "hip"), ("ankle", "knee"), ("foot", "ankle")):
            p.setdefault(f"{side}_{part}", p[f"{side}_{above}"] + 0.5 * down)
    return np.stack([np.asarray(p[name], np.float64) for name in JOINT_NAMES], 1)


def _leaning_as_ours(joints: Array, rest: Array) -> Array:
    """(T, 22, 3) joints with neck and head turned about the first joint of the spine, so that upright stays upright.

    The orientation of a chest is taken from spine and neck. In our skeleton the neck of an upright person leans 3.4 degrees
    before the spine; in the file's skeleton it leans as in the rest pose `rest` (1, 22, 3). A rest pose that is no standing
    person changes nothing.
    """
    turn_rad = _LEAN_RAD - _lean_rad(rest)
    if abs(turn_rad) > _MOST_LEAN_RAD:
        return joints
    left = normalise(across_shoulders(joints))
    up = joints[:, _NECK] - joints[:, _SPINE1]
    along = left * (left * up).sum(-1, keepdims=True)
    turned = along + np.cos(turn_rad) * (up - along) + np.sin(turn_rad) * np.cross(left, up)
    moved = joints.copy()
    moved[:, (_NECK, _HEAD)] += (turned - up)[:, None]
    return moved


def _lean_rad(standing: Array) -> float:
    """Angle by which the neck of (1, 22, 3) upright joints leans before the spine."""
    left, up = across_shoulders(standing)[0], standing[0, _NECK] - standing[0, _SPINE1]
    forward = normalise(np.cross(left, [0.0, 1, 0]))
    return float(np.arctan2(up @ forward, up[1]))


def _at_our_rate(joints: Array, head: Array | None, fps: float) -> tuple[Array, Array | None]:
    """Joints and head orientation at 20 fps: joints interpolated linearly, the head's orientation from the nearest frame."""
    if fps == FPS or len(joints) == 1:
        return joints, head
    frames = np.arange(0, (len(joints) - 1) / fps + 1e-9, 1 / FPS) * fps
    low = np.minimum(frames.astype(np.int64), len(joints) - 1)
    high = np.minimum(low + 1, len(joints) - 1)
    share = (frames - low)[:, None, None]
    nearest = np.minimum(np.rint(frames).astype(np.int64), len(joints) - 1)
    return joints[low] * (1 - share) + joints[high] * share, None if head is None else head[nearest]


def rest_frame(places: Mapping[str, Array]) -> Array:
    """(3, 3) directions left, up and forward of a person in a rest pose, from the joints' (3,) positions by name."""
    left = places["left_shoulder"] - places["right_shoulder"] + places["left_hip"] - places["right_hip"]
    up = (places["left_shoulder"] + places["right_shoulder"]) / 2 - places["pelvis"]
    x = left / np.linalg.norm(left)
    z = np.cross(x, up)
    z = z / np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z], -1)


_LEAN_RAD = _lean_rad(standing_joints())
