"""Steps towards targets that nobody knows beforehand, kept within every limit and off the robot itself.

The invariant: from where the last step led, braking as hard as the limits allow touches nothing. A step is taken only
when that holds after it, else the robot brakes on the way that the step before has already proved free. So whatever ends
the steps (a stop, a lost sender, no further frame), the same braking in the bus process stays clear as well.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.path.collision import KEPT, SelfContact
from retarget.path.limits import JointLimits, brake, limit_step
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
LOOK_AHEAD_S = 0.15
"""Seconds of the way to the target that must be free before a robot that has braked for a contact goes on: it does not creep."""
_NEARER_M = 1e-6
"""Poses that are within the margin already may not come nearer to themselves than by rounding."""


class SafetyFilter:
    """One robot's next positions towards a target, step by step. No clock, no I/O; not for several threads.

    Args:
        robot: which one.
        contact: of the robot; made anew when None.
        share: of the margin that is kept.

    Attributes:
        position_rad, velocity_rad_s: (J,) the last step's end and its difference quotient.
        held: whether it brakes, or stands, because the way to the target would touch.
        clipped: whether the last target lay outside the position limits.
        holds: times it began to be held.
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
        """Go on from here."""
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
        """Whether the way of the next steps, and braking after them, is free."""
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
        """Whether a step to `goal` and braking after it stay clear."""
        way = [goal, *self._braking(goal, (goal - self.position_rad) / self.period_s)]
        if len(way) == 1 and (goal == self.position_rad).all():
            return True
        if self._within_slack(way):
            return True
        self._known_rad, self._slack_m = self.position_rad, self._contact.slack_m(self.position_rad, self._share)
        return self._within_slack(way) or self._clear(way, self._slack_m)

    def _within_slack(self, way: list[Array]) -> bool:
        """Whether nothing can touch because all poses are near one that has slack enough on every side."""
        far = np.abs(np.array([self.position_rad, *way]) - self._known_rad).max(0)
        return self._contact.within_slack(self._slack_m, far)

    def _braking(self, position: Array, velocity: Array) -> list[Array]:
        """Positions while every joint stops as hard as it can; what `brake` gives step by step, at once where it is plain."""
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
        """Whether a way from here, where each pair has (P,) slack, stays off the robot, between its poses too."""
        points = np.array([self.position_rad, *way])
        if (here > 0).all():
            return self._contact.clear_along(points, self._share, here)
        # A robot that stands within the margin (it was led there by hand, or rests so) may leave it, not go deeper.
        path = np.concatenate([points[1:], (points[1:] + points[:-1]) / 2])
        return bool((self._contact.slacks_m(path, self._share) >= np.minimum(here, 0.0) - _NEARER_M).all())
