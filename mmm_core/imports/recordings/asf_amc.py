"""Reads CMU's ASF skeletons and AMC motions (Acclaim format).

A bone turns by its degrees of freedom about its own axes, which the ASF gives as an XYZ rotation C: in the parent's frame
by C M C^-1 (J. Lander, "Working with Motion Capture File Formats", Game Developer 1/1998). An AMC names neither its
skeleton nor its frame rate: the skeleton is the ASF beside it, the rate CMU's 120 fps unless told otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import MotionFileError
from mmm_core.imports.recordings.skeletons import motion_of, rest_frame
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import rotation_about

Array = NDArray[np.float64]
CMU_FPS = 120.0
_AXES = {"x": np.array([1.0, 0, 0]), "y": np.array([0.0, 1, 0]), "z": np.array([0.0, 0, 1])}
_ENDS = {
    "spine1": "lowerback", "spine2": "upperback", "spine3": "thorax", "neck": "lowerneck", "head": "upperneck",
    **{f"{side}_{ours}": f"{side[0]}{bone}" for side in ("left", "right") for ours, bone in (
        ("hip", "hipjoint"), ("knee", "femur"), ("ankle", "tibia"), ("foot", "foot"), ("shoulder", "clavicle"),
        ("elbow", "humerus"), ("wrist", "radius"))},
}  # fmt: skip
"""Name of the bone at whose end each of our joints lies."""


@dataclass(frozen=True)
class _Bone:
    offset: Array
    axes: Array
    dof: tuple[str, ...]


def read_amc(path: Path, fps: float | None = None) -> Motion:
    """The motion of an AMC file with its ASF; None for `fps` means CMU's 120.

    Raises:
        MotionFileError: there is no skeleton, or either file is garbled; file, line and bone are named.
    """
    asf = skeleton_of(path)
    bones, parents = _read_asf(asf)
    frames = _read_amc(path, bones)
    missing = [bone for bone in _ENDS.values() if bone not in bones]
    if missing:
        raise MotionFileError(asf, ", ".join(missing), "no such bones", "the bones of CMU's skeletons")
    places, turns = _pose(bones, parents, frames)
    rest, _ = _pose(bones, parents, {"root": np.zeros((1, 6))})
    joints, standing = (
        {ours: pose[bone] for ours, bone in _ENDS.items()} | {"pelvis": pose["root"]} for pose in (places, rest)
    )
    facing = rest_frame({ours: place[0] for ours, place in standing.items()})
    head = turns["head" if "head" in bones else "upperneck"] @ facing
    return motion_of(path, joints, head, fps or CMU_FPS, rest=standing)


def skeleton_of(path: Path) -> Path:
    """The ASF file of an AMC file: that of the same name, of the subject in `SUBJECT_TRIAL.amc`, or the folder's only one."""
    named = [path.with_suffix(".asf"), path.with_name(path.stem.split("_")[0] + ".asf")]
    beside = sorted(p for p in path.parent.glob("*") if p.suffix.lower() == ".asf")
    for asf in [*(p for p in named if p.is_file()), *(beside if len(beside) == 1 else [])]:
        return asf
    found = ", ".join(p.name for p in beside) or "no .asf"
    raise MotionFileError(
        path, "skeleton", f"{found} in its folder", f"{' or '.join(p.name for p in named)}, or one .asf"
    )


