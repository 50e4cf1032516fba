"""The control loops and motors of all servos of a robot, one array element a servo.

A fixed grid of 2 ms steps, so that the result does not depend on when the drives are read. In each step: profile (trapezoid)
-> PID and feed-forward, or the loop of the operating mode -> PWM limit -> current through the winding, limited -> torque on
the body. Every tenth step: supply voltage, heating, load filter. Gains are scaled as in the block diagrams of the
ROBOTIS e-manual (XM430-W350, "Position PID Gain", "Velocity PI Gain"); sums and differences are taken per millisecond,
which the manual leaves open.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from sim.bodies.body import Body
from sim.bodies.motors import Motor

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

STEP_S = 0.002
SLOW_EVERY = 10
_SLOW_S = STEP_S * SLOW_EVERY
ROOM_C = 25.0
_LOAD_FILTER_S = 2.0
"""Seconds, time constant of the load that the overload check uses (our estimate; the manual says 'persistent')."""
_SUPPLY_OHM = 0.05
"""Ohms of supply and cables, shared by the servos of one rated voltage (our estimate)."""


class Mode(IntEnum):
    """Operating modes (e-manual, "Operating Mode")."""

    CURRENT = 0
    VELOCITY = 1
    POSITION = 3
    EXTENDED_POSITION = 4
    CURRENT_POSITION = 5
    PWM = 16


POSITION_MODES = (Mode.POSITION, Mode.EXTENDED_POSITION, Mode.CURRENT_POSITION)


class Drives:
    """Loops and motors of S servos; positions in ticks of each servo, voltages as shares of the supply.

    Attributes that the servos set (call `touch` afterwards): `mode`, `torque`, `goal_tick`, `goal_tick_s`, `goal_a`, `goal_duty`,
    `limit_duty`, `limit_a`, gains, `profile_tick_s` and `profile_tick_s2` (inf for none), `deadband_tick`, `supply_share`.
    """

    def __init__(
        self, motors: Sequence[Motor], rad_per_tick: Sequence[float], backlash_tick: Sequence[float], body: Body
    ) -> None:
        n = len(motors)
        self.n, self.body = n, body
        self.rad_per_tick: Array = np.array(rad_per_tick)
        self._resistance: Array = np.array([m.resistance_ohm for m in motors])
        self._torque_per_a: Array = np.array([m.torque_nm_per_a for m in motors])
        self._emf_per_tick_s: Array = np.array([m.emf_v_s_per_rad for m in motors]) * self.rad_per_tick
        self._rated_v: Array = np.array([m.rated_v for m in motors])
        self._stall_a: Array = np.array([m.stall_current_a for m in motors])
        self._heating: Array = np.array([m.heating_k_per_j for m in motors])
        self._cooling: Array = np.array([m.cooling_per_s for m in motors])
        self._half_play: Array = np.array(backlash_tick) / 2
        self._supplies = [np.flatnonzero(self._rated_v == v) for v in np.unique(self._rated_v)]

        self.mode: NDArray[np.int64] = np.full(n, Mode.POSITION, np.int64)
        self.torque: Mask = np.zeros(n, bool)
        self.stuck: Mask = np.zeros(n, bool)
        self.goal_tick = body.position_rad / self.rad_per_tick
        self.goal_tick_s, self.goal_a, self.goal_duty = np.zeros(n), np.zeros(n), np.zeros(n)
        self.limit_duty, self.limit_a = np.ones(n), np.full(n, np.inf)
        self.p_gain, self.i_gain, self.d_gain = np.zeros(n), np.zeros(n), np.zeros(n)
        self.velocity_p_gain, self.velocity_i_gain = np.zeros(n), np.zeros(n)
        self.feedforward_1, self.feedforward_2 = np.zeros(n), np.zeros(n)
        self.deadband_tick, self.punch_duty = np.zeros(n), np.zeros(n)
        self.profile_tick_s, self.profile_tick_s2 = np.full(n, np.inf), np.full(n, np.inf)
        self.supply_share = np.ones(n)

        self.position_tick: Array = body.position_rad / self.rad_per_tick
        self.velocity_tick_s: Array = np.zeros(n)
        self.path_tick: Array = self.position_tick.copy()
        self.path_tick_s: Array = np.zeros(n)
        self.duty: Array = np.zeros(n)
        self.current_a: Array = np.zeros(n)
        self.voltage_v: Array = self._rated_v.copy()
        self.temperature_c: Array = np.full(n, ROOM_C)
        self.load: Array = np.zeros(n)
        """Filtered share of the stall current."""
        self._sum: Array = np.zeros(n)
        self._last_error: Array = np.zeros(n)
        self._steps = 0
        self._quiet = False
        self._plain = True
        self._rows: list[tuple[float, ...]] | None = None
        self._path_tick_s2: Array = np.zeros(n)
        self._ramp_tick_s: Array = np.zeros(n)
        self.touch()

    def set_goal(self, i: int, tick: float) -> None:
        """Set a new goal position of servo `i`; an unchanged goal costs nothing."""
        if self.goal_tick[i] != tick:
            self.goal_tick[i] = tick
            self._quiet = False

    def touch(self) -> None:
        """Recompute the values derived from settings, after a setting has changed."""
        self._quiet, self._rows = False, None
        in_position = np.logical_or.reduce([self.mode == mode for mode in POSITION_MODES])
        self._plain = bool(in_position.all()) and not (
            self.i_gain.any() or self.feedforward_1.any() or self.feedforward_2.any() or self.deadband_tick.any()
        )
        self._in_position = in_position
        self._least_duty, self._least_a = -self.limit_duty, -self.limit_a
        self._has_profile = bool((np.isfinite(self.profile_tick_s) | np.isfinite(self.profile_tick_s2)).any())

    def start(self, i: int) -> None:
        """Switch torque of servo `i` on: its path begins at its present position."""
        self.path_tick[i], self.path_tick_s[i] = self.position_tick[i], 0.0
        self._sum[i], self._ramp_tick_s[i] = 0.0, self.velocity_tick_s[i]
        self._last_error[i] = self.goal_tick[i] - self.position_tick[i]

    def place(self, i: int, tick: float) -> None:
        """Set the shaft of servo `i` to a position, at rest."""
        self.body.place(i, tick * float(self.rad_per_tick[i]))
        self.position_tick[i] = self.path_tick[i] = tick
        self.velocity_tick_s[i] = self.path_tick_s[i] = 0.0
        self._quiet, self._rows = False, None

    def live(self) -> list[tuple[float, ...]]:
        """A tuple for each servo: position, velocity, current, duty, voltage, temperature, path position, path velocity."""
        if self._rows is None:
            ramp_tick_s = self._ramp_tick_s * self.torque
            measured = (
                self.position_tick, self.velocity_tick_s, self.current_a, self.duty, self.voltage_v,
                self.temperature_c, self.path_tick, np.where(self.mode == Mode.VELOCITY, ramp_tick_s, self.path_tick_s),
            )  # fmt: skip
            self._rows = list(zip(*(a.tolist() for a in measured), strict=True))
        return self._rows

    def step(self) -> bool:
        """Make one step of the grid; return whether the slow part ran, after which latched errors must be updated."""
        self._steps += 1
        slow = self._steps % SLOW_EVERY == 0
        if not self._quiet:
            self._rows = None
            self._move()
        if slow:
            self._heat()
            self._rows = None
        return slow

    def _move(self) -> None:
        self._follow_path()
        duty = self._position_duty() if self._plain else self._any_duty()
        np.minimum(np.maximum(duty, self._least_duty, out=duty), self.limit_duty, out=duty)
        duty *= self.torque
        voltage = duty * self.voltage_v
        current = (voltage - self._emf_per_tick_s * self.velocity_tick_s) / self._resistance
        np.minimum(np.maximum(current, self._least_a, out=current), self.limit_a, out=current)
        current *= self.torque
        was = self.position_tick
        self.body.step(current * self._torque_per_a, self.stuck, STEP_S)
        shaft = self.body.position_rad / self.rad_per_tick
        self.position_tick = np.minimum(np.maximum(was, shaft - self._half_play), shaft + self._half_play)
        self.velocity_tick_s = self.body.velocity_rad_s / self.rad_per_tick
        steady = self._plain and self.body.at_rest and np.array_equal(self.duty, duty)
        self._quiet = steady and not self.path_tick_s.any() and np.array_equal(was, self.position_tick)
        self.duty, self.current_a = duty, current

    def _follow_path(self) -> None:
        """Advance the profile: at the goal without a profile, else on a trapezoid that ends at the goal at rest."""
        if not self._has_profile:
            self.path_tick_s = np.zeros(self.n)
            self.path_tick = self.goal_tick.copy()
            return
        left = self.goal_tick - self.path_tick
        distance = np.abs(left)
        top, bend = self.profile_tick_s, self.profile_tick_s2 * STEP_S
        with np.errstate(invalid="ignore"):
            braking = np.sqrt(2 * self.profile_tick_s2 * distance + bend**2 / 4) - bend / 2
        wanted = np.minimum(np.minimum(top, np.where(np.isfinite(bend), braking, np.inf)), distance / STEP_S)
        change = np.clip(np.copysign(wanted, left) - self.path_tick_s, -bend, bend)
        free = ~(np.isfinite(top) | np.isfinite(bend)) | ~self.torque
        self._path_tick_s2 = np.where(free, 0.0, change / STEP_S)
        self.path_tick_s = np.where(free, 0.0, self.path_tick_s + change)
        self.path_tick = np.where(free, self.goal_tick, self.path_tick + self.path_tick_s * STEP_S)
        there = np.abs(self.goal_tick - self.path_tick) < 1e-6
        self.path_tick_s[there & (np.abs(self.path_tick_s) <= bend)] = 0.0

    def _position_duty(self) -> Array:
        error = self.path_tick - self.position_tick
        duty = self.p_gain * error + self.d_gain * (error - self._last_error) / STEP_S
        self._last_error = error
        return duty

    def _any_duty(self) -> Array:
        """(S,) duty for any mode and any gains."""
        error = self.path_tick - self.position_tick
        effective = np.copysign(np.maximum(np.abs(error) - self.deadband_tick, 0.0), error)
        held = self.p_gain * effective + self.d_gain * (error - self._last_error) / STEP_S
        held += np.copysign(self.punch_duty, effective) * (effective != 0) + self.i_gain * self._sum
        held += self.feedforward_1 * self.path_tick_s + self.feedforward_2 * self._path_tick_s2
        bend = self.profile_tick_s2 * STEP_S
        self._ramp_tick_s = self._ramp_tick_s + np.clip(self.goal_tick_s - self._ramp_tick_s, -bend, bend)
        slip = self._ramp_tick_s - self.velocity_tick_s
        turned = self.velocity_p_gain * slip + self.velocity_i_gain * self._sum
        in_velocity = self.mode == Mode.VELOCITY
        duty = np.where(self._in_position, held, np.where(in_velocity, turned, self.goal_duty))
        wanted_v = self.goal_a * self._resistance + self._emf_per_tick_s * self.velocity_tick_s
        duty = np.where(self.mode == Mode.CURRENT, wanted_v / np.maximum(self.voltage_v, 0.1), duty)
        free = (np.abs(duty) < self.limit_duty) & self.torque  # no winding up at the limit
        self._sum = np.where(self.torque, self._sum + np.where(in_velocity, slip, error) * STEP_S * free, 0.0)
        self._last_error = error
        return duty

    def _heat(self) -> None:
        """Update the supply under load, the temperature and the filtered load."""
        drawn = np.abs(self.duty * self.current_a)
        for group in self._supplies:
            sag_v = _SUPPLY_OHM * float(drawn[group].sum())
            self.voltage_v[group] = np.maximum(self._rated_v[group] * self.supply_share[group] - sag_v, 0.0)
        loss_w = self.current_a**2 * self._resistance
        self.temperature_c += _SLOW_S * (loss_w * self._heating - (self.temperature_c - ROOM_C) * self._cooling)
        share = np.abs(self.current_a) / self._stall_a
        self.load += (share - self.load) * (_SLOW_S / _LOAD_FILTER_S)
