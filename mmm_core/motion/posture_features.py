"""Posture features of a motion: directions of arms, head and trunk in the frames of chest and pelvis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.skeleton import matrix_from_quat, normalise

Array = NDArray[np.floating]

ARM_MOVED_DEG = 24.0
"""Degrees from the hanging pose beyond which an arm counts as moved."""
_ARMS = {"left": (16, 18, 20), "right": (17, 19, 21)}


@dataclass(frozen=True, eq=False)
class PostureFeatures:
    """Directions of the upper body in every frame of a motion.

    Attributes:
        arms: which arms left their hanging pose: "left", "right", "both" or "".
        head_yaw_deg, head_pitch_deg, head_roll_deg: (T,) head against the chest: left, down, left.
        trunk_yaw_deg, trunk_pitch_deg, trunk_roll_deg: (T,) chest against the pelvis: left, forward, left.
        upper, fore: per side, (T, 3) bone directions in the chest frame (left, up, forward).
        wrists_m: per side, (T, 3) wrist in the chest frame, from the middle of the shoulders.
        lift_m: (T,) height of the shoulders above the neck's root, in the chest frame.
        twist_rad: per side, (T,) forearm twist; None where it is not known.
    """

    arms: str
    head_yaw_deg: Array
    head_pitch_deg: Array
    head_roll_deg: Array
    trunk_yaw_deg: Array
    trunk_pitch_deg: Array
    trunk_roll_deg: Array
    upper: dict[str, Array]
    fore: dict[str, Array]
    wrists_m: dict[str, Array]
    lift_m: Array
    twist_rad: dict[str, Array | None]


def posture_features(joints_m: Array, head_quat_wxyz: Array, forearm_twist_rad: Array | None = None) -> PostureFeatures:
    """Posture features of (T, 22, 3) joints, (T, 4) head orientation and, where known, (T, 2) forearm twist."""
    joints = np.asarray(joints_m, np.float64)
    pelvis = _frame(joints[:, 1] - joints[:, 2], np.broadcast_to([0.0, 1, 0], joints[:, 0].shape))
    chest = _frame(joints[:, 13] - joints[:, 14], joints[:, 12] - joints[:, 3])
    to_chest = np.swapaxes(chest, -1, -2)
    upper, fore, wrists = {}, {}, {}
    middle = (joints[:, 16] + joints[:, 17]) / 2
    for side, (shoulder, elbow, wrist) in _ARMS.items():
        upper[side] = np.einsum("tij,tj->ti", to_chest, normalise(joints[:, elbow] - joints[:, shoulder]))
        fore[side] = np.einsum("tij,tj->ti", to_chest, normalise(joints[:, wrist] - joints[:, elbow]))
        wrists[side] = np.einsum("tij,tj->ti", to_chest, joints[:, wrist] - middle)
    head = _yaw_pitch_roll_deg(to_chest @ matrix_from_quat(np.asarray(head_quat_wxyz, np.float64)))
    trunk = _yaw_pitch_roll_deg(np.swapaxes(pelvis, -1, -2) @ chest)
    twist: dict[str, Array | None] = {
        side: None if forearm_twist_rad is None else np.asarray(forearm_twist_rad)[:, i] for i, side in enumerate(_ARMS)
    }
    lift = np.einsum("ti,ti->t", chest[:, :, 1], middle - joints[:, 9])
    return PostureFeatures(_moved(upper, fore), *head, *trunk, upper, fore, wrists, lift, twist)


def _moved(upper: dict[str, Array], fore: dict[str, Array]) -> str:
    """Names the arms that left their hanging pose: "left", "right", "both" or ""."""
    moved: list[str] = []
    for side in _ARMS:
        hanging = np.array([0.15 if side == "left" else -0.15, -0.97, 0.2])
        away = np.maximum(angle_deg(upper[side], hanging), angle_deg(fore[side], hanging))
        moved += [side] if away.max() > ARM_MOVED_DEG else []
    return "both" if len(moved) == 2 else "".join(moved)


def part(s: PostureFeatures, start: int, end: int) -> PostureFeatures:
    """Posture features of frames `start` to `end`."""
    upper, fore = ({side: v[start:end] for side, v in d.items()} for d in (s.upper, s.fore))
    return PostureFeatures(
        _moved(upper, fore), s.head_yaw_deg[start:end], s.head_pitch_deg[start:end], s.head_roll_deg[start:end],
        s.trunk_yaw_deg[start:end], s.trunk_pitch_deg[start:end], s.trunk_roll_deg[start:end], upper, fore,
        {side: v[start:end] for side, v in s.wrists_m.items()}, s.lift_m[start:end],
        {side: None if v is None else v[start:end] for side, v in s.twist_rad.items()},
    )  # fmt: skip


def angle_deg(a: Array, b: Array) -> Array:
    """(T,) angles between unit directions (T, 3) and `b`."""
    return np.rad2deg(np.arccos(np.clip((a * normalise(b)).sum(-1), -1, 1)))


def _yaw_pitch_roll_deg(R: Array) -> tuple[Array, Array, Array]:
    forward, left = R[..., 2], R[..., 0]
    yaw = np.arctan2(forward[:, 0], forward[:, 2])
    pitch = -np.arcsin(np.clip(forward[:, 1], -1, 1))
    roll = -np.arcsin(np.clip(left[:, 1], -1, 1))
    return np.rad2deg(yaw), np.rad2deg(pitch), np.rad2deg(roll)


def _frame(left: Array, up: Array) -> Array:
    x = normalise(left)
    z = normalise(np.cross(x, up))
    return np.stack([x, np.cross(z, x), z], -1)
