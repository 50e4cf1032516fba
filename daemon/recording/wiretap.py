"""A port that passes all bytes on and remembers the goals written through it, decoded from the bytes."""

from __future__ import annotations

import struct
from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec.packet import Instruction, PacketDecoder
from daemon.dynamixel.ports.port import Port

_GOAL_OF_X = (116, 4)


class Wiretap:
    """A `Port` around another one.

    Args:
        port: the wrapped port.
        servo_ids: ids of the servos.
        goal_places: (address, size) of goal_position in their control tables.

    Attributes:
        goal_tick: (S,) last goals sent to the servos, ticks, in the order of `servo_ids`.
        writes: number of whole sets of goals sent so far, each in one write to the port.
    """

    def __init__(
        self, port: Port, servo_ids: Sequence[int], goal_places: Collection[tuple[int, int]] = (_GOAL_OF_X,)
    ) -> None:
        self._port, self._places = port, frozenset(goal_places)
        self._row = {servo_id: i for i, servo_id in enumerate(servo_ids)}
        self._decoder = PacketDecoder()
        self.goal_tick: NDArray[np.int32] = np.zeros(len(servo_ids), np.int32)
        self.writes = 0

    @property
    def name(self) -> str:
        """URL of the wrapped port."""
        return self._port.name

    @property
    def baud(self) -> int:
        """Bits per second on the wire."""
        return self._port.baud

    def write(self, data: bytes) -> None:
        """Send all of `data`, after looking for goals in it."""
        written = [p for p in self._decoder.feed(data) if p.instruction == Instruction.SYNC_WRITE]
        self.writes += sum(self._look(p.parameters) for p in written) > 0
        self._port.write(data)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Bytes that the wrapped port reads within `timeout_s`."""
        return self._port.read(max_bytes, timeout_s)

    def close(self) -> None:
        """Close the wrapped port."""
        self._port.close()

    def _look(self, parameters: bytes) -> bool:
        """Keep the goals of a sync write; returns whether it is a write of goals."""
        if struct.unpack_from("<HH", parameters) not in self._places:
            return False
        for servo_id, tick in struct.iter_unpack("<Bi", parameters[4:]):
            if servo_id in self._row:
                self.goal_tick[self._row[servo_id]] = tick
        return True
