"""The Motion record: the model's output and the input of everything downstream. NumPy only, no torch.

Frame: metres, y up, z forward, x to the person's left; see `mmm_core.motion.skeleton` for the joints.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import MotionFileError
from mmm_core.motion.arrays import ArraysError, read_npz

FPS = 20.0
"""Frames per second of every motion of the model (HumanML3D's rate)."""
MOST_FRAMES = 24_000
"""Frames of a motion file at most: each takes 7 kB until it is sent to a robot."""
N_JOINTS = 22
N_FEATURES = 263

Status = Literal["accepted", "degraded", "rejected"]
_STATUSES: tuple[Status, ...] = ("accepted", "degraded", "rejected")


@dataclass(frozen=True)
class Motion:
    """A human motion of T frames, and the text, seed and tokens that generate it again.

    Attributes:
        joints_m: (T, 22, 3) float32, joint positions in the world, metres.
        fps: frames per second.
        head_quat_wxyz: (T, 4) float32, world orientation of the head; identity is upright and faces +z.
        forearm_twist_rad: (T, 2) float32, left and right, right-hand rule about elbow to wrist; 0 is rest.
        features: (T, 263) float32, HumanML3D layout, not normalised.
        tokens: (L,) int64, one id for each four frames (several codebooks are packed into one id).
        text: the command.
        seed: seed of the generation.
        status: accepted, degraded or rejected, the scope verdict of the text.
        scope_score: score of the text, from about 0 (the model can do nothing of it) to 1.
    """

    joints_m: NDArray[np.float32]
    fps: float
    head_quat_wxyz: NDArray[np.float32]
    forearm_twist_rad: NDArray[np.float32]
    features: NDArray[np.float32]
    tokens: NDArray[np.int64]
    text: str
    seed: int
    status: Status
    scope_score: float

    def __post_init__(self) -> None:
        """Check shapes and values once, at the border.

        Raises:
            ValueError: a shape differs, fps is not positive or a value is not finite.
        """
        T = len(self.joints_m)
        expected = {
            "joints_m": (T, N_JOINTS, 3),
            "head_quat_wxyz": (T, 4),
            "forearm_twist_rad": (T, 2),
            "features": (T, N_FEATURES),
        }
        for key, shape in expected.items():
            array = getattr(self, key)
            if array.shape != shape:
                raise ValueError(f"Motion.{key} has shape {array.shape}; expected {shape} for {T} frames")
            if not np.isfinite(array).all():
                raise ValueError(f"Motion.{key} holds NaN or infinite values; every frame must be finite")
        if not self.fps > 0:
            raise ValueError(f"Motion.fps is {self.fps}; it must be positive")
        if self.status not in _STATUSES:
            raise ValueError(f"Motion.status is {self.status!r}; allowed: {', '.join(_STATUSES)}")

    @property
    def duration_s(self) -> float:
        return len(self.joints_m) / self.fps

    def save_npz(self, path: Path | str) -> None:
        """Write all fields (`joints_m` as `joints`) to an .npz; an older file stays whole if writing fails."""
        path = Path(path)
        partial = path.with_name(path.name + ".part")
        try:
            with partial.open("wb") as f:
                np.savez_compressed(
                    f,
                    joints=self.joints_m.astype(np.float32),
                    fps=np.float64(self.fps),
                    head_quat_wxyz=self.head_quat_wxyz.astype(np.float32),
                    forearm_twist_rad=self.forearm_twist_rad.astype(np.float32),
                    features=self.features.astype(np.float32),
                    tokens=self.tokens.astype(np.int64),
                    text=np.array(self.text),
                    seed=np.int64(self.seed),
                    status=np.array(self.status),
                    scope_score=np.float64(self.scope_score),
                )
            os.replace(partial, path)
        finally:
            partial.unlink(missing_ok=True)


def joined(pieces: Sequence[Motion]) -> Motion:
    """One motion of consecutive chunks; texts are joined by "; ", the seed is the first chunk's.

    Raises:
        ValueError: no chunks, or chunks of different fps.
    """
    if not pieces or len({p.fps for p in pieces}) != 1:
        raise ValueError(
            f"{len(pieces)} pieces of {sorted({p.fps for p in pieces})} fps; expected one or more, of one fps"
        )
    shown = [p for p in pieces if len(p.joints_m)]
    texts = [p.text for i, p in enumerate(shown) if i == 0 or p.text != shown[i - 1].text]
    worst = _STATUSES[max((_STATUSES.index(p.status) for p in shown), default=_STATUSES.index("rejected"))]
    return Motion(
        joints_m=np.concatenate([p.joints_m for p in pieces]),
        fps=pieces[0].fps,
        head_quat_wxyz=np.concatenate([p.head_quat_wxyz for p in pieces]),
        forearm_twist_rad=np.concatenate([p.forearm_twist_rad for p in pieces]),
        features=np.concatenate([p.features for p in pieces]),
        tokens=np.concatenate([p.tokens for p in pieces]),
        text="; ".join(texts),
        seed=pieces[0].seed,
        status=worst,
        scope_score=min((p.scope_score for p in shown), default=0.0),
    )


def load_npz(path: Path | str) -> Motion:
    """Read a motion written by `Motion.save_npz`.

    Only `joints` and `fps` are required, so that other programs' motions can be read: a missing head orientation
    is the identity, missing twist and features are zero.

    Raises:
        MotionFileError: the file is missing, is no npz, lacks a field or holds another shape; path and key are named.
    """
    path = Path(path)
    try:
        fields = read_npz(path)
    except FileNotFoundError:
        raise MotionFileError(path, "", "no such file", "an .npz written by `mmmd generate`") from None
    except (OSError, ArraysError) as error:
        raise MotionFileError(path, "", str(error), "an .npz without pickled objects") from error
    for key in ("joints", "fps"):
        if key not in fields:
            raise MotionFileError(path, key, f"missing; found {sorted(fields)}", "joints (T,22,3) in metres and fps")
    joints_m = np.asarray(fields["joints"])
    if joints_m.ndim != 3 or joints_m.shape[1:] != (N_JOINTS, 3) or len(joints_m) == 0:
        raise MotionFileError(
            path, "joints", f"shape {joints_m.shape}", "(T, 22, 3) with T >= 1, HumanML3D joint order"
        )
    if joints_m.dtype.kind not in "fiu":
        raise MotionFileError(path, "joints", f"values of type {joints_m.dtype}", "numbers, metres")
    finite = np.isfinite(joints_m).all((1, 2))
    if not finite.all():
        found = f"NaN or infinite values in frame {int(finite.argmin())}, {int((~finite).sum())} such frames"
        raise MotionFileError(
            path, "joints", found, "finite metres in every frame; cut those frames out or fill them in"
        )
    if len(joints_m) > MOST_FRAMES:
        found, allowed = (
            f"{len(joints_m)} frames",
            f"at most {MOST_FRAMES}, which are {MOST_FRAMES / FPS / 60:.0f} minutes at {FPS:g} fps",
        )
        raise MotionFileError(path, "joints", found, allowed)
    T = len(joints_m)
    identity = np.tile(np.array([1, 0, 0, 0], np.float32), (T, 1))
    try:
        return Motion(
            joints_m=joints_m.astype(np.float32),
            fps=float(fields["fps"]),
            head_quat_wxyz=fields.get("head_quat_wxyz", identity).astype(np.float32),
            forearm_twist_rad=fields.get("forearm_twist_rad", np.zeros((T, 2), np.float32)).astype(np.float32),
            features=fields.get("features", np.zeros((T, N_FEATURES), np.float32)).astype(np.float32),
            tokens=fields.get("tokens", np.zeros(0)).astype(np.int64),
            text=str(fields.get("text", "")),
            seed=int(fields.get("seed", 0)),
            status=str(fields.get("status", "accepted")),  # type: ignore[arg-type]  # checked by Motion
            scope_score=float(fields.get("scope_score", 1.0)),
        )
    except (ValueError, TypeError, OverflowError) as error:
        raise MotionFileError(path, "", str(error), "finite arrays of one length") from error
