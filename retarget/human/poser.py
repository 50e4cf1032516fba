"""Poses from a human motion: waist, neck, arms, and rest of the joints that are unobservable.

Where an arm points along one of its axes, or is straight, one joint turns without changing a bone's direction, and the closed form
leaves its angle undetermined. The poser then takes the path of least movement with unchanged directions: a least-squares
problem over all frames, solved by a few Gauss-Newton steps on one banded matrix.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from retarget.human.arm_chain import ArmChain, read_arm
from retarget.human.arms import Arms
from retarget.human.bones import Bones
from retarget.human.branches import choose
from retarget.human.human import SIDES, HumanPose
from retarget.human.objective import ArmObjective, PoseObjective
from retarget.human.trunk import Trunk
from retarget.human.weighing import bone_weights
from retarget.path.limit_path import Angles
from retarget.path.limits import JointLimits, within
from retarget.path.lookahead_qp import LeastSquares, least_moving
from retarget.robot.kinematics import Kinematics

Array = NDArray[np.float64]
ArmsFollow = Literal["chest", "world"]
_REST_PULL = 0.004
"""Weight of squared steps against squared direction errors. The weight costs human motion a tenth of a degree of direction;
an unobservable joint follows the squared steps alone."""
_REST_STEPS = 3
_CHOICE_PULL = 0.03
"""Weight of squared steps for arms that cannot match both bones: a larger error is preferred to a jump."""
_SEEN_RAD = 0.004
"""Radians of direction error that a resting step may leave; a larger one is followed by another step."""
_NEARBY = 0.01
"""Weight of squared changes from one Gauss-Newton step to the next: directions are linear in angles nearby only."""
_MOST_LOST_RAD = 0.03
"""Radians of direction error above which a frame keeps its closed-form pose instead of the resting one."""


@dataclass(frozen=True)
class Poses:
    """Poses of a robot within its position limits; velocity, acceleration and contacts are not yet limited.

    Attributes:
        q_rad: (T, J) angles within the position limits.
        outside: (T, J) whether a position limit changed the angle.
        upper: (2, T, 3) target directions of left and right upper arm, in the robot's chest frame.
        fore: (2, T, 3) target directions of left and right forearm.
        weights: (2, T, 2, 2) weights of the errors of both bones, see `weighing`.
    """

    q_rad: Array
    outside: NDArray[np.bool_]
    upper: Array
    fore: Array
    weights: Array

    def part(self, frames: slice) -> Poses:
        """The poses of some frames."""
        return Poses(
            self.q_rad[frames],
            self.outside[frames],
            self.upper[:, frames],
            self.fore[:, frames],
            self.weights[:, frames],
        )

    def stretched(self, times: float) -> Poses:
        """The poses, `times` times slower."""
        T = len(self.q_rad)
        at = np.linspace(0, T - 1, max(2, round(T * times)) if T > 1 else 1)
        low = np.minimum(at.astype(np.int64), T - 1)
        high, share = np.minimum(low + 1, T - 1), (at - low)[:, None]

        def between(x: Array) -> Array:
            return x[..., low, :] * (1 - share) + x[..., high, :] * share

        upper, fore = (d / np.linalg.norm(d, axis=-1, keepdims=True) for d in map(between, (self.upper, self.fore)))
        return Poses(between(self.q_rad), self.outside[low], upper, fore, self.weights[:, low])


class Poser:
    """Solves the poses of one robot."""

    def __init__(self, kinematics: Kinematics, limits: JointLimits, arms_follow: ArmsFollow = "chest") -> None:
        robot = kinematics.robot
        self._limits, self._rest_rad, self._arms_follow = limits, robot.rest_rad, arms_follow
        self._trunk = Trunk(kinematics)
        self.chains: tuple[ArmChain, ...] = tuple(read_arm(kinematics, side) for side in SIDES)
        kinds = sorted({chain.kind for chain in self.chains})
        self._sides = [[i for i, chain in enumerate(self.chains) if chain.kind == kind] for kind in kinds]
        self._arms = [Arms([self.chains[i] for i in sides]) for sides in self._sides]
        self._joints = [np.array([self.chains[i].joints for i in sides], np.int64) for sides in self._sides]  # (G, n)
        in_arms = {j for chain in self.chains for j in chain.joints}
        self._others = [j for j in range(robot.n_joints) if j not in in_arms]
        self._twists: list[tuple[int, int, float]] = []
        for i, chain in enumerate(self.chains):
            twist = robot.joint_with_role(f"{chain.side}_forearm_yaw")
            if twist is not None:
                self._twists.append((i, twist, float(np.sign(kinematics.axes[twist] @ chain.fore_m))))

    def solve(self, human: HumanPose, before_rad: Array | None) -> Poses:
        """Poses for all frames; the first is near `before_rad` (J,), or near the rest pose where that is None."""
        low, high = self._limits.position_min_rad, self._limits.position_max_rad
        before = self._rest_rad if before_rad is None else before_rad
        q = np.tile(self._rest_rad, (human.upper.shape[1], 1))
        outside = np.zeros(q.shape, bool)
        if self._trunk.has_waist:
            self._trunk.solve_waist(human.chest_rotation, q)
            outside |= (q < low) | (q > high)
            q = within(q, low, high)
        self._trunk.solve_neck(human.head_rotation, q)
        upper, fore = human.upper, human.fore
        if self._arms_follow == "world":
            turned = np.swapaxes(self._trunk.into_chest(q) @ human.chest_rotation, -1, -2)
            upper, fore = ((d[:, :, None] @ turned)[:, :, 0] for d in (upper, fore))
        weights = self._weights(human)
        for arms, sides, joints in zip(self._arms, self._sides, self._joints, strict=True):
            angles, cut = self._arm_angles(arms, upper[sides], fore[sides], weights[sides], before[joints])
            q[:, joints], outside[:, joints] = angles.transpose(1, 0, 2), cut.transpose(1, 0, 2)
        for i, joint, sense in self._twists:
            q[:, joint] = sense * human.forearm_twist_rad[i]
        outside |= (q < low) | (q > high)
        return Poses(within(q, low, high), outside, upper, fore, weights)

    def _weights(self, human: HumanPose) -> Array:
        """(2, T, 2, 2) weights of upper arm and forearm; the identity for arms that reach every pair of directions."""
        weights = np.tile(np.eye(2), (2, human.upper.shape[1], 1, 1))
        some = [i for arms, sides in zip(self._arms, self._sides, strict=True) if not arms.reaches_all for i in sides]
        if some:
            weights[some] = bone_weights(human)[some]
        return weights

    def directions(self, q_rad: Array) -> tuple[Array, Array]:
        """Directions of the upper arms and of the forearms, each (2, T, 3) for left and right, in poses (T, J)."""
        upper, fore = np.empty((2, 2, len(q_rad), 3))
        for arms, sides, joints in zip(self._arms, self._sides, self._joints, strict=True):
            upper[sides], fore[sides] = arms.directions(q_rad[:, joints].transpose(1, 0, 2))
        return upper, fore

    def yielding(self, q_rad: Array) -> Array:
        """(T, J, J) inverses of the quadratic cost K of a small movement away from poses (T, J): x costs x' K x / 2.

        The cost is the change of bone directions, plus that of angles, so it couples the joints of each arm alone.
        """
        T, J = q_rad.shape
        every = np.zeros((T, J, J))
        every[:, np.arange(J), np.arange(J)] = 1.0
        for arms, joints in zip(self._arms, self._joints, strict=True):
            of_arms = np.linalg.inv(arms.bones(q_rad[:, joints].transpose(1, 0, 2)).hessian() + arms.eye)
            for g, of in enumerate(joints):
                every[:, of[:, None], of] = of_arms[g]
        return every

    def shown(self, poses: Poses, q_rad: Array) -> tuple[Array, Array]:
        """Half the weighted squared error linearised at poses (T, J), see `Retargeter.shown`."""
        T, J = q_rad.shape
        every, falls = np.zeros((T, J, J)), np.zeros((T, J))
        for arms, sides, joints in zip(self._arms, self._sides, self._joints, strict=True):
            bones = arms.bones(q_rad[:, joints].transpose(1, 0, 2))
            weights = poses.weights[sides][:, :T]
            hessian = bones.hessian(weights)
            fall = bones.towards(poses.upper[sides][:, :T], poses.fore[sides][:, :T], weights)
            for g, of in enumerate(joints):
                every[:, of[:, None], of] += hessian[g]
                falls[:, of] += fall[g]
        return every, falls

    def objective(self, q_rad: Array, led_rad: Array) -> PoseObjective:
        """The objective of following poses (T, J): directions for arms, angles for the other joints.

        Where poses were pushed out of a contact by `led_rad` (T, J), a smaller displacement along the push has a cost too.
        """
        arms = [ArmObjective(a, j, q_rad, led_rad) for a, j in zip(self._arms, self._joints, strict=True)]
        return PoseObjective(arms, Angles(q_rad, self._others) if self._others else None)

    def _arm_angles(
        self, arms: Arms, upper: Array, fore: Array, weights: Array, before: Array
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Angles of arms of one kind for directions (G, T, 3), continued from `before` (G, n), and which were clipped, (G, T, n).

        Arms that reach every pair of directions rest where a joint is unobservable; other arms move less where that costs
        little direction error.
        """
        solutions, observability = arms.ik_solutions(upper, fore, weights)
        chosen, observability = choose(
            solutions, arms.unary_cost(solutions, upper, fore, observability, weights), observability, before
        )
        cut = (chosen < arms.low) | (chosen > arms.high)
        closed = arms.within_limits(chosen, upper, fore) if cut.any() else chosen
        if not arms.reaches_all:
            x = closed
            x = closed
            for k in range(_REST_STEPS):
                x = self._calmer(arms, x, arms.bones(x), (upper, fore), weights, _CHOICE_PULL, before)
                if k:  # the others compensate for a clipped joint
                    x = arms.within_limits(x, upper, fore, weights)
                else:
                    x = within(x, arms.low, arms.high)
            return x, cut
        bones = arms.bones(closed)
        shown = bones.upper, bones.fore
        x = arms.rested(closed, observability, *shown, before)
        if x is not closed:
            bones = arms.bones(x)
        lost = np.zeros(0)
        for _ in range(_REST_STEPS):
            x = within(self._calmer(arms, x, bones, shown, None, _REST_PULL, before), arms.low, arms.high)
            bones = arms.bones(x)
            lost = np.maximum(np.abs(bones.upper - shown[0]), np.abs(bones.fore - shown[1])).max(-1)
            if lost.max() < _SEEN_RAD:
                return x, cut
        return np.where((lost > _MOST_LOST_RAD)[..., None], closed, x), cut

    @staticmethod
    def _calmer(
        arms: Arms,
        x: Array,
        bones: Bones,
        wanted: tuple[Array, Array],
        weights: Array | None,
        pull: float,
        before: Array,
    ) -> Array:
        """(G, T, n) angles after one Gauss-Newton step from `x`, with `bones`, towards directions `wanted` and little movement.

        The angles may lie outside the limits.
        """
        hessian = bones.hessian(weights) + arms.eye * _NEARBY
        linear = (hessian @ x[..., None])[..., 0] + bones.towards(*wanted, weights)
        return least_moving(LeastSquares(hessian, linear, pull), before)
