"""Steps towards targets that are not known in advance, within every limit and without self-contact.

The invariant: braking from the last step's end, as hard as the limits allow, is free of contact. A step is taken only if the
invariant holds after it; otherwise the robot brakes on the path that the previous step has proved free. However the steps end (a
stop, a lost sender, no further frame), the same braking in the bus process therefore stays free of contact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.path.collision import KEPT, SelfContact
from retarget.path.limits import JointLimits, brake, limit_step
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
LOOK_AHEAD_S = 0.15
"""Seconds of the path to the target that must be free before a robot that has braked for a contact continues; without this
reserve it would creep towards the contact."""
_NEARER_M = 1e-6
"""Metres of rounding by which poses within the margin may come nearer."""


class SafetyFilter:
    """One robot's next positions towards a target, step by step. It has no clock and no I/O, and is not thread-safe.

    Args:
        robot: the robot.
        contact: distances between the robot's shapes; None builds them.
        share: share of the margin that is kept.

    Attributes:
        position_rad, velocity_rad_s: (J,) end of the last step and its difference quotient.
        held: whether the robot brakes or stands because the path to the target would touch.
        clipped: whether the last target lay outside the position limits.
        holds: number of times that `held` became true.
    """

    def __init__(self, robot: RobotModel, contact: SelfContact | None = None, share: float = KEPT) -> None:
        self._share = share
        self.limits = JointLimits.of(robot)
        self.period_s = robot.bus.period_s
        self._contact = contact or SelfContact(robot)
        self._ahead = max(1, round(LOOK_AHEAD_S / self.period_s))
        self.holds = 0
        self.reset(robot.rest_rad, np.zeros(robot.n_joints))

    def reset(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Continue from a position and velocity (J,)."""
        self.position_rad, self.velocity_rad_s = position_rad.copy(), velocity_rad_s.copy()
        self.held = self.clipped = False
        self._refused_rad: Array | None = None
        self._known_rad = self.position_rad
        self._slack_m = self._contact.slack_m(self.position_rad, self._share)

    @property
    def at_rest(self) -> bool:
        """Whether the last step moved nothing."""
        return not self.velocity_rad_s.any()

    def step(self, target_rad: Array) -> Array:
        """(J,) the next position towards finite targets (J,)."""
        low, high = self.limits.position_min_rad, self.limits.position_max_rad
        self.clipped = bool(((target_rad < low) | (target_rad > high)).any())
        if self.held and not self._free_ahead(target_rad):
            return self.brake()
        goal = limit_step(target_rad, self.position_rad, self.velocity_rad_s, self.limits, self.period_s)
        if self._free(goal):
            self.held = False
            return self._advance(goal)
        if not self.held:
            self.held, self.holds = True, self.holds + 1
        return self.brake()

    def brake(self) -> Array:
        """(J,) the next position while coming to rest."""
        return self._advance(brake(self.position_rad, self.velocity_rad_s, self.limits, self.period_s))

    def touching(self, target_rad: Array) -> list[tuple[str, str]]:
        """Names of the bodies that would touch at (J,) targets, for people."""
        return self._contact.pairs(np.clip(target_rad, self.limits.position_min_rad, self.limits.position_max_rad))

    def _advance(self, goal: Array) -> Array:
        self.velocity_rad_s = (goal - self.position_rad) / self.period_s
        self.position_rad = goal
        return goal

    def _free_ahead(self, target: Array) -> bool:
        """Whether the next `LOOK_AHEAD_S` towards the target, and braking after them, are free of contact."""
        if self.at_rest and self._refused_rad is not None and np.array_equal(target, self._refused_rad):
            return False
        position, velocity, path = self.position_rad, self.velocity_rad_s, list[Array]()
        for _ in range(self._ahead):
            goal = limit_step(target, position, velocity, self.limits, self.period_s)
            position, velocity = goal, (goal - position) / self.period_s
            path.append(goal)
        here = self._contact.slack_m(self.position_rad, self._share)
        free = self._clear([*path, *self._braking(position, velocity)], here)
        self._refused_rad = None if free or not self.at_rest else target.copy()
        return free

    def _free(self, goal: Array) -> bool:
        """Whether a step to `goal` and braking after it are free of contact."""
        way = [goal, *self._braking(goal, (goal - self.position_rad) / self.period_s)]
        if len(way) == 1 and (goal == self.position_rad).all():
            return True
        if self._within_slack(way):
            return True
        self._known_rad, self._slack_m = self.position_rad, self._contact.slack_m(self.position_rad, self._share)
        return self._within_slack(way) or self._clear(way, self._slack_m)

    def _within_slack(self, way: list[Array]) -> bool:
        """Whether all poses are so near a known pose that its slacks exclude contact."""
        far = np.abs(np.array([self.position_rad, *way]) - self._known_rad).max(0)
        return self._contact.within_slack(self._slack_m, far)

    def _braking(self, position: Array, velocity: Array) -> list[Array]:
        """Positions while every joint brakes as hard as it can: the steps of `brake`, in closed form inside the position limits."""
        low, high = self.limits.position_min_rad, self.limits.position_max_rad
        if ((position >= low) & (position <= high)).all():
            loss = self.limits.acceleration_rad_s2 * self.period_s
            n = int(np.ceil((np.abs(velocity) / loss).max()))
            left = np.maximum(np.abs(velocity) - np.arange(1, n + 1)[:, None] * loss, 0.0)
            return list(np.clip(position + np.cumsum(np.sign(velocity) * left * self.period_s, 0), low, high))
        way: list[Array] = []
        while velocity.any():
            goal = brake(position, velocity, self.limits, self.period_s)
            position, velocity = goal, (goal - position) / self.period_s
            way.append(goal)
        return way

    def _clear(self, way: list[Array], here: Array) -> bool:
        """Whether a path from here, with slacks `here` (P,), is free of contact at and between its poses."""
        points = np.array([self.position_rad, *way])
        if (here > 0).all():
            return self._contact.clear_along(points, self._share, here)
        # A robot within the margin (moved there by hand, or resting there) may leave the margin but not come nearer.
        path = np.concatenate([points[1:], (points[1:] + points[:-1]) / 2])
        return bool((self._contact.slacks_m(path, self._share) >= np.minimum(here, 0.0) - _NEARER_M).all())
