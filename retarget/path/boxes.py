"""Distances from boxes to capsules and to boxes, many at once.

The distance of a point to a box is convex along a line: the nearest point of a capsule's axis is found by halving.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_HALVINGS = 8


def capsule_to_box(offset: Array, axis: Array, half_m: Array, box_half_m: Array) -> Array:
    """(n,) distance of n capsules' axes to boxes, at most `half_m` / 256 less than it is; 0 or less where one goes through.

    Args:
        offset: (n, 3) centre of the capsule in the box's own axes.
        axis: (n, 3) unit axis of the capsule there.
        half_m: (n,) its half length; 0 for a sphere.
        box_half_m: (n, 3) half edges of the box.
    """
    at, reach = np.zeros(len(offset)), half_m
    point = offset
    for _ in range(_HALVINGS if half_m.any() else 0):
        beyond = point - np.minimum(np.maximum(point, -box_half_m), box_half_m)
        reach = reach / 2
        at = at - np.sign(np.einsum("ni,ni->n", beyond, axis)) * reach
        point = offset + at[:, None] * axis
    beyond = point - np.minimum(np.maximum(point, -box_half_m), box_half_m)
    return np.sqrt(np.einsum("ni,ni->n", beyond, beyond)) - reach


def box_to_box(offset: Array, turn1: Array, half1_m: Array, turn2: Array, half2_m: Array) -> Array:
    """(n,) not more than the distance of n pairs of boxes: that of either to the other's bounds along its own axes.

    Args:
        offset: (n, 3) centre of the second less centre of the first.
        turn1: (n, 3, 3) rotations; columns are the axes of the first box.
        half1_m: (n, 3) its half edges.
        turn2: (n, 3, 3) of the second.
        half2_m: (n, 3).
    """
    between = np.abs(turn1.transpose(0, 2, 1) @ turn2)
    apart1 = np.abs(offset[:, None] @ turn1)[:, 0] - half1_m - (between @ half2_m[..., None])[..., 0]
    apart2 = np.abs(offset[:, None] @ turn2)[:, 0] - half2_m - (half1_m[:, None] @ between)[:, 0]
    apart = np.maximum(np.stack([apart1, apart2]), 0.0)
    return np.sqrt(np.einsum("sni,sni->sn", apart, apart).max(0))
