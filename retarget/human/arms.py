"""Arms in closed form: joint angles from the directions of upper arm and forearm.

Families by the joints from chest to elbow, with any axes, signs, order and zero pose (`arm_chain`):

- three shoulder axes and an elbow (arms of 4 to 7 joints): the angle between the bones gives the elbow, two ways; the
  shoulder's rotation then follows from both directions and splits into its three angles, two ways (Paden-Kahan
  subproblems; Murray, Li, Sastry 1994, sec. 3.2). Any pair of directions is reached, in up to four ways.
- two shoulder axes and an elbow (3 joints), one and an elbow, or two without an elbow (2 joints): most pairs cannot be
  reached. From several closed-form starts Gauss-Newton steps within the limits find the least weighted error.

Where an axis misses the shoulder, the directions follow the true points and a few damped steps take up what the closed
form left. Arms of one kind are solved together: G arms, M poses.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from retarget.human.arm_chain import ArmChain
from retarget.human.arm_kinematics import ArmKinematics
from retarget.human.bones import poses_last, weighted
from retarget.human.branches import UNSEEN, fill_unseen
from retarget.human.subproblems import Reach, Turn, angle_about, frame, unit
from retarget.path.limits import within
from retarget.robot.kinematics import cross, skew

Array = NDArray[np.float64]
_LEAST_ERROR_STEPS, _CUT_STEPS, _OFFSET_STEPS = 5, 3, 3
_DONE_RAD = 1e-3
_DAMPING = 1e-3
_LARGEST_STEP_RAD = 0.6
_LIMIT_COST, _ERROR_COST = 5.0, 4.0
"""Costs of a radian outside a limit and of a radian of direction error; a radian of joint motion costs 1."""
_SEEN_ACROSS, _SEEN_BENT = 0.15, 0.05
"""Squared sines above which the first and the third shoulder joint count as fully observable."""
_SPREAD = {2: 21, 3: 9}
"""Grid points per joint from which the minimisation may start, by number of joints."""
_STRAIGHT = 1e-6
"""Sine below which two directions count as parallel."""


class Arms(ArmKinematics):
    """Solves the joint angles of G arms of one kind for directions of their bones."""

    def __init__(self, chains: Sequence[ArmChain]) -> None:
        super().__init__(chains)
        self.eye = np.eye(self.n_joints)
        self.reaches_all = self._n_shoulder == 3 and self._has_elbow
        self.low, self.high = np.stack([c.low for c in chains])[:, None], np.stack([c.high for c in chains])[:, None]
        self._middle = (self.low + self.high) / 2
        if self.reaches_all:
            a1, a2, a3, a4 = np.moveaxis(self.axes, 1, 0)
            self._elbow_turn = Turn(a4, self.fore0)
            self._third_turn, self._first_turn = Turn(a2, a3), Turn(a2, a1)
            self._elbow_reach, self._roll_reach = Reach(self._elbow_turn, self.upper0), Reach(self._third_turn, a1)
            self._skew_upper = np.array([skew(u) for u in self.upper0])
        else:
            self._spread_out()

    def _spread_out(self) -> None:
        steps = _SPREAD[self.n_joints]
        share = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, steps)] * self.n_joints), -1).reshape(-1, self.n_joints)
        self._poses = self.low + share * (self.high - self.low)  # (G, S, n)
        upper, fore = self.directions(self._poses)
        self._pose_directions = np.concatenate([upper, fore], -1)
        self._pose_cosines = np.vecdot(upper, fore)  # (G, S)

    def ik_solutions(self, upper: Array, fore: Array, weights: Array | None = None) -> tuple[Array, Array]:
        """Joint angles of each solution for unit directions (G, M, 3), and the observability of each joint, both (G, M, C, n).

        Solutions of arms that reach all directions may lie outside the limits. Observability is 0 to 1: where the first and
        the third axis are parallel only the sum of their angles is observable, and where the arm is straight the third
        angle is unobservable.
        """
        if not self.reaches_all:
            if weights is None:
                weights = np.broadcast_to(np.eye(2), (*upper.shape[:2], 2, 2))
            solutions = self._refine(self._starts(upper, fore, weights), upper, fore, _LEAST_ERROR_STEPS, weights)
            return solutions, np.ones_like(solutions)
        solutions, observability = self._every_pair(upper, fore)
        if self._has_offsets:
            solutions = self._refine(solutions, upper, fore, _OFFSET_STEPS)
        return self._nearest_turn(solutions), observability

    def unary_cost(
        self, solutions: Array, upper: Array, fore: Array, observability: Array, weights: Array | None = None
    ) -> Array:
        """(G, M, C) cost of each solution by itself, in radians of movement: angles outside limits and direction errors."""
        outside = np.abs(solutions - within(solutions, self.low[:, None], self.high[:, None]))
        cost = _LIMIT_COST * np.einsum("gmcn,gmcn->gmc", outside, observability)
        if not self.reaches_all or self._has_offsets:
            found = self.directions(solutions.reshape(len(solutions), -1, self.n_joints))
            missed = [
                f.reshape(*solutions.shape[:3], 3) - wanted[:, :, None]
                for f, wanted in zip(found, (upper, fore), strict=True)
            ]
            if weights is None or self.reaches_all:
                for m in missed:
                    cost = cost + _ERROR_COST * np.linalg.norm(m, axis=-1)
            else:
                error = np.concatenate(missed, -1)
                square = np.vecdot(weighted(error, weights[:, :, None]), error)
                cost = cost + _ERROR_COST * np.sqrt(np.maximum(square, 0.0))
        return cost

    def within_limits(self, q: Array, upper: Array, fore: Array, weights: Array | None = None) -> Array:
        """(G, M, n) angles within the limits; where one joint is clipped, the other joints compensate as far as they can."""
        inside = within(q, self.low, self.high)
        cut = (inside != q).any((0, 2))
        if cut.any():
            of = None if weights is None else weights[:, cut]
            better = self._refine(q[:, cut, None], upper[:, cut], fore[:, cut], _CUT_STEPS, of)[:, :, 0]
            some = (inside != q).any(2)[:, cut]
            inside[:, cut] = np.where(some[..., None], better, inside[:, cut])
        return inside

    def rested(self, q: Array, observability: Array, upper: Array, fore: Array, previous: Array) -> Array:
        """(G, M, n) angles `q` with the unobservable ones replaced by rest positions, continued from `previous` (G, n).

        Where the first and the third axis are parallel, the sum of their angles is observable and stays unchanged.
        """
        if not (observability < UNSEEN).any():
            return q
        x = q.copy()
        straight = (1 - np.einsum("gmi,gmi->gm", upper, fore) ** 2) / _SEEN_BENT
        in_line = np.sign(self._third_turn.at(np.cos(q[..., 1]), np.sin(q[..., 1])) @ self.axes[:, 0, :, None])[..., 0]
        for g in range(len(q)):
            fill_unseen(x[g, :, 0], observability[g, :, 0], previous[g, 0])
            x[g, :, 2] += in_line[g] * (q[g, :, 0] - x[g, :, 0])
            fill_unseen(x[g, :, 2], straight[g], previous[g, 2])
        return x

    def _every_pair(self, upper: Array, fore: Array) -> tuple[Array, Array]:
        """The four solutions of three shoulder axes through the shoulder and an elbow, and the joints' observability."""
        G, M = upper.shape[:2]
        a1, _, a3, _ = np.moveaxis(self.axes, 1, 0)
        cosine = np.einsum("gmi,gmi->gm", upper, fore)
        elbow = self._elbow_reach.angles(cosine)  # (G, M, 2)
        bent = self._elbow_turn.at(np.cos(elbow), np.sin(elbow))  # forearm in the upper arm's zero frame
        R = frame(upper, fore)[:, :, None] @ np.swapaxes(self._zero_frame(bent), -1, -2)  # (G, M, 2, 3, 3)
        third = np.einsum("gmeij,gj->gmei", R, a3)
        first = np.einsum("gmeij,gi->gmej", R, a1)
        height = np.einsum("gmei,gi->gme", third, a1)
        q2 = self._roll_reach.angles(height)  # (G, M, 2, 2)
        c2, s2 = np.cos(q2), np.sin(q2)
        q1, lost = angle_about(a1, self._third_turn.at(c2, s2), third)
        q3, _ = angle_about(a3, first, self._first_turn.at(c2, -s2), first_has_ways=False)
        solutions = np.empty((G, M, 2, 2, 4))
        solutions[..., 0], solutions[..., 1], solutions[..., 2], solutions[..., 3] = q1, q2, q3, elbow[..., None]
        if lost.any():  # the first and the third axis are parallel: only the sum of their angles is observable
            solutions[..., 2] = np.where(lost, self._third_alone(solutions, R), q3)
        observability = np.ones((G, M, 2, 2, 4))
        across = np.minimum(np.maximum(1 - height**2, 0.0) / _SEEN_ACROSS, 1)
        observability[..., 0] = across[..., None]
        observability[..., 2] = (across * np.minimum(np.maximum(1 - cosine**2, 0.0) / _SEEN_BENT, 1)[:, :, None])[
            ..., None
        ]
        return solutions.reshape(G, M, 4, 4), observability.reshape(G, M, 4, 4)

    def _zero_frame(self, bent: Array) -> Array:
        """(..., 3, 3) frames of the zero pose with the elbow bent: upper arm, normal of both bones, and their cross product."""
        across = bent @ np.swapaxes(self._skew_upper, -1, -2)[:, None]
        length = np.linalg.norm(across, axis=-1, keepdims=True)
        straight = length < _STRAIGHT
        if straight.any():
            other = cross(self.upper0, np.eye(3)[np.abs(self.upper0).argmin(-1)])[:, None, None]
            across = np.where(straight, other, across)
            length = np.linalg.norm(across, axis=-1, keepdims=True)
        across = across / length
        columns = np.empty((*bent.shape, 3))
        columns[..., 0] = self.upper0[:, None, None]
        columns[..., 1] = across
        columns[..., 2] = across @ np.swapaxes(self._skew_upper, -1, -2)[:, None]
        return columns

    def _third_alone(self, solutions: Array, R: Array) -> Array:
        """(G, M, 2, 2) third angles that complete the first two to the rotation `R` (G, M, 2, 3, 3)."""
        a3 = self.axes[:, 2]
        probe = unit(cross(a3, np.eye(3)[np.abs(a3).argmin(-1)]))
        turns = self._rotations(solutions.reshape(len(solutions), -1, 4)).reshape(*solutions.shape, 3, 3)
        left = np.swapaxes(turns[..., 0, :, :] @ turns[..., 1, :, :], -1, -2) @ R[:, :, :, None]
        moved = np.einsum("gmewij,gj->gmewi", left, probe)
        sine = np.einsum("gmewi,gi->gmew", moved, cross(a3, probe))
        return np.arctan2(sine, np.einsum("gmewi,gi->gmew", moved, probe))

    def _starts(self, upper: Array, fore: Array, weights: Array) -> Array:
        """(G, M, C, n) angles at which the minimisation of the direction error starts."""
        # One start is the nearest grid pose: limits divide the error into valleys that the other starts may miss.
        aim = weighted(np.concatenate([upper, fore], -1), weights)
        likeness = aim @ np.swapaxes(self._pose_directions, -1, -2) - weights[..., :1, 1] * self._pose_cosines[:, None]
        nearest = likeness.argmax(-1)  # (G, M)
        grid = np.take_along_axis(self._poses, nearest[..., None], 1)
        between = unit(upper + fore)
        aims = np.concatenate([upper, between], 1) if self._has_elbow else between  # (G, A M, 3)
        if self._n_shoulder == 2:
            a1, a2 = self.axes[:, 0], self.axes[:, 1]
            turn = Turn(a2, self.upper0)
            q2 = Reach(turn, a1).angles(np.einsum("gmi,gi->gm", aims, a1))  # (G, A M, 2)
            q1, _ = angle_about(a1, turn.at(np.cos(q2), np.sin(q2)), aims)
            shoulders = np.stack([q1, q2], -1)  # (G, A M, W, 2)
        else:
            q1, _ = angle_about(self.axes[:, 0], self.upper0[:, None, None], aims)
            shoulders = q1[..., None]
        G, M = nearest.shape
        A, W = aims.shape[1] // M, shoulders.shape[2]
        starts = shoulders.reshape(G, A, M, W, -1).transpose(0, 2, 1, 3, 4).reshape(G, M * A * W, -1)
        starts = self._with_elbow(starts, np.repeat(fore, A * W, 1)).reshape(G, M, A * W, -1)
        return np.concatenate([grid[:, :, None], starts], 2)

    def _with_elbow(self, shoulder: Array, fore: Array) -> Array:
        """(G, M, n) shoulder angles with the elbow that brings the forearm nearest to `fore`."""
        if not self._has_elbow:
            return shoulder
        R = self._rotations(np.concatenate([shoulder, np.zeros((*shoulder.shape[:2], 1))], -1))
        local = fore[..., None]
        for j in range(self._n_shoulder):
            local = np.swapaxes(R[:, :, j], -1, -2) @ local
        elbow, _ = angle_about(self.axes[:, -1], self.fore0[:, None, None], local[..., 0])
        return np.concatenate([shoulder, elbow], -1)

    def _refine(self, solutions: Array, upper: Array, fore: Array, steps: int, weights: Array | None = None) -> Array:
        """Gauss-Newton steps on both direction errors from angles (G, M, C, n), clipped to the limits."""
        G, M, C, n = solutions.shape
        q = poses_last(self._nearest_turn(solutions).reshape(G, M * C, n))
        q = within(q, self.low, self.high)
        upper, fore = (poses_last(np.repeat(d, C, 1)) for d in (upper, fore))
        of = None if weights is None else poses_last(np.repeat(weights, C, 1))
        damping = _DAMPING * np.eye(n)
        for _ in range(steps):
            b = self.bones(q)
            fall = b.towards(upper, fore, of)
            # A joint at its limit that a step would push further out stays fixed; the other joints compensate.
            stuck = ((q <= self.low) & (fall < 0)) | ((q >= self.high) & (fall > 0))
            free = 1.0 - stuck
            normal = b.hessian(of) * (free[..., None] * free[..., None, :]) + damping
            step = np.linalg.solve(normal, (free * fall)[..., None])[..., 0]
            q = q + np.minimum(np.maximum(step, -_LARGEST_STEP_RAD), _LARGEST_STEP_RAD)
            q = within(q, self.low, self.high)
            if step.size and np.abs(step).max() < _DONE_RAD:
                break
        return q.reshape(G, M, C, n)

    def _nearest_turn(self, solutions: Array) -> Array:
        """Angles with whole turns added where a turn brings an angle inside its limits."""
        return solutions - 2 * np.pi * np.round((solutions - self._middle[:, None]) / (2 * np.pi))
