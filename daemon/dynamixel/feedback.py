"""Steps of a cycle: one request, the answers of its servos, and their storage in a reading.

A whole group of Protocol 2.0 servos is one step (sync read, or fast sync read); MX on protocol 1.0 are one step (bulk read); an AX
knows no group read and is a step of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.dialect import DIALECTS
from daemon.dynamixel.codec.group import FastGroupReply, GroupReply
from daemon.dynamixel.codec.packet import Instruction, Packet
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.registers.models import BusModel
from daemon.dynamixel.registers.registers import FEEDBACK_LENGTH, Item


@dataclass(frozen=True)
class Layout:
    """Addresses and offsets of position, velocity and effort in the bytes that are read.

    Attributes:
        address, length: first address and number of the bytes that are read.
        position, velocity, effort: offset of each in these bytes.
    """

    address: int
    length: int
    position: int
    velocity: int
    effort: int


def direct(address: int) -> Layout:
    """The layout of Protocol 2.0: effort, velocity and position in a row from `address` on."""
    return Layout(address, FEEDBACK_LENGTH, 6, 2, 0)


DIRECT = direct(126)
"""Layout of X and MX: effort 126, velocity 128, position 132."""
PROTOCOL_1_ADDRESS, PROTOCOL_1_LENGTH = 36, 6
"""Address and number of bytes in Protocol 1.0: position 36, speed 38, load 40."""


_ALL = slice(None)


def _index(rows: Sequence[int]) -> NDArray[np.intp] | slice:
    """An index for `rows`: a slice when they are consecutive, because NumPy copies a slice several times faster."""
    if list(rows) == list(range(rows[0], rows[0] + len(rows))):
        return slice(rows[0], rows[0] + len(rows))
    return np.array(rows, np.intp)


class Step(Protocol):
    """One request and its answers; `index` selects its servos' rows in a reading.

    `chained`: whether a silent servo silences those behind it.
    """

    rows: NDArray[np.intp]
    index: NDArray[np.intp] | slice
    request: bytes
    reply_bytes: int
    answers: int
    chained: bool

    def take(self, raw: bytearray, reading: BusReading) -> NDArray[np.bool_]:
        """Store the answers in `raw`; return (rows,) whether each servo answered. Bytes of a False row go to the byte parser."""
        ...

    def ends(self, raw: bytearray) -> bool:
        """Whether the last servo has answered, so that no more bytes will come."""
        ...

    def store(self, row: int, answer: Packet, reading: BusReading) -> bool:
        """Store one answer found by the byte parser; return False when it does not belong to this step."""
        ...


class SyncStep:
    """Sync read of a group: vectorised when all answers came whole, else byte by byte.

    Args:
        rows: rows of the servos in the reading.
        servo_ids: ids of these servos.
        layout: layout of the bytes that are read.
    """

    def __init__(self, rows: Sequence[int], servo_ids: Sequence[int], layout: Layout = DIRECT) -> None:
        self.rows, self._layout = np.array(rows, np.intp), layout
        self.index = _index(rows)
        self.request = packet.sync_read(layout.address, layout.length, servo_ids)
        self._reply = GroupReply(servo_ids, layout.length)
        self.reply_bytes, self.answers = self._reply.n_bytes, len(rows)
        self._columns = _Columns(self._reply, layout)
        self._all = np.ones(len(rows), bool)
        self._none = np.zeros(len(rows), bool)
        self.chained = False

    def take(self, raw: bytearray, reading: BusReading) -> NDArray[np.bool_]:
        """Store all answers at once when all are complete, else none."""
        if not self._reply.parse(raw):
            return self._none
        self._columns.store(self.index, self._reply.errors, reading)
        return self._all

    def ends(self, raw: bytearray) -> bool:
        """Whether the last servo's frame has arrived."""
        return self._reply.ends(raw)

    def store(self, row: int, answer: Packet, reading: BusReading) -> bool:
        """Store one servo's status packet."""
        if len(answer.parameters) != self._layout.length:
            return False
        layout, data = self._layout, answer.parameters
        reading.error[row] = answer.error
        reading.position_tick[row] = _number(data, layout.position, 4)
        reading.velocity_raw[row] = _number(data, layout.velocity, 4)
        reading.current_raw[row] = _number(data, layout.effort, 2)
        return True


class FastSyncStep:
    """Fast sync read of a group: one common packet, each servo's part judged by itself."""

    def __init__(self, rows: Sequence[int], servo_ids: Sequence[int], layout: Layout = DIRECT) -> None:
        self.rows, self.index = np.array(rows, np.intp), _index(rows)
        self.request = packet.sync_read(layout.address, layout.length, servo_ids, fast=True)
        self._reply = FastGroupReply(servo_ids, layout.length)
        self.reply_bytes, self.answers = self._reply.n_bytes, 1
        self.chained = True
        self._columns = _Columns(self._reply, layout)

    def take(self, raw: bytearray, reading: BusReading) -> NDArray[np.bool_]:
        """Store the parts that are complete."""
        whole = self._reply.parse(raw)
        if whole.all():
            self._columns.store(self.index, self._reply.errors, reading)
        elif whole.any():
            self._columns.store(self.rows[whole], self._reply.errors, reading, whole)
        return whole

    def ends(self, raw: bytearray) -> bool:
        """Whether the packet is complete: behind a silent servo no other answers, so only a full packet is an end."""
        return len(raw) >= self.reply_bytes

    def store(self, row: int, answer: Packet, reading: BusReading) -> bool:
        """Return False: this step has no single answers."""
        return False


