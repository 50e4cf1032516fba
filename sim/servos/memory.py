"""The control table of one servo as bytes: items by name, access rights, indirect addresses.

The table knows addresses, sizes, access rights and ranges; `SimServo` knows the meaning of values. An indirect data byte shows the
byte whose address stands in its indirect address item (ROBOTIS e-manual, "Indirect Address").
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass

from daemon.dynamixel.registers.models import BusModel, IndirectWindow
from daemon.dynamixel.registers.registers import Item

INDIRECT = "indirect_"
"""Prefix of the names of indirect address items and of indirect data items."""


@dataclass(frozen=True)
class Span:
    """Items that a write of some length at some address covers, with the offset of each in the data.

    `problem` is "" or what is wrong: "undefined" (no item there), "read only", "short" (an item cut in two).
    """

    items: tuple[tuple[Item, int], ...]
    problem: str = ""


class Memory:
    """The bytes of one servo.

    Args:
        model, firmware: servo model and firmware version, which choose the control table.
        measured: addresses whose bytes are written by `measure`.
        assumed: initial values of items for which the manual gives none.
    """

    def __init__(
        self, model: BusModel, firmware: int, measured: range = range(0), assumed: Mapping[str, int] | None = None
    ) -> None:
        self.model = model
        self._windows = model.indirect_windows(firmware)
        self.items: dict[str, Item] = dict(model.table) | _indirect_items(self._windows)
        self.size = max(item.end for item in self.items.values())
        self.bytes = bytearray(self.size)
        self._is_item = bytearray(self.size)
        for item in self.items.values():
            self._is_item[item.address : item.end] = b"\1" * item.size
        self._by_address = {item.address: item for item in self.items.values()}
        self._measured, self._assumed = measured, dict(assumed or {})
        self._values: dict[str, int] = {}  # of items that only `set` changes
        self._spans: dict[tuple[int, int], Span] = {}
        self._data_first = min((w.data for w in self._windows), default=self.size)
        for item in self.items.values():
            self.reset(item)

    def reset(self, item: Item) -> None:
        """Set an item back to its value from the factory; without one to its assumed value, or zero."""
        self.set(item.name, item.initial if item.initial is not None else self._assumed.get(item.name, 0))

    def get(self, name: str) -> int:
        """Value of an item."""
        value = self._values.get(name)
        if value is None:
            item = self.items[name]
            return item.decode(bytes(self.bytes[item.address : item.end]))
        return value

    def set(self, name: str, value: int) -> None:
        """Store an item's value, unchecked."""
        item = self.items[name]
        data = item.encode(value)
        self.bytes[item.address : item.end] = data
        if item.address not in self._measured:
            self._values[name] = item.decode(data)

    def measure(self, layout: struct.Struct, *values: int) -> None:
        """Store measured values, packed side by side from the first of the measured addresses on."""
        layout.pack_into(self.bytes, self._measured.start, *values)

    def read(self, address: int, length: int, *, strict: bool = True) -> bytes | None:
        """Bytes as a client reads them; None beyond the end, or, when `strict`, from or to an address without an item.

        Addresses without an item between others read as zero: clients read the table in blocks.
        """
        end = address + length
        if length < 1 or end > self.size:
            return None
        if end <= self._data_first:
            if strict and not (self._is_item[address] and self._is_item[end - 1]):
                return None
            return bytes(self.bytes[address:end])
        targets = [self.resolve(a) for a in range(address, end)]
        if strict and not (self._is_item[targets[0]] and self._is_item[targets[-1]]):
            return None
        return bytes(self.bytes[a] for a in targets)

    def resolve(self, address: int) -> int:
        """The address that an indirect data byte stands for; any other address itself."""
        for window in self._windows:
            if window.data <= address < window.data + window.count:
                at = window.address + 2 * (address - window.data)
                target = self.bytes[at] | self.bytes[at + 1] << 8
                return target if target < self.size else address
        return address

    def runs(self, address: int, data: bytes) -> list[tuple[int, bytes]]:
        """A write split into writes to real addresses: one, or several where indirect data bytes point to separate places."""
        if address + len(data) <= self._data_first:
            return [(address, data)]
        found: list[tuple[int, bytearray]] = []
        for i, byte in enumerate(data):
            target = self.resolve(address + i)
            if found and found[-1][0] + len(found[-1][1]) == target:
                found[-1][1].append(byte)
            else:
                found.append((target, bytearray([byte])))
        return [(start, bytes(part)) for start, part in found]

    def span(self, address: int, length: int) -> Span:
        """The whole items that a write covers, and the problem with the write, if any."""
        key = (address, length)
        if key not in self._spans:
            self._spans[key] = self._find_span(address, length)
        return self._spans[key]

    def _find_span(self, address: int, length: int) -> Span:
        items: list[tuple[Item, int]] = []
        at, end = address, address + length
        while at < end:
            item = self._by_address.get(at)
            if item is None:
                return Span((), "undefined")
            if not item.writable:
                return Span((), "read only")
            if item.end > end:
                return Span((), "short")
            items.append((item, at - address))
            at = item.end
        return Span(tuple(items), "" if items else "short")


def _indirect_items(windows: tuple[IndirectWindow, ...]) -> dict[str, Item]:
    """The address and data items of every window; from the factory each address points to its own data byte, which is RAM."""
    items: list[Item] = []
    for window in windows:
        for i in range(window.count):
            number, at, data = 1 + len(items) // 2, window.address + 2 * i, window.data + i
            kept, low, high = window.kept, window.low, window.high
            items.append(Item(f"{INDIRECT}address_{number}", at, 2, eeprom=kept, low=low, high=high, initial=data))
            items.append(Item(f"{INDIRECT}data_{number}", data, 1, initial=0))
    return {item.name: item for item in items}
