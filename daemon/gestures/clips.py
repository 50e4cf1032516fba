"""Clips on disk: bones above the hips as 16-bit numbers, about 100 bytes a frame before compression.

One .npz file holds any number of clips. The legs are not stored: the person of a clip stands.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.errors import ClipError
from daemon.poses.cycles import Marks
from daemon.poses.pose_sequence import PoseSequence, standing
from mmm_core.motion.arrays import read_npz
from mmm_core.motion.motion import FPS
from mmm_core.motion.skeleton import BONE_LENGTHS_M, normalise

FORMAT = 1
MOST_BYTES = 16 << 20
"""Bytes of a file of clips at most, unpacked: the library that ships has 0.4 MB."""
_KEPT = np.array([3, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21])
_UNIT = 32767.0
_TWIST_RAD = 2 * np.pi
"""Radians of forearm twist at full scale of the 16-bit number."""


@dataclass(frozen=True)
class Clip:
    """A named motion.

    Attributes:
        name: lower case letters, digits and _.
        text: text of the motion.
        posture: its poses.
        marks: frames of its loop and of its hold.
        mirror: name of the clip that shows its mirror image, empty when there is none.
        source: origin of the motion.
        side: arms with which it was taught, left, right or both; empty when unknown.
    """

    name: str
    text: str
    posture: PoseSequence
    marks: Marks
    mirror: str = ""
    source: str = ""
    side: str = ""


def save_clips(path: Path, clips: Mapping[str, Clip]) -> None:
    """Write clips; an older file stays intact if writing fails.

    Raises:
        OSError: the file cannot be written.
    """
    arrays: dict[str, NDArray[Any]] = {}
    meta: dict[str, Any] = {"format": FORMAT, "clips": {}}
    for name, clip in clips.items():
        p = clip.posture
        arrays[f"{name}.bones"] = np.rint(p.bones[:, _KEPT] * _UNIT).astype(np.int16)
        arrays[f"{name}.head"] = np.rint(p.head_quat_wxyz * _UNIT).astype(np.int16)
        arrays[f"{name}.twist"] = np.rint(np.clip(p.forearm_twist_rad / _TWIST_RAD, -1, 1) * _UNIT).astype(np.int16)
        meta["clips"][name] = {
            "text": clip.text, "mirror": clip.mirror, "source": clip.source, "loop": clip.marks.loop,
            "hold": clip.marks.hold, "side": clip.side,
        }  # fmt: skip
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with partial.open("wb") as f:
            text = np.frombuffer(json.dumps(meta).encode(), np.uint8)
            np.savez_compressed(f, allow_pickle=False, meta=text, **arrays)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def load_clips(path: Path) -> dict[str, Clip]:
    """The clips of a file.

    Raises:
        ClipError: the file is missing, damaged or of another format; the error names path and finding.
    """
    try:
        data = read_npz(path, MOST_BYTES)
        meta = json.loads(data["meta"].tobytes())
        if meta["format"] != FORMAT:
            raise ClipError(f"{path}: clip format {meta['format']}; this mmmd reads {FORMAT}; make the clip again")
        return {name: _clip(name, row, data) for name, row in meta["clips"].items()}
    except ClipError:
        raise
    except Exception as error:  # a file from another source can raise any error
        do = "gestures are written by `mmmd gesture add`, `record` and `teach`"
        raise ClipError(f"{path}: no clips to be read there ({error}); {do}") from error


def _clip(name: str, row: dict[str, Any], data: Mapping[str, NDArray[Any]]) -> Clip:
    kept = data[f"{name}.bones"].astype(np.float64)
    T = len(kept)
    head, twist = data[f"{name}.head"].astype(np.float64), data[f"{name}.twist"].astype(np.float64)
    loop = None if row["loop"] is None else (int(row["loop"][0]), int(row["loop"][1]))
    sound = kept.shape == (T, len(_KEPT), 3) and head.shape == (T, 4) and twist.shape == (T, 2) and T >= 2
    sound = sound and 0 <= int(row["hold"]) < T and (loop is None or 0 <= loop[0] < loop[1] <= T)
    if not sound:
        raise ValueError(f"clip '{name}' has arrays or marks that do not fit its {T} frames")
    bones = standing().at(np.zeros(T, np.intp)).bones.copy()
    bones[:, _KEPT] = normalise(kept)
    posture = PoseSequence(
        bones, BONE_LENGTHS_M.copy(), np.asarray(normalise(head), np.float64), twist / _UNIT * _TWIST_RAD, FPS
    )
    marks = Marks(loop, int(row["hold"]))
    told = (str(row["mirror"]), str(row["source"]), str(row.get("side", "")))  # older files have no side
    return Clip(name, str(row["text"]), posture, marks, *told)
