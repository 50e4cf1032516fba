"""Paths near a reference that keep every limit, computed with all known future frames.

A reference that keeps the limits is left alone, bit for bit. For the rest `lookahead_qp` finds the best path inside them, with
the objective linearised at the reference, then at each solution until it settles (Gauss-Newton); where a start breaks a limit,
so that there is no such path, exact causal steps (`limits.limit_step`) lead back first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from retarget.path.limits import JointLimits, keeps, limit_step, within
from retarget.path.lookahead_qp import Bounds, LeastSquares, frames_between, nearer_path

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_WINDOW_FRAMES, _AHEAD_FRAMES = 36, 10
"""Frames of the windows in which a long reference is solved, and frames after each that are taken into account."""
_TAIL_WEIGHT = 1e-3
"""Weight of the frames after the last known one, in which the joints come to rest."""
_PULL = 1e-3
_LINEARISED = 4
"""Largest number of linearisations: where the reference jumps, more than two improve the path."""
SETTLED_RAD = 0.1
"""Radians of the largest movement of a control point above which the objective is linearised again."""


@dataclass(frozen=True)
class QuadraticCost:
    """The cost of a group of joints: angles q in a frame cost q' H q / 2 - b' q.

    Attributes:
        joints: (G, w) indices of the joints of G groups.
        hessian: (G, T, w, w).
        linear: (G, T, w), b.
        fixed: whether the cost is the same wherever it is linearised.
    """

    joints: Indices
    hessian: Array
    linear: Array
    fixed: bool = False


class Objective(Protocol):
    """The objective of T frames, for groups that hold every joint once."""

    def around(self, first: int, q_rad: Array | None) -> Sequence[QuadraticCost]:
        """The costs linearised around frames (n, J) from frame `first` on; None: around the reference from there on."""
        ...


class Angles:
    """The objective of joints that follow given angles (T, J), with equal weights."""

    def __init__(self, q_rad: Array, joints: Sequence[int]) -> None:
        """Take the angles (T, J) of some joints."""
        self._joints = np.array(joints, np.int64)[:, None]
        self._target_rad: Array = q_rad[:, joints].T[..., None]  # (G, T, 1)

    def around(self, first: int, q_rad: Array | None) -> Sequence[QuadraticCost]:
        """The squared distances from the wanted angles, independent of the path `q_rad`."""
        target = self._target_rad[:, first : None if q_rad is None else first + len(q_rad)]
        return (QuadraticCost(self._joints, np.ones((*target.shape, 1)), target, fixed=True),)


def limit_path(
    reference_rad: Array,
    position_rad: Array,
    velocity_rad_s: Array,
    limits: JointLimits,
    period_s: float,
    make_objective: Callable[[], Objective] | None = None,
    settled_rad: float = SETTLED_RAD,
) -> Array:
    """(T, J) path near `reference_rad` (T, J) that keeps every limit, from the given position and velocity.

    Both are control points of splines. `make_objective` gives the objective of the frames half way between them and is called
    only when a limit is passed; None weighs every joint alike. An arm whose last linearisation moved no control point by
    `settled_rad` is not linearised again.
    """
    T, J = reference_rad.shape
    path = within(reference_rad, limits.position_min_rad, limits.position_max_rad)
    follows = kept(path, position_rad, velocity_rad_s, limits, period_s)
    if follows.all():
        return path
    objective = (
        make_objective()
        if make_objective
        else Angles(frames_between(reference_rad[None], position_rad[None])[0], range(J))
    )
    position, velocity = position_rad, velocity_rad_s
    for k in range(0, T, _WINDOW_FRAMES):
        n = min(_WINDOW_FRAMES, T - k)
        part = path[k : k + n + _AHEAD_FRAMES]
        if k or len(part) < T:
            follows = kept(part, position, velocity, limits, period_s)
        if not follows.all():
            near = reference_rad[k : k + n + _AHEAD_FRAMES]
            _solve(objective, k, near, follows, part, position, velocity, limits, period_s, settled_rad)
            part[:n] = within(part[:n], limits.position_min_rad, limits.position_max_rad)
            part[:n] = _follow(part[:n], position, velocity, limits, period_s)
        before = path[k + n - 2] if n > 1 else position
        position, velocity = path[k + n - 1].copy(), (path[k + n - 1] - before) / period_s
        # The frames beyond this window are planned again from its end.
        part[n:] = within(reference_rad[k + n : k + len(part)], limits.position_min_rad, limits.position_max_rad)
    return path


def _solve(
    objective: Objective,
    first: int,
    near: Array,
    kept: NDArray[np.bool_],
    path: Array,
    position: Array,
    velocity: Array,
    limits: JointLimits,
    period_s: float,
    settled_rad: float,
) -> None:
    """Optimise in place a path (n, J) from frame `first` on, for all groups with a joint that is not `kept`."""
    inside, settled = kept.copy(), kept
    for linearised in range(_LINEARISED):
        led = path.copy()
        at = None if not linearised else frames_between(path[None], position[None])[0]
        for group in objective.around(first, at):
            some = np.flatnonzero(~settled[group.joints].all(1))
            if not len(some) or (linearised and group.fixed):
                continue
            joints = group.joints[some]
            bounds = Bounds(
                limits.position_min_rad[joints], limits.position_max_rad[joints],
                (limits.velocity_rad_s * period_s)[joints], (limits.acceleration_rad_s2 * period_s**2)[joints],
            )  # fmt: skip
            tail = int(np.ceil((bounds.step / bounds.bend).max())) + 1
            hessian, linear = group.hessian[some, : len(path)], group.linear[some, : len(path)]
            # After the last frame in view the joints come to rest.
            points, target = path[:, joints].transpose(1, 0, 2), near[:, joints].transpose(1, 0, 2)
            points, target, hessian, linear = (_held(x, tail) for x in (points, target, hessian, linear))
            hessian[:, -tail:] *= _TAIL_WEIGHT
            linear[:, -tail:] *= _TAIL_WEIGHT
            step = (velocity * period_s)[joints]
            problem = LeastSquares(hessian, linear, _PULL)
            if nearer_path(problem, points, target, position[joints], step, bounds, inside[joints]):
                path[:, joints.ravel()] = points[:, : len(path)].transpose(1, 0, 2).reshape(len(path), -1)
                inside[joints] = True
        settled = kept | (np.abs(path - led).max(0) < settled_rad)
        if settled.all():
            break


def _held(x: Array, n: int) -> Array:
    """(G, T + n, ...) values (G, T, ...) with the last one repeated n times."""
    return np.concatenate([x, np.repeat(x[:, -1:], n, 1)], 1)


def kept(path: Array, position: Array, velocity: Array, limits: JointLimits, period_s: float) -> NDArray[np.bool_]:
    """(J,) whether each joint may follow `path` (T, J) from a state as it is."""
    before = np.concatenate([position[None], path])
    speed = (path - before[:-1]) / period_s
    came, ahead = np.concatenate([velocity[None], speed[:-1]]), np.concatenate([speed[1:], speed[-1:]])
    return np.asarray(keeps(path, before[:-1], came, limits, period_s, ahead).all(0), bool)


def _follow(reference: Array, position: Array, velocity: Array, limits: JointLimits, period_s: float) -> Array:
    """Causal following of `reference`, each step knowing the velocity of the reference after it."""
    if kept(reference, position, velocity, limits, period_s).all():
        return reference
    ahead = np.diff(reference, axis=0, append=2 * reference[-1:] - reference[-2:-1]) / period_s
    path = np.empty_like(reference)
    for k in range(len(reference)):
        following = limit_step(reference[k], position, velocity, limits, period_s, ahead[k])
        velocity = (following - position) / period_s
        path[k] = position = following
    return path
