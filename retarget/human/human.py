"""A human motion in the terms of a robot: chest frame, arm directions in it, trunk and head angles.

Human frame: x left, y up, z forward. Robot frame: x forward, y left, z up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.skeleton import JOINT_NAMES, PARENTS, across_shoulders, matrix_from_quat, standing_joints
from retarget.errors import MotionError
from retarget.human.subproblems import unit
from retarget.robot.kinematics import cross

Array = NDArray[np.float64]
_TO_ROBOT = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
_L_HIP, _R_HIP, _SPINE1, _NECK = 1, 2, 3, 12
SIDES = ("left", "right")
_ABOVE = np.array(PARENTS[1:], np.int64)
_ARMS = slice(17, 21)
"""Rows of the bones that end in elbows and wrists among all bones, left before right."""
_SHORTEST_BONE_M, _LONGEST_BONE_M = 0.02, 0.6
"""Metres within which a bone of a person lies. The forearm of the tallest person (Robert Wadlow, 2.7 m) was under 0.45 m;
other units than metres lie far outside."""
_BONES = ("left upper arm", "right upper arm", "left forearm", "right forearm")
_LONGEST_LEG_BONE_M = 0.8
_LIMBS = ((3, 4), (6, 7), (17, 18), (19, 20))
"""Rows of left and right bones that end in knees, ankles, elbows and wrists."""
_MOST_UNEQUAL = 2.0
"""Ratio of a left and a right bone of one person at most; a larger one shows joints in another order."""
_SQUARE = 1e-6


class HumanMotion(Protocol):
    """T frames of one person: a `Motion`, or any object with joints, head and forearms."""

    @property
    def joints_m(self) -> NDArray[np.floating[Any]]:
        """(T, 22, 3) positions in metres, in HumanML3D's order."""
        ...

    @property
    def head_quat_wxyz(self) -> NDArray[np.floating[Any]]:
        """(T, 4) orientation of the head in the frame of the joints."""
        ...

    @property
    def forearm_twist_rad(self) -> NDArray[np.floating[Any]]:
        """(T, 2) twist of the left and the right forearm."""
        ...

    @property
    def fps(self) -> float: ...


@dataclass(frozen=True)
class HumanPose:
    """Directions and rotations of a person in T frames, in the robot's axes.

    Attributes:
        upper: (2, T, 3) unit directions of left and right upper arm in the chest frame.
        fore: (2, T, 3) unit directions of left and right forearm in the chest frame.
        forearm_twist_rad: (2, T) twist of left and right forearm.
        chest_rotation: (T, 3, 3) chest against the pelvis's upright heading; the identity for a person who stands upright.
        head_rotation: (T, 3, 3) head against the pelvis's upright heading.
        fps: frames per second.
    """

    upper: Array
    fore: Array
    forearm_twist_rad: Array
    chest_rotation: Array
    head_rotation: Array
    fps: float


def read_human(motion: HumanMotion) -> HumanPose:
    """Directions and rotations of the person in a motion.

    Raises:
        MotionError: no frames, values that are not finite, or bones that no human has; the message names frame and bone.
    """
    joints = motion.joints_m.astype(np.float64)
    if len(joints) == 0:
        raise MotionError("joints", "no frames", "at least one frame; a rejected text has none")
    for key, values in (("joints", joints), ("head", motion.head_quat_wxyz), ("twist", motion.forearm_twist_rad)):
        if not np.isfinite(values).all():
            raise MotionError(key, "NaN or infinite values", "finite values in every frame")
    every = joints[:, 1:] - joints[:, _ABOVE]  # (T, 21, 3)
    every_m = np.sqrt(np.einsum("tbi,tbi->tb", every, every))
    bones, length = every[:, _ARMS], every_m[:, _ARMS]
    if length.min() < _SHORTEST_BONE_M or length.max() > _LONGEST_BONE_M:
        _refuse_bones(length)
    _refuse_another_order(every_m.mean(0).tolist())
    pelvis = _frame(joints[:, _L_HIP] - joints[:, _R_HIP], np.array([[0.0, 1, 0]]), "hips")
    across = across_shoulders(joints)
    chest = _frame(across, joints[:, _NECK] - joints[:, _SPINE1], "shoulders and spine") @ _FROM_UPRIGHT
    to_pelvis = np.swapaxes(pelvis, -1, -2)
    relative = to_pelvis @ chest
    head = to_pelvis @ matrix_from_quat(motion.head_quat_wxyz.astype(np.float64))
    in_chest = (bones / length[..., None]) @ (chest @ _TO_ROBOT.T)  # rows: left, up, forward turned to the robot's axes
    arms = in_chest.transpose(1, 0, 2)
    return HumanPose(
        np.ascontiguousarray(arms[:2]), np.ascontiguousarray(arms[2:]), motion.forearm_twist_rad.T.astype(np.float64),
        _TO_ROBOT @ relative @ _TO_ROBOT.T, _TO_ROBOT @ head @ _TO_ROBOT.T, motion.fps,
    )  # fmt: skip


def _refuse_bones(length_m: Array) -> None:
    outside = (length_m < _SHORTEST_BONE_M) | (length_m > _LONGEST_BONE_M)
    frame, bone = (int(i) for i in np.argwhere(outside)[0])
    found = f"a bone of {length_m[frame, bone]:.4f} m in frame {frame}, {int(outside.any(1).sum())} such frames"
    allowed = f"bones of {_SHORTEST_BONE_M} to {_LONGEST_BONE_M} m, joints in metres in HumanML3D's order"
    raise MotionError(_BONES[bone], found, allowed)


def _refuse_another_order(mean_m: list[float]) -> None:
    """Refuse mean lengths (21,) in which a bone is longer than a thigh, or a left and a right bone are far from equal."""
    longest = max(range(len(mean_m)), key=mean_m.__getitem__)
    if mean_m[longest] > _LONGEST_LEG_BONE_M:
        allowed = f"at most {_LONGEST_LEG_BONE_M} m, joints in metres in HumanML3D's order"
        raise MotionError(_name(longest), f"{mean_m[longest]:.3f} m", allowed)
    for left, right in _LIMBS:
        short, long = sorted((mean_m[left], mean_m[right]))
        if long > _MOST_UNEQUAL * short:
            found = f"{mean_m[left]:.3f} m, and {mean_m[right]:.3f} m for {_name(right)}"
            raise MotionError(_name(left), found, "left and right bones of one person, joints in HumanML3D's order")


def _name(bone: int) -> str:
    return f"{JOINT_NAMES[_ABOVE[bone]]} to {JOINT_NAMES[bone + 1]}".replace("_", " ")


def _frame(left: Array, up: Array, key: str) -> Array:
    """(T, 3, 3) rotations whose columns are left, up, forward; `up` is made orthogonal to `left`."""
    z = cross(left, up)
    for v in (left, z):
        flat = np.einsum("ti,ti->t", v, v) < _SQUARE**2
        if flat.any():
            found = f"joints on one line or point in frame {int(flat.argmax())}, {int(flat.sum())} such frames"
            raise MotionError(key, found, "hips, shoulders and spine of a person, in HumanML3D's order")
    x, z = unit(left), unit(z)
    return np.stack([x, cross(z, x), z], -1)


def _from_upright() -> Array:
    """(3, 3) rotation that removes the lean of an upright person's spine, 3.4 degrees forward, from a chest frame."""
    joints = standing_joints()
    return np.ascontiguousarray(_frame(across_shoulders(joints), joints[:, _NECK] - joints[:, _SPINE1], "")[0].T)


_FROM_UPRIGHT = _from_upright()
