"""The least direction error that one clip allows a robot: one program over all of its frames, without blocks.

`mmmd bench retarget` compares the path of the retargeter, which is made block by block with 0.4 s in view, with this one.
Limits are the retargeter's own: position, velocity and acceleration of every control point, rest at the start and at the
end, and the margin of every pair of bodies in every frame. Sequential quadratic programming: bone directions and distances
are linearised at the last program's solution, and `banded_program` solves each program. Contacts are kept by a steep
penalty, because a program that has them as bounds may have no solution.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.bench.banded_program import Program, least
from retarget.human.poser import Poses
from retarget.path.paths import JointPath
from retarget.pipeline import Retargeter

_sparse: Any = importlib.import_module("scipy.sparse")  # has no types
Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_ROUNDS = 20
"""Number of linearisations at most."""
_LEAST_GAIN = 1e-4
"""Share of the error by which a round must lower it; after a smaller gain the trust radius is reduced."""
_SETTLE_FRAMES = 16
"""Frames after the last pose in which the joints come to rest, as the retargeter allows."""
_ANGLE_WEIGHT = 1e-6
"""Weight of a squared angle against a squared direction error: enough for joints whose rotation is not visible."""
_NEAR_M = 0.08
"""Metres beyond its margin within which a pair is part of the program."""
_STIFFNESS = 4e4
"""Weight of a squared metre below the margin: a millimetre costs as much as 11 degrees in one frame."""
_TRUST_RAD = (0.4, 0.2, 0.1, 0.05, 0.02)
"""Radians that a control point may move in one round; the next value is used after a round with too little gain."""
_MOST_LACK_M = 1e-3
"""Metres that a pair may lack of its margin in a solution that counts as free of contact."""


@dataclass(frozen=True)
class WholeClip:
    """The best path of a whole clip.

    Attributes:
        errors_deg: (4, T) direction errors, in the order of `retarget.path.report.BONES`.
        control_rad: (N, J) control points of the path that has them.
        cost: half the squared error as the retargeter weighs bones in each frame, and the penalty of contacts; unlike the
            degrees, of which an arm of few joints gives up some to show the hand, this is the quantity that is minimised.
        lack_m: metres that the nearest pair of bodies lacks of its margin in the worst frame, 0 where it lacks none.
    """

    errors_deg: Array
    control_rad: Array
    cost: float
    lack_m: float


def best_of_clip(retargeter: Retargeter, poses: Poses, path: JointPath, *, contact: bool = True) -> WholeClip:
    """The least squared direction error of all paths for `poses` that begin where `path` begins.

    Head and waist follow `path`; the arms are free. The program is not convex: it is solved once starting from `path` and once
    starting from the poses, and the solution of lower cost counts.

    Args:
        retargeter: the robot.
        poses: the poses to be shown.
        path: the retargeter's path for them.
        contact: whether distances are kept; without them the error is a bound that no method can pass.
    """
    program = _Program(retargeter, poses, path, contact=contact)
    found = [program.solve(start) for start in program.starts()]
    return min(found, key=lambda w: (w.lack_m > _MOST_LACK_M, w.cost))


class _Program:
    """The program of one clip, for the arms' control points after the first two."""

    def __init__(self, retargeter: Retargeter, poses: Poses, path: JointPath, *, contact: bool) -> None:
        self._retargeter, self._poses, self._contact = retargeter, poses, contact
        self._T = len(poses.q_rad)
        self._n_points = max(self._T + _SETTLE_FRAMES, len(path.control_rad) - 2)
        control = path.control_rad
        more = self._n_points + 2 - len(control)
        self._control = np.concatenate([control, np.repeat(control[-1:], max(more, 0), 0)])
        self._joints = np.array(sorted({j for arm in retargeter.arms for j in arm.joints}), np.int64)
        limits, period = retargeter.limits, 1 / path.rate_hz
        step = limits.velocity_rad_s[self._joints] * period
        bend = limits.acceleration_rad_s2[self._joints] * period**2
        self._first = self._control[:2, self._joints]
        N, n = self._n_points, len(self._joints)
        first = self._differences
        self._rows = _sparse.vstack([self._each(m) for m in (_sparse.identity(N), first, first @ first)]).tocsr()
        # Control points before the first free one.
        offset = np.zeros((3, N, n))
        offset[1, 0] = -self._first[1]
        offset[2, 0] = self._first[0] - 2 * self._first[1]
        if N > 1:
            offset[2, 1] = self._first[1]
        self._offset = offset.reshape(3 * N * n)
        self._upper = np.concatenate([np.tile(x, N) for x in (limits.position_max_rad[self._joints], step, bend)])
        self._lower = np.concatenate([np.tile(x, N) for x in (limits.position_min_rad[self._joints], -step, -bend)])

    @property
    def _differences(self) -> Any:
        """(N, N) first differences of the free control points."""
        return _sparse.diags([1.0, -1.0], [0, -1], shape=(self._n_points, self._n_points))

    def _each(self, matrix: Any) -> Any:
        """A matrix over control points, applied to each joint."""
        return _sparse.kron(matrix, _sparse.identity(len(self._joints))).tocsr()

    @cached_property
    def _moved(self) -> Any:
        """(N n, N n) matrix of the squared first differences."""
        first = self._each(self._differences)
        return first.T @ first

    def starts(self) -> list[Array]:
        """Control points to start from, (N, n) each: the retargeter's, and those of the poses with the end held."""
        posed = self._poses.q_rad[:, self._joints]
        held = np.concatenate([posed, np.repeat(posed[-1:], self._n_points - len(posed), 0)])
        return [self._control[2:, self._joints], held]

    def solve(self, start: Array) -> WholeClip:
        """Solve in rounds from control points `start` (N, n) until the error stops falling."""
        x = start
        best, cost = x, self._cost(x)
        trust = 0
        kept_inside = self._inside(x)
        for _ in range(_ROUNDS):
            x = self._round(best, _TRUST_RAD[trust] if kept_inside else np.inf)
            found = self._cost(x)
            if kept_inside and found > cost * (1 - _LEAST_GAIN):
                if found < cost:
                    best, cost = x, found
                if trust + 1 == len(_TRUST_RAD):
                    break
                trust += 1
                continue
            best, cost, kept_inside = x, found, True
        control = self._all(best)
        frames = self._frames(control)
        errors_deg = self._retargeter.direction_errors_deg(self._poses, frames)
        return WholeClip(errors_deg, control, cost, float(self._lacks(frames).max(initial=0.0)))

    def _frames(self, control: Array) -> Array:
        """(T, J) poses in the frames, from (N + 2, J) control points."""
        return ((control[1:-1] + control[2:]) / 2)[: self._T]

    def _all(self, x: Array) -> Array:
        """(N + 2, J) control points of all joints, from free ones (N, n)."""
        control = self._control.copy()
        control[2:, self._joints] = x
        return control

    def _lacks(self, frames: Array) -> Array:
        """(T,) metres that the nearest pair lacks of its margin."""
        if not self._contact:
            return np.zeros(0)
        return np.maximum(-self._retargeter.contact.slacks_m(frames, 1.0).min(1, initial=np.inf), 0.0)

    def _inside(self, x: Array) -> bool:
        """Whether (N, n) control points keep every bound."""
        rows = self._rows @ x.ravel() + self._offset
        return bool((rows < self._upper + 1e-7).all() and (rows > self._lower - 1e-7).all())

    def _cost(self, x: Array) -> float:
        """Half the squared error of all directions, and the penalty of all contacts."""
        frames = self._frames(self._all(x))
        rooms = self._retargeter.contact.slacks_m(frames, 1.0) if self._contact else np.zeros((0, 0))
        missed = self._retargeter.missed(self._poses, frames)
        return float((missed**2).sum() / 2 + _STIFFNESS * (np.minimum(rooms, 0.0) ** 2).sum() / 2)

    def _round(self, x: Array, trust_rad: float) -> Array:
        """The optimum of the program linearised at (N, n) control points `x`, no further than `trust_rad` from them."""
        N, n, T = self._n_points, len(self._joints), self._T
        frames = self._frames(self._all(x))
        hessian, fall = self._retargeter.shown(self._poses, frames)
        # A frame lies half way between two control points.
        between = self._each(_sparse.diags([0.5, 0.5], [0, -1], shape=(T, N)))
        seen = _sparse.block_diag(list(hessian[:, self._joints[:, None], self._joints]), format="csr")
        matrix = (between.T @ seen @ between + _ANGLE_WEIGHT * self._moved).tocsc()
        gradient = _ANGLE_WEIGHT * (self._moved @ x.ravel()) - between.T @ fall[:, self._joints].ravel()
        at = self._rows @ x.ravel() + self._offset
        rows, upper, soft = [self._rows, -self._rows], [self._upper - at, at - self._lower], [np.zeros(2 * len(at))]
        if np.isfinite(trust_rad):
            eye = _sparse.identity(N * n, format="csr")
            rows, upper, soft = (
                [*rows, eye, -eye],
                [*upper, np.full(2 * N * n, trust_rad)],
                [*soft, np.zeros(2 * N * n)],
            )
        if self._contact:
            grows, rooms = self._near_pairs(frames)
            if len(rooms):
                rows, upper, soft = (
                    [*rows, -(grows @ between)],
                    [*upper, rooms],
                    [*soft, np.full(len(rooms), 1 / _STIFFNESS)],
                )
        program = Program(matrix, gradient, _sparse.vstack(rows).tocsr(), np.concatenate(upper), np.concatenate(soft))
        return x + least(program, 3 * n).reshape(N, n)

    def _near_pairs(self, frames: Array) -> tuple[Any, Array]:
        """(R, T n) derivatives of the near pairs' distances beyond the margin by the arms' joints, and these distances (R,)."""
        contact, n = self._retargeter.contact, len(self._joints)
        rooms = contact.slacks_m(frames, 1.0)
        data: list[Array] = []
        columns: list[Indices] = []
        room: list[Array] = []
        for pair in np.flatnonzero((rooms < _NEAR_M).any(0)):
            t = np.flatnonzero(rooms[:, pair] < _NEAR_M)
            gap, way = contact.nearest(frames[t], np.array([pair]))
            way = way[:, self._joints]
            moved = (way != 0).any(1)
            data.append(way[moved])
            columns.append(t[moved, None] * n + np.arange(n))
            room.append(gap[moved])
        if not data:
            return None, np.zeros(0)
        values, at, gaps = np.concatenate(data), np.concatenate(columns), np.concatenate(room)
        rows = np.repeat(np.arange(len(gaps)), n)
        return _sparse.csr_matrix((values.ravel(), (rows, at.ravel())), shape=(len(gaps), self._T * n)), gaps
