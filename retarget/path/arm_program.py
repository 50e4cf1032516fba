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
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

_lapack: Any = importlib.import_module("scipy.linalg.lapack")  # has no types
Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_MOST_STEPS = 50
_GAP, _RESIDUAL = 3e-6, 1e-7
"""Mean complementarity and largest violation of a row at which a solution counts as found."""
_START, _START_GAP = 1e-2, 2e-2
"""Least initial value of slacks, and initial product of each slack and its multiplier. Products all alike keep the first steps
long: with equal multipliers instead, 90 programs took 13 steps on average, now 9."""
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

    def of(self, change: Array) -> float:
        """The cost of a change (N, n) of the control points, less that of none."""
        e = change / 2
        e[1:] += change[:-1] / 2
        return float(((self.hessian @ e[..., None])[..., 0] / 2 - self.fall).ravel() @ e.ravel())


@dataclass(frozen=True)
class Rooms:
    """Distances to be kept: each pair may approach by `room_m`, and the room changes with the joints.

    Attributes:
        point: (R,) index of a control point, in rising order.
        grows: (R, 2, n) derivative of the room by each joint of the previous control point and of this one, metres per radian.
        room_m: (R,) metres of room.
        stiffness: weight of half the squared metres of missing room.
    """

    point: Indices
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
        differences = _differences_of(N)[0]
        at = (differences @ points).reshape(3, N, n)
        at[1, 0] -= self._before[1]
        at[2, 0] += self._before[0] - 2 * self._before[1]
        at[2, 1:2] += self._before[1]
        upper, lower = self._upper - at, at - self._lower
        np.minimum(upper[0], most_rad, out=upper[0])
        np.minimum(lower[0], most_rad, out=lower[0])
        weights = np.zeros((3, N, n))
        weights[1], weights[2] = steady.step, steady.bend
        gradient = differences.T @ (weights * at).reshape(3 * N, n) - _halves_summed(frames.fall)
        return _Solver(frames.hessian, weights, gradient, (upper, lower), rooms).solve()


