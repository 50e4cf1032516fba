"""Reads motion files of every supported kind, and finds them in folders."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mmm_core.errors import MotionFileError
from mmm_core.imports.recordings.asf_amc import read_amc
from mmm_core.imports.recordings.bvh import read_bvh
from mmm_core.imports.recordings.skeletons import motion_of
from mmm_core.motion.arrays import ArraysError, read_npy, read_npz
from mmm_core.motion.features import joints_from_positions
from mmm_core.motion.motion import FPS, N_FEATURES, Motion, load_npz
from mmm_core.motion.skeleton import JOINT_NAMES

KINDS = (".npz", ".npy", ".bvh", ".amc")
_HUMANML3D = ("new_joints", "new_joint_vecs")


def read_motion(path: Path, fps: float | None = None) -> Motion:
    """The motion of an .npz (ours), .npy (HumanML3D `new_joints` or `new_joint_vecs`), .bvh or .amc file, at 20 fps.

    Args:
        path: the file.
        fps: frames per second; wins over the file's own rate. None takes the file's, or the usual rate of its kind.

    Raises:
        MotionFileError: the file is missing, of another kind or not usable; path and key are named.
    """
    kind = path.suffix.lower()
    if not path.is_file():
        raise MotionFileError(path, "", "no such file", f"a file of {', '.join(KINDS)}")
    if kind == ".bvh":
        return read_bvh(path, fps)
    if kind == ".amc":
        return read_amc(path, fps)
    if kind == ".npy":
        return _read_npy(path, fps or FPS)
    if kind == ".npz":
        return _read_npz(path, fps)
    raise MotionFileError(path, "", f"a {kind or 'nameless'} file", f"{', '.join(KINDS)}")


def find_motions(folder: Path) -> list[Path]:
    """All motion files below a folder, sorted; in a HumanML3D folder only its joints or, without these, its features."""
    for name in _HUMANML3D:
        if (folder / name).is_dir():
            folder = folder / name
            break
    return sorted(p for p in folder.rglob("*") if p.suffix.lower() in KINDS and p.is_file())


def _read_npy(path: Path, fps: float) -> Motion:
    try:
        data = read_npy(path)
    except (OSError, ArraysError) as error:
        raise MotionFileError(path, "", str(error), "an array without pickled objects") from error
    if data.ndim == 2 and data.shape[1] == N_FEATURES and data.dtype.kind == "f":
        if not np.isfinite(data).all():
            raise MotionFileError(path, "frames", "NaN or infinite values", "numbers")
        data = joints_from_positions(data)
    if data.ndim != 3 or data.shape[1:] != (len(JOINT_NAMES), 3) or data.dtype.kind not in "fiu":
        allowed = f"(T, {len(JOINT_NAMES)}, 3) joints of HumanML3D's new_joints or (T, {N_FEATURES}) of new_joint_vecs"
        raise MotionFileError(path, "", f"shape {data.shape}, {data.dtype}", allowed)
    places = {n: np.asarray(data[:, j], np.float64) for j, n in enumerate(JOINT_NAMES)}
    return motion_of(path, places, None, fps, unit_known=True)


def _read_npz(path: Path, fps: float | None) -> Motion:
    motion = load_npz(path)
    has_head = "head_quat_wxyz" in read_npz(path)
    rate = fps or motion.fps
    if has_head and rate == FPS:
        return motion
    if has_head:
        raise MotionFileError(path, "fps", f"{rate:g} with a head orientation", f"{FPS:g}, or joints alone")
    places = {n: motion.joints_m[:, j].astype(np.float64) for j, n in enumerate(JOINT_NAMES)}
    return motion_of(path, places, None, rate, unit_known=True)
