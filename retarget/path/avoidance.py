"""Avoids self-contact: pushes poses out of contact, and pushes the targets of a path that still touches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from retarget.path.collision import SelfContact
from retarget.path.least_distances import LeastDistances
from retarget.path.limits import JointLimits, within
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
STRENGTHS = (0.0, 0.0, 0.0, 0.1, 0.3, 0.6, 1.0)
"""Share by which frames around a contact are drawn towards the rest pose, by attempt; the first attempts push only."""
_AIM_M = 0.002
"""Metres beyond the margin to which a pose is pushed out, a reserve for corners that velocity and acceleration limits cut."""
_PUSHED_ON_M = 0.004
"""Metres beyond the margin to which a touching path is pushed."""
_PUSHES, _FEW_PUSHES, _STEP_PUSHES = 6, 4, 3
"""Largest number of pushes of a pose: all the way out, most of the way, and after each step towards it."""
_MOST_PUSHED_RAD = 0.15
_COME_STEPS = 5
"""Number of steps in which a pose that pushes cannot free is approached from a clear pose."""
_DAMPING = 1e-5
_AROUND = (1.0, 0.85, 0.5, 0.2)
"""Share of a push that reaches the frames 0, 1, 2, 3 away."""


class Avoidance:
    """Keeps one robot out of self-contact. The arms give way; head and waist keep their targets."""

    def __init__(
        self, robot: RobotModel, contact: SelfContact, limits: JointLimits, yielding: Callable[[Array], Array]
    ) -> None:
        """Set up for a robot.

        Args:
            robot: the robot.
            contact: distances between the robot's shapes.
            limits: position limits.
            yielding: gives for poses (T, J) the inverses of matrices K (T, J, J); moving by x from a pose costs x' K x / 2.
        """
        self._contact, self._yielding = contact, yielding
        self._low, self._high = limits.position_min_rad, limits.position_max_rad
        self._rest_rad = robot.rest_rad
        self._mobility = np.array([j.role.startswith(("left_", "right_")) for j in robot.joints], np.float64)

    def push_out(self, wanted_rad: Array, before_rad: Array, least: LeastDistances | None = None) -> tuple[Array, int]:
        """Poses (T, J) without self-contact near the wanted ones, and the number of runs of changed frames.

        `least` has bounds of the distances in the wanted poses; None computes them.
        """
        least = least or self._contact.least(wanted_rad)
        clear = wanted_rad.copy()
        touching = self._contact.touching(least)
        some = np.flatnonzero(touching)
        if len(some):
            clear[some], free = self._pushed_out(clear[some], _AIM_M, least.part(some))
            lost = some[~free]
            if len(lost):  # too deep for a push: approach from between the clear poses before and after
                between = _between(clear, lost, before_rad)
                clear[lost] = self._from_between(wanted_rad[lost], between, least.part(lost))
        return clear, stretches(touching)

    def push_a_little(self, wanted_rad: Array, touching: NDArray[np.bool_], least: LeastDistances) -> Array:
        """Poses (T, J) in which those that touch, (T,) `touching`, are pushed most or all of the way out of contact."""
        clear, some = wanted_rad.copy(), np.flatnonzero(touching)
        clear[some] = self._pushed_out(clear[some], _AIM_M, least.part(some), _FEW_PUSHES, enough_m=_AIM_M)[0]
        return clear

    def push(self, eased_rad: Array, path_rad: Array, hit: NDArray[np.bool_], strength: float) -> Array:
        """Targets (T, J), changed near the segments `hit` (N - 2,) in which their path, (N, J) control points, touches."""
        T = len(eased_rad)
        pushes = np.zeros_like(eased_rad)
        segments = np.flatnonzero(hit)
        c0, c1, c2 = path_rad[segments], path_rad[segments + 1], path_rad[segments + 2]
        poses = np.stack([(c0 + c1) / 2, (c0 + 6 * c1 + c2) / 8, (c1 + c2) / 2], 1)  # (S, 3, J)
        clearance = self._contact.clearance_m(poses.reshape(-1, path_rad.shape[1])).reshape(-1, 3)
        worst = poses[np.arange(len(segments)), clearance.argmin(1)]
        out = self._pushed_out(worst, _PUSHED_ON_M, self._contact.least(worst))[0] - worst
        for k, push in zip(segments, out, strict=True):  # segment k runs from frame k - 1 to frame k
            for t in {min(max(int(k) - 1, 0), T - 1), min(int(k), T - 1)}:
                pushes[t] = _larger(pushes[t], push)
        spread = np.zeros_like(pushes)
        near = np.zeros((T, 1))
        touched = np.zeros(T, bool)
        touched[np.minimum(np.flatnonzero(hit), T - 1)] = True
        for away, share in enumerate(_AROUND[:T]):
            for shift in {away, -away}:
                to, of = slice(max(shift, 0), T + min(shift, 0)), slice(max(-shift, 0), T - max(shift, 0))
                spread[to] = _larger(spread[to], share * pushes[of])
                near[to] = np.maximum(near[to], share * touched[of, None])
        changed = eased_rad + spread
        changed = changed + strength * near * (self._rest_rad - changed)
        return within(changed, self._low, self._high)

    def _from_between(self, wanted_rad: Array, between_rad: Array, least: LeastDistances) -> Array:
        """Poses (n, J) near the wanted ones: interpolates head and waist between clear poses; if that fails, all joints.

        Interpolating all joints at once would hold up both arms because of a head turned against a shoulder.
        """
        q, free = self._pushed_out(np.where(self._mobility > 0, wanted_rad, between_rad), _AIM_M, least)
        if not free.all():
            q[~free] = self._come_near(wanted_rad[~free], between_rad[~free], least.part(np.flatnonzero(~free)))
        return q

    def _come_near(self, wanted_rad: Array, from_rad: Array, least: LeastDistances) -> Array:
        """Poses (n, J) reached in steps from `from_rad` towards the wanted ones, pushed out of contact after each step."""
        q, free = self._pushed_out(from_rad, _AIM_M, least)
        going = np.arange(len(q))
        for _ in range(_COME_STEPS):
            step = within(wanted_rad[going] - q[going], -_MOST_PUSHED_RAD, _MOST_PUSHED_RAD)
            ahead, clear = self._pushed_out(q[going] + step, _AIM_M, least.part(going), _STEP_PUSHES)
            # A clear pose whose step ends in a contact stays, and so would each further step.
            nearer = clear | ~free[going]
            going = going[nearer]
            q[going] = ahead[nearer]
            free[going] |= clear[nearer]
            if not len(going):
                break
        return q

    def _pushed_out(
        self, q_rad: Array, aim_m: float, least: LeastDistances, pushes: int = _PUSHES, *, enough_m: float = 0.0
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Poses (T, J) moved little until they keep the margin plus `aim_m`, and (T,) whether each keeps the margin.

        Each iteration pushes apart the worst pair of each pose by the movement of least cost, until no pose lacks more than
        `enough_m` of its distance.
        """
        q = q_rad.copy()
        yielding = self._yielding(q_rad)
        rows = np.arange(len(q))
        free = np.zeros(len(q), bool)
        for _ in range(pushes):
            lack, way, least_m = self._contact.worst(q[rows], aim_m, least.at(q[rows]))
            free[rows] = lack <= aim_m
            if lack.max(initial=0.0) <= enough_m:
                break
            some = lack > 0
            least = LeastDistances(q[rows[some]], least_m[some], least.sweep_m)
            rows, lack = rows[some], lack[some, None]
            way = way * self._mobility
            along = (yielding[rows] @ way[..., None])[..., 0]
            push = lack * along / (np.vecdot(way, along)[:, None] + _DAMPING)
            push = within(push, -_MOST_PUSHED_RAD, _MOST_PUSHED_RAD)
            q[rows] = within(q[rows] + push, self._low, self._high)
        return q, free


def stretches(of: NDArray[np.bool_]) -> int:
    """Number of separate runs of true."""
    return int(of[0]) + int((of[1:] & ~of[:-1]).sum())


def _between(q_rad: Array, frames: NDArray[np.int64], before_rad: Array) -> Array:
    """(n, J) poses at `frames` (n,), interpolated between the other poses of `q_rad` (T, J); after the last of these constant."""
    kept = np.setdiff1d(np.arange(len(q_rad)), frames)
    at = np.concatenate([[0], kept + 1])
    known = np.concatenate([before_rad[None], q_rad[kept]])
    return np.stack([np.interp(frames + 1, at, known[:, j]) for j in range(q_rad.shape[1])], 1)


def _larger(a: Array, b: Array) -> Array:
    """Element by element the value that is further from zero."""
    return np.where(np.abs(b) > np.abs(a), b, a)
