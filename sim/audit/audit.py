"""The audit: every goal the servos receive, checked against the robot's limits, independently of the daemon's own gate.

Written from the robot file alone, in ticks of each servo. A goal is one step of one bus period; rounding to ticks adds at most one
tick to a step and two to the difference of two steps. The bus may pause between two goals (a skipped cycle), but may not hurry:
more than a few goals in a row that come faster than the robot's rate are a violation of their own. Another violation are goals that
move a servo which has reported its trip often enough, once there was time to come to rest.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from sim.audit.contact_audit import ContactAudit

PIN_TOLERANCE_TICK, _TICKS_PER_TURN = 12, 4096
"""Ticks between a servo and its goal when torque comes on, about one degree at 4096 ticks a turn. Finer servos (Y, P) may be the
same angle away, coarser ones the same number of ticks.
"""
HURRY_GOALS, HURRY_RATE = 4, 1.1
"""Number of goals that may come at once (those of a late cycle and of the next ones), and their long-run rate as a multiple of the
bus rate.
"""
TTY_GOALS = 30
"""Number of goals that may come at once over a tty: a loaded machine may have let the simulator sleep meanwhile."""
FAULT_GRACE_S = 0.1
"""Seconds after a servo's trip in which goals already under way are no violation."""
ANSWERS_TOLD = 10
"""Complete answers after which the client must know of a servo's trip: some may be lost on the wire."""
_MAX_DETAILS = 20


@dataclass
class _Track:
    """Last goals of one servo; None before torque is on."""

    minimum: int
    maximum: int
    step: float
    bend: float
    rest_s: float
    pin_tick: float
    last: int | None = None
    before: int | None = None
    at_s: float = 0.0
    credit: float = math.inf
    faulted_s: float | None = None
    alerts: int = 0
    told_s: float = math.inf
    told_tick: int | None = None

    def well(self) -> None:
        """Clear the record of a latched fault."""
        self.faulted_s, self.alerts, self.told_s, self.told_tick = None, 0, math.inf, None


