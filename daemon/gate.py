"""The last limiter before bytes, for every source: text, replay, raw stream, park.

Whatever comes in, what goes out keeps position, velocity and acceleration; what already keeps them passes bit for bit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.limits import JointLimits, brake, limit_step
from retarget.robot import RobotModel

Array = NDArray[np.float64]

FARTHEST_RAD = 1000.0
"""Targets beyond are all equally far; without this bound the limiter overflows at 1e300 and its goal is NaN."""


class Gate:
    """Holds what the joints were told last, and lets nothing through that they cannot follow.

    Attributes:
        position_rad, velocity_rad_s: (J,) the last goal and the step to it.
        clipped: (J,) whether the last target was changed.
        refused: targets refused because they were not finite.
    """

    def __init__(self, robot: RobotModel, period_s: float | None = None) -> None:
        self.limits = JointLimits.of(robot)
        self.period_s = period_s or robot.bus.period_s
        self.position_rad: Array = robot.park_rad.copy()
        self.velocity_rad_s: Array = np.zeros(robot.n_joints)
        self.clipped: NDArray[np.bool_] = np.zeros(robot.n_joints, bool)
        self.refused = 0

    def reset(self, position_rad: Array) -> None:
        """Start anew at a measured position, at rest."""
        if not np.isfinite(position_rad).all():
            raise ValueError(f"the gate cannot start at {position_rad}: not finite")
        self.position_rad = position_rad.copy()
        self.velocity_rad_s = np.zeros_like(position_rad)
        self.clipped = np.zeros(len(position_rad), bool)

    def step(self, target_rad: Array) -> Array:
        """(J,) next goal towards `target_rad`; a target that is not finite brakes instead."""
        if not np.isfinite(target_rad).all():
            self.refused += 1
            goal = self.brake()
            self.clipped = np.ones(len(goal), bool)
            return goal
        near_rad = np.clip(target_rad, -FARTHEST_RAD, FARTHEST_RAD)
        goal = limit_step(near_rad, self.position_rad, self.velocity_rad_s, self.limits, self.period_s)
        self.clipped = goal != target_rad
        return self._advance(goal)

    def brake(self) -> Array:
        """(J,) next goal while coming to rest."""
        self.clipped = np.zeros(len(self.position_rad), bool)
        return self._advance(brake(self.position_rad, self.velocity_rad_s, self.limits, self.period_s))

    @property
    def at_rest(self) -> bool:
        """Whether the last step moved nothing."""
        return not self.velocity_rad_s.any()

    def _advance(self, goal: Array) -> Array:
        self.velocity_rad_s = (goal - self.position_rad) / self.period_s
        self.position_rad = goal
        return goal