class _Columns:
    """Views of the numbers in a group's buffer, and their copying into the reading."""

    def __init__(self, reply: GroupReply | FastGroupReply, layout: Layout) -> None:
        self._position = reply.column(layout.position, "<i4")
        self._velocity = reply.column(layout.velocity, "<i4")
        self._effort = reply.column(layout.effort, "<i2")

    def store(
        self,
        index: NDArray[np.intp] | slice,
        errors: NDArray[np.uint8],
        reading: BusReading,
        whole: NDArray[np.bool_] | slice = _ALL,
    ) -> None:
        """Copy the values of the servos selected by `whole` to the rows of `index`."""
        reading.error[index] = errors[whole]
        reading.position_tick[index] = self._position[whole]
        reading.velocity_raw[index] = self._velocity[whole]
        reading.current_raw[index] = self._effort[whole]


class Protocol1Step:
    """Bulk read of MX servos, or the read of a single AX; few bytes, taken byte by byte.

    Args:
        rows: rows of the servos in the reading.
        servo_ids: ids of these servos.
        models: models of these servos, all with equal items.
    """

    def __init__(self, rows: Sequence[int], servo_ids: Sequence[int], models: Sequence[BusModel]) -> None:
        self.rows, self.index = np.array(rows, np.intp), _index(rows)
        if len(rows) > 1:
            self.request = packet1.bulk_read([(i, PROTOCOL_1_ADDRESS, PROTOCOL_1_LENGTH) for i in servo_ids])
        else:
            self.request = packet1.read(servo_ids[0], PROTOCOL_1_ADDRESS, PROTOCOL_1_LENGTH)
        self.reply_bytes, self.answers = len(rows) * (6 + PROTOCOL_1_LENGTH), len(rows)
        names = ("present_position", "present_speed", "present_load")
        self.chained = len(rows) > 1
        self._items = {row: tuple(m.table[name] for name in names) for row, m in zip(rows, models, strict=True)}
        self._none = np.zeros(len(rows), bool)

    def take(self, raw: bytearray, reading: BusReading) -> NDArray[np.bool_]:
        """Return all False: the byte parser handles all answers of this step."""
        return self._none

    def ends(self, raw: bytearray) -> bool:
        """Whether all bytes have arrived."""
        return len(raw) >= self.reply_bytes

    def store(self, row: int, answer: Packet, reading: BusReading) -> bool:
        """Store one servo's status packet."""
        if len(answer.parameters) != PROTOCOL_1_LENGTH:
            return False
        position, speed, load = (_decoded(item, answer.parameters) for item in self._items[row])
        reading.error[row] = DIALECTS[1.0].alert(answer.error)
        reading.hardware_error[row] = answer.error & packet1.ALERT_BITS  # the same bits as on protocol 2.0
        reading.position_tick[row], reading.velocity_raw[row], reading.current_raw[row] = position, speed, load
        return True


def _decoded(item: Item, data: bytes) -> int:
    at = item.address - PROTOCOL_1_ADDRESS
    return item.decode(data[at : at + item.size])


def _number(data: bytes, offset: int, size: int) -> int:
    return int.from_bytes(data[offset : offset + size], "little", signed=True)


def steps_for(
    rows: Sequence[int], servo_ids: Sequence[int], models: Sequence[BusModel], fast: Sequence[bool], *, chained: bool
) -> list[Step]:
    """The steps that read these servos: those with `fast` in one fast sync read, the others by the best read of their protocol.

    Args:
        rows: rows of the servos in the reading.
        servo_ids: ids of these servos.
        models: models of these servos.
        fast: which of them answer fast sync reads.
        chained: whether to use requests in which a silent servo silences those behind it (fast sync read, bulk read of
            protocol 1.0). Without them every servo's silence is its own.
    """
    of = dict(zip(rows, zip(servo_ids, models, fast, strict=True), strict=True))
    modern = [r for r in rows if of[r][1].protocol == 2.0]
    steps: list[Step] = []
    for address in dict.fromkeys(of[r][1].feedback_address for r in modern):  # one for X, one for Y, one for P
        there = [r for r in modern if of[r][1].feedback_address == address]
        for group, kind in (
            ([r for r in there if chained and of[r][2]], FastSyncStep),
            ([r for r in there if not (chained and of[r][2])], SyncStep),
        ):
            if group:
                steps.append(kind(group, [of[r][0] for r in group], direct(address)))
    mx = [r for r in rows if of[r][1].family == "mx1"]
    single = [[r] for r in rows if of[r][1].family == "ax"] + ([] if chained else [[r] for r in mx])
    for group in ([mx] if mx and chained else []) + single:
        steps.append(Protocol1Step(group, [of[r][0] for r in group], [of[r][1] for r in group]))
    return steps


def is_status(answer: Packet) -> bool:
    """Whether this is an answer, not another client's request."""
    return answer.instruction == Instruction.STATUS