@dataclass
class Audit:
    """Collects goals and violations of one robot.

    Attributes:
        measure: returns the servos' true ticks, for contacts that were not commanded; None where these are unknown.
        goals: goals received.
        waiting_goals: number of goals that may come at once.
        violations: by kind.
        writes_in_fault: goals to a servo whose fault has taken its torque, after a grace of 0.1 s. They move nothing: a group
            is told to hold, and the servo belongs to it. Goals that move the servo are violations.
        body_contacts: steps in which the body (MuJoCo) touched itself.
        led_contacts: body contacts while every servo had torque: the goals led the robot there, it did not fall.
        details: description of the first violations.
    """

    robot: RobotModel
    measure: Callable[[], list[int]] | None = None
    goals: int = 0
    waiting_goals: int = HURRY_GOALS
    violations: Counter[str] = field(default_factory=Counter[str])
    writes_in_fault: int = 0
    body_contacts: int = 0
    led_contacts: int = 0
    details: list[str] = field(default_factory=list[str])

    def __post_init__(self) -> None:
        """Bounds in ticks for each servo."""
        period = self.robot.bus.period_s
        self._tracks: dict[int, _Track] = {}
        self.contacts = ContactAudit(self.robot, self.measure)
        ticks = JointServoMap(self.robot)
        bounds = zip(
            ticks.position_min_tick.tolist(), ticks.position_max_tick.tolist(), ticks.velocity_limit_tick_s.tolist(),
            ticks.acceleration_limit_tick_s2.tolist(), strict=True,
        )  # fmt: skip
        for servo, (low, high, velocity, acceleration) in zip(self.robot.servos, bounds, strict=True):
            pin_tick = PIN_TOLERANCE_TICK * max(1.0, servo.model.ticks_per_turn / _TICKS_PER_TURN)
            step, bend = velocity * period + 1.0, acceleration * period**2 + 2.0
            rest_s = velocity / acceleration + FAULT_GRACE_S
            self._tracks[servo.servo_id] = _Track(low, high, step, bend, rest_s, pin_tick)

    def torque(self, t_s: float, servo_id: int, on: bool, goal_tick: int, present_tick: int) -> None:
        """Record that torque was switched on or off."""
        track = self._tracks.get(servo_id)
        if track is None:
            return
        track.last = track.before = goal_tick if on else None
        track.well()
        if on:
            self.contacts.begin(servo_id, goal_tick)
        if on and abs(goal_tick - present_tick) > track.pin_tick:
            self._violate(t_s, servo_id, "unpinned_torque", f"goal {goal_tick}, standing at {present_tick}")

    def torque_in_fault(self, t_s: float, servo_id: int) -> None:
        """Count a request for torque on a servo with a latched fault, unless the servo has not answered since."""
        track = self._tracks.get(servo_id)
        if track is None or track.alerts:
            self._violate(t_s, servo_id, "torque_in_fault", "it has to be rebooted first")

    def torque_limit(self, t_s: float, servo_id: int, limit: int, most: int) -> None:
        """Count a torque limit for a servo of Protocol 1.0 above `most`, the maximum that its owner has set."""
        if limit > most:
            self._violate(t_s, servo_id, "torque_limit", f"{limit}, its max torque is {most}")

    def heard_in_fault(self, t_s: float, servo_id: int) -> None:
        """Record a complete answer of a servo whose fault has taken its torque, or that its watchdog has stopped."""
        track = self._tracks.get(servo_id)
        if track is not None:
            track.alerts += 1
            if track.alerts == ANSWERS_TOLD:
                track.told_s = t_s

    def goal(self, t_s: float, servo_id: int, tick: int, torque: bool, *, faulted: bool = False) -> None:
        """Check a goal that a servo received."""
        track = self._tracks.get(servo_id)
        if track is None:
            return
        self.goals += 1
        self.contacts.told(t_s, servo_id, tick, track.last is not None)
        if not torque:
            self._count_in_fault(track, t_s, faulted)
            self._judge_in_fault(track, t_s, servo_id, tick)
            return
        track.well()
        # a joint that was outside its range when torque came on may only come back
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
        self._count_hurry(track, t_s, servo_id, tick)
        track.before, track.last = track.last, tick

    def missed(self, t_s: float, servo_id: int, tick: int) -> None:
        """Record a goal that was lost on the wire: the next goal is a step from this one, not from the last one received."""
        track = self._tracks.get(servo_id)
        if track is not None and track.last is not None:
            track.before, track.last = track.last, tick
            self.contacts.told(t_s, servo_id, tick, torque=True)

    def refused(self, t_s: float, servo_id: int, code: int, *, faulted: bool = False, tripped: bool = False) -> None:
        """Count a goal that a servo refused: it was beyond the servo's limits, or its watchdog had stopped the servo.

        A servo that has not answered since its watchdog `tripped` may get goals: the client cannot know of the trip.
        """
        track = self._tracks.get(servo_id)
        if track is not None and (faulted or (tripped and t_s <= track.told_s + FAULT_GRACE_S)):
            self._count_in_fault(track, t_s, faulted=True)
        else:
            self._violate(t_s, servo_id, "refused_goal", f"error code {code}")

    def report(self) -> dict[str, Any]:
        """All figures as plain values."""
        return {
            "robot": self.robot.name,
            "goals": self.goals,
            "violations": sum(self.violations.values()),
            "violations_by_kind": dict(self.violations),
            "writes_in_fault": self.writes_in_fault,
            "body_contacts": self.body_contacts,
            "led_contacts": self.led_contacts,
            "details": self.details,
            **self.contacts.report(),
        }

    def touched(self, steps: int, *, led: bool) -> None:
        """Count `steps` in which the body touched itself; `led`: whether every servo had torque."""
        self.body_contacts += steps
        self.led_contacts += steps if led else 0

    def check_poses(self) -> None:
        """Check the poses collected so far for self-contact, and forget them: for runs of hours."""
        self.contacts.check()

    def _count_in_fault(self, track: _Track, t_s: float, faulted: bool) -> None:
        if not faulted:
            track.well()
            return
        if track.faulted_s is None:
            track.faulted_s = t_s
        self.writes_in_fault += t_s > track.faulted_s + FAULT_GRACE_S

    def _judge_in_fault(self, track: _Track, t_s: float, servo_id: int, tick: int) -> None:
        """Check a goal for a servo that has reported its trip: the servo may be told to stand still with its group, no more."""
        if t_s > track.told_s + track.rest_s and track.told_tick not in (None, tick):
            self._violate(
                t_s, servo_id, "goal_in_fault", f"led from {track.told_tick} to {tick}, though it has tripped"
            )
        track.told_tick = tick

    def _count_hurry(self, track: _Track, t_s: float, servo_id: int, tick: int) -> None:
        """Count goals that move the servo against the time since the last ones."""
        earned = (t_s - track.at_s) * self.robot.bus.rate_hz * HURRY_RATE
        track.credit, track.at_s = min(float(self.waiting_goals), track.credit + max(0.0, earned)), max(track.at_s, t_s)
        if tick == track.last:
            return
        track.credit -= 1
        if track.credit < 0:
            track.credit = 0.0
            rate_hz = self.robot.bus.rate_hz
            self._violate(
                t_s, servo_id, "hurry", f"more than {self.waiting_goals} goals faster than {rate_hz:g} a second"
            )

    def _violate(self, t_s: float, servo_id: int, kind: str, text: str) -> None:
        self.violations[kind] += 1
        if len(self.details) < _MAX_DETAILS:
            self.details.append(f"{t_s:.3f} s, servo {servo_id}: {kind}: {text}")
