"""Paden-Kahan subproblems (Murray, Li, Sastry 1994, sec. 3.2): angles about axes that bring one direction onto another.

Each is solved for G axes and any number of directions at once.
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
        """Split the vectors into the component along the axis and the two components that turn."""
        along = (axis * v).sum(-1, keepdims=True) * axis
        self.still, self.cosine, self.sine = along, v - along, cross(axis, v)

    def at(self, cosine: Array, sine: Array) -> Array:
        """(G, ..., 3) vectors turned by angles (G, ...), given as cosine and sine."""
        shape = (len(self.still), *[1] * (cosine.ndim - 1), 3)
        turned = cosine[..., None] * self.cosine.reshape(shape) + sine[..., None] * self.sine.reshape(shape)
        return turned + self.still.reshape(shape)


class Reach:
    """Solves the angles at which a turning vector has a given height, its product with a fixed direction."""

    def __init__(self, turn: Turn, onto: Array) -> None:
        """Prepare heights of `turn` along unit directions `onto` (G, 3)."""
        cosine, sine = (turn.cosine * onto).sum(-1), (turn.sine * onto).sum(-1)
        self._still, self._middle = (turn.still * onto).sum(-1), np.arctan2(sine, cosine)
        self._reach = np.maximum(np.hypot(cosine, sine), 1e-9)

    def angles(self, height: Array) -> Array:
        """(G, ..., 2) both angles for heights (G, ...); a height out of reach gives the angle nearest to it."""
        shape = (-1, *[1] * (height.ndim - 1))
        share = (height - self._still.reshape(shape)) / self._reach.reshape(shape)
        spread = np.arccos(np.minimum(np.maximum(share, -1.0), 1.0))
        return self._middle.reshape(shape)[..., None] + spread[..., None] * _SIGNS


def angle_about(axis: Array, a: Array, b: Array, *, first_has_ways: bool = True) -> tuple[Array, NDArray[np.bool_]]:
    """Angles (G, M, ..., W) about unit `axis` (G, 3) that turn `a` nearest to `b`, and where either is parallel to the axis.

    One argument holds W solutions in the axis before its last, the other none: with `first_has_ways` `a` is
    (G, M, ..., W, 3) and `b` (G, M, ..., 3), else the reverse. Undetermined angles are 0.
    """
    many, one = (a, b) if first_has_ways else (b, a)
    shape = (len(axis), *[1] * (one.ndim - 2), 3)
    along = axis.reshape(shape)
    height = (one * along).sum(-1, keepdims=True)
    flat = one - height * along  # its component perpendicular to the axis
    across = cross(flat, along) if first_has_ways else cross(along, flat)
    sine = np.einsum("...wi,...i->...w", many, across)
    cosine = np.einsum("...wi,...i->...w", many, flat)
    lost = np.abs(sine) + np.abs(cosine) < _STRAIGHT**2
    return np.where(lost, 0.0, np.arctan2(sine, cosine)), lost


def frame(a: Array, b: Array) -> Array:
    """(..., 3, 3) rotations with columns `a`, the normal of `a` and `b`, and their cross product; any normal if parallel."""
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
    """(..., 3) vectors scaled to length one; a zero vector stays near zero."""
    return v / np.maximum(np.sqrt(np.vecdot(v, v)), 1e-9)[..., None]
