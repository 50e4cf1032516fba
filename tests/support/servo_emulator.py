"""Servos as plain memory, of both protocols, in virtual time: another far end than the simulator, for what the wire can do.

Knows nothing of motion. Everything odd (echo, a second servo with the same id, strangers, silence) is switched on by name.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import BROADCAST_ID, ErrorCode, Instruction, Packet, Part
from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS, BusModel
from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED
from daemon.errors import LinkLostError, PacketError
from retarget.robot.robot import ServoSpec
from retarget.robot.servos import servo_models
from sim.clock import VirtualClock


@dataclass
class FakeServo:
    """One servo: memory, and what is wrong with it."""

    model: BusModel
    servo_id: int
    firmware: int = 52
    fast: bool = True
    silent: bool = False
    doubled: bool = False
    hardware_error: int = 0
    memory: bytearray = field(default_factory=lambda: bytearray(700))

    def __post_init__(self) -> None:
        for item in self.model.table.values():
            self.set(item.name, item.initial or 0)
        self.set("model_number", self.model.model_number)
        self.set("firmware_version", self.firmware)
        self.set("id", self.servo_id)
        self.set("return_delay_time", 0)
        for window in self.model.indirect_windows(self.firmware):
            for i in range(window.count):
                self.memory[window.address + 2 * i : window.address + 2 * i + 2] = (window.data + i).to_bytes(
                    2, "little"
                )
        self._ram = bytes(self.memory)

    def get(self, name: str) -> int:
        item = self.model.table[name]
        return item.decode(bytes(self.memory[item.address : item.end]))

    def set(self, name: str, value: int) -> None:
        item = self.model.table[name]
        self.memory[item.address : item.end] = item.encode(value)

    def reboot(self) -> None:
        """RAM is as after power on."""
        start = min(i.address for i in self.model.table.values() if not i.eeprom)
        self.memory[start:] = self._ram[start:]

    def _place(self, address: int) -> int:
        for w in self.model.indirect_windows(self.firmware):
            if w.data <= address < w.data + w.count:
                at = w.address + 2 * (address - w.data)
                return int.from_bytes(self.memory[at : at + 2], "little")
        return address

    def read(self, address: int, length: int) -> bytes:
        return bytes(self.memory[self._place(a)] for a in range(address, address + length))

    def write(self, address: int, data: bytes) -> int:
        goals = {self.model.table[n].address for n in ("goal_position",)}
        if "bus_watchdog" in self.model.table and self.get("bus_watchdog") == WATCHDOG_TRIPPED and address in goals:
            return ErrorCode.DATA_RANGE
        if any(i.eeprom and i.address == address for i in self.model.table.values()) and self.get("torque_enable"):
            return ErrorCode.ACCESS
        for i, byte in enumerate(data):
            self.memory[self._place(address + i)] = byte
        return 0


class FakePort:
    """A `Port` with fake servos at its end, in virtual time; and reopenable."""

    def __init__(
        self, clock: VirtualClock, servos: list[FakeServo], baud: int = 1_000_000, turnaround_s: float = 0.0
    ) -> None:
        self.name, self.baud, self.clock = "fake://", baud, clock
        self.servos = {s.servo_id: s for s in servos}
        self.turnaround_s, self.echo, self.unplugged = turnaround_s, False, False
        self.spoil: Callable[[bytes, int], bytes] = lambda raw, _servo_id: raw
        self.before: bytes = b""
        self.reopened, self.writes = 0, list[bytes]()
        self._arriving: deque[tuple[float, bytes]] = deque()
        self._decoders = (packet.PacketDecoder(), packet1.PacketDecoder(answers=False))

    def reopen(self) -> None:
        if self.unplugged:
            raise LinkLostError("fake://: still not there")
        self.reopened += 1

    def close(self) -> None:
        self.unplugged = True

    def write(self, data: bytes) -> None:
        if self.unplugged:
            raise LinkLostError("fake://: lost")
        self.writes.append(data)
        t_s = self.clock.now_s() + len(data) * 10 / self.baud
        if self.echo:
            self._arriving.append((t_s, data))
        t_s += self.turnaround_s
        if self.before:
            self._arriving.append((t_s, self.before))
        for decoder, version in zip(self._decoders, (2.0, 1.0), strict=True):
            for request in decoder.feed(data):
                for servo_id, reply in self._replies(request, version):
                    raw = self.spoil(reply, servo_id)
                    t_s += len(raw) * 10 / self.baud
                    if raw:
                        self._arriving.append((t_s, raw))

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        if self.unplugged:
            raise LinkLostError("fake://: lost")
        until_s = self.clock.now_s() + max(0.0, timeout_s)
        if not self._arriving or self._arriving[0][0] > until_s:
            self.clock.sleep_until(until_s)
            return b""
        at_s, raw = self._arriving.popleft()
        self.clock.sleep_until(at_s)
        if len(raw) > max_bytes:
            self._arriving.appendleft((at_s, raw[max_bytes:]))
        return raw[:max_bytes]

    def _replies(self, request: Packet, version: float) -> list[tuple[int, bytes]]:
        kind, codec = request.instruction, packet if version == 2.0 else packet1
        there = {s.get("id"): s for s in self.servos.values() if s.model.protocol == version}
        if kind in (Instruction.PING, Instruction.REBOOT):
            asked = [s for i, s in sorted(there.items()) if request.servo_id in (i, BROADCAST_ID)]
            return [(s.servo_id, r) for s in asked for r in self._simple(s, kind, codec) * (1 + s.doubled)]
        try:
            wanted = codec.accesses(request)
        except PacketError:
            return []
        if kind in (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ):
            return self._fast(wanted, there)
        out: list[tuple[int, bytes]] = []
        for a in wanted:
            servo = there.get(a.servo_id)
            if servo is None or servo.silent:
                if version == 1.0 and kind == Instruction.BULK_READ:
                    break  # each waits for the one before it
                continue
            level = servo.get("status_return_level")
            alert = servo.hardware_error and (packet.ALERT_BIT if version == 2.0 else servo.hardware_error)
            if a.data:
                error = servo.write(a.address, a.data) if version == 2.0 else servo.write(a.address, a.data) * 0
                if request.servo_id != BROADCAST_ID and level == 2:  # a new level counts from the next packet on
                    out.append((a.servo_id, codec.status(a.servo_id, error | alert)))
            elif level:
                out += [(a.servo_id, codec.status(a.servo_id, alert, servo.read(a.address, a.length)))] * (
                    1 + servo.doubled
                )
        return out

    @staticmethod
    def _simple(servo: FakeServo, kind: int, codec: object) -> list[bytes]:
        if servo.silent:
            return []
        if kind == Instruction.REBOOT:
            servo.reboot()
        data = servo.read(0, 2) + servo.read(6, 1) if codec is packet and kind == Instruction.PING else b""
        return [codec.status(servo.get("id"), 0, data)]  # type: ignore[attr-defined]

    @staticmethod
    def _fast(wanted: list[packet.Access], there: dict[int, FakeServo]) -> list[tuple[int, bytes]]:
        """The common packet; it breaks off before the first servo that does not know it or is silent."""
        parts = [there.get(a.servo_id) for a in wanted]
        known = [s is not None and not s.silent and s.fast for s in parts]
        n = known.index(False) if False in known else len(known)
        whole = [
            Part(
                a.servo_id,
                packet.ALERT_BIT if s and s.hardware_error else 0,
                s.read(a.address, a.length) if s else bytes(a.length),
            )
            for a, s in zip(wanted, parts, strict=True)
        ]
        raw = packet.fast_status(whole)
        cut = 8 + sum(4 + a.length for a in wanted[:n]) if n else 0
        return [(wanted[0].servo_id, raw[:cut])]


def spec(name: str, servo_id: int) -> ServoSpec:
    """A servo of a robot file."""
    return ServoSpec.direct(servo_id, f"joint_{servo_id}", servo_models()[name], servo_id - 1)


def fake(*names: str, **port: object) -> tuple[FakePort, list[ServoSpec], VirtualClock]:
    """A port with servos of these models, ids from 1 on."""
    clock = VirtualClock()
    servos = [FakeServo(MODELS[MODEL_NUMBERS[n]], i) for i, n in enumerate(names, 1)]
    return FakePort(clock, servos, **port), [spec(n, i) for i, n in enumerate(names, 1)], clock  # type: ignore[arg-type]
