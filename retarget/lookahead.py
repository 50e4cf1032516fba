"""Following a wish within position, velocity and acceleration bounds, knowing all of it beforehand.

A quadratic program: the weighted least-squares path under box bounds on positions, first and second differences. Its
matrix couples the joints of a group (an arm) within a frame and each joint over three frames, so it is banded, and a
primal-dual interior-point method (Mehrotra 1992; Nocedal, Wright 2006, sec. 16.6) solves it in a handful of banded
Cholesky factorisations. The path found lies strictly inside every bound.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_lapack: Any = importlib.import_module("scipy.linalg.lapack")  # it has no types
Array = NDArray[np.float64]
_ITERATIONS = 30
_GAP = 1e-6
"""Mean complementarity at which the path is as near as a hundredth of a tick."""
_RESIDUAL = 1e-11
_TO_BOUNDARY = 0.995
_TIGHTENED = 1e-4
"""Share of a bound kept free, so that rounding of sums never carries a step over it."""
_INWARD_RAD = 1e-9
"""The same for positions: far below a tick."""
_LAST_STEP = 0.02
"""The last step may be so much of what one step of braking takes away: at rest, but with an inside."""


@dataclass(frozen=True)
class Bounds:
    """(G, 1, w) bounds of joints in G groups of w: positions, |first| and |second| differences."""

    low: Array
    high: Array
    step: Array
    bend: Array


@dataclass(frozen=True)
class Wish:
    """What is wanted of G groups of w joints in T frames: least x' H x / 2 - b' x, and few movements.

    Attributes:
        hessian: (G, T, w, w).
        linear: (G, T, w), b; H times the wanted angles where those alone count.
        pull: weight of squared first differences.
    """

    hessian: Array
    linear: Array
    pull: float


def least_moving(wish: Wish, start: Array) -> Array:
    """(G, T, w) path of a wish without bounds from `start` (G, w): where the wish says nothing, joints rest."""
    weights = np.zeros((3, *wish.linear.shape))
    weights[1] = wish.pull
    band = _band(wish.hessian, weights)
    right = wish.linear.copy()
    right[:, 0] += wish.pull * start
    return _Factor(band).solve(right)


def inside(path: Array, start: Array, start_step: Array, bounds: Bounds, slack: float = 1e-9) -> NDArray[np.bool_]:
    """(G, w) whether a joint of `path` (G, T, w) from a start (G, w) keeps its bounds."""
    y = _differences(path, start, start_step)
    kept = (y[0] >= bounds.low - slack) & (y[0] <= bounds.high + slack)
    kept &= (np.abs(y[1]) <= bounds.step * (1 + slack)) & (np.abs(y[2]) <= bounds.bend * (1 + slack))
    return np.asarray(kept.all(1), bool)


def nearest_path(wish: Wish, first: Array, start: Array, start_step: Array, bounds: Bounds) -> Array | None:
    """(G, T, w) best path of a wish that keeps the bounds and comes to rest at its end; None when there is none.

    Args:
        wish: what is wanted.
        first: (G, T, w) a path from which to look, which need not keep anything.
        start: (G, w) where the joints are.
        start_step: (G, w) their last step.
        bounds: bounds, the same in all frames.
    """
    shape = first.shape
    bound = np.empty((2, 3, *shape))
    margin = np.minimum(_INWARD_RAD, 0.01 * (bounds.high - bounds.low))
    bound[0, 0], bound[1, 0] = bounds.low + margin, bounds.high - margin
    bound[1, 1], bound[1, 2] = (1 - _TIGHTENED) * bounds.step, (1 - _TIGHTENED) * bounds.bend
    bound[1, 1, :, -1] = np.minimum(bound[1, 1, :, -1], _LAST_STEP * bounds.bend[:, 0])
    bound[0, 1:] = -bound[1, 1:]
    sign = np.array([1.0, -1.0]).reshape(2, 1, 1, 1, 1)
    bound *= sign  # both sides now read sign * y >= bound
    constant = _differences(np.zeros(shape), start, start_step)

    x = first.copy()
    y = _differences(x, start, start_step)
    room = bound[::-1].sum(0)  # minus the width
    slack = np.maximum(sign * y - bound, 0.05 * -room)
    dual = 0.02 / slack * np.maximum(-room, 1e-9)
    pull = np.zeros((3, 1, 1, 1))
    pull[1] = wish.pull
    n = slack.size
    for _ in range(_ITERATIONS):
        y = _differences(x, start, start_step)
        primal = sign * y - bound - slack
        gap = float((slack * dual).sum()) / n
        if gap < _GAP and float(np.abs(primal).max()) < _RESIDUAL:
            return x
        force = dual[0] - dual[1]
        gradient = (wish.hessian @ x[..., None])[..., 0] - wish.linear
        dual_residual = gradient + _transposed(pull * y - force)
        ratio = dual / slack
        factor = _Factor(_band(wish.hessian, ratio[0] + ratio[1] + pull))
        # Predictor: straight to the optimum.
        pushed = -dual - ratio * primal
        dx = factor.solve(-dual_residual + _transposed(pushed[0] - pushed[1]))
        ds = sign * (_differences(dx, 0.0, 0.0)) + primal
        dz = -dual - ratio * ds
        primal_step, dual_step = _step(slack, ds), _step(dual, dz)
        aimed = float(((slack + primal_step * ds) * (dual + dual_step * dz)).sum()) / n
        centre = (aimed / gap) ** 3 * gap
        # Corrector: bent towards the central path.
        pushed = (centre - ds * dz) / slack - dual - ratio * primal
        dx = factor.solve(-dual_residual + _transposed(pushed[0] - pushed[1]))
        ds = sign * (_differences(dx, 0.0, 0.0)) + primal
        dz = pushed + ratio * primal - ratio * ds
        primal_step, dual_step = _TO_BOUNDARY * _step(slack, ds), _TO_BOUNDARY * _step(dual, dz)
        primal_step, dual_step = min(1.0, primal_step), min(1.0, dual_step)
        x = x + primal_step * dx
        slack = slack + primal_step * ds
        dual = dual + dual_step * dz
    return None


def _step(value: Array, change: Array) -> float:
    """Largest step, at most 1 / 0.995, along `change` that keeps `value` positive."""
    return 1.0 / max(_TO_BOUNDARY, float((-change / value).max()))


def _differences(x: Array, start: Array | float, start_step: Array | float) -> Array:
    """(3, G, T, w) positions, first and second differences."""
    y = np.empty((3, *x.shape))
    y[0] = x
    np.subtract(x[:, 1:], x[:, :-1], out=y[1, :, 1:])
    np.subtract(x[:, 0], start, out=y[1, :, 0])
    np.subtract(y[1, :, 1:], y[1, :, :-1], out=y[2, :, 1:])
    np.subtract(y[1, :, 0], start_step, out=y[2, :, 0])
    return y


def _transposed(y: Array) -> Array:
    """(G, T, w) what forces on positions, first and second differences come to."""
    first = y[1] + y[2]
    first[:, :-1] -= y[2, :, 1:]
    x = y[0] + first
    x[:, :-1] -= first[:, 1:]
    return x


def _band(hessian: Array, weights: Array) -> Array:
    """(G T w, 2 w + 1) lower band of H + C' W C, row by row of the transpose that LAPACK reads."""
    G, T, w = weights.shape[1:]
    band = np.zeros((G, T, w, 2 * w + 1))
    w0, w1, w2 = weights
    along = w0 + w1 + w2
    along[:, :-1] += w1[:, 1:] + 4 * w2[:, 1:]
    along[:, :-2] += w2[:, 2:]
    beside = -w1[:, 1:] - 2 * w2[:, 1:]
    beside[:, :-1] -= 2 * w2[:, 2:]
    band[:, :-1, :, w] = beside
    band[:, :-2, :, 2 * w] = w2[:, 2:]
    for j in range(w):
        band[:, :, j, : w - j] = hessian[:, :, j:, j]
    band[..., 0] += along
    return band.reshape(G * T * w, 2 * w + 1)


class _Factor:
    """Cholesky factor of a banded matrix."""

    def __init__(self, band: Array) -> None:
        self._band, info = _lapack.dpbtrf(band.T, lower=1, overwrite_ab=1)
        if info:
            raise FloatingPointError(f"banded Cholesky: not positive definite at row {info}")

    def solve(self, right: Array) -> Array:
        solved, _ = _lapack.dpbtrs(self._band, right.reshape(-1, 1), lower=1)
        return solved.reshape(right.shape)
