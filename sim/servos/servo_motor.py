"""A simulated servo's control table and motor: registers drive the motor, and measurements are stored in registers.

Frames: the drive counts the shaft's ticks; the registers count with sign, homing offset and whole turns.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from typing import ClassVar

from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED, WATCHDOG_UNIT_S, Item
from retarget.robot.robot import ServoSpec
from sim.errors import SimSettingError
from sim.servos.drives import POSITION_MODES, STEP_S, Drives, Mode
from sim.servos.memory import Memory

_FIRMWARE = {"x330": 52, "mx1": 41, "ax": 24}
_FIRMWARE_OTHER = 45
"""Firmware version of simulated servos by default; for Y and P any version would do."""
_LIVE_AT = range(120, 147)
_LIVE = struct.Struct("<HBBhhiiiiHB")  # realtime tick 120 ... temperature 146, side by side; P: 568 ... 594
_MS_PER_S, _TICK_WRAP_MS = 1000, 32768
_RECTANGULAR, _TRIANGULAR, _TRAPEZOIDAL = 0x10, 0x20, 0x30
"""Type of the profile in the moving status (e-manual, "Moving Status", bits 4 and 5)."""


class ServoMotor:
    """One servo of Protocol 2.0 as its registers count it.

    Attributes:
        spec, model, firmware: identity of the servo.
        index: row of its motor in `drives`.
        memory: its control table.
        baud: bits per second at which the servo receives; 0 for a baud code without meaning.
        watchdog_tripped: whether its bus watchdog has run out; it refuses goals until the watchdog is cleared.
    """

    _measured_at = _LIVE_AT
    _most_offset_in_position_mode: ClassVar[float] = 1024
    """Homing offset in ticks beyond which position mode ignores it (e-manual, "Homing Offset")."""
    _assumed: ClassVar[Mapping[str, int]] = {}
    """Initial values of items for which the manual gives none."""

    def __init__(self, spec: ServoSpec, drives: Drives, index: int, firmware: int | None = None) -> None:
        number = spec.model.model_number
        if number not in MODELS:
            raise SimSettingError(f"servo {spec.servo_id}: model number", str(number), ", ".join(map(str, MODELS)))
        self.spec, self.model, self.index = spec, MODELS[number], index
        self.drives = drives
        self.firmware = firmware if firmware is not None else _FIRMWARE.get(self.model.family, _FIRMWARE_OTHER)
        self.memory = Memory(self.model, self.firmware, self._measured_at, self._assumed)
        self.rad_per_tick = float(drives.rad_per_tick[index])
        self._tick_s_per_unit = self._speed_unit_rad_s() / self.rad_per_tick
        self._pwm_full = self._full_duty()
        has_current = self.model.has_current
        self._raw_per_ampere = 1e3 / self.items["present_current"].scale if has_current else 0.0
        self.baud = 0
        self._torque = False
        self._fed_s = 0.0
        self._watchdog_s = math.inf
        self.watchdog_tripped = False
        self._turn_tick = 0.0
        self._sign, self._homing_tick, self._threshold_tick_s = 1, 0, 0.0
        self._profile_type = 0
        self._top_tick_s = self._bend_tick_s2 = math.inf
        self._now_s = 0.0
        self._set("model_number", number)
        self._set("firmware_version", self.firmware)
        self._set("id", spec.servo_id)

    def _speed_unit_rad_s(self) -> float:
        return self.items["present_velocity"].scale

    def _full_duty(self) -> int:
        """Value of goal_pwm and present_pwm that stands for full duty."""
        return self.items["pwm_limit"].high or 0

    @property
    def servo_id(self) -> int:
        """Bus id."""
        return self.memory.get("id")

    @property
    def items(self) -> dict[str, Item]:
        """Items of the control table."""
        return self.memory.items

    @property
    def torque(self) -> bool:
        """Whether torque is on."""
        return self._torque

    @property
    def position_tick(self) -> float:
        """True position in ticks of the register, with fractions."""
        return self._to_register(float(self.drives.position_tick[self.index]))

    @position_tick.setter
    def position_tick(self, tick: float) -> None:
        self.drives.place(self.index, self._to_shaft(tick))

    def get(self, name: str) -> int:
        """Value of an item; measured items are refreshed first."""
        if name.startswith(("present_", "moving", "realtime", "velocity_traj", "position_traj")):
            self._refresh()
        return self.memory.get(name)

    def _set(self, name: str, value: int) -> None:
        self.memory.set(name, value)

    def _set_if(self, name: str, value: int) -> None:
        if name in self.items:
            self._set(name, value)

    # From registers to the motor.

    def _set_torque(self, on: bool) -> None:
        self._set("torque_enable", int(on))
        if on and not self.torque:
            self.drives.start(self.index)
            self._fed_s = self._now_s
        self._torque = self.drives.torque[self.index] = on
        self.drives.touch()

    def _goal_here(self) -> None:
        tick = round(self.position_tick)
        self._set("goal_position", tick)
        self.drives.set_goal(self.index, self._to_shaft(tick))

    def _configure(self) -> None:
        """Pass the settings in the registers to the drive."""
        get, i, d = self.memory.get, self.index, self.drives
        self._sign = -1 if get("drive_mode") & 1 else 1
        self._threshold_tick_s = get("moving_threshold") * self._tick_s_per_unit
        units = 1.0 / self._pwm_full
        mode, offset = get("operating_mode"), get("homing_offset")
        ignored = mode == Mode.POSITION and abs(offset) > self._most_offset_in_position_mode
        self._homing_tick = 0 if ignored else offset
        d.mode[i] = mode
        pwm = get("goal_pwm")
        d.goal_duty[i] = self._sign * pwm * units
        d.limit_duty[i] = (get("pwm_limit") if mode == Mode.PWM else min(abs(pwm), get("pwm_limit"))) * units
        if "goal_current" in self.items:
            ampere = self.items["goal_current"].scale * 1e-3
            goal = get("goal_current")
            most = min(abs(goal), get("current_limit")) if mode == Mode.CURRENT_POSITION else get("current_limit")
            d.goal_a[i], d.limit_a[i] = self._sign * goal * ampere, most * ampere
        d.goal_tick_s[i] = self._sign * get("goal_velocity") * self._tick_s_per_unit
        self._set_gains()
        self._top_tick_s, self._bend_tick_s2 = d.profile_tick_s[i], d.profile_tick_s2[i] = self._profile()
        self.baud = self.model.baud_of_code(get("baud_rate")) or 0
        watchdog = get("bus_watchdog")
        has = watchdog > 0 and self.model.has_watchdog(self.firmware)
        self._watchdog_s = watchdog * WATCHDOG_UNIT_S if has else math.inf
        self.watchdog_tripped = watchdog == WATCHDOG_TRIPPED
        d.touch()

    def _set_gains(self) -> None:
        """Set the loop gains as in the block diagrams of the manual, in PWM units."""
        get, i, d, units = self.memory.get, self.index, self.drives, 1.0 / self._pwm_full
        d.p_gain[i] = get("position_p_gain") / 128 * units
        d.i_gain[i] = get("position_i_gain") / 65536 * units * _MS_PER_S
        d.d_gain[i] = get("position_d_gain") / 16 * units / _MS_PER_S
        d.velocity_p_gain[i] = get("velocity_p_gain") / 128 * units / self._tick_s_per_unit
        d.velocity_i_gain[i] = get("velocity_i_gain") / 65536 * units * _MS_PER_S / self._tick_s_per_unit
        d.feedforward_1[i] = get("feedforward_1st_gain") / 4 * units / self._tick_s_per_unit
        d.feedforward_2[i] = get("feedforward_2nd_gain") / 4 * units / self._tick_s2_per_unit

    def _profile(self) -> tuple[float, float]:
        """Top speed and acceleration of the profile in ticks; inf for none."""
        velocity, acceleration = self.memory.get("profile_velocity"), self.memory.get("profile_acceleration")
        if not self.memory.get("drive_mode") & 4:
            bend = acceleration * self._tick_s2_per_unit if acceleration else math.inf
            if not velocity:  # a step, but in velocity mode (e-manual, "Profile Velocity", types of profile)
                return math.inf, bend if self.memory.get("operating_mode") == Mode.VELOCITY else math.inf
            return min(velocity, self.memory.get("velocity_limit")) * self._tick_s_per_unit, bend
        if not velocity:
            return math.inf, math.inf
        whole_s = velocity / _MS_PER_S  # time-based profile: milliseconds from start to end, and of speeding up
        ramp_s = min(acceleration / _MS_PER_S, whole_s / 2)
        way = abs(float(self.drives.goal_tick[self.index] - self.drives.path_tick[self.index]))
        top = max(way, 1e-3) / max(whole_s - ramp_s, STEP_S)
        return top, top / ramp_s if ramp_s else math.inf

    def _type_of_profile(self) -> int:
        """Type of profile that a goal position leads to; from rest, as the manual assumes."""
        in_time = self.memory.get("drive_mode") & 4  # a profile in time, whose speed depends on the distance
        top, bend = self._profile() if in_time else (self._top_tick_s, self._bend_tick_s2)
        way = abs(float(self.drives.goal_tick[self.index] - self.drives.path_tick[self.index]))
        if math.isinf(top):
            return 0
        if math.isinf(bend):
            return _RECTANGULAR
        return _TRAPEZOIDAL if way * bend > top**2 * (1 + 1e-9) else _TRIANGULAR

    @property
    def _tick_s2_per_unit(self) -> float:
        return self.items["profile_acceleration"].scale / self.rad_per_tick

    def _to_register(self, shaft_tick: float) -> float:
        tick = shaft_tick - self._turn_tick
        if self._sign < 0:
            tick = self.model.ticks_per_turn - tick
        return tick + self._homing_tick

    def _to_shaft(self, register_tick: float) -> float:
        tick = register_tick - self._homing_tick
        if self._sign < 0:
            tick = self.model.ticks_per_turn - tick
        return tick + self._turn_tick

    def _refresh(self) -> None:
        """Write measured values into the table."""
        position, velocity, current, duty, voltage, temperature, path, path_speed = self.drives.live()[self.index]
        sign, per_unit = self._sign, self._tick_s_per_unit
        moving = abs(velocity) > self._threshold_tick_s
        here = self._to_register(position)
        in_position_mode = self.memory.get("operating_mode") in POSITION_MODES
        arrived = in_position_mode and abs(self.memory.get("goal_position") - here) < 10
        status = int(arrived) | int(in_position_mode and path_speed != 0) << 1 | self._profile_type
        if self._raw_per_ampere:
            effort = sign * current * self._raw_per_ampere
        else:
            effort = sign * duty * 1000
        self.memory.measure(
            _LIVE, int(self._now_s * _MS_PER_S) % _TICK_WRAP_MS, int(moving), status,
            round(sign * duty * self._pwm_full), round(effort), round(sign * velocity / per_unit), round(here),
            round(sign * path_speed / per_unit), round(self._to_register(path)),
            max(0, round(voltage * 10)), max(0, min(255, round(temperature))),
        )  # fmt: skip
