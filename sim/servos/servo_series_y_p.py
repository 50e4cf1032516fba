"""Simulated DYNAMIXEL-Y and -P: the registers that behave unlike those of X.

ROBOTIS e-manual, "Control Table" of YM070-210-R099-RH and PH42-020-S300-R. Our own estimates, as the manual gives no scale:
the scale of the gains, and the initial gains of P. Not modelled for Y: the current loop, position I and D gain, feed-forward,
low-pass filters, offsets, dynamic brake, safe stop time and the time in which torque comes on or goes; following-error,
over-speed and position-limit errors; the battery; clearing whole turns (refused) and clearing errors without a reboot.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from typing import ClassVar

from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED, Item
from daemon.dynamixel.registers.registers_series_y_p import HOLDING_ERRORS
from sim.servos.drives import STEP_S
from sim.servos.servo import SimServo
from sim.servos.servo_power import ENCODER_BIT, HEAT_BIT, OVERLOAD_BIT, VOLTAGE_BIT

_LIMIT_OF = {
    "goal_velocity": "velocity_limit", "goal_current": "current_limit", "goal_pwm": "pwm_limit",
    "profile_velocity": "velocity_limit", "profile_acceleration": "acceleration_limit", "current_offset": "current_limit",
    "velocity_offset": "velocity_limit", "pwm_offset": "pwm_limit",
}  # fmt: skip
_LIVE_Y = struct.Struct("<BHhhii4xiiHBB")  # moving status 541 ... motor temperature 571
_IN_POSITION, _PROFILE_ONGOING, _MOVING, _IN_RANGE = 0x01, 0x02, 0x04, 0x40
_WATCHDOG_ERROR, _OVER_VOLTAGE, _LOW_VOLTAGE = 18, 1, 2
_CODES = {HEAT_BIT: 4, OVERLOAD_BIT: 5, ENCODER_BIT: 13}
_LOOP_PER_S, _LOOP_GAIN = 25.0, 6283185
"""Position gain from the factory in 1/s, the rate at which a position error decays, and its register value (our estimate)."""
_TURNING, _TURNING_PER_S = 3.0, 10.0
"""Velocity P and I gain from the factory, as shares of the duty that the speed itself takes (our estimate)."""


class SimServoP(SimServo):
    """Registers of one P: as those of X at other addresses, with positions counted from the middle of the range."""

    _measured_at = range(568, 595)
    _position_range: ClassVar[Mapping[int, float]] = {}
    _most_offset_in_position_mode: ClassVar[float] = math.inf
    _limit_of: ClassVar[Mapping[str, str]] = _LIMIT_OF
    _assumed: ClassVar[Mapping[str, int]] = {"position_p_gain": 20, "velocity_p_gain": 20, "velocity_i_gain": 190}

    def _set_up(self) -> None:
        super()._set_up()
        if "shutdown" in self.items:
            self._set("shutdown", self.memory.get("shutdown") | HEAT_BIT | OVERLOAD_BIT)  # not of heat from the factory

    def _whole_turns(self) -> float:
        turn = self.model.ticks_per_turn
        return math.floor(float(self.drives.position_tick[self.index]) / turn + 0.5) * turn

    def _profile(self) -> tuple[float, float]:
        return super()._profile() if self.memory.get("profile_velocity") else (math.inf, math.inf)

    def _to_register(self, shaft_tick: float) -> float:
        return self._sign * (shaft_tick - self._turn_tick) + self._homing_tick

    def _to_shaft(self, register_tick: float) -> float:
        return self._sign * (register_tick - self._homing_tick) + self._turn_tick


class SimServoY(SimServoP):
    """Registers of one Y: error codes in place of bits, whole turns kept without power, loops within loops."""

    _measured_at = range(541, 572)
    _assumed: ClassVar[Mapping[str, int]] = {}

    def _set_up(self) -> None:
        super()._set_up()
        self._set("profile_velocity", 0)

    @property
    def is_faulted(self) -> bool:
        """Whether a latched error has taken the servo's torque."""
        return self.error not in (0, *HOLDING_ERRORS)

    def trip(self, hardware_error: int) -> None:
        """Latch the error that corresponds to these bits of an X: the first error stays until a reboot, and takes the torque."""
        if self.is_faulted:
            return
        over = float(self.drives.live()[self.index][4]) * 10 > self.memory.get("max_voltage_limit")
        code = (_OVER_VOLTAGE if over else _LOW_VOLTAGE) if hardware_error == VOLTAGE_BIT else _CODES[hardware_error]
        self._tell(code)
        self._set_torque(False)

    def _latch(self, bit: int) -> None:
        self.trip(bit)

    def _tell(self, code: int) -> None:
        """Store a new error code, and add it to the history of the last sixteen."""
        for i in range(16, 1, -1):
            self._set(f"error_code_history_{i}", self.memory.get(f"error_code_history_{i - 1}"))
        self._set("error_code_history_1", code)
        self._set("error_code", code)

    def watch(self, t_s: float) -> None:
        """Run the bus watchdog, whose trip is an error of its own in this family."""
        was = self.watchdog_tripped
        super().watch(t_s)
        if self.watchdog_tripped and not was and not self.error:
            self._tell(_WATCHDOG_ERROR)

    def _accept(self, item: Item, value: int) -> None:
        super()._accept(item, value)
        if item.name == "bus_watchdog" and value != WATCHDOG_TRIPPED and self.error == _WATCHDOG_ERROR:
            self._set("error_code", 0)

    def clear_turns(self) -> bool:
        """Refuse to clear whole turns, which is not modelled: on a servo with a gear the zero would move."""
        return False

    def _whole_turns(self) -> float:
        return 0.0

    def _set_gains(self) -> None:
        get, i, d = self.memory.get, self.index, self.drives
        self._threshold_tick_s = get("moving_threshold") * self.items["moving_threshold"].scale * 1e3
        top_tick_s = self.spec.model.no_load_speed_rad_s / self.rad_per_tick
        d.p_gain[i] = get("position_p_gain") / _LOOP_GAIN * _LOOP_PER_S / top_tick_s
        d.velocity_p_gain[i] = (
            get("velocity_p_gain") / (self.items["velocity_p_gain"].initial or 1) * _TURNING / top_tick_s
        )
        d.velocity_i_gain[i] = (
            get("velocity_i_gain") / (self.items["velocity_i_gain"].initial or 1) * _TURNING_PER_S / top_tick_s
        )

    def _profile(self) -> tuple[float, float]:
        """Top speed and acceleration of the profile in ticks; time-based profiles have items of their own."""
        get = self.memory.get
        if not get("drive_mode") & 4:
            return super()._profile()
        whole_s, ramp_s = (get(name) * 0.2e-3 for name in ("profile_time", "profile_acceleration_time"))
        if not whole_s:
            return math.inf, math.inf
        ramp_s = min(ramp_s, whole_s / 2)
        way = abs(float(self.drives.goal_tick[self.index] - self.drives.path_tick[self.index]))
        top = max(way, 1e-3) / max(whole_s - ramp_s, STEP_S)
        return top, top / ramp_s if ramp_s else math.inf

    def _refresh(self) -> None:
        position, velocity, current, duty, voltage, temperature, path, path_speed = self.drives.live()[self.index]
        get, sign = self.memory.get, self._sign
        here = self._to_register(position)
        status = _IN_POSITION * (abs(get("goal_position") - here) <= get("in_position_threshold"))
        status |= _PROFILE_ONGOING * (path_speed != 0) | _MOVING * (abs(velocity) > self._threshold_tick_s)
        status |= _IN_RANGE * (get("min_position_limit") <= here <= get("max_position_limit"))
        heat = max(0, min(255, round(temperature)))  # one case for motor and inverter
        self.memory.measure(
            _LIVE_Y, status, int(self._now_s * 1000) % 32768, round(sign * duty * self._pwm_full),
            round(sign * current / (self.items["present_current"].scale * 1e-3)),
            round(sign * velocity / self._tick_s_per_unit), round(here), round(self._to_register(path)),
            round(sign * path_speed), max(0, round(voltage * 100)), heat, heat,
        )  # fmt: skip
