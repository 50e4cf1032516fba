"""One simulated servo of Protocol 2.0: the writes that each register accepts, and the error code of each mistake.

This file covers X and MX; `servo_series_y_p.py` has the differences of Y and P.

ROBOTIS e-manual, "Control Table" of XM430-W350, XL430-W250 and XL330-M288. Time is passed in, never read. Where the
manual is silent we chose, and say so in docs/simulator.md: a write with one bad item writes nothing.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from daemon.dynamixel.codec.packet import ALERT_BIT, ErrorCode
from daemon.dynamixel.registers.registers import Item
from retarget.robot.robot import ServoSpec
from sim.servos.drives import Drives, Mode
from sim.servos.memory import INDIRECT
from sim.servos.servo_power import GOALS, ServoPower

_POSITION_RANGE: dict[int, float] = {Mode.EXTENDED_POSITION: 1048575, Mode.CURRENT_POSITION: 1048575}
_LIMIT_OF = {"goal_velocity": "velocity_limit", "goal_current": "current_limit", "goal_pwm": "pwm_limit"}
_SINGLE_TURN = (Mode.POSITION,)


@dataclass(frozen=True)
class Errors:
    """Error codes for mistakes found before a register is reached, and for bytes that are no valid value."""

    instruction: int
    length: int
    access: int
    value: int
    checksum: int


class SimServo(ServoPower):
    """Registers of one servo, and their effect on its motor.

    Attributes:
        asked: names of the items that the last write addressed, accepted or not.
    """

    errors = Errors(ErrorCode.INSTRUCTION, ErrorCode.DATA_LENGTH, ErrorCode.ACCESS, ErrorCode.DATA_RANGE, ErrorCode.CRC)
    _strict_reads = True
    has_encoder_error = True
    _position_range: ClassVar[Mapping[int, float]] = _POSITION_RANGE
    _limit_of: ClassVar[Mapping[str, str]] = _LIMIT_OF

    def __init__(self, spec: ServoSpec, drives: Drives, index: int, firmware: int | None = None) -> None:
        super().__init__(spec, drives, index, firmware)
        self.asked: list[str] = []

    def alert(self) -> int:
        """The alert bit for a status packet."""
        return ALERT_BIT if self.error else 0

    def read(self, address: int, length: int) -> tuple[int, bytes]:
        """Error code and `length` bytes at `address`."""
        self._refresh()
        data = self.memory.read(address, length, strict=self._strict_reads)
        return (self.errors.access, b"") if data is None else (ErrorCode.NONE, data)

    def write(self, address: int, data: bytes) -> int:
        """Write whole items; return the error code of the first item that refuses, in which case nothing is written."""
        accepted: list[tuple[Item, int]] = []
        self.asked = []
        for start, part in self.memory.runs(address, data):
            span = self.memory.span(start, len(part))
            if span.problem:
                return self.errors.length if span.problem == "short" else self.errors.access
            for item, at in span.items:
                raw = part[at : at + item.size]
                value = item.decode(raw)
                self.asked.append(item.name)
                error = self._refusal(item, value) if item.holds(raw) else self.errors.value
                if error:
                    return error
                accepted.append((item, value))
        if not accepted:
            return self.errors.length
        for item, value in accepted:
            self._accept(item, value)
        return ErrorCode.NONE

    def writes_eeprom(self, address: int, data: bytes) -> bool:
        """Whether a write addresses an item that is kept without power."""
        spans = (self.memory.span(start, len(part)) for start, part in self.memory.runs(address, data))
        return any(item.eeprom for span in spans for item, _ in span.items)

    def register(self, address: int, data: bytes) -> int:
        """Keep a write until `act` (instruction "Reg Write")."""
        self._pending = (address, data)
        self._set("registered_instruction", 1)
        return ErrorCode.NONE

    def act(self) -> tuple[int, bytes] | None:
        """Address and data of the write kept by `register`, which is forgotten; None when there is none."""
        pending, self._pending = self._pending, None
        self._set("registered_instruction", 0)
        return pending

    def _refusal(self, item: Item, value: int) -> int:
        name = item.name
        if item.eeprom and self.torque:
            return ErrorCode.ACCESS
        if name in GOALS and self.watchdog_tripped:
            return ErrorCode.DATA_RANGE
        if not item.takes(value):
            return ErrorCode.DATA_RANGE
        if name == "torque_enable" and value and self.is_faulted:
            return ErrorCode.RESULT_FAIL
        if name == "operating_mode" and value not in self.model.operating_modes:
            return ErrorCode.DATA_RANGE
        if name == "baud_rate" and self.model.baud_of_code(value) is None:
            return ErrorCode.DATA_RANGE
        low, high = self._limits(name)
        return ErrorCode.NONE if low <= value <= high else ErrorCode.DATA_LIMIT

    def _limits(self, name: str) -> tuple[float, float]:
        """Lowest and highest value of an item that other items allow."""
        if name == "goal_position":
            mode = self.memory.get("operating_mode")
            if mode == Mode.POSITION:
                return self.memory.get("min_position_limit"), self.memory.get("max_position_limit")
            far = self._position_range.get(mode, math.inf)
            return -far, far
        limit = self._limit_of.get(name)
        most = math.inf if limit is None else self.memory.get(limit)
        return -most, most

    def _accept(self, item: Item, value: int) -> None:
        name = item.name
        if name == "goal_position":
            self._set(name, value)
            self.drives.set_goal(self.index, self._to_shaft(value))
            self._profile_type = self._type_of_profile()
            drive_mode = self.memory.get("drive_mode")
            if drive_mode & 8 and not self.torque and not self.is_faulted:
                self._set_torque(True)  # drive mode bit 3: torque on by goal update
            if drive_mode & 4:
                self._configure()  # the duration of a profile depends on the distance to go
        elif name == "torque_enable":
            self._set_torque(bool(value))
        else:
            self._set(name, value)
            if name == "operating_mode":
                self._change_mode()
            if name == "bus_watchdog":
                self.fed(self._now_s)
            if not name.startswith(INDIRECT):
                self._configure()

    def _change_mode(self) -> None:
        """Give the items of a new operating mode their defaults (e-manual, "Operating Mode", note)."""
        for name in ("position_p_gain", "position_i_gain", "position_d_gain", "velocity_p_gain", "velocity_i_gain",
                     "feedforward_1st_gain", "feedforward_2nd_gain", "profile_velocity", "profile_acceleration"):  # fmt: skip
            if name in self.items and not self.items[name].hybrid:
                self.memory.reset(self.items[name])
        if self.memory.get("operating_mode") in _SINGLE_TURN:
            self._turn_tick = self._whole_turns()
        self._reset_goals()
