"""The servos on one port: goals out and measurements in, one exchange a cycle, each servo judged by itself."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.bus import packet
from daemon.bus.models import CONTROL_TABLES
from daemon.bus.packet import BROADCAST_ID, GroupReply, Instruction, Packet, PacketDecoder, error_text
from daemon.bus.port import Port
from daemon.bus.registers import FEEDBACK_ADDRESS, FEEDBACK_LENGTH, Item
from daemon.clock import Clock
from daemon.errors import BusMismatchError, CommandError, LinkTimeoutError, MismatchRow, ServoFaultError
from retarget.robot import ServoSpec

log = logging.getLogger(__name__)

_BITS_PER_BYTE = 10  # 8 data bits, start, stop
_MARGIN_S = 0.004
"""On top of wire time: scheduling on a shared machine and one USB frame."""
_GOAL_POSITION_ADDRESS, _GOAL_POSITION_BYTES = 116, 4
_TRIES = 3
_SETUP_MARGIN_S = 0.03
"""For single questions outside the cycle: nothing waits for them, and a busy machine may answer late."""


@dataclass
class BusReading:
    """What the servos said last; rows follow the servos of the bus.

    Attributes:
        position_tick, velocity_raw, current_raw: (S,) int32 in register units; the last known values.
        valid: (S,) whether the value is from this cycle.
        age_cycles: (S,) cycles since it was.
        error: (S,) error byte of the last answer; bit 7 is the hardware alert.
    """

    position_tick: NDArray[np.int32]
    velocity_raw: NDArray[np.int32]
    current_raw: NDArray[np.int32]
    valid: NDArray[np.bool_]
    age_cycles: NDArray[np.int32]
    error: NDArray[np.uint8]


class ServoBus:
    """Drives the servos of a robot over any port. Works in raw register units and knows no joints."""

    def __init__(self, port: Port, servos: Sequence[ServoSpec], clock: Clock) -> None:
        self.port, self.servos, self._clock = port, tuple(servos), clock
        self.ids = tuple(s.servo_id for s in servos)
        self._row = {servo_id: i for i, servo_id in enumerate(self.ids)}
        n = len(self.ids)
        self._decoder = PacketDecoder()
        self._fast = GroupReply(self.ids, FEEDBACK_LENGTH)
        self._read_request = packet.sync_read(FEEDBACK_ADDRESS, FEEDBACK_LENGTH, self.ids)
        self._goal_rows = np.zeros((n, 1 + _GOAL_POSITION_BYTES), np.uint8)
        self._goal_rows[:, 0] = self.ids
        self._goal_head = Packet(
            BROADCAST_ID, Instruction.SYNC_WRITE, bytes([_GOAL_POSITION_ADDRESS, 0, _GOAL_POSITION_BYTES, 0])
        )
        zeros = np.zeros(n, np.int32)
        self.reading = BusReading(
            zeros.copy(),
            zeros.copy(),
            zeros.copy(),
            np.zeros(n, bool),
            np.full(n, 1 << 20, np.int32),
            np.zeros(n, np.uint8),
        )
        self.timeouts = zeros.copy()
        """(S,) cycles in which each servo did not answer."""

    def exchange(self, goal_ticks: NDArray[np.int32] | None) -> BusReading:
        """Write goals (none when None) and read current, velocity and position of every servo, in one `write()`.

        A servo that does not answer keeps its old values, marked not valid.

        Raises:
            LinkLostError: the device is gone.
        """
        request = self._read_request if goal_ticks is None else self._goal_packet(goal_ticks) + self._read_request
        self._drop_late_answers()
        self.port.write(request)
        deadline = self._clock.now_s() + self._wire_s(len(request) + self._fast.n_bytes) + _MARGIN_S
        raw = b""
        packets: dict[int, Packet] = {}
        while len(raw) < self._fast.n_bytes and (left := deadline - self._clock.now_s()) > 0:
            raw += self.port.read(self._fast.n_bytes - len(raw), left)
        fast = self._fast.parse(raw)
        reading = self.reading
        if fast is not None:
            errors, data = fast
            self._store(np.arange(len(self.ids)), errors, data)
            reading.valid[:] = True
        else:
            for p in self._decoder.feed(raw):
                if (
                    p.instruction == Instruction.STATUS
                    and len(p.parameters) == FEEDBACK_LENGTH
                    and p.servo_id in self._row
                ):
                    packets[p.servo_id] = p
            rows = np.array([self._row[i] for i in packets], np.int64)
            reading.valid[:] = False
            if len(rows):
                errors = np.array([p.error for p in packets.values()], np.uint8)
                data = np.frombuffer(b"".join(p.parameters for p in packets.values()), np.uint8).reshape(len(rows), -1)
                self._store(rows, errors, data)
                reading.valid[rows] = True
            self.timeouts += ~reading.valid
        reading.age_cycles[:] = np.where(reading.valid, 0, reading.age_cycles + 1)
        return reading

    def ping_all(self) -> dict[int, tuple[int, int]]:
        """Model number and firmware of each servo that answers."""
        found: dict[int, tuple[int, int]] = {}
        for servo_id in self.ids:
            try:
                answer = self._ask(packet.ping(servo_id), servo_id, 3)
            except LinkTimeoutError:
                pass
            else:
                found[servo_id] = (int.from_bytes(answer.parameters[:2], "little"), answer.parameters[2])
            if servo_id == self.ids[3 % len(self.ids)] and not found:
                break  # the first four are silent: wrong baud or no power; do not wait for the rest
        return found

    def verify(self) -> None:
        """Compare the bus with the robot file.

        Raises:
            BusMismatchError: with a table of what was expected and what was found.
        """
        found = self.ping_all()
        rows = [
            MismatchRow(s.servo_id, s.joint_name, s.model.name, self._found_text(found.get(s.servo_id)))
            for s in self.servos
            if s.servo_id not in found or found[s.servo_id][0] != s.model.model_number
        ]
        if not rows:
            return
        hint = "check ids and cables: a servo keeps its id, a chain is cut behind the last one that answers"
        if not found:
            hint = (
                f"nothing answers at {self.port.baud} baud on {self.port.name}: check power, and the baud (?baud=...)"
            )
        raise BusMismatchError(rows, hint)

    def read_item(self, servo_id: int, name: str) -> int:
        """Value of one item of one servo."""
        item = self._item(servo_id, name)
        answer = self._ask(packet.read(servo_id, item.address, item.size), servo_id, item.size)
        return item.decode(answer.parameters)

    def poll_item(self, servo_id: int, name: str) -> int | None:
        """Value of one item, asked once and within the cycle; None when the servo did not answer in time."""
        item = self._item(servo_id, name)
        answer = self._ask_once(packet.read(servo_id, item.address, item.size), servo_id, item.size, _MARGIN_S)
        return None if answer is None else item.decode(answer.parameters)

    def write_item(self, servo_id: int, name: str, value: int) -> None:
        """Set one item of one servo and wait for its answer.

        Raises:
            CommandError: the item is read only or the value does not fit.
            ServoFaultError: the servo refused.
            LinkTimeoutError: it did not answer.
        """
        item = self._item(servo_id, name)
        if not item.writable:
            raise CommandError(f"servo {servo_id}: '{name}' is read only")
        try:
            data = item.encode(value)
        except OverflowError:
            raise CommandError(f"servo {servo_id}: '{name}' = {value} does not fit {item.size} bytes") from None
        self._ask(packet.write(servo_id, item.address, data), servo_id, 0)

    def write_all(self, name: str, value: int) -> None:
        """Set one item of every servo, each confirmed; the first refusal is raised."""
        for servo_id in self.ids:
            self.write_item(servo_id, name, value)

    def send_all(self, name: str, value: int) -> None:
        """Set one item of every servo with one packet that nobody answers; the item must be at the same address in all."""
        item = self._item(self.ids[0], name)
        self.port.write(packet.sync_write(item.address, item.size, [(i, item.encode(value)) for i in self.ids]))

    def send_torque_off(self) -> None:
        """Cut the torque of every servo with one packet that nobody has to answer."""
        self.port.write(packet.sync_write(64, 1, [(i, b"\0") for i in self.ids]))

    def _goal_packet(self, goal_ticks: NDArray[np.int32]) -> bytes:
        self._goal_rows[:, 1:] = goal_ticks.astype("<i4").view(np.uint8).reshape(-1, 4)
        head = self._goal_head
        return packet.encode(Packet(head.servo_id, head.instruction, head.parameters + self._goal_rows.tobytes()))

    def _store(self, rows: NDArray[np.int64], errors: NDArray[np.uint8], data: NDArray[np.uint8]) -> None:
        """Keep what FEEDBACK_LENGTH bytes of each row say: current 2, velocity 4, position 4."""
        reading = self.reading
        reading.error[rows] = errors
        reading.current_raw[rows] = np.ascontiguousarray(data[:, 0:2]).view("<i2")[:, 0]
        reading.velocity_raw[rows] = np.ascontiguousarray(data[:, 2:6]).view("<i4")[:, 0]
        reading.position_tick[rows] = np.ascontiguousarray(data[:, 6:10]).view("<i4")[:, 0]

    def _ask(self, request: bytes, servo_id: int, answer_bytes: int) -> Packet:
        """Send one instruction and return the servo's answer; asked again when it stays silent.

        Only instructions that may be repeated are sent this way.
        """
        for _ in range(_TRIES):
            answer = self._ask_once(request, servo_id, answer_bytes, _SETUP_MARGIN_S)
            if answer is not None:
                return answer
        raise LinkTimeoutError(f"servo {servo_id} did not answer instruction {request[7]:#04x} on {self.port.name}")

    def _ask_once(self, request: bytes, servo_id: int, answer_bytes: int, margin_s: float) -> Packet | None:
        self._drop_late_answers()
        self.port.write(request)
        deadline = self._clock.now_s() + self._wire_s(len(request) + 11 + answer_bytes) + margin_s
        while (left := deadline - self._clock.now_s()) > 0:
            for p in self._decoder.feed(self.port.read(256, left)):
                if p.servo_id != servo_id or p.instruction != Instruction.STATUS:
                    continue
                code = p.error & ~packet.ALERT_BIT
                if code:
                    name = error_text(code)
                    raise ServoFaultError(servo_id, f"instruction {request[7]:#04x}", name)
                if len(p.parameters) == answer_bytes:  # an answer to something else has another length
                    return p
        return None

    def _drop_late_answers(self) -> None:
        """Throw away what arrived after its deadline, or this cycle would read the last one's answers for ever."""
        while self.port.read(4096, 0.0):
            pass
        self._decoder.clear()

    def _item(self, servo_id: int, name: str) -> Item:
        table = CONTROL_TABLES[self.servos[self._row[servo_id]].model.model_number]
        if name not in table:
            raise CommandError(f"servo {servo_id} has no item '{name}'; it has: {', '.join(table)}")
        return table[name]

    def _wire_s(self, n_bytes: int) -> float:
        return n_bytes * _BITS_PER_BYTE / self.port.baud

    @staticmethod
    def _found_text(found: tuple[int, int] | None) -> str:
        if found is None:
            return "no answer"
        return f"model {found[0]}, firmware {found[1]}"
