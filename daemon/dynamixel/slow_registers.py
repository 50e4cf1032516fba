"""Registers that change slowly (torque, hardware error, voltage, temperature), read from one servo at a time, in turn.

On Protocol 2.0 they are far apart; a window of indirect addresses allows one read for all. The window is RAM: after a reboot it
contains zeros that look like values, so a register that is never zero (status_return_level) is read along.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec.dialect import DIALECTS
from daemon.dynamixel.codec.packet import Packet
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.registers.registers import Table

_WITNESS = "status_return_level"


def _slow_items(model: BusModel) -> list[str]:
    """Names of the slow items of this model."""
    temperatures = (t.present for t in model.thermometers)
    names = ("torque_enable", _WITNESS, model.error_item, "present_input_voltage", *temperatures)
    return [name for name in names if name in model.table]


@dataclass(frozen=True)
class Span:
    """A range of bytes to read, and the offset of each item in it."""

    address: int
    length: int
    offsets: dict[str, tuple[int, int]]
    witness: bool = False

    @classmethod
    def of(cls, table: Table, *names: str) -> Span:
        """The span from the first to the last byte of these items."""
        items = [table[name] for name in names]
        start, end = min(i.address for i in items), max(i.end for i in items)
        return cls(start, end - start, {i.name: (i.address - start, i.size) for i in items})


class SlowReader:
    """Chooses the servo whose slow registers are read next, builds the request and decodes the answer.

    Args:
        models: models of the servos, in the order of the reading.
    """

    def __init__(self, models: Sequence[BusModel]) -> None:
        self._models = tuple(models)
        self._spans: list[list[Span]] = [_direct(m) for m in models]
        self._turn = [0] * len(models)
        self._tried = [False] * len(models)
        self._next = 0

    @property
    def n_windows(self) -> int:
        """Number of servos whose window is in use."""
        return sum(spans[0].witness for spans in self._spans)

    def wants_window(self, row: int) -> bool:
        """Whether a servo has no window yet and has not refused one."""
        return not self._spans[row][0].witness and not self._tried[row]

    def no_window(self, row: int) -> None:
        """Note that a servo refuses its indirect window: its registers are read one by one."""
        self._tried[row] = True

    def map_window(
        self, row: int, firmware: int, write: Callable[[int, bytes], None], read: Callable[[int, int], bytes]
    ) -> bool:
        """Map a servo's indirect addresses to the slow registers; return False when it has none or does not keep them.

        Args:
            row: row of the servo.
            firmware: firmware of the servo, on which the place of the window depends.
            write: writes bytes at an address of that servo.
            read: reads bytes at an address of that servo.
        """
        model = self._models[row]
        addresses: list[int] = []
        offsets: dict[str, tuple[int, int]] = {}
        for item in (model.table[name] for name in _slow_items(model)):
            offsets[item.name] = (len(addresses), item.size)
            addresses += range(item.address, item.end)
        window = next((w for w in model.indirect_windows(firmware) if w.count >= len(addresses)), None)
        if window is None:
            self._tried[row] = True
            return False
        data = struct.pack(f"<{len(addresses)}H", *addresses)
        is_there = (
            window.kept and read(window.address, len(data)) == data
        )  # values in place are not written again, as writing wears the memory
        if not is_there:
            write(window.address, data)
            if read(window.address, len(data)) != data:
                self._tried[row] = True
                return False
        self._spans[row] = [Span(window.data, len(addresses), offsets, witness=True)]
        self._turn[row] = 0
        return True

    def next_row(self, asked: NDArray[np.bool_]) -> int | None:
        """Row of the next servo in turn among those that take part; None for none."""
        for _ in self._models:
            row, self._next = self._next, (self._next + 1) % len(self._models)
            if asked[row]:
                return row
        return None

    def request(self, row: int, servo_id: int) -> tuple[bytes, int]:
        """The request for a servo, and the number of parameter bytes in its answer."""
        span = self._spans[row][self._turn[row]]
        return DIALECTS[self._models[row].protocol].read(servo_id, span.address, span.length), span.length

    def store(self, row: int, answer: Packet, reading: BusReading) -> bool:
        """Store the values of an answer; return False when the window has lost its addresses (the servo has rebooted)."""
        span = self._spans[row][self._turn[row]]
        self._turn[row] = (self._turn[row] + 1) % len(self._spans[row])
        values = {
            name: int.from_bytes(answer.parameters[at : at + size], "little")
            for name, (at, size) in span.offsets.items()
        }
        if span.witness and not values[_WITNESS]:
            self._spans[row] = _direct(self._models[row])
            self._turn[row] = 0
            return False
        model = self._models[row]
        for name, column in (("torque_enable", reading.torque), (model.error_item, reading.hardware_error)):
            if name in values:
                column[row] = values[name]
        if "present_input_voltage" in values:
            reading.voltage_raw[row] = model.decivolt(values["present_input_voltage"])
        temperature_c = model.temperature_c(values)
        if temperature_c is not None:
            reading.temperature_c[row] = temperature_c
        return True


def _direct(model: BusModel) -> list[Span]:
    """Spans of neighbouring items, read in turn, for a servo without a window."""
    temperatures = (t.present for t in model.thermometers)
    spans = [Span.of(model.table, "present_input_voltage", *temperatures)]
    if model.error_item == "error_code":  # on a Y it stands apart from the others
        return [Span.of(model.table, "torque_enable"), Span.of(model.table, "error_code"), *spans]
    near = ("torque_enable", "hardware_error_status") if model.error_item else ("torque_enable",)
    return [Span.of(model.table, *near), *spans]
