"""The audit: every goal the servos receive, checked against the robot's limits, apart from the daemon's own gate.

Written from the robot file alone, in ticks of each servo. A goal is one step of one bus period; rounding to ticks adds at most one
tick to a step and two to the difference of two steps. Between two goals the bus may pause (a skipped cycle), but may
not hurry: what is checked is the step, not the wall clock.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from retarget.collision import SelfContact
from retarget.robot import RobotModel
from retarget.ticks import JointServoMap

PIN_TOLERANCE_TICK = 12
"""About one degree: torque may come on over a goal no further from where the servo stands."""
_CONTACT_EVERY = 5
_MAX_DETAILS = 20


@dataclass
class _Track:
    """Last goals of one servo; None before torque is on."""

    minimum: int
    maximum: int
    step: float
    bend: float
    last: int | None = None
    before: int | None = None


@dataclass
class Audit:
    """Collects goals and violations of one robot."""

    robot: RobotModel
    goals: int = 0
    violations: Counter[str] = field(default_factory=Counter[str])
    details: list[str] = field(default_factory=list[str])

    def __post_init__(self) -> None:
        """Bounds in ticks for each servo."""
        period = self.robot.bus.period_s
        self._tracks: dict[int, _Track] = {}
        self._pose: dict[int, int] = {}
        self._poses: list[list[float]] = []
        self._sets = 0
        ticks = self._ticks = JointServoMap(self.robot)
        bounds = zip(
            ticks.position_min_tick.tolist(), ticks.position_max_tick.tolist(), ticks.velocity_limit_tick_s.tolist(),
            ticks.acceleration_limit_tick_s2.tolist(), strict=True,
        )  # fmt: skip
        for servo_id, (low, high, velocity, acceleration) in zip(self.robot.servo_ids, bounds, strict=True):
            self._tracks[servo_id] = _Track(low, high, velocity * period + 1.0, acceleration * period**2 + 2.0)

    def torque(self, t_s: float, servo_id: int, on: bool, goal_tick: int, present_tick: int) -> None:
        """Torque was switched."""
        track = self._tracks.get(servo_id)
        if track is None:
            return
        track.last = track.before = goal_tick if on else None
        if on and abs(goal_tick - present_tick) > PIN_TOLERANCE_TICK:
            self._violate(t_s, servo_id, "unpinned_torque", f"goal {goal_tick}, standing at {present_tick}")

    def goal(self, t_s: float, servo_id: int, tick: int, torque: bool) -> None:
        """A servo received a goal."""
        track = self._tracks.get(servo_id)
        if track is None:
            return
        self.goals += 1
        if not torque:
            return
        # Where a joint stood outside its range when torque came on, it may only come back.
        low, high = track.minimum, track.maximum
        if track.last is not None:
            low, high = min(low, track.last), max(high, track.last)
        if not low <= tick <= high:
            self._violate(t_s, servo_id, "position", f"goal {tick} outside [{track.minimum}, {track.maximum}]")
        if track.last is not None and track.before is not None:
            step, bend = tick - track.last, tick - 2 * track.last + track.before
            if abs(step) > track.step + 1e-6:
                self._violate(t_s, servo_id, "velocity", f"step {step} ticks, allowed {track.step:.2f}")
            if abs(bend) > track.bend + 1e-6:
                self._violate(t_s, servo_id, "acceleration", f"second difference {bend}, allowed {track.bend:.2f}")
        track.before, track.last = track.last, tick
        self._collect(servo_id, tick)

    def refused(self, t_s: float, servo_id: int, code: int) -> None:
        """A servo refused a goal: the daemon wrote to a servo in fault or beyond its own limits."""
        self._violate(t_s, servo_id, "refused_goal", f"error code {code}")

    def report(self) -> dict[str, Any]:
        """All figures as plain values."""
        contacts = 0
        if self._poses:
            contact = SelfContact(self.robot, margin_m=0.0)
            contacts = int(contact.frames(np.array(self._poses)).sum())
        return {
            "robot": self.robot.name,
            "goals": self.goals,
            "violations": sum(self.violations.values()),
            "violations_by_kind": dict(self.violations),
            "self_contacts": contacts,
            "poses_checked": len(self._poses),
            "details": self.details,
        }

    def _collect(self, servo_id: int, tick: int) -> None:
        """Keep every few whole sets of goals for the check of self-contact."""
        self._pose[servo_id] = tick
        if servo_id != self.robot.servos[-1].servo_id or len(self._pose) < len(self._tracks):
            return
        self._sets += 1
        if self._sets % _CONTACT_EVERY == 0:
            ticks = np.array([self._pose[servo_id] for servo_id in self.robot.servo_ids])
            self._poses.append(self._ticks.tick_to_rad(ticks).tolist())

    def _violate(self, t_s: float, servo_id: int, kind: str, text: str) -> None:
        self.violations[kind] += 1
        if len(self.details) < _MAX_DETAILS:
            self.details.append(f"{t_s:.3f} s, servo {servo_id}: {kind}: {text}")
