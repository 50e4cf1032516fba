"""Poses from a human motion: waist, neck, arms, and joints that rest where their turning cannot be seen.

Where an arm points along one of its axes, or is straight, some joint turns without being seen. The closed form says
nothing of use for it there; what is wanted then is the path of least movement that shows the same directions: a least-
squares problem over all frames, solved by a few Gauss-Newton steps on one banded matrix.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.arms import Arm
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
_CHANGED_RAD = 1e-9


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
        for arm in self.arms:
            q[:, arm.joints] = arm.solve(human.upper[arm.side], human.fore[arm.side], before[list(arm.joints)])
        for group in self._groups:
            self._let_rest(group, human, q, before)
        for arm, twist in self._twists:
            if twist is not None:
                along = self.kinematics.axes[twist] @ arm.fore0
                q[:, twist] = np.sign(along) * human.forearm_twist_rad[arm.side]
        return np.clip(q, low, high, out=q)

    def importance(self, q_rad: Array) -> list[Importance]:
        """What matters of each joint around poses (T, J): directions for arms, angles for the rest."""
        T = len(q_rad)
        every: list[Importance] = []
        for group in self._groups:
            joints = np.array([arm.joints for arm in group], np.int64)
            hessian = np.stack([_hessian(arm, q_rad[:, arm.joints])[0] for arm in group])
            hessian += _LEAST * np.eye(joints.shape[1])
            every.append(Importance(joints, hessian, np.zeros((len(group), T, joints.shape[1]))))
        if self._others:
            every.append(each_by_itself(T, self._others))
        return every

    def _let_rest(self, arms: list[Arm], human: HumanPose, q: Array, before: Array) -> None:
        """Replace the arms' angles in `q` (T, J) by those of least movement that show the same."""
        joints = [list(arm.joints) for arm in arms]
        solved = np.stack([q[:, j] for j in joints])  # (G, T, w)
        start = np.stack([before[j] for j in joints])
        low, high = (np.stack([x[j] for j in joints])[:, None] for x in (self._limits.position_min_rad, self._limits.position_max_rad))
        aims = [arm.directions(s) for arm, s in zip(arms, solved, strict=True)]
        x = solved
        lost = np.zeros(x.shape[:2])
        for _ in range(_REST_STEPS):
            parts = [_hessian(arm, x[g], aims[g]) for g, arm in enumerate(arms)]
            hessian = np.stack([p[0] for p in parts]) + 1e-6 * np.eye(x.shape[-1])
            slope = np.stack([p[1] for p in parts])
            linear = (hessian @ x[..., None])[..., 0] + slope
            x = np.clip(least_moving(Wish(hessian, linear, _REST_PULL), start), low, high)
            found = [arm.directions(x[g]) for g, arm in enumerate(arms)]
            lost = np.stack([np.maximum(_apart(f[0], a[0]), _apart(f[1], a[1])) for f, a in zip(found, aims, strict=True)])
            if lost.max() < _SEEN_RAD:
                break
        x = np.where((lost > _MOST_LOST_RAD)[..., None], solved, x)
        for g, j in enumerate(joints):
            q[:, j] = x[g]


def _hessian(arm: Arm, q: Array, aim: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
    """(T, n, n) J' J of both directions at (T, n), and (T, n) the slope towards `aim`."""
    b = arm.bones(q)
    J = np.concatenate([b.upper_jacobian, b.fore_jacobian], -1)  # (T, n, 6)
    hessian = J @ np.swapaxes(J, -1, -2)
    if aim is None:
        return hessian, q
    error = np.concatenate([aim[0] - b.upper, aim[1] - b.fore], -1)
    return hessian, (J @ error[..., None])[..., 0]


def _apart(a: Array, b: Array) -> Array:
    """(T,) length of the difference of unit vectors: nearly the angle between them."""
    return np.asarray(np.linalg.norm(a - b, axis=-1), np.float64)
