"""Parts of closed-form arms: turns about axes, and the angles that bring one direction onto another.

The subproblems of Paden and Kahan (Murray, Li, Sastry 1994, sec. 3.2), for G axes and any number of directions at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.robot.kinematics import cross

Array = NDArray[np.float64]
_STRAIGHT = 1e-6
"""Sine below which two directions count as parallel."""
_SIGNS = np.array([-1.0, 1.0])


class Turn:
    """Vectors `v` (G, 3) turned about unit axes (G, 3)."""

    def __init__(self, axis: Array, v: Array) -> None:
        """Split what stays from what turns."""
        along = (axis * v).sum(-1, keepdims=True) * axis
        self.still, self.cosine, self.sine = along, v - along, cross(axis, v)

    def at(self, cosine: Array, sine: Array) -> Array:
        """(G, ..., 3) the vectors turned by angles (G, ...) of which cosine and sine are given."""
        shape = (len(self.still), *[1] * (cosine.ndim - 1), 3)
        turned = cosine[..., None] * self.cosine.reshape(shape) + sine[..., None] * self.sine.reshape(shape)
        return turned + self.still.reshape(shape)


class Reach:
    """Which turns bring a vector to a given height along another."""

    def __init__(self, turn: Turn, onto: Array) -> None:
        """`onto`: unit directions (G, 3) that the height is measured along."""
        cosine, sine = (turn.cosine * onto).sum(-1), (turn.sine * onto).sum(-1)
        self._still, self._middle = (turn.still * onto).sum(-1), np.arctan2(sine, cosine)
        self._reach = np.maximum(np.hypot(cosine, sine), 1e-9)

    def angles(self, height: Array) -> Array:
        """(G, ..., 2) both angles for heights (G, ...); as near as can be where none reaches."""
        shape = (-1, *[1] * (height.ndim - 1))
        share = (height - self._still.reshape(shape)) / self._reach.reshape(shape)
        spread = np.arccos(np.minimum(np.maximum(share, -1.0), 1.0))
        return self._middle.reshape(shape)[..., None] + spread[..., None] * _SIGNS


def angle_about(axis: Array, a: Array, b: Array, *, first_has_ways: bool = True) -> tuple[Array, NDArray[np.bool_]]:
    """Angles (G, M, ..., W) about unit `axis` (G, 3) that turn `a` nearest to `b`, and where either lies along it.

    One of the two has W ways more than the other, in the axis before the last: `a` (G, M, ..., W, 3) and `b`
    (G, M, ..., 3), or the other way round. Angles are 0 where they are not determined.
    """
    many, one = (a, b) if first_has_ways else (b, a)
    shape = (len(axis), *[1] * (one.ndim - 2), 3)
    along = axis.reshape(shape)
    height = (one * along).sum(-1, keepdims=True)
    flat = one - height * along  # what of it is across the axis
    across = cross(flat, along) if first_has_ways else cross(along, flat)
    sine = np.einsum("...wi,...i->...w", many, across)
    cosine = np.einsum("...wi,...i->...w", many, flat)
    lost = np.abs(sine) + np.abs(cosine) < _STRAIGHT**2
    return np.where(lost, 0.0, np.arctan2(sine, cosine)), lost


def frame(a: Array, b: Array) -> Array:
    """(..., 3, 3) rotations whose columns are `a`, what is across both, and what is across that; any such when parallel."""
    across = cross(a, b)
    length = np.sqrt(np.einsum("...i,...i", across, across))[..., None]
    straight = length < _STRAIGHT
    if straight.any():
        across = np.where(straight, cross(a, np.eye(3)[np.abs(a).argmin(-1)]), across)
        length = np.linalg.norm(across, axis=-1, keepdims=True)
    across = across / length
    frame = np.empty((*a.shape, 3))
    frame[..., 0], frame[..., 1], frame[..., 2] = a, across, cross(a, across)
    return frame


def unit(v: Array) -> Array:
    """(..., 3) at length one; what has no length stays near zero."""
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)
