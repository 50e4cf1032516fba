"""Poses from a human motion: waist, neck, arms, and joints that rest where their turning cannot be seen.

Where an arm points along one of its axes, or is straight, some joint turns without being seen. The closed form says
nothing of use for it there; what is wanted then is the path of least movement that shows the same directions: a least-
squares problem over all frames, solved by a few Gauss-Newton steps on one banded matrix.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.arms import Arm
from retarget.branches import choose, fill_unseen
from retarget.following import Importance, each_by_itself
from retarget.human import HumanPose
from retarget.kinematics import Kinematics
from retarget.limits import JointLimits
from retarget.lookahead import Wish, least_moving
from retarget.trunk import solve_neck, solve_waist

Array = NDArray[np.float64]
_REST_PULL = 0.004
"""Weight of squared steps against squared direction errors: a tenth of a degree for human motion, all for an unseen joint."""
_REST_STEPS = 3
_SEEN_RAD = 0.004
"""Direction error that resting may leave before it is tried again from where it came to."""
_MOST_LOST_RAD = 0.03
"""A frame in which resting still costs more than this keeps its closed-form pose."""
_LEAST = 1e-4
"""Weight of a joint's own angle in the limiter, so that an unseen joint too has somewhere to go."""
_CHANGED_RAD = 1e-6
_LED_WEIGHT = 3.0


class Poser:
    """Solves the poses of one robot, before limits in time and contacts."""

    def __init__(self, kinematics: Kinematics, limits: JointLimits) -> None:
        self.kinematics, self._limits = kinematics, limits
        self.arms = tuple(Arm(kinematics, side) for side in ("left", "right"))
        robot = kinematics.robot
        self._rest_rad = robot.rest_rad
        widths = {len(arm.joints) for arm in self.arms}
        self._groups = [[a for a in self.arms if len(a.joints) == w] for w in sorted(widths)]
        in_arms = {j for arm in self.arms for j in arm.joints}
        self._others = [j for j in range(robot.n_joints) if j not in in_arms]
        self._twists = [(arm, robot.joint_with_role(f"{arm.side}_forearm_yaw")) for arm in self.arms]

    def solve(self, human: HumanPose, before_rad: Array | None) -> Array:
        """(T, J) joint angles within the position limits, the first near `before_rad` (J,)."""
        T = len(human.trunk_yaw_rad)
        low, high = self._limits.position_min_rad, self._limits.position_max_rad
        before = self._rest_rad if before_rad is None else before_rad
        q = np.tile(self._rest_rad, (T, 1))
        solve_waist(self.kinematics, human, q)
        np.clip(q, low, high, out=q)
        solve_neck(self.kinematics, human, q)
        for group in self._groups:
            self._solve_arms(group, human, q, before)
        for arm, twist in self._twists:
            if twist is not None:
                along = self.kinematics.axes[twist] @ arm.fore0
                q[:, twist] = np.sign(along) * human.forearm_twist_rad[arm.side]
        return np.clip(q, low, high, out=q)

    def importance(self, q_rad: Array, led_rad: Array) -> list[Importance]:
        """What matters of each joint around poses (T, J): directions for arms, angles for the rest.

        Where poses were led round a contact by `led_rad` (T, J), going less far that way matters too.
        """
        T = len(q_rad)
        every: list[Importance] = []
        for group in self._groups:
            joints = np.array([arm.joints for arm in group], np.int64)
            hessian = np.stack([_hessian(arm, q_rad[:, arm.joints])[0] for arm in group])
            hessian += _LEAST * np.eye(joints.shape[1])
            led = np.stack([led_rad[:, arm.joints] for arm in group])
            length = np.maximum(np.linalg.norm(led, axis=-1, keepdims=True), _CHANGED_RAD)
            hessian += (
                _LED_WEIGHT
                * np.where(length > _CHANGED_RAD, led / length, 0.0)[..., None]
                * (led / length)[..., None, :]
            )
            every.append(Importance(joints, hessian, np.zeros((len(group), T, joints.shape[1]))))
        if self._others:
            every.append(each_by_itself(T, self._others))
        return every

    def _solve_arms(self, arms: list[Arm], human: HumanPose, q: Array, before: Array) -> None:
        """Write the angles of arms of one kind into `q` (T, J)."""
        aims = [(human.upper[arm.side], human.fore[arm.side]) for arm in arms]
        ways = [arm.ways(*aim) for arm, aim in zip(arms, aims, strict=True)]
        seen = [arm.seen(w, *aim) for arm, w, aim in zip(arms, ways, aims, strict=True)]
        cost = [arm.own_cost(w, *aim, s) for arm, w, aim, s in zip(arms, ways, aims, seen, strict=True)]
        start = np.stack([before[list(arm.joints)] for arm in arms])
        chosen, chosen_seen = choose(np.stack(ways), np.stack(cost), np.stack(seen), start)
        closed = np.stack([arm.within_limits(c, *aim) for arm, c, aim in zip(arms, chosen, aims, strict=True)])
        x, shown = closed.copy(), [arm.directions(c) for arm, c in zip(arms, closed, strict=True)]
        for g in range(len(arms)):
            fill_unseen(x[g], chosen_seen[g], start[g])
        x = self._let_rest(arms, x, shown, start)
        for g, arm in enumerate(arms):
            q[:, arm.joints] = np.where((_lost(arm, x[g], shown[g]) > _MOST_LOST_RAD)[:, None], closed[g], x[g])

    def _let_rest(self, arms: list[Arm], x: Array, shown: list[tuple[Array, Array]], start: Array) -> Array:
        """(G, T, w) angles of least movement from near `x` that show the same directions."""
        low, high = np.stack([arm.low for arm in arms])[:, None], np.stack([arm.high for arm in arms])[:, None]
        for _ in range(_REST_STEPS):
            parts = [_hessian(arm, x[g], shown[g]) for g, arm in enumerate(arms)]
            hessian = np.stack([p[0] for p in parts]) + 1e-6 * np.eye(x.shape[-1])
            linear = (hessian @ x[..., None])[..., 0] + np.stack([p[1] for p in parts])
            x = np.clip(least_moving(Wish(hessian, linear, _REST_PULL), start), low, high)
            if max(float(_lost(arm, x[g], shown[g]).max()) for g, arm in enumerate(arms)) < _SEEN_RAD:
                break
        return x


def _hessian(arm: Arm, q: Array, aim: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
    """(T, n, n) J' J of both directions at (T, n), and (T, n) the slope towards `aim`."""
    b = arm.bones(q)
    J = np.concatenate([b.upper_jacobian, b.fore_jacobian], -1)  # (T, n, 6)
    hessian = J @ np.swapaxes(J, -1, -2)
    if aim is None:
        return hessian, q
    error = np.concatenate([aim[0] - b.upper, aim[1] - b.fore], -1)
    return hessian, (J @ error[..., None])[..., 0]


def _lost(arm: Arm, q: Array, shown: tuple[Array, Array]) -> Array:
    """(T,) the larger direction error of (T, n) against the directions `shown`."""
    upper, fore = arm.directions(q)
    apart = [np.linalg.norm(found - wanted, axis=-1) for found, wanted in ((upper, shown[0]), (fore, shown[1]))]
    return np.maximum(*apart)
