"""BVH files read: a joint tree with Euler channels, forward kinematics to positions. Lengths are centimetres unless said."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from mmm_core.corpus.mocap.recording import Recording
from mmm_core.errors import TrainingDataError
from mmm_core.skeleton import Array, rotation_about

_AXES = {"X": np.array([1.0, 0, 0]), "Y": np.array([0.0, 1, 0]), "Z": np.array([0.0, 0, 1])}


@dataclass
class _Node:
    name: str
    parent: int
    offset: Array = field(default_factory=lambda: np.zeros(3))
    channels: tuple[str, ...] = ()


def read_bvh(path: Path, unit_m: float = 0.01) -> Recording:
    """The recording in a BVH file.

    Args:
        path: the file.
        unit_m: metres to a unit of the file: 0.01 for centimetres, 0.0564 for CMU's own scale.

    Raises:
        TrainingDataError: the file is not BVH, or its motion has other channels than its skeleton.
    """
    try:
        words = path.read_text("utf-8", errors="replace").split()
    except FileNotFoundError:
        raise TrainingDataError(path, "", "no such file", "a BVH file") from None
    if not words or words[0] != "HIERARCHY" or "MOTION" not in words:
        raise TrainingDataError(path, "HIERARCHY", f"{' '.join(words[:3])!r}", "a BVH file: HIERARCHY ... MOTION ...")
    middle = words.index("MOTION")
    nodes = _tree(path, words[1:middle])
    n_frames, frame_s, values = _frames(path, words[middle:])
    n_channels = sum(len(n.channels) for n in nodes)
    if len(values) != n_frames * n_channels:
        raise TrainingDataError(path, "MOTION", f"{len(values)} values", f"{n_frames} frames of {n_channels} channels")
    positions = _positions(nodes, values.reshape(n_frames, n_channels))
    return Recording(path, tuple(n.name for n in nodes), positions * unit_m, 1.0 / frame_s)


def _tree(path: Path, words: list[str]) -> list[_Node]:
    nodes: list[_Node] = []
    stack: list[int] = []
    i = 0
    try:
        while i < len(words):
            word = words[i]
            if word in ("ROOT", "JOINT", "End"):
                parent = stack[-1] if stack else -1
                name = f"{nodes[parent].name}_end" if word == "End" else words[i + 1]
                nodes.append(_Node(name, parent))
                i += 2
            elif word == "{":
                stack.append(len(nodes) - 1)
                i += 1
            elif word == "}":
                stack.pop()
                i += 1
            elif word == "OFFSET":
                nodes[-1].offset = np.array([float(w) for w in words[i + 1 : i + 4]])
                i += 4
            elif word == "CHANNELS":
                n = int(words[i + 1])
                nodes[-1].channels = tuple(words[i + 2 : i + 2 + n])
                i += 2 + n
            else:
                raise TrainingDataError(
                    path, "HIERARCHY", f"{word!r}", "ROOT, JOINT, End Site, OFFSET, CHANNELS, { or }"
                )
    except (ValueError, IndexError) as error:
        raise TrainingDataError(path, "HIERARCHY", str(error), "numbers and matching braces") from error
    return nodes


def _frames(path: Path, words: list[str]) -> tuple[int, float, Array]:
    try:
        n_frames, frame_s = int(words[words.index("Frames:") + 1]), float(words[words.index("Time:") + 1])
        values = np.array(words[words.index("Time:") + 2 :], float)
    except (ValueError, IndexError) as error:
        raise TrainingDataError(path, "MOTION", str(error), "Frames: n, Frame Time: s, then numbers") from error
    if frame_s <= 0:
        raise TrainingDataError(path, "Frame Time", f"{frame_s}", "more than 0 s")
    return n_frames, frame_s, values


def _positions(nodes: list[_Node], values: Array) -> Array:
    """(T, J, 3): rotations apply in the order in which a joint's channels stand."""
    T = len(values)
    world, positions = np.empty((T, len(nodes), 3, 3)), np.empty((T, len(nodes), 3))
    column = 0
    for j, node in enumerate(nodes):
        local = np.tile(np.eye(3), (T, 1, 1))
        shift = np.tile(node.offset, (T, 1))
        for channel in node.channels:
            axis, kind = channel[0].upper(), channel[1:].lower()
            if kind == "rotation":
                local = local @ rotation_about(_AXES[axis], np.deg2rad(values[:, column]))
            else:
                at = "XYZ".index(axis)
                shift[:, at] = values[:, column] + (0.0 if node.parent < 0 else node.offset[at])
            column += 1
        if node.parent < 0:
            world[:, j], positions[:, j] = local, shift
        else:
            parent = world[:, node.parent]
            world[:, j] = parent @ local
            positions[:, j] = positions[:, node.parent] + np.einsum("tij,tj->ti", parent, shift)
    return positions