class _Solver:
    """One run of the method. Rows are upper bounds, lower bounds, and M rows of rooms for each control point."""

    def __init__(
        self, hessian: Array, weights: Array, gradient: Array, boxes: tuple[Array, Array], rooms: Rooms
    ) -> None:
        self._gradient = gradient
        self._shape, self._n_boxes = gradient.shape, 3 * gradient.size
        N, n = self._shape
        self._differences, self._squares = _differences_of(N)
        self._lower_triangle = _lower_triangle(n)
        self._take_rooms(boxes, rooms)
        # Element (row, column) of a block has its place in the band at 2 n column + row from the block's first element.
        self._band: Array = np.zeros((N, n, 2 * n + 1))
        strides = 8 * n * (2 * n + 1), 16 * n, 8
        self._own = as_strided(self._band, (N, n, n), strides)
        self._before = as_strided(self._band.reshape(-1)[n:], (N - 1, n, n), strides)
        self._band[:, :, ::n] = self._squared(weights)
        quarter = hessian / 4
        own = quarter.copy()
        own[:-1] += quarter[1:]
        self._add_blocks(own, quarter[1:])
        self._fixed = self._band.copy()
        # A change of the control points (N, n) after a row of 0, and the same with each point after the previous one.
        self._padded = np.zeros(N * n + n)
        self._pairs = as_strided(self._padded, (N, 2 * n, 1), (n * 8, 8, 8), writeable=False)

    def solve(self) -> Array | None:
        b, soft = self._bound, self._soft
        both, change = np.empty((2, len(b))), np.empty((2, len(b)))
        (s, z), (ds, dz) = both, change
        np.maximum(b, _START, out=s)
        np.divide(_START_GAP, s, out=z)
        x: Array = np.zeros(self._shape)
        dual, primal = self._gradient + self._back(z), s - b - soft * z
        worst_dual = float(np.abs(dual).max()) / (1 + float(np.abs(self._gradient).max()))
        worst_primal, left = float(np.abs(primal).max()), 1.0
        for _ in range(_MOST_STEPS):
            gap = float(s @ z) / len(b)
            if gap < _GAP and left * worst_primal < _RESIDUAL and left * worst_dual < _GAP:
                return x
            weight = z / (s + soft * z)
            factor, info = _lapack.dpbtrf(self._normal(weight).T, lower=1, overwrite_ab=1)
            if info:
                return None
            # Changes that bring s z to 0, then to a share of the gap, and the residuals to 0, to first order.
            dz[:] = self._step(left * primal - s, left * dual, weight, factor)[1]
            np.multiply(s, -1 - dz / z, out=ds)
            length, product = _longest(both, change), ds * dz
            centring = (1 - length + length * length * float(product.sum()) / (len(b) * gap)) ** 3
            aim = (centring * gap - product) / z
            dx, dz[:] = self._step(left * primal - s + aim, left * dual, weight, factor)
            np.subtract(aim - s, s * dz / z, out=ds)
            length = _TO_BORDER * _longest(both, change)
            x, left = x + length * dx, (1 - length) * left  # residuals are linear
            both += length * change
        return None

    def _step(self, lacks: Array, dual: Array, weight: Array, factor: Array) -> tuple[Array, Array]:
        """Changes of x and z."""
        right = -(dual + self._back(weight * lacks))
        dx: Array = _lapack.dpbtrs(factor, right.reshape(-1, 1), lower=1, overwrite_b=1)[0].reshape(self._shape)
        return dx, weight * (self._along(dx) + lacks)

    def _take_rooms(self, boxes: tuple[Array, Array], rooms: Rooms) -> None:
        """Lay out the rows of rooms by control point, padded to M each: (N, M, 2 n) for the previous point and the point."""
        N, n = self._shape
        first: Indices = np.asarray(np.searchsorted(rooms.point, np.arange(N, dtype=np.int64)), np.int64)
        place: Indices = np.arange(len(rooms.point), dtype=np.int64) - first[rooms.point]
        M = int(place.max(initial=-1)) + 1
        place += rooms.point * M
        grows, room_m = np.zeros((N * M, 2, n)), np.ones(N * M)
        grows[place], room_m[place] = rooms.grows, rooms.room_m
        self._grows = grows.reshape(N, M, 2 * n)
        self._grows_turned = self._grows.transpose(0, 2, 1)
        self._bound = np.concatenate([*(side.ravel() for side in boxes), room_m])
        self._soft = np.zeros(len(self._bound))
        self._soft[2 * self._n_boxes :] = 1 / rooms.stiffness

    def _along(self, x: Array) -> Array:
        """Product of the constraint matrix and `x`: differences, negated differences, and loss of room."""
        m = self._n_boxes
        every = np.empty(len(self._bound))
        every[:m] = (self._differences @ x).ravel()
        np.negative(every[:m], out=every[m : 2 * m])
        self._padded[x.shape[1] :] = x.ravel()
        np.negative((self._grows @ self._pairs).ravel(), out=every[2 * m :])
        return every

    def _back(self, y: Array) -> Array:
        """Product of the transposed constraint matrix and `y`."""
        m, (N, n) = self._n_boxes, self._shape
        x = self._differences.T @ (y[:m] - y[m : 2 * m]).reshape(3 * N, n)
        moved = (self._grows_turned @ y[2 * m :].reshape(N, -1, 1))[..., 0]
        x -= moved[:, n:]
        x[:-1] -= moved[1:, :n]
        return x

    def _normal(self, weight: Array) -> Array:
        """(N n, 2 n + 1) lower band of the normal matrix, row by row."""
        m, (N, n) = self._n_boxes, self._shape
        self._band[:] = self._fixed
        self._band[:, :, ::n] += self._squared((weight[:m] + weight[m : 2 * m]).reshape(3, N, n))
        each = (self._grows_turned * weight[2 * m :].reshape(N, 1, -1)) @ self._grows
        own = each[:, n:, n:]
        own[:-1] += each[1:, :n, :n]
        self._add_blocks(own, each[1:, n:, :n])
        return self._band.reshape(-1, 2 * n + 1)

    def _squared(self, weights: Array) -> Array:
        """(N, n, 3) the band's columns 0, n and 2 n of weights (3, N, n) of squared differences."""
        N, n = self._shape
        return (self._squares @ weights.reshape(3 * N, n)).reshape(3, N, n).transpose(1, 2, 0)

    def _add_blocks(self, own: Array, before: Array) -> None:
        """Add to the band the blocks of control points with themselves, (N, n, n), and with the one before, (N - 1, n, n)."""
        self._own += own.transpose(0, 2, 1) * self._lower_triangle
        self._before += before.transpose(0, 2, 1)


def _halves_summed(frames: Array) -> Array:
    """(N, n) gradients of control points from gradients of frames (N, n), which lie half way between control points."""
    every = frames / 2
    every[:-1] += frames[1:] / 2
    return every


def _longest(values: Array, change: Array) -> float:
    """Largest share, at most 1, of a change that leaves every value positive."""
    return 1.0 / max(1.0, -float((change / values).min()))


@lru_cache(maxsize=128)
def _differences_of(N: int) -> tuple[Array, Array]:
    """(3 N, N) points, first and second differences of N points after two that are 0; (3 N, 3 N) their squares' band.

    The second maps weights of squared differences to the matrix's diagonal and its first and second secondary diagonals, each
    with zeros at its end.
    """
    first = np.eye(N) - np.eye(N, k=-1)
    every = np.concatenate([np.eye(N), first, first @ first])
    band = np.zeros((3, N, 3 * N))
    for k in range(min(3, N)):
        band[k, : N - k] = (every[:, : N - k] * every[:, k:]).T
    return every, band.reshape(3 * N, 3 * N)


@lru_cache(maxsize=16)
def _lower_triangle(n: int) -> Array:
    """(n, n) 1 where the second index is not less than the first."""
    return np.triu(np.ones((n, n)))
