"""Reads BVH files: the joint tree and its rotations, as a motion of our joints.

A joint's rotations are applied in the order of its channels, each about the axis as turned by the rotations before it. The
format names neither unit nor facing: lengths are scaled to a person's, and the rest pose shows the forward direction.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.errors import MotionFileError
from mmm_core.imports.recordings.skeletons import find_joints, motion_of, rest_frame
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import rotation_about

Array = NDArray[np.float64]
_AXES = {"X": np.array([1.0, 0, 0]), "Y": np.array([0.0, 1, 0]), "Z": np.array([0.0, 0, 1])}


@dataclass
class _Tree:
    """Joints in the order of their channels."""

    names: list[str] = field(default_factory=list[str])
    parents: list[int] = field(default_factory=list[int])
    offsets: list[list[float]] = field(default_factory=list[list[float]])
    channels: list[list[str]] = field(default_factory=list[list[str]])


def read_bvh(path: Path, fps: float | None = None) -> Motion:
    """The motion of a BVH file; `fps` wins over the file's frame time.

    Raises:
        MotionFileError: the file is no BVH file or is cut short, or its skeleton has no arms; line or key is named.
    """
    try:
        words = path.read_text("utf-8", errors="replace").split()
    except OSError as error:
        raise MotionFileError(path, "", str(error), "a readable BVH file") from error
    try:
        tree, at = _hierarchy(path, words)
        values, frame_time_s = _frames(path, words, at, sum(map(len, tree.channels)))
    except (IndexError, ValueError) as error:
        if isinstance(error, MotionFileError):
            raise
        raise MotionFileError(path, "HIERARCHY", f"cut short or garbled ({error})", "a whole BVH file") from error
    if fps is None and not frame_time_s > 0:
        raise MotionFileError(path, "Frame Time", str(frame_time_s), "seconds, more than 0; or give --fps")
    found = find_joints(path, tree.names, tree.parents)
    places, turns = _pose(tree, values)
    rest, _ = _pose(tree, np.zeros((1, values.shape[1])))
    facing = rest_frame({name: rest[j][0] for name, j in found.items()})
    upright = _upright(facing)
    head = turns[found["head"]] @ facing if "head" in found else None
    return motion_of(
        path, {name: places[j] @ upright.T for name, j in found.items()}, None if head is None else upright @ head,
        1 / frame_time_s if fps is None else fps, rest={name: rest[j] @ upright.T for name, j in found.items()},
    )  # fmt: skip


def _hierarchy(path: Path, words: list[str]) -> tuple[_Tree, int]:
    """The joint tree, and the index of the word with which the motion begins."""
    if not words or words[0].upper() != "HIERARCHY":
        raise MotionFileError(
            path, "HIERARCHY", repr(words[0] if words else ""), "a BVH file, which begins with HIERARCHY"
        )
    tree, above, at = _Tree(), [-1], 1
    while words[at].upper() != "MOTION":
        word = words[at].upper()
        if word in ("ROOT", "JOINT"):
            name_end = words.index("{", at)
            tree.names.append(" ".join(words[at + 1 : name_end]))
            tree.parents.append(above[-1])
            above.append(len(tree.names) - 1)
            at = name_end + 1
        elif word == "END":  # the end of a bone stands for a joint that the file lacks: the wrist, the top of the head
            tree.names.append(f"{tree.names[above[-1]]} end")
            tree.parents.append(above[-1])
            tree.channels.append([])
            above.append(len(tree.names) - 1)
            at = words.index("{", at) + 1
        elif word == "OFFSET":
            tree.offsets.append([float(v) for v in words[at + 1 : at + 4]])
            at += 4
        elif word == "CHANNELS":
            n = int(words[at + 1])
            tree.channels.append([c.capitalize() for c in words[at + 2 : at + 2 + n]])
            at += 2 + n
        elif word == "}":
            above.pop()
            at += 1
        else:
            raise MotionFileError(
                path, "HIERARCHY", repr(words[at]), "ROOT, JOINT, End Site, OFFSET, CHANNELS or MOTION"
            )
    if not len(tree.names) == len(tree.offsets) == len(tree.channels):
        raise MotionFileError(path, "HIERARCHY", "a joint without OFFSET or CHANNELS", "both for every joint")
    return tree, at


def _frames(path: Path, words: list[str], at: int, n_channels: int) -> tuple[Array, float]:
    """(T, channels) values and the frame time."""
    n_frames, frame_time_s = int(words[at + 2]), float(words[at + 5])
    values = np.array(words[at + 6 :], np.float64)
    if len(values) != n_frames * n_channels or n_frames < 1:
        found = f"{len(values)} values for {n_frames} frames of {n_channels} channels"
        raise MotionFileError(path, "MOTION", found, f"{n_frames * n_channels} values, at least one frame")
    return values.reshape(n_frames, n_channels), frame_time_s


def _pose(tree: _Tree, values: Array) -> tuple[list[Array], list[Array]]:
    """Position (T, 3) and world rotation (T, 3, 3) of every joint."""
    places: list[Array] = []
    turns: list[Array] = []
    column = 0
    for parent, offset, channels in zip(tree.parents, tree.offsets, tree.channels, strict=True):
        moved, turn = np.tile(np.array(offset), (len(values), 1)), np.tile(np.eye(3), (len(values), 1, 1))
        given = np.zeros_like(moved)
        has_place = False
        for channel in channels:
            axis, kind = channel[0].upper(), channel[1:]
            if kind == "position":
                given[:, "XYZ".index(axis)], has_place = values[:, column], True
            else:
                turn = turn @ rotation_about(_AXES[axis], np.deg2rad(values[:, column]))
            column += 1
        moved = moved + given if has_place and parent < 0 else (given if has_place else moved)
        if parent < 0:
            places.append(moved)
            turns.append(turn)
        else:
            places.append(places[parent] + (turns[parent] @ moved[..., None])[..., 0])
            turns.append(turns[parent] @ turn)
    return places, turns


def _upright(facing: Array) -> Array:
    """(3, 3) rotation from the file's axes to y up, by the axis along which its rest pose stands."""
    up = facing[:, 1]
    axis = int(np.abs(up).argmax())
    if axis == 1 and up[1] > 0:
        return np.eye(3)
    if axis == 2:  # z up, as Blender exports on request
        return (
            np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]) * np.sign(up[2])
            if up[2] > 0
            else np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
        )
    return np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
