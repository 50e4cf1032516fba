"""A person as bones for drawing: limbs, hands, head and nose, in the robot's axes and at its size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.skeleton import JOINT_NAMES, PARENTS

Array = NDArray[np.float64]
Colour = Literal["left", "right", "", "nose"]

_TO_ROBOT_AXES = [2, 0, 1]
"""Row order from a person's axes (x left, y up, z forward) to a robot's (x forward, y left, z up)."""
_LIMB_RADIUS_M, _SKULL_RADIUS_M = 0.042, 0.105
_PELVIS, _NECK, _HEAD = (JOINT_NAMES.index(name) for name in ("pelvis", "neck", "head"))
_SHOULDERS = [JOINT_NAMES.index(f"{side}_shoulder") for side in ("left", "right")]


@dataclass(frozen=True)
class Bone:
    """A capsule from start to end, or a ball where both are equal, in metres and the robot's axes."""

    start_m: Array
    end_m: Array
    radius_m: float
    colour: Colour


@dataclass(frozen=True)
class Stand:
    """Position (3,) of the middle between the person's shoulders, and the person's size as a share of the true one."""

    shoulders_m: Array
    scale: float


_HAND_SHARE, _HAND_RADIUS_SHARE = 0.4, 0.85
"""Length of a hand as a share of the forearm's, and its radius as a share of a limb's."""


def radii_m() -> dict[str, float]:
    """Radii in metres of limb, hand and skull of a person of true size."""
    return {"limb": _LIMB_RADIUS_M, "hand": _HAND_RADIUS_SHARE * _LIMB_RADIUS_M, "skull": _SKULL_RADIUS_M}


def hand_share() -> float:
    """Length of a hand as a share of the forearm's."""
    return _HAND_SHARE


def bones(joints_m: Array, head_faces: Array | None, stand: Stand) -> list[Bone]:
    """The bones of a person with joints (22, 3) whose head faces along (3,), forward if None."""
    points = joints_m[:, _TO_ROBOT_AXES] * stand.scale
    feet_to_shoulders_m = float(points[_SHOULDERS, 2].mean())
    origin = np.array([*points[_PELVIS, :2], feet_to_shoulders_m])
    points = points - origin + stand.shoulders_m
    radius_m = _LIMB_RADIUS_M * stand.scale
    drawn: list[Bone] = []
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            drawn.append(Bone(points[parent], points[joint], radius_m, _colour(JOINT_NAMES[joint])))
    for side in ("left", "right"):
        elbow, wrist = (points[JOINT_NAMES.index(f"{side}_{part}")] for part in ("elbow", "wrist"))
        drawn.append(
            Bone(wrist, wrist + _HAND_SHARE * (wrist - elbow), _HAND_RADIUS_SHARE * radius_m, _colour(f"{side}_hand"))
        )
    faces = np.array([0.0, 0.0, 1.0]) if head_faces is None else head_faces
    return drawn + _head(points[_NECK], points[_HEAD], faces[_TO_ROBOT_AXES], stand.scale)


def _head(neck: Array, head: Array, faces: Array, scale: float) -> list[Bone]:
    up = (head - neck) / max(float(np.linalg.norm(head - neck)), 1e-9)
    radius_m = _SKULL_RADIUS_M * scale
    skull = head + 0.07 * scale * up
    nose = Bone(skull + 0.9 * radius_m * faces, skull + 1.3 * radius_m * faces, 0.22 * radius_m, "nose")
    return [Bone(skull, skull, radius_m, ""), nose]


def _colour(joint: str) -> Colour:
    if joint.startswith("left"):
        return "left"
    return "right" if joint.startswith("right") else ""
