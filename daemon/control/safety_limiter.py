"""The last limiter before the bytes, for every source of setpoints: text, replay, raw stream, park.

For any input, its output keeps position, velocity and acceleration limits and leads the robot into no self-contact: after every
goal, braking at full deceleration is proved free of contact. Input that already keeps all of these passes bit for bit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from retarget.path.collision import SelfContact
from retarget.path.limits import JointLimits, brake, limit_step
from retarget.path.safety_filter import SafetyFilter
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]

FARTHEST_RAD = 1000.0
"""Radians beyond which targets count as equally far; without this bound the limiter overflows at 1e300 and its goal is NaN."""
GATE_SHARE = 0.3
"""Share of the self-contact margin that the gate keeps: less than the share of paths and streams, so that those pass."""


class SafetyLimiter:
    """Holds the joints' last goal and passes only goals that the joints can follow.

    Args:
        robot: the robot.
        period_s: time between two goals; that of the robot's bus when None.
        contact: model of the robot's body; None keeps the limits alone.

    Attributes:
        position_rad, velocity_rad_s: (J,) the last goal and the step to it.
        clipped: (J,) whether the last target was changed.
        refused: targets refused because they were not finite.
    """

    def __init__(self, robot: RobotModel, period_s: float | None = None, contact: SelfContact | None = None) -> None:
        self.limits = JointLimits.of(robot)
        self.period_s = period_s or robot.bus.period_s
        self.position_rad: Array = robot.park_rad.copy()
        self.velocity_rad_s: Array = np.zeros(robot.n_joints)
        self.clipped: NDArray[np.bool_] = np.zeros(robot.n_joints, bool)
        self.refused = 0
        self._guarded = None if contact is None else SafetyFilter(robot, contact, GATE_SHARE)
        self.reset(robot.park_rad)

    @property
    def held(self) -> bool:
        """Whether the gate keeps the robot from touching itself in this cycle."""
        return self._guarded is not None and self._guarded.held

    def reset(self, position_rad: Array) -> None:
        """Start again at a measured position (J,), at rest."""
        if not np.isfinite(position_rad).all():
            raise ValueError(f"the gate cannot start at {position_rad}: not finite")
        self.position_rad = position_rad.copy()
        self.velocity_rad_s = np.zeros_like(position_rad)
        self.clipped = np.zeros(len(position_rad), bool)
        if self._guarded is not None:
            self._guarded.reset(self.position_rad, self.velocity_rad_s)

    def step(self, target_rad: Array) -> Array:
        """(J,) next goal towards `target_rad`; a target that is not finite brakes instead."""
        if not np.isfinite(target_rad).all():
            self.refused += 1
            goal = self.brake()
            self.clipped = np.ones(len(goal), bool)
            return goal
        near_rad = np.clip(target_rad, -FARTHEST_RAD, FARTHEST_RAD)
        limits = self._limits_now()
        if self._guarded is not None:
            self._guarded.limits = limits
            goal = self._guarded.step(near_rad)
        else:
            goal = limit_step(near_rad, self.position_rad, self.velocity_rad_s, limits, self.period_s)
        self.clipped = goal != target_rad
        return self._advance(goal)

    def brake(self) -> Array:
        """(J,) next goal while coming to rest."""
        self.clipped = np.zeros(len(self.position_rad), bool)
        limits = self._limits_now()
        if self._guarded is not None:
            self._guarded.limits = limits
            return self._advance(self._guarded.brake())
        return self._advance(brake(self.position_rad, self.velocity_rad_s, limits, self.period_s))

    def _limits_now(self) -> JointLimits:
        """The robot's limits; the range of a joint found outside extends to its position, so that it is not driven back hard."""
        low, high = self.limits.position_min_rad, self.limits.position_max_rad
        if ((self.position_rad >= low) & (self.position_rad <= high)).all():
            return self.limits
        return replace(
            self.limits,
            position_min_rad=np.minimum(low, self.position_rad),
            position_max_rad=np.maximum(high, self.position_rad),
        )

    @property
    def at_rest(self) -> bool:
        """Whether the last step moved no joint."""
        return not self.velocity_rad_s.any()

    def touching(self, target_rad: Array) -> list[tuple[str, str]]:
        """Names of the bodies that would touch at finite targets (J,), for messages; empty when the body is unknown."""
        return [] if self._guarded is None else self._guarded.touching(target_rad)

    def _advance(self, goal: Array) -> Array:
        self.velocity_rad_s = (goal - self.position_rad) / self.period_s
        self.position_rad = goal
        return goal
