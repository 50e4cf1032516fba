"""Leading a robot round itself: poses pushed out of contact, and a path's targets pushed where the path still touches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.collision import SelfContact
from retarget.limits import JointLimits
from retarget.robot import RobotModel

Array = NDArray[np.float64]
STRENGTHS = (0.0, 0.0, 0.1, 0.3, 0.6, 1.0)
"""Share drawn towards the rest pose around what a path touches, one attempt after another; first by pushes alone."""
_AIM_M = 0.004
"""A pose led round keeps so much more than the margin, for what limits in time then cut off."""
_PUSHED_ON_M = 0.006
"""A path that touches is pushed so much further than the margin."""
_FADING = 0.7
"""Share of one frame's push that the next one starts from."""
_PUSHES, _ROUNDS = 5, 5
_MOST_PUSHED_RAD = 0.15
_DAMPING = 1e-5
_AROUND = (1.0, 0.85, 0.5, 0.2)
"""How much of a push reaches the frames 0, 1, 2, 3 away."""


class Avoidance:
    """Keeps one robot off itself. The arms give way; head and waist go where they are meant to."""

    def __init__(self, robot: RobotModel, contact: SelfContact, limits: JointLimits) -> None:
        self._contact = contact
        self._low, self._high = limits.position_min_rad, limits.position_max_rad
        self._rest_rad = robot.rest_rad
        self._mobility = np.array([j.role.startswith(("left_", "right_")) for j in robot.joints], np.float64)

    def lead_round(self, wanted_rad: Array, before_rad: Array) -> tuple[Array, int]:
        """Poses (T, J) clear of the robot, each near the wanted one; how many stretches of them were changed."""
        clear = np.clip(wanted_rad, self._low, self._high)
        touching = self._contact.frames(clear)
        for t in np.flatnonzero(touching):
            target = clear[t].copy()
            came_from, pushed = (clear[t - 1], clear[t - 1] - wanted_rad[t - 1]) if t else (before_rad, 0.0)
            q, free = self._pushed_out(np.clip(target + _FADING * pushed, self._low, self._high), _AIM_M, _PUSHES)
            clear[t] = q if free else self._from_outside(target, came_from)
        return clear, stretches(touching)

    def push(self, eased_rad: Array, path_rad: Array, hit: NDArray[np.bool_], strength: float) -> Array:
        """Targets (T, J) changed where the path made of them, (N, J) control points, touches in segments `hit` (N - 2,)."""
        T = len(eased_rad)
        pushes = np.zeros_like(eased_rad)
        for k in np.flatnonzero(hit):
            c0, c1, c2 = path_rad[k : k + 3]
            poses = np.stack([(c0 + c1) / 2, (c0 + 6 * c1 + c2) / 8, (c1 + c2) / 2])
            worst = poses[int(self._contact.clearance_m(poses).argmin())]
            out, _ = self._pushed_out(worst, _PUSHED_ON_M, _PUSHES)
            # Segment k runs from frame k - 1 to frame k.
            for t in {min(max(k - 1, 0), T - 1), min(k, T - 1)}:
                pushes[t] = _larger(pushes[t], out - worst)
        spread = np.zeros_like(pushes)
        near = np.zeros((T, 1))
        touched = np.zeros(T, bool)
        touched[np.minimum(np.flatnonzero(hit), T - 1)] = True
        for away, share in enumerate(_AROUND):
            for shift in {away, -away}:
                to, of = slice(max(shift, 0), T + min(shift, 0)), slice(max(-shift, 0), T - max(shift, 0))
                spread[to] = _larger(spread[to], share * pushes[of])
                near[to] = np.maximum(near[to], share * touched[of, None])
        changed = eased_rad + spread
        changed = changed + strength * near * (self._rest_rad - changed)
        return np.clip(changed, self._low, self._high)

    def _pushed_out(self, q: Array, aim_m: float, pushes: int) -> tuple[Array, bool]:
        """A pose (J,) moved the least until it keeps the margin and `aim_m` more; whether that came about."""
        for _ in range(pushes):
            near = self._contact.near(q, aim_m)
            if not len(near.lack_m):
                return q, True
            A = near.gradient * self._mobility
            push = np.asarray(np.linalg.solve(A @ A.T + _DAMPING * np.eye(len(A)), near.lack_m), np.float64)
            q = np.clip(q + np.clip(push @ A, -_MOST_PUSHED_RAD, _MOST_PUSHED_RAD), self._low, self._high)
        return q, not len(self._contact.near(q, 0.0).lack_m)

    def _from_outside(self, target: Array, q: Array) -> Array:
        """A pose near `target` reached from `q` on its own side, step by step; best effort."""
        for _ in range(_ROUNDS):
            q = q + np.clip(target - q, -2 * _MOST_PUSHED_RAD, 2 * _MOST_PUSHED_RAD)
            q, _ = self._pushed_out(q, _AIM_M, 3)
        return q


def stretches(of: NDArray[np.bool_]) -> int:
    """Number of separate runs of true."""
    return int(of[0]) + int((of[1:] & ~of[:-1]).sum())


def _larger(a: Array, b: Array) -> Array:
    """Element by element what is further from zero."""
    return np.where(np.abs(b) > np.abs(a), b, a)
