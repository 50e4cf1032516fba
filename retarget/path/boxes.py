"""Distances from boxes to capsules and to boxes, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_LEAST = 1e-12
_STEEP = 1e9
"""Metres that exceed every slope."""


def capsule_to_box(offset: Array, axis: Array, half_m: Array, box_half_m: Array) -> tuple[Array, Array, Array]:
    """Distances (n,) from boxes to capsules' axes, vectors (3, n) from box to axis, and places (n,) of the nearest points.

    Distance and vector are 0 where an axis crosses its box. The places are metres along the axes from the capsules' centres.

    Half the squared distance of a point on the axis is convex, and its slope is linear between the planes of the box's faces: the
    nearest point is the zero of the slope between the last plane with a negative and the first with a positive slope.

    Args:
        offset: (3, n) centre of the capsule in the box's own axes.
        axis: (3, n) unit axis of the capsule there.
        half_m: (n,) its half length; 0 for a sphere.
        box_half_m: (3, n) half edges of the box.
    """
    along = np.where(np.abs(axis) < _LEAST, _LEAST, axis)
    at = np.empty((8, len(half_m)))
    np.negative(half_m, out=at[0])
    at[1] = half_m
    np.divide(-box_half_m - offset, along, out=at[2:5])
    np.divide(box_half_m - offset, along, out=at[5:])
    np.minimum(np.maximum(at, at[0], out=at), half_m, out=at)
    slope = np.einsum("in,isn->sn", axis, _beyond(offset[:, None] + axis[:, None] * at, box_half_m[:, None]))  # (8, n)
    rises, falls = slope > 0, slope < 0
    low, high = np.where(rises, at[0], at).max(0), np.where(falls, half_m, at).min(0)
    fall, rise = np.where(rises, -_STEEP, slope).max(0), np.where(falls, _STEEP, slope).min(0)
    # A slope that only rises or only falls makes `low` and `high` the nearest end; between them a slope of 0 is nearest throughout.
    nearest = low - fall / np.where(rise > fall, rise - fall, 1.0) * (high - low)
    beyond = _beyond(offset + axis * nearest, box_half_m)
    return np.sqrt(np.einsum("in,in->n", beyond, beyond)), beyond, nearest


def _beyond(point: Array, half_m: Array) -> Array:
    """Vectors from the nearest points of boxes to points."""
    return point - np.minimum(np.maximum(point, -half_m), half_m)


def box_to_box(offset: Array, turn1: Array, half1_m: Array, turn2: Array, half2_m: Array) -> tuple[Array, Array]:
    """Lower bounds (n,) of the distances of n pairs of boxes, and vectors (n, 3) from the first to the second.

    The bound is the distance of either box to the other's bounding box in its own axes, the larger of both; it and the vector
    are 0 where no axis of the boxes separates them.

    Args:
        offset: (n, 3) centre of the second less centre of the first.
        turn1: (n, 3, 3) rotations; columns are the axes of the first box.
        half1_m: (n, 3) its half edges.
        turn2: (n, 3, 3) of the second.
        half2_m: (n, 3).
    """
    between = np.abs(turn1.transpose(0, 2, 1) @ turn2)
    along1, along2 = (offset[:, None] @ turn1)[:, 0], (offset[:, None] @ turn2)[:, 0]
    apart1 = np.maximum(np.abs(along1) - half1_m - (between @ half2_m[..., None])[..., 0], 0.0)
    apart2 = np.maximum(np.abs(along2) - half2_m - (half1_m[:, None] @ between)[:, 0], 0.0)
    far1, far2 = np.vecdot(apart1, apart1), np.vecdot(apart2, apart2)
    first = (far1 > far2)[:, None]
    way = np.where(first, np.copysign(apart1, along1), np.copysign(apart2, along2))
    turn = np.where(first[..., None], turn1, turn2)
    return np.sqrt(np.maximum(far1, far2)), (turn @ way[..., None])[..., 0]
