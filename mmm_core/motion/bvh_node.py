"""A node of a BVH file's joint tree."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mmm_core.motion.skeleton import PARENTS, Array

CM_PER_M = 100.0


@dataclass(frozen=True, eq=False)
class Node:
    """A node of the joint tree.

    Attributes:
        name: name in the file.
        parent: index of the parent in the list of nodes; -1 for the root.
        offset_cm: (3,) centimetres from the parent, in the parent's frame.
        turn: (T, 3, 3) rotation in the parent's frame.
        end_cm: (3,) end of the node's bone in centimetres, for a node without children.
    """

    name: str
    parent: int
    offset_cm: Array
    turn: Array
    end_cm: Array | None = None


def bone_lengths_m(joints_m: Array) -> Array:
    """(22,) median length of the bone that ends in each joint of (T, 22, 3); 0 for the root."""
    lengths_m = np.zeros(len(PARENTS))
    lengths_m[1:] = np.median(np.linalg.norm(joints_m[:, 1:] - joints_m[:, list(PARENTS[1:])], axis=-1), axis=0)
    return lengths_m
