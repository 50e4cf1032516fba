"""The best change of all arms' control points at once, where distances couple the joints.

A quadratic program in a change d (N, n) of N control points of n joints: the linearised costs of the frames half way between
control points, little movement and bend, under boxes on positions, first and second differences, and with soft rows that keep
distances. A primal-dual interior-point method solves it (Mehrotra's predictor and corrector; Nocedal, Wright 2006, algorithm
16.4); each step factorises one banded matrix, since no row couples points more than two apart.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

_lapack: Any = importlib.import_module("scipy.linalg.lapack")  # has no types
Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_MOST_STEPS = 25
_GAP, _RESIDUAL = 3e-6, 1e-7
"""Mean complementarity and largest violation of a row at which a solution counts as found."""
_START = 1e-2
"""Least initial value of slacks and multipliers."""
_TO_BORDER = 0.99
"""Largest share of the distance to the nearest bound that a step covers."""


@dataclass(frozen=True)
class Frames:
    """The cost of a change of frames, half way between control points: e' H e / 2 - f' e.

    Attributes:
        hessian: (N, n, n) H.
        fall: (N, n) f, the negative gradient of the cost.
    """

    hessian: Array
    fall: Array


@dataclass(frozen=True)
class Rooms:
    """Distances to be kept: each pair may approach by `room_m`, and the room changes with the joints.

    Attributes:
        point: (R,) index of a control point, in rising order.
        share: (R, 2) weights of the previous control point and of this one in the pose: 1/2 and 1/2 in a frame.
        grows: (R, n) derivative of the room by each joint, metres per radian.
        room_m: (R,) metres of room.
        stiffness: weight of half the squared metres of missing room.
    """

    point: Indices
    share: Array
    grows: Array
    room_m: Array
    stiffness: float


@dataclass(frozen=True)
class Steady:
    """Weights of squared first and second differences."""

    step: float
    bend: float


class ArmProgram:
    """The program of control points after two known ones.

    Args:
        upper: (3, N, n) upper bounds of positions, first and second differences.
        lower: (3, N, n) lower bounds.
        before: (2, n) the two control points before the first.
    """

    def __init__(self, upper: Array, lower: Array, before: Array) -> None:
        self._upper, self._lower, self._before = upper, lower, before

    def change(self, points: Array, frames: Frames, rooms: Rooms, steady: Steady, most_rad: float) -> Array | None:
        """(N, n) best change of `points` (N, n), no element larger than `most_rad`; None if the solver found no solution."""
        N, n = points.shape
        at = _differences(points)
        at[1, 0] -= self._before[1]
        at[2, 0] += self._before[0] - 2 * self._before[1]
        at[2, 1:2] += self._before[1]
        upper, lower = self._upper - at, at - self._lower
        np.minimum(upper[0], most_rad, out=upper[0])
        np.minimum(lower[0], most_rad, out=lower[0])
        weights = np.zeros((3, N, n))
        weights[1], weights[2] = steady.step, steady.bend
        gradient = _summed(weights * at) - _halves_summed(frames.fall)
        bound = np.concatenate([upper.ravel(), lower.ravel(), rooms.room_m])
        soft = np.zeros(len(bound))
        soft[2 * upper.size :] = 1 / rooms.stiffness
        return _Solver(frames.hessian, weights, gradient, bound, soft, rooms).solve()


class _Solver:
    """One run of the method."""

    def __init__(
        self, hessian: Array, weights: Array, gradient: Array, bound: Array, soft: Array, rooms: Rooms
    ) -> None:
        self._gradient = gradient
        self._bound, self._soft, self._rooms = bound, soft, rooms
        self._shape, self._n_boxes = gradient.shape, 3 * gradient.size
        self._take_rooms()
        self._fixed = _banded_boxes(weights)
        quarter = hessian / 4
        own = quarter.copy()
        own[:-1] += quarter[1:]
        _add_blocks(self._fixed, own, quarter)

    def solve(self) -> Array | None:
        b, soft = self._bound, self._soft
        x: Array = np.zeros(self._shape)
        s: Array = np.maximum(b, _START)
        z: Array = np.full(len(b), _START)
        scale = 1 + float(np.abs(self._gradient).max())
        dual = self._gradient + self._back(z)
        primal = s - b - soft * z
        for _ in range(_MOST_STEPS):
            gap = float(s @ z) / len(b)
            if gap < _GAP and np.abs(primal).max() < _RESIDUAL and np.abs(dual).max() < _GAP * scale:
                return x
            weight = 1 / (s / z + soft)
            factor, info = _lapack.dpbtrf(self._normal(weight).T, lower=1, overwrite_ab=1)
            if info:
                return None
            ds, dz = self._step(0.0, s, z, dual, primal, weight, factor)[1:]
            length = min(_longest(s, ds), _longest(z, dz))
            centring = (float((s + length * ds) @ (z + length * dz)) / len(b) / gap) ** 3
            dx, ds, dz = self._step(centring * gap - ds * dz, s, z, dual, primal, weight, factor)
            length = _TO_BORDER * min(_longest(s, ds), _longest(z, dz))
            x, s, z = x + length * dx, s + length * ds, z + length * dz
            # Residuals are linear: a step of this length leaves the share 1 - length of each.
            dual, primal = (1 - length) * dual, (1 - length) * primal
        return None

    def _step(
        self, aim: Array | float, s: Array, z: Array, dual: Array, primal: Array, weight: Array, factor: Array
    ) -> tuple[Array, Array, Array]:
        """Changes of x, s, z that bring s z to `aim` and the residuals to 0, to first order."""
        left = primal - s + aim / z
        right = -(dual + self._back(weight * left))
        dx: Array = _lapack.dpbtrs(factor, right.ravel(), lower=1)[0].reshape(self._shape)
        dz: Array = weight * (self._along(dx) + left)
        return dx, (aim - s * dz) / z - s, dz

    def _take_rooms(self) -> None:
        """Lay out the rows of rooms by control point, padded to M each, (N, M, 2 n): previous point, then the point."""
        rooms, (N, n) = self._rooms, self._shape
        first: Indices = np.asarray(np.searchsorted(rooms.point, np.arange(N, dtype=np.int64)), np.int64)
        place: Indices = np.arange(len(rooms.point), dtype=np.int64) - first[rooms.point]
        self._wide = int(place.max(initial=-1)) + 1
        self._place: Indices = rooms.point * self._wide + place
        grows = np.zeros((N * self._wide, 2, n))
        grows[self._place] = rooms.share[:, :, None] * rooms.grows[:, None]
        self._grows = grows.reshape(N, self._wide, 2 * n)

    def _spread(self, y: Array) -> Array:
        """(N, M) values `y` of the rows of rooms (R,), laid out like the rows, padded with 0."""
        N = self._shape[0]
        every = np.zeros(N * self._wide)
        every[self._place] = y
        return every.reshape(N, self._wide)

    def _along(self, x: Array) -> Array:
        """Product of the constraint matrix and `x`: differences, negated differences, and loss of room."""
        boxes = _differences(x).ravel()
        if not self._wide:
            return np.concatenate([boxes, -boxes])
        both = np.zeros((len(x), 2, x.shape[1]))
        both[1:, 0], both[:, 1] = x[:-1], x
        room = (self._grows @ both.reshape(len(x), -1, 1)).ravel()[self._place]
        return np.concatenate([boxes, -boxes, -room])

    def _back(self, y: Array) -> Array:
        """Product of the transposed constraint matrix and `y`."""
        m = self._n_boxes
        x = _summed((y[:m] - y[m : 2 * m]).reshape(3, *self._shape))
        if self._wide:
            n = self._shape[1]
            moved = (self._spread(y[2 * m :])[:, None] @ self._grows)[:, 0]
            x -= moved[:, n:]
            x[:-1] -= moved[1:, :n]
        return x

    def _normal(self, weight: Array) -> Array:
        """(N n, 2 n + 1) lower band of the normal matrix, row by row."""
        m = self._n_boxes
        boxes = (weight[:m] + weight[m : 2 * m]).reshape(3, *self._shape)
        band = self._fixed + _banded_boxes(boxes)
        if self._wide:
            n = self._shape[1]
            each = np.swapaxes(self._grows * self._spread(weight[2 * m :])[..., None], 1, 2) @ self._grows
            own = each[:, n:, n:]
            own[:-1] += each[1:, :n, :n]
            _add_blocks(band, own, each[:, n:, :n])
        return band.reshape(-1, band.shape[-1])


def _differences(x: Array) -> Array:
    """(3, N, n) control points (N, n), their first and second differences, after two that are 0."""
    every = np.empty((3, *x.shape))
    every[0] = every[1] = x
    every[1, 1:] -= x[:-1]
    every[2] = every[1]
    every[2, 1:] -= every[1, :-1]
    return every


def _summed(y: Array) -> Array:
    """(N, n) the transpose of `_differences`."""
    steps = y[2].copy()
    steps[:-1] -= y[2, 1:]
    steps += y[1]
    every = y[0] + steps
    every[:-1] -= steps[1:]
    return every


def _halves_summed(frames: Array) -> Array:
    """(N, n) gradients of control points from gradients of frames (N, n), which lie half way between control points."""
    every = frames / 2
    every[:-1] += frames[1:] / 2
    return every


def _add_blocks(band: Array, own: Array, before: Array) -> None:
    """Add to a lower band (N, n, 2 n + 1) the blocks (N, n, n) of control points with themselves and with the previous one."""
    n = own.shape[-1]
    column, row, across, along = _places(n)
    band[:, column, row - column] += own[:, row, column]
    band[:-1, along, n + across - along] += before[1:, across, along]


def _banded_boxes(weights: Array) -> Array:
    """(N, n, 2 n + 1) lower band, row by row, of weights of squared differences (3, N, n)."""
    _, N, n = weights.shape
    band = np.zeros((N, n, 2 * n + 1))
    own, first, second = weights
    band[..., 0] = own + first + second
    band[:-1, :, 0] += first[1:] + 4 * second[1:]
    band[:-2, :, 0] += second[2:]
    band[:-1, :, n] = -first[1:] - 2 * second[1:]
    band[:-2, :, n] -= 2 * second[2:]
    band[:-2, :, 2 * n] = second[2:]
    return band


@lru_cache(maxsize=16)
def _places(n: int) -> tuple[Indices, Indices, Indices, Indices]:
    """Columns and rows of the lower triangle of (n, n), and rows and columns of the whole."""
    row, column = np.tril_indices(n)
    across, along = (x.ravel() for x in np.indices((n, n)))
    return column, row, across, along


def _longest(v: Array, change: Array) -> float:
    """Largest share, at most 1, of a change that leaves every element of `v` positive."""
    return 1.0 / max(1.0, float((-change / v).max()))