def _read_asf(path: Path) -> tuple[dict[str, _Bone], dict[str, str]]:
    """Bones by name, and the parent of each."""
    bones: dict[str, _Bone] = {"root": _Bone(np.zeros(3), np.eye(3), ("tx", "ty", "tz", "rx", "ry", "rz"))}
    parents: dict[str, str] = {}
    section, fields = "", dict[str, list[str]]()
    for number, line in enumerate(path.read_text("utf-8", errors="replace").splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            if words[0].startswith(":"):
                section = words[0]
            elif section == ":root" and words[0] == "order":
                bones["root"] = _Bone(np.zeros(3), np.eye(3), tuple(w.lower() for w in words[1:]))
            elif section == ":bonedata":
                if words[0] == "begin":
                    fields = {}
                elif words[0] == "end":
                    bones[fields["name"][0]] = _bone(fields)
                else:
                    fields[words[0]] = words[1:]
            elif section == ":hierarchy" and words[0] not in ("begin", "end"):
                parents |= dict.fromkeys(words[1:], words[0])
        except (KeyError, IndexError, ValueError) as error:
            raise MotionFileError(path, f"line {number}", f"{line.strip()!r} ({error!r})", "an ASF skeleton") from error
    if not parents or len(bones) < 2:
        raise MotionFileError(path, ":bonedata, :hierarchy", "no bones", "an ASF skeleton")
    return bones, parents


def _bone(fields: dict[str, list[str]]) -> _Bone:
    direction, length = np.array(fields["direction"][:3], np.float64), float(fields["length"][0])
    angles, order = np.deg2rad(np.array(fields["axis"][:3], np.float64)), fields["axis"][3].lower()
    axes = np.eye(3)
    for letter, angle in zip(order, angles, strict=True):  # the first letter turns first, about fixed axes
        axes = rotation_about(_AXES[letter], angle) @ axes
    return _Bone(length * direction, axes, tuple(w.lower() for w in fields.get("dof", [])))


def _read_amc(path: Path, bones: dict[str, _Bone]) -> dict[str, Array]:
    """(T, dof) values of every bone that moves."""
    rows: dict[str, list[list[float]]] = {}
    n_frames = 0
    for number, line in enumerate(path.read_text("utf-8", errors="replace").splitlines(), 1):
        words = line.split()
        if not words or words[0][0] in "#:":
            continue
        if len(words) == 1 and words[0].isdigit():
            n_frames += 1
            continue
        try:
            rows.setdefault(words[0], []).append([float(w) for w in words[1:]])
        except ValueError as error:
            raise MotionFileError(path, f"line {number}", repr(line.strip()), "a bone and its numbers") from error
        if words[0] not in bones or len(words) - 1 != len(bones[words[0]].dof):
            dof = ", ".join(bones[words[0]].dof) if words[0] in bones else "no such bone in the skeleton"
            raise MotionFileError(path, f"line {number}: {words[0]}", f"{len(words) - 1} numbers", dof)
    short = [bone for bone, values in rows.items() if len(values) != n_frames]
    if short or n_frames == 0 or "root" not in rows:
        raise MotionFileError(path, ", ".join(short) or "frames", f"{n_frames} frames", "every bone in every frame")
    return {bone: np.array(values) for bone, values in rows.items()}


def _pose(
    bones: dict[str, _Bone], parents: dict[str, str], frames: dict[str, Array]
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Position (T, 3) of the end and world rotation (T, 3, 3) of every bone, by name."""
    T = len(frames["root"])
    places: dict[str, Array] = {}
    turns: dict[str, Array] = {}

    def visit(name: str) -> None:
        if name in places:
            return
        bone, values = bones[name], frames.get(name, np.zeros((T, len(bones[name].dof))))
        turn = np.tile(np.eye(3), (T, 1, 1))
        moved = np.zeros((T, 3))
        for i, dof in enumerate(bone.dof):
            if dof.startswith("r"):
                turn = rotation_about(_AXES[dof[1]], np.deg2rad(values[:, i])) @ turn
            elif dof.startswith("t"):
                moved[:, "xyz".index(dof[1])] = values[:, i]
        turn = bone.axes @ turn @ bone.axes.T
        if name == "root":
            places[name], turns[name] = moved, turn
            return
        visit(parents[name])
        turns[name] = turns[parents[name]] @ turn
        places[name] = places[parents[name]] + turns[name] @ bone.offset

    for name in bones:
        if name == "root" or name in parents:
            visit(name)
    return places, turns
