"""Least squares within position, velocity and acceleration bounds, with all frames known beforehand.

A quadratic program: the weighted least-squares path under box bounds on positions, first and second differences of a
spline's control points, whose costs are those of the frames half way between them. Only the weights couple the joints of an
arm, the bounds do not, so the program is solved joint by joint, each knowing where the others went (block coordinate descent, which
ends at the optimum: Tseng 2001, theorem 4.1). One joint's program is small and dense, for which a dual active-set method
(DAQP: Arnström, Bemporad, Axehill 2022) was the fastest of those measured, see docs/retargeting.md.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

_daqp: Any = importlib.import_module("daqp")  # neither has types
_lapack: Any = importlib.import_module("scipy.linalg.lapack")
Array = NDArray[np.float64]
_SAME_TARGET_RAD = 0.01
"""Radians from its optimum within which a joint's path is not solved again."""
_OPTIMAL = 1
_TIGHTENED = 1e-4
"""Share of a bound kept free: the solver keeps bounds within 1e-6."""
_INWARD_RAD = 4e-6
"""Radians by which position bounds are tightened: far below a tick."""
_LAST_STEP = 0.02
"""Largest last step as a share of what one step of braking takes away: at rest, but with an interior."""


@dataclass(frozen=True)
class Bounds:
    """(G, w) bounds of joints in G groups of w: positions, |first| and |second| differences."""

    low: Array
    high: Array
    step: Array
    bend: Array


@dataclass(frozen=True)
class LeastSquares:
    """The problem of G groups of w joints in T frames: least x' H x / 2 - b' x, and little movement.

    Attributes:
        hessian: (G, T, w, w).
        linear: (G, T, w), b; H times the wanted angles where those alone count.
        pull: weight of squared first differences.
    """

    hessian: Array
    linear: Array
    pull: float


def least_moving(objective: LeastSquares, start: Array) -> Array:
    """(G, T, w) optimum without bounds from `start` (G, w); joints without a cost rest.

    The matrix couples the joints of a group within a frame and each joint with itself a frame later: it is banded.
    """
    G, T, w = objective.linear.shape
    band = np.zeros((G, T, w, w + 1))
    for j in range(w):
        band[:, :, j, : w - j] = objective.hessian[:, :, j:, j]
    band[..., 0] += 2 * objective.pull
    band[:, -1, :, 0] -= objective.pull
    band[:, :-1, :, w] = -objective.pull
    right = objective.linear.copy()
    right[:, 0] += objective.pull * start
    # LAPACK reads the transpose of a lower band, row by row.
    _, x, info = _lapack.dpbsv(band.reshape(-1, w + 1).T, right.reshape(-1, 1), lower=1, overwrite_ab=1, overwrite_b=1)
    if info:
        raise FloatingPointError(f"banded Cholesky: not positive definite at row {info}")
    return np.asarray(x, np.float64).reshape(G, T, w)


def nearer_path(
    objective: LeastSquares,
    path: Array,
    near: Array,
    start: Array,
    start_step: Array,
    bounds: Bounds,
    inside: NDArray[np.bool_],
) -> bool:
    """Move a path in place to the optimum within the bounds, joint by joint; returns whether the solver succeeded.

    The path is a spline's control points, the costs are those of the frames half way between them. There a zigzag of control points
    does not show: half of each step's difference from `near`'s counts like an error of the joint's own in the frame.

    Args:
        objective: costs of the frames.
        path: (G, T, w) control points to start from, changed in place; at the end they come to rest.
        near: (G, T, w) control points near the optimum without bounds.
        start: (G, w) the control point before the first.
        start_step: (G, w) the step that led to it.
        bounds: bounds, the same for all control points.
        inside: (G, w) joints whose path keeps the bounds already; they stay unless their optimum is elsewhere.
    """
    G, T, w = path.shape
    rows, pull = _differences(T)
    upper, lower = _sides(bounds, start, start_step, T)
    inactive = np.zeros(3 * T, np.int32)
    own = np.ascontiguousarray(np.einsum("gtjj->gjt", objective.hessian))  # (G, w, T)
    enough = _SAME_TARGET_RAD * (own + objective.pull)
    # With steps counted like frames, squares of sums and of differences, no two control points are coupled.
    matrix = np.repeat((objective.pull * pull)[None], G * w, 0).reshape(G, w, T, T)
    diagonal = matrix.reshape(G, w, T * T)[..., :: T + 1]
    diagonal += own / 2
    diagonal[..., :-1] += own[..., 1:] / 2
    zigzag = near.transpose(0, 2, 1).copy()
    zigzag[..., 1:] -= near.transpose(0, 2, 1)[..., :-1]
    zigzag[..., 0] -= start
    zigzag *= own / 4
    known = -zigzag
    known[..., :-1] += zigzag[..., 1:]
    known[..., 0] -= objective.pull * start
    frames = frames_between(path, start)
    for j in range(w):
        slope = np.vecdot(objective.hessian[:, :, j], frames) - objective.linear[:, :, j]  # (G, T)
        moves = ~inside[:, j] | (np.abs(slope) > enough[:, j]).any(1)
        if not moves.any():
            continue
        # The slope that the other joints leave in the frames, and for the control points, of which each is half of two frames.
        slope -= own[:, j] * frames[:, :, j]
        slope /= 2
        linear = known[:, j] + slope
        linear[:, :-1] += slope[:, 1:]
        for g in np.flatnonzero(moves):
            found, _, status, _ = _daqp.solve(matrix[g, j], linear[g], rows, upper[g, j], lower[g, j], inactive)
            if status != _OPTIMAL:
                return False
            path[g, :, j] = found
        frames[:, :, j] = frames_between(path[:, :, j, None], start[:, j, None])[..., 0]
    return True


def frames_between(path: Array, start: Array) -> Array:
    """(G, T, w) frames of a spline with control points `path` (G, T, w) after `start` (G, w): half way between two points."""
    frames = path.copy()
    frames[:, 1:] += path[:, :-1]
    frames[:, 0] += start
    frames /= 2
    return frames


@lru_cache(maxsize=128)
def _differences(T: int) -> tuple[Array, Array]:
    """(2 T, T) first and second differences of a path after two frames of 0, and (T, T) first' first."""
    first = np.eye(T) - np.eye(T, k=-1)
    return np.concatenate([first, first @ first]), first.T @ first


def _sides(bounds: Bounds, start: Array, start_step: Array, T: int) -> tuple[Array, Array]:
    """(G, w, 3 T) upper and lower bounds of positions, first and second differences as `_differences` takes them."""
    margin = np.minimum(_INWARD_RAD, 0.01 * (bounds.high - bounds.low))
    step, bend = (1 - _TIGHTENED) * bounds.step, (1 - _TIGHTENED) * bounds.bend
    upper = np.empty((*start.shape, 3 * T))
    lower = np.empty_like(upper)
    upper[..., :T], lower[..., :T] = (bounds.high - margin)[..., None], (bounds.low + margin)[..., None]
    upper[..., T : 2 * T], upper[..., 2 * T :] = step[..., None], bend[..., None]
    upper[..., 2 * T - 1] = np.minimum(step, _LAST_STEP * bend)
    lower[..., T:] = -upper[..., T:]
    # The rows do not contain the two points before the first frame.
    for side in (upper, lower):
        side[..., T] += start
        side[..., 2 * T] += start + start_step
        side[..., 2 * T + 1 : 2 * T + 2] -= start[..., None]
    return upper, lower
