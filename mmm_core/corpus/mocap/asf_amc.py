"""CMU's own files read: a skeleton (ASF) and its motion (AMC), forward kinematics to positions.

A bone turns about axes of its own: its rotation in its parent is C M C^-1, with C from `axis` and M from the frame's angles,
each applied x first, then y, then z (Acclaim skeleton format).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from mmm_core.corpus.mocap.recording import Recording
from mmm_core.errors import TrainingDataError
from mmm_core.skeleton import Array, rotation_about

CMU_UNIT_M = 0.0254 / 0.45
"""CMU's lengths are inches times 0.45."""
CMU_FPS = 120.0
_AXES = np.eye(3)
_ORDER = ("rx", "ry", "rz")


@dataclass
class _Bone:
    name: str
    parent: str = "root"
    direction: Array = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: Array = field(default_factory=lambda: np.eye(3))
    dof: tuple[str, ...] = ()


def read_asf_amc(asf: Path, amc: Path, unit_m: float = CMU_UNIT_M, fps: float = CMU_FPS) -> Recording:
    """The recording of an AMC file on the skeleton of an ASF file; joints are the ends of the bones and the root.

    Raises:
        TrainingDataError: a file is missing or broken, or the motion has a bone or angle that the skeleton lacks.
    """
    bones, root_order = _skeleton(asf)
    frames = _motion(amc)
    T = len(frames)
    world: dict[str, Array] = {}
    ends: dict[str, Array] = {}
    root = np.array([_values(amc, f, "root", len(root_order)) for f in frames])
    angles = {"rx": np.zeros(T), "ry": np.zeros(T), "rz": np.zeros(T)}
    place = np.zeros((T, 3))
    for column, kind in enumerate(root_order):
        if kind[0] == "t":
            place[:, "xyz".index(kind[1])] = root[:, column]
        else:
            angles[kind] = root[:, column]
    world["root"], ends["root"] = _turn(angles), place
    for bone in bones:
        turned = {kind: np.zeros(T) for kind in _ORDER}
        if bone.dof:
            rows = np.array([_values(amc, f, bone.name, len(bone.dof)) for f in frames])
            turned |= {kind: rows[:, i] for i, kind in enumerate(bone.dof)}
        local = bone.axis @ _turn(turned) @ bone.axis.T
        world[bone.name] = world[bone.parent] @ local
        ends[bone.name] = ends[bone.parent] + world[bone.name] @ (bone.direction * bone.length)
    positions = np.stack(list(ends.values()), 1) * unit_m
    return Recording(amc, tuple(ends), positions, fps)


def _turn(angles_deg: Mapping[str, Array]) -> Array:
    """(T, 3, 3) rotations: x first, then y, then z."""
    x, y, z = (rotation_about(axis, np.deg2rad(angles_deg[k])) for axis, k in zip(_AXES, _ORDER, strict=True))
    return z @ y @ x


def _skeleton(asf: Path) -> tuple[list[_Bone], tuple[str, ...]]:
    """Bones, parents before children, and the order of the root's values."""
    section, bones, order = "", {}, ()
    bone = _Bone("")
    for number, line in enumerate(_lines(asf), 1):
        words = line.split()
        try:
            if words[0].startswith(":"):
                section = words[0]
            elif section == ":root" and words[0] == "order":
                order = tuple(w.lower() for w in words[1:])
            elif section == ":bonedata":
                bone = _described(bone, words)
                if words[0] == "name":
                    bones[bone.name] = bone
            elif section == ":hierarchy" and words[0] not in ("begin", "end"):
                for child in words[1:]:
                    bones[child].parent = words[0]
        except (ValueError, IndexError, KeyError) as error:
            raise TrainingDataError(asf, f"line {number}", f"{line!r}: {error}", "an Acclaim skeleton (ASF)") from error
    if not bones or not order:
        raise TrainingDataError(asf, "", "no :root order or no :bonedata", "an Acclaim skeleton (ASF)")
    return _parents_first(asf, bones), order


def _described(bone: _Bone, words: list[str]) -> _Bone:
    """The bone with what one line says of it; a new one where the line begins it."""
    match words[0]:
        case "begin":
            return _Bone("")
        case "name":
            bone.name = words[1]
        case "direction":
            bone.direction = np.array([float(w) for w in words[1:4]])
        case "length":
            bone.length = float(words[1])
        case "axis":
            bone.axis = _turn({k: np.array([float(w)]) for k, w in zip(_ORDER, words[1:4], strict=True)})[0]
        case "dof":
            bone.dof = tuple(w.lower() for w in words[1:] if w.lower() in _ORDER)
        case _:
            pass
    return bone


def _parents_first(asf: Path, bones: dict[str, _Bone]) -> list[_Bone]:
    placed, rows = {"root"}, list[_Bone]()
    while len(rows) < len(bones):
        ready = [b for b in bones.values() if b.parent in placed and b.name not in placed]
        if not ready:
            raise TrainingDataError(asf, ":hierarchy", "bones that hang on no root", "a tree from the root")
        rows += ready
        placed |= {b.name for b in ready}
    return rows


def _motion(amc: Path) -> list[dict[str, list[float]]]:
    frames: list[dict[str, list[float]]] = []
    for number, line in enumerate(_lines(amc), 1):
        words = line.split()
        if words[0].startswith(":"):
            continue
        if len(words) == 1 and words[0].isdigit():
            frames.append({})
            continue
        try:
            frames[-1][words[0]] = [float(w) for w in words[1:]]
        except (ValueError, IndexError) as error:
            raise TrainingDataError(
                amc, f"line {number}", f"{line!r}", "a frame number, or a bone and its angles"
            ) from error
    if not frames:
        raise TrainingDataError(amc, "", "no frames", "an Acclaim motion (AMC)")
    return frames


def _values(amc: Path, frame: dict[str, list[float]], bone: str, n: int) -> list[float]:
    values = frame.get(bone, [])
    if len(values) != n:
        raise TrainingDataError(amc, bone, f"{len(values)} values", f"{n} in every frame, as the skeleton says")
    return values


def _lines(path: Path) -> list[str]:
    """Lines that say something, comments removed."""
    try:
        text = path.read_text("utf-8", errors="replace")
    except FileNotFoundError:
        raise TrainingDataError(path, "", "no such file", "an ASF or AMC file") from None
    lines = (line.split("#")[0].strip() for line in text.splitlines())
    return [line for line in lines if line]
