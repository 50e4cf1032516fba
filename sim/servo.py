"""One simulated servo: register table, torque, motion, watchdog.

Not modelled: gravity and load, backlash and friction, PID gains and profiles (a first-order lag with the model's top
speed and a fixed acceleration stands for them), heating, voltage sag, overload, modes other than position.
"""

from __future__ import annotations

import math

from daemon.bus.models import CONTROL_TABLES
from daemon.bus.packet import ALERT_BIT, ErrorCode
from daemon.bus.registers import (
    EEPROM_END,
    VELOCITY_UNIT_RAD_S,
    WATCHDOG_TRIPPED,
    WATCHDOG_UNIT_S,
    Item,
)
from retarget.robot import ServoSpec

_TABLE_BYTES = 256
_FIRMWARE = 45
_LAG_S = 0.025
"""Time constant with which a servo follows its goal; typical of an XM430 with default gains (our estimate)."""
_ACCELERATION_RAD_S2 = 400.0
_STEP_S = 0.002
_GOALS = ("goal_position", "goal_velocity", "goal_pwm", "goal_current")


class SimServo:
    """Registers and motion of one servo; time is handed in, never read.

    It starts at `position_rad`: of its joint, or what its joints and linkage come to (`ServoSpec`).
    """

    def __init__(self, spec: ServoSpec, position_rad: float) -> None:
        self.spec = spec
        self.items = CONTROL_TABLES[spec.model.model_number]
        self._by_address = {item.address: item for item in self.items.values()}
        self._rad_per_tick = 2 * math.pi / spec.model.ticks_per_turn
        self._memory = bytearray(_TABLE_BYTES)
        self._position_tick = spec.zero_tick + spec.direction * spec.gear_ratio * position_rad / self._rad_per_tick
        self._velocity_tick_s = 0.0
        self._at_s: float | None = None
        self._fed_s = 0.0
        self._set("model_number", spec.model.model_number)
        self._set("firmware_version", _FIRMWARE)
        self._set("id", spec.servo_id)
        self._set("baud_rate", 3)
        self._set("operating_mode", 4 if spec.extended else 3)
        self._set("protocol_type", 2)
        self._set("status_return_level", 2)
        self._set("temperature_limit", 80)
        self._set("max_voltage_limit", 160)
        self._set("min_voltage_limit", 55)
        self._set("velocity_limit", 1023)
        self._set("max_position_limit", spec.model.max_tick)
        self._set("shutdown", 52)
        self._set("present_input_voltage", 120)
        self._set("present_temperature", 32)
        self._power_on()

    @property
    def servo_id(self) -> int:
        """Bus id."""
        return self.get("id")

    @property
    def torque(self) -> bool:
        """Whether torque is on."""
        return bool(self.get("torque_enable"))

    @property
    def position_tick(self) -> float:
        """True position, finer than a tick."""
        return self._position_tick

    def get(self, name: str) -> int:
        """Value of an item."""
        item = self.items[name]
        return item.decode(bytes(self._memory[item.address : item.address + item.size]))

    def _set(self, name: str, value: int) -> None:
        item = self.items.get(name)
        if item is not None:
            data = int(value).to_bytes(item.size, "little", signed=item.signed)
            self._memory[item.address : item.address + item.size] = data

    def trip(self, hardware_error: int) -> None:
        """Latch a hardware error: torque drops until a reboot."""
        self._set("hardware_error_status", hardware_error)
        self._set("torque_enable", 0)

    def reboot(self) -> None:
        """Restart: RAM items return to their defaults, torque is off, latched errors are gone."""
        self._memory[EEPROM_END:] = bytes(_TABLE_BYTES - EEPROM_END)
        self._set("status_return_level", 2)
        self._set("present_input_voltage", 120)
        self._set("present_temperature", 32)
        self._power_on()

    def _power_on(self) -> None:
        self._set("goal_position", round(self._position_tick))
        self._publish()

    def alert(self) -> int:
        """The alert bit for a status packet."""
        return ALERT_BIT if self.get("hardware_error_status") else 0

    def read(self, address: int, length: int) -> tuple[int, bytes]:
        """Error code and `length` bytes at `address`."""
        if length < 1 or address + length > _TABLE_BYTES:
            return ErrorCode.ACCESS, b""
        return ErrorCode.NONE, bytes(self._memory[address : address + length])

    def write(self, address: int, data: bytes) -> int:
        """Write whole items; the error code of the first that refuses, nothing written then."""
        accepted: list[tuple[Item, int]] = []
        at, end = address, address + len(data)
        if not data:
            return ErrorCode.DATA_LENGTH
        while at < end:
            item = self._by_address.get(at)
            if item is None or not item.writable:
                return ErrorCode.ACCESS
            if at + item.size > end:
                return ErrorCode.DATA_LENGTH
            value = item.decode(data[at - address : at - address + item.size])
            error = self._refusal(item, value)
            if error:
                return error
            accepted.append((item, value))
            at += item.size
        for item, value in accepted:
            self._accept(item, value)
        return ErrorCode.NONE

    def _refusal(self, item: Item, value: int) -> int:
        if item.address < EEPROM_END and self.torque:
            return ErrorCode.ACCESS
        if item.name == "torque_enable" and value not in (0, 1):
            return ErrorCode.DATA_RANGE
        if item.name == "torque_enable" and value and self.get("hardware_error_status"):
            return ErrorCode.RESULT_FAIL
        if item.name == "bus_watchdog" and not 0 <= value <= 127:
            return ErrorCode.DATA_RANGE
        if item.name in _GOALS and self.get("bus_watchdog") == WATCHDOG_TRIPPED:
            return ErrorCode.DATA_RANGE
        limits = (self.get("min_position_limit"), self.get("max_position_limit"))
        if self.get("operating_mode") == 4:  # extended: position limits do not count
            limits = self.spec.model.tick_range(extended=True)
        if item.name == "goal_position" and not limits[0] <= value <= limits[1]:
            return ErrorCode.DATA_LIMIT
        return ErrorCode.NONE

    def _accept(self, item: Item, value: int) -> None:
        if item.name == "torque_enable" and value and not self.torque:
            self._velocity_tick_s = 0.0
        self._set(item.name, value)

    def fed(self, t_s: float) -> None:
        """An instruction packet passed on the bus: the watchdog starts anew."""
        self._fed_s = t_s

    def advance(self, t_s: float) -> None:
        """Move on to time `t_s`."""
        if self._at_s is None:
            self._at_s = self._fed_s = t_s
        watchdog = self.get("bus_watchdog")
        if watchdog > 0 and self.torque and t_s - self._fed_s > watchdog * WATCHDOG_UNIT_S:
            self._set("bus_watchdog", WATCHDOG_TRIPPED)
            self._set("goal_position", round(self._position_tick))
        while self._at_s < t_s - 1e-9:
            step = min(_STEP_S, t_s - self._at_s)
            self._at_s += step
            self._move(step)
        self._publish()

    def _move(self, step_s: float) -> None:
        if not self.torque:
            self._velocity_tick_s = 0.0
            return
        top = self.spec.model.no_load_speed_rad_s / self._rad_per_tick
        wanted = (self.get("goal_position") - self._position_tick) / _LAG_S
        wanted = max(-top, min(top, wanted))
        change = _ACCELERATION_RAD_S2 / self._rad_per_tick * step_s
        self._velocity_tick_s += max(-change, min(change, wanted - self._velocity_tick_s))
        self._position_tick += self._velocity_tick_s * step_s

    def _publish(self) -> None:
        self._set("present_position", round(self._position_tick))
        velocity = self._velocity_tick_s * self._rad_per_tick / VELOCITY_UNIT_RAD_S
        self._set("present_velocity", round(velocity))
        self._set("moving", int(abs(velocity) > 1))
        effort = round(0.6 * velocity) if self.torque else 0
        self._set(
            "present_current" if "present_current" in self.items else "present_load", max(-1000, min(1000, effort))
        )
