"""Poses of a person, frame by frame: bone directions, head and forearm twist, independent of the person's place and facing.

The daemon makes every change to a motion before retargeting (tempo, size, mirror, seams, loops, gaze, idling) here, on the human
poses, so that only retargeting has to keep limits and self-contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS, N_FEATURES, Motion
from mmm_core.motion.skeleton import (
    BONE_LENGTHS_M,
    JOINT_NAMES,
    MIRROR,
    PARENTS,
    facing_yaw_rad,
    matrix_from_quat,
    normalise,
    quat_wxyz,
    rotation_y,
)

Array = NDArray[np.float64]

_MIRROR = np.array(MIRROR)
_FLIP_X = np.array([-1.0, 1.0, 1.0])
_IDENTITY_WXYZ = np.array([1.0, 0.0, 0.0, 0.0])
_STANDING = {
    "hip": (0.97, -0.2, 0.0), "knee": (0.0, -1.0, 0.0), "ankle": (0.0, -1.0, -0.05), "foot": (0.1, -0.4, 0.9),
    "collar": (0.72, 0.69, 0.0), "shoulder": (0.98, -0.1, 0.0), "elbow": (0.17, -0.98, 0.02), "wrist": (0.1, -0.97, 0.2),
    "": (0.0, 1.0, 0.05),
}  # fmt: skip


@dataclass(frozen=True)
class PoseSequence:
    """T frames of one person, facing +z with the pelvis at the origin.

    Attributes:
        bones: (T, 22, 3) unit direction of the bone that ends in each joint; the pelvis's row is zero.
        lengths_m: (22,) lengths of the bones, m.
        head_quat_wxyz: (T, 4) orientation of the head against the person's facing.
        forearm_twist_rad: (T, 2) forearm twist, left and right.
        fps: frames per second.
    """

    bones: Array
    lengths_m: Array
    head_quat_wxyz: Array
    forearm_twist_rad: Array
    fps: float = FPS

    def __len__(self) -> int:
        return len(self.bones)

    def __getitem__(self, frames: slice) -> PoseSequence:
        return replace(
            self,
            bones=self.bones[frames],
            head_quat_wxyz=self.head_quat_wxyz[frames],
            forearm_twist_rad=self.forearm_twist_rad[frames],
        )

    def at(self, frames: NDArray[np.intp]) -> PoseSequence:
        """The poses at the frame numbers `frames`; numbers before the first or after the last frame give that frame."""
        k = np.clip(frames, 0, len(self) - 1)
        return replace(
            self,
            bones=self.bones[k],
            head_quat_wxyz=self.head_quat_wxyz[k],
            forearm_twist_rad=self.forearm_twist_rad[k],
        )

    @property
    def joints_m(self) -> Array:
        """(T, 22, 3) joint positions in metres."""
        joints = np.zeros((len(self), len(PARENTS), 3))
        for j, parent in enumerate(PARENTS[1:], 1):
            joints[:, j] = joints[:, parent] + self.lengths_m[j] * self.bones[:, j]
        return joints

    def faces(self) -> Array:
        """(T, 3) unit vectors of the direction that the head faces."""
        return np.asarray(matrix_from_quat(self.head_quat_wxyz)[..., 2], np.float64)

    def motion(self, like: Motion | None = None, text: str = "") -> Motion:
        """The motion record of these frames; text, seed and status are those of `like`."""
        return Motion(
            joints_m=self.joints_m.astype(np.float32),
            fps=self.fps,
            head_quat_wxyz=self.head_quat_wxyz.astype(np.float32),
            forearm_twist_rad=self.forearm_twist_rad.astype(np.float32),
            features=np.zeros((len(self), N_FEATURES), np.float32),
            tokens=np.zeros(0, np.int64),
            text=like.text if like else text,
            seed=like.seed if like else 0,
            status=like.status if like else "accepted",
            scope_score=like.scope_score if like else 1.0,
        )


def posture_of(motion: Motion) -> PoseSequence:
    """The poses of a motion."""
    joints, head_quat_wxyz = motion.joints_m.astype(np.float64), motion.head_quat_wxyz.astype(np.float64)
    return poses_of_joints(joints, head_quat_wxyz, motion.forearm_twist_rad.astype(np.float64), motion.fps)


def poses_of_joints(joints: Array, head_quat_wxyz: Array, forearm_twist_rad: Array, fps: float) -> PoseSequence:
    """The poses of a person whose joints (T, 22, 3) in metres and head (T, 4) are given in the world."""
    bones = np.zeros_like(joints)
    for j, parent in enumerate(PARENTS[1:], 1):
        bones[:, j] = joints[:, j] - joints[:, parent]
    lengths = np.linalg.norm(bones, axis=-1).mean(0)
    R_facing_world = np.swapaxes(rotation_y(facing_yaw_rad(joints)), -1, -2)
    bones = np.einsum("tij,tkj->tki", R_facing_world, normalise(bones))
    head = R_facing_world @ matrix_from_quat(head_quat_wxyz)
    return PoseSequence(bones, lengths, np.asarray(quat_wxyz(head), np.float64), forearm_twist_rad, fps)


@cache
def standing() -> PoseSequence:
    """One frame of a person who stands with hanging arms and looks ahead."""
    bones = np.zeros((1, len(PARENTS), 3))
    for j, name in enumerate(JOINT_NAMES[1:], 1):
        side, _, part = name.partition("_")
        bones[0, j] = np.array(_STANDING[part]) * (_FLIP_X if side == "right" else 1.0)
    return PoseSequence(
        np.asarray(normalise(bones), np.float64), BONE_LENGTHS_M.copy(), _IDENTITY_WXYZ[None].copy(), np.zeros((1, 2))
    )


def mixed(a: PoseSequence, b: PoseSequence, weight: Array) -> PoseSequence:
    """Blend frame by frame from `a` (weight 0) to `b` (weight 1), along the shortest arcs; a weight above 1 goes beyond `b`.

    `a` may be a single frame. Lengths and rate are those of `b`.
    """
    w = np.broadcast_to(weight, (len(b),))
    return replace(
        b,
        bones=_slerp(np.broadcast_to(a.bones, b.bones.shape), b.bones, w[:, None, None]),
        head_quat_wxyz=_slerp(
            *_same_half(np.broadcast_to(a.head_quat_wxyz, b.head_quat_wxyz.shape), b.head_quat_wxyz), w[:, None]
        ),
        forearm_twist_rad=a.forearm_twist_rad + w[:, None] * (b.forearm_twist_rad - a.forearm_twist_rad),
    )


def joined(parts: list[PoseSequence]) -> PoseSequence:
    """The parts one after the other; lengths and rate are those of the first."""
    return replace(
        parts[0],
        bones=np.concatenate([p.bones for p in parts]),
        head_quat_wxyz=np.concatenate([p.head_quat_wxyz for p in parts]),
        forearm_twist_rad=np.concatenate([p.forearm_twist_rad for p in parts]),
    )


def mirrored(p: PoseSequence) -> PoseSequence:
    """`p` with left and right exchanged."""
    return replace(
        p,
        bones=p.bones[:, _MIRROR] * _FLIP_X,
        lengths_m=p.lengths_m[_MIRROR],
        head_quat_wxyz=p.head_quat_wxyz * np.array([1.0, 1.0, -1.0, -1.0]),
        forearm_twist_rad=-p.forearm_twist_rad[:, ::-1],
    )


def scaled(p: PoseSequence, amplitude: float) -> PoseSequence:
    """`p` with every deviation from standing multiplied by `amplitude`."""
    return mixed(standing(), p, np.full(len(p), amplitude))


def at_tempo(p: PoseSequence, tempo: float) -> PoseSequence:
    """`p` played `tempo` times as fast, at the same frame rate."""
    n = max(2, round((len(p) - 1) / tempo) + 1)
    return at_steps(p, np.linspace(0, len(p) - 1, n))


def at_steps(p: PoseSequence, places: Array) -> PoseSequence:
    """`p` interpolated at (n,) fractional frame numbers."""
    before = np.floor(places).astype(np.intp)
    return mixed(p.at(before), p.at(before + 1), places - before)


def smooth_step(n: int) -> Array:
    """(n,) minimum-jerk weights that rise from above 0 to 1."""
    u = np.arange(1, n + 1) / n
    return u**3 * (10 - 15 * u + 6 * u**2)


def faded_in(p: PoseSequence, before: PoseSequence, n: int) -> PoseSequence:
    """`p` with its first `n` frames blended from `before`, whose last frame is held where it is shorter."""
    n = min(n, len(p))
    grown = mixed(before.at(np.arange(n)), p[:n], smooth_step(n))
    return joined([grown, p[n:]])


def distance_deg(a: PoseSequence, b: PoseSequence) -> Array:
    """(T,) largest angle in degrees between the two in arms, spine and head."""
    seen = [3, 6, 9, 12, 18, 19, 20, 21]
    cos = np.clip((a.bones[:, seen] * b.bones[:, seen]).sum(-1), -1, 1)
    head = np.clip(np.abs((a.head_quat_wxyz * b.head_quat_wxyz).sum(-1)), -1, 1)
    return np.maximum(np.rad2deg(np.arccos(cos)).max(-1), np.rad2deg(2 * np.arccos(head)))


def _same_half(a: Array, b: Array) -> tuple[Array, Array]:
    """The quaternions `a` with the sign that is nearer to `b`, and `b`."""
    return np.where((a * b).sum(-1, keepdims=True) < 0, -a, a), b


def _slerp(a: Array, b: Array, w: Array) -> Array:
    """Unit vectors between `a` and `b` (..., n), by weight; opposite vectors switch to `b` half way."""
    angle = np.arccos(np.clip((a * b).sum(-1, keepdims=True), -1, 1))
    sine = np.sin(angle)
    small = sine < 1e-6
    sine = np.where(small, 1.0, sine)
    along = np.where(small, 1 - w, np.sin((1 - w) * angle) / sine), np.where(small, w, np.sin(w * angle) / sine)
    v = along[0] * a + along[1] * b
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.where(length < 1e-3, b, v / np.maximum(length, 1e-9))
