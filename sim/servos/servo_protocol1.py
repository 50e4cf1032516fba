"""One simulated servo of Protocol 1.0 (AX and MX): its own table, error bits in place of error numbers, no reboot.

ROBOTIS e-manual, "Control Table" of AX-12A, AX-18A, MX-28, MX-64, MX-106. Where the manual is silent we chose: a goal
outside the angle limits is refused, not clipped; torque or torque limit written again clears a latched alarm once its
cause is over.
"""

from __future__ import annotations

import math

from daemon.dynamixel.registers.registers import Item
from sim.servos.drives import Mode
from sim.servos.servo import Errors, SimServo
from sim.servos.servo_power import HEAT_BIT, OVERLOAD_BIT

VOLTAGE_ERROR, ANGLE_ERROR, HEAT_ERROR, RANGE_ERROR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
CHECKSUM_ERROR, OVERLOAD_ERROR, INSTRUCTION_ERROR = 1 << 4, 1 << 5, 1 << 6
_FULL = 1023
_AMPERE_PER_UNIT, _ZERO_CURRENT = 0.0045, 2048  # MX-64/106 present current (e-manual, address 68)
_COOLER_C = 5.0


class SimServo1(SimServo):
    """Registers of one AX or MX of Protocol 1.0."""

    errors = Errors(INSTRUCTION_ERROR, INSTRUCTION_ERROR, INSTRUCTION_ERROR, RANGE_ERROR, CHECKSUM_ERROR)
    _strict_reads = False
    has_encoder_error = False
    _measured_at = range(0)

    @property
    def is_faulted(self) -> bool:
        """Whether a latched alarm has taken the servo's torque."""
        return bool(self._alarm & self.memory.get("shutdown"))

    @property
    def _is_wheel(self) -> bool:
        return self.memory.get("min_position_limit") == 0 == self.memory.get("max_position_limit")

    def _set_up(self) -> None:
        self._alarm = 0
        self._set("return_delay_time", 0)

    def trip(self, hardware_error: int) -> None:
        """Latch an alarm; where the shutdown mask contains it, torque goes off and the torque limit becomes zero."""
        self._alarm |= hardware_error
        if self.is_faulted:
            self._set("torque_limit", 0)
            self._set_torque(False)

    def alert(self) -> int:
        """The alarm's bits for the error byte of a status packet."""
        return self._alarm

    def _power_on(self, *, was_on: bool = False) -> None:
        self._alarm, self._pending, self._turn_tick = 0, None, 0.0
        self._set_torque(False)
        self._set("torque_limit", self.memory.get("max_torque"))
        self._goal_here()
        self._configure()

    def _refusal(self, item: Item, value: int) -> int:
        if item.eeprom and self.torque:
            return INSTRUCTION_ERROR
        if not item.takes(value) or (item.name == "moving_speed" and value < 0 and not self._is_wheel):
            return RANGE_ERROR
        if item.name == "goal_position" and not self._is_wheel:
            low, high = self.memory.get("min_position_limit"), self.memory.get("max_position_limit")
            return 0 if low <= value <= high else ANGLE_ERROR
        if item.name == "torque_enable" and value and self.is_faulted and not self._recovered():
            return OVERLOAD_ERROR
        return 0

    def _accept(self, item: Item, value: int) -> None:
        if item.name == "goal_position":
            self._set(item.name, value)
            self.drives.set_goal(self.index, self._to_shaft(value))
            if not self.torque and not self.is_faulted:
                self._set_torque(True)  # AX and MX switch torque on with a goal (e-manual, "Torque Enable")
        elif item.name == "torque_enable":
            self._set_torque(bool(value))
        else:
            self._set(item.name, value)
            if item.name == "torque_limit" and value:
                self._recovered()
            self._configure()

    def _recovered(self) -> bool:
        """Clear an alarm whose cause is over; return whether no alarm is left."""
        hot = self.drives.temperature_c[self.index] > self.memory.get("temperature_limit") - _COOLER_C
        loaded = self.drives.load[self.index] > 0.5
        if (self._alarm & HEAT_BIT and hot) or (self._alarm & OVERLOAD_BIT and loaded):
            return False
        self._alarm = 0
        if not self.memory.get("torque_limit"):
            self._set("torque_limit", self.memory.get("max_torque"))
        return True

    def _configure(self) -> None:
        get, i, d = self.memory.get, self.index, self.drives
        self.baud = self.model.baud_of_code(get("baud_rate")) or 0
        speed = get("moving_speed")
        per_unit = self._tick_s_per_unit
        d.mode[i] = Mode.VELOCITY if self._is_wheel else Mode.POSITION
        d.limit_duty[i] = get("torque_limit") / _FULL  # max torque is only what it begins with (manual, address 14)
        d.goal_tick_s[i] = speed * per_unit
        d.velocity_p_gain[i], d.velocity_i_gain[i] = 1.0 / (50 * per_unit), 1.0 / (5 * per_unit)
        d.profile_tick_s[i] = abs(speed) * per_unit if speed and not self._is_wheel else math.inf
        d.profile_tick_s2[i] = math.inf
        if "cw_compliance_slope" in self.items:  # AX: proportional within the slope, nothing within the margin
            d.p_gain[i] = 1.0 / max(1, (get("cw_compliance_slope") + get("ccw_compliance_slope")) / 2)
            d.deadband_tick[i] = (get("cw_compliance_margin") + get("ccw_compliance_margin")) / 2
            d.punch_duty[i] = get("punch") / _FULL
        else:
            d.p_gain[i] = get("position_p_gain") / 8 / _FULL
            d.i_gain[i] = get("position_i_gain") * 1000 / 2048 / _FULL
            d.d_gain[i] = get("position_d_gain") * 4 / 1000 / _FULL
            acceleration = get("goal_acceleration")
            if acceleration:
                d.profile_tick_s2[i] = acceleration * self.items["goal_acceleration"].scale / self.rad_per_tick
        d.touch()

    def _speed_unit_rad_s(self) -> float:
        return self.items["present_speed"].scale

    def _full_duty(self) -> int:
        return _FULL

    @property
    def error(self) -> int:
        """The alarm's bits."""
        return self._alarm

    def _to_register(self, shaft_tick: float) -> float:
        return shaft_tick

    def _to_shaft(self, register_tick: float) -> float:
        return register_tick

    def watch(self, t_s: float) -> None:
        """Do nothing: these models have no bus watchdog."""
        self._now_s = t_s

    def _latch(self, bit: int) -> None:
        if not self._alarm & bit:
            self.trip(bit)

    def _refresh(self) -> None:
        position, velocity, current, duty, voltage, temperature, path, _ = self.drives.live()[self.index]
        most = (1 << 10) - 1
        top = self.items["present_position"]
        low, high = (-28672, 28672) if top.signed else (0, most)
        self._set("present_position", max(low, min(high, round(position))))
        self._set("present_speed", max(-most, min(most, round(velocity / self._tick_s_per_unit))))
        self._set("present_load", max(-most, min(most, round(duty * _FULL))))
        self._set("present_input_voltage", max(0, min(255, round(voltage * 10))))
        self._set("present_temperature", max(0, min(255, round(temperature))))
        self._set("moving", int(abs(path - self.drives.goal_tick[self.index]) > 1))
        if "present_current" in self.items:
            self._set("present_current", max(0, min(4095, _ZERO_CURRENT + round(current / _AMPERE_PER_UNIT))))
        if "realtime_tick" in self.items:
            self._set("realtime_tick", int(self._now_s * 1000) % 32768)
