"""DYNAMIXEL Protocol 1.0 packets (AX, MX), both roles, without any I/O.

ROBOTIS e-manual, "DYNAMIXEL Protocol 1.0": header FF FF, id, length, instruction (or, in a status packet, the error
bits), parameters, checksum: the complement of the sum of all after the header. Bytes are not stuffed, and requests
and answers look alike, so that a decoder must be set to decode one of the two.
"""

from __future__ import annotations

from collections.abc import Sequence

from daemon.dynamixel.codec.decoder import StreamDecoder
from daemon.dynamixel.codec.packet import BROADCAST_ID, Access, Instruction, Packet
from daemon.errors import PacketError

HEADER = b"\xff\xff"
MAX_ID = 253
MAX_PARAMETERS = 253
HARDWARE_ERROR_BITS = {0: "input voltage", 1: "angle limit", 2: "overheating", 5: "overload"}
REQUEST_ERROR_BITS = {3: "range", 4: "checksum", 6: "instruction"}
ALERT_BITS = 0b100101
"""Bits of the error byte for voltage, overheating and overload: the servo is in trouble, whatever was requested. The other bits
concern the request."""


def error_text(error: int) -> str:
    """The set bits of an error byte in words."""
    names = HARDWARE_ERROR_BITS | REQUEST_ERROR_BITS
    return ", ".join(f"{name} error" for bit, name in sorted(names.items()) if error >> bit & 1) or "none"


def checksum(data: bytes | bytearray | memoryview) -> int:
    """Checksum of everything between header and checksum."""
    return ~sum(data) & 0xFF


def encode(packet: Packet) -> bytes:
    """Bytes of a packet; a status packet carries its error byte in place of the instruction.

    Raises:
        PacketError: more parameters than the length byte can say.
    """
    if len(packet.parameters) > MAX_PARAMETERS:
        raise PacketError(f"{len(packet.parameters)} parameters; protocol 1.0 carries at most {MAX_PARAMETERS}")
    kind = packet.error if packet.instruction == Instruction.STATUS else packet.instruction
    body = bytes([packet.servo_id, len(packet.parameters) + 2, kind]) + packet.parameters
    return HEADER + body + bytes([checksum(body)])


def ping(servo_id: int) -> bytes:
    """Ask whether a servo is there."""
    return encode(Packet(servo_id, Instruction.PING))


def read(servo_id: int, address: int, length: int) -> bytes:
    """Ask for `length` bytes at `address`."""
    return encode(Packet(servo_id, Instruction.READ, bytes([address, length])))


def write(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes at `address`."""
    return encode(Packet(servo_id, Instruction.WRITE, bytes([address]) + data))


def reg_write(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes at `address` once `action` is sent."""
    return encode(Packet(servo_id, Instruction.REG_WRITE, bytes([address]) + data))


def action(servo_id: int = BROADCAST_ID) -> bytes:
    """Carry out what `reg_write` registered."""
    return encode(Packet(servo_id, Instruction.ACTION))


def factory_reset(servo_id: int) -> bytes:
    """Set a servo's table to the factory's values, its id included."""
    return encode(Packet(servo_id, Instruction.FACTORY_RESET))


def reboot(servo_id: int) -> bytes:
    """Restart a servo (MX with firmware that knows it)."""
    return encode(Packet(servo_id, Instruction.REBOOT))


def sync_write(address: int, length: int, rows: Sequence[tuple[int, bytes]]) -> bytes:
    """Write `length` bytes at `address` of several servos at once; no servo answers."""
    data = b"".join(bytes([servo_id]) + value for servo_id, value in rows)
    return encode(Packet(BROADCAST_ID, Instruction.SYNC_WRITE, bytes([address, length]) + data))


def bulk_read(rows: Sequence[tuple[int, int, int]]) -> bytes:
    """Ask each servo (id, address, length) for its own bytes (MX only).

    They answer in this order, each once the one before it has.
    """
    data = b"".join(bytes([length, servo_id, address]) for servo_id, address, length in rows)
    return encode(Packet(BROADCAST_ID, Instruction.BULK_READ, b"\0" + data))


def accesses(request: Packet) -> list[Access]:
    """The accesses that a read or write of any kind requests of each servo, in the order of their answers.

    Raises:
        PacketError: the parameters of the request are cut short.
    """
    p, kind = request.parameters, request.instruction
    if kind == Instruction.READ and len(p) == 2:
        return [Access(request.servo_id, p[0], p[1])]
    if kind in (Instruction.WRITE, Instruction.REG_WRITE) and len(p) >= 2:
        return [Access(request.servo_id, p[0], len(p) - 1, p[1:])]
    if kind == Instruction.SYNC_WRITE and len(p) >= 2 and p[1] and (len(p) - 2) % (p[1] + 1) == 0:
        address, length = p[0], p[1]
        starts = range(2, len(p), length + 1)
        return [Access(p[at], address, length, p[at + 1 : at + 1 + length]) for at in starts]
    if kind == Instruction.BULK_READ and len(p) % 3 == 1 and p[0] == 0:
        return [Access(p[at + 1], p[at + 2], p[at]) for at in range(1, len(p), 3)]
    raise PacketError(f"instruction {kind:#04x} with {len(p)} parameters is no whole read or write")


def status(servo_id: int, error: int = 0, parameters: bytes = b"") -> bytes:
    """A servo's answer."""
    return encode(Packet(servo_id, Instruction.STATUS, parameters, error))


class PacketDecoder(StreamDecoder[Packet]):
    """Packets of one role.

    Args:
        answers: True for the controller's role (status packets come in), False for the servo's (requests come in).
    """

    header = HEADER

    def __init__(self, *, answers: bool = True) -> None:
        super().__init__()
        self._answers = answers

    def _end(self, start: int) -> int | None:
        buffer = self._buffer
        if len(buffer) < start + 4:
            return None
        if buffer[start + 2] == 0xFF or buffer[start + 3] < 2:
            return 0
        end = start + 4 + buffer[start + 3]
        if len(buffer) < end:
            return None
        if checksum(memoryview(buffer)[start + 2 : end - 1]) != buffer[end - 1]:
            self.bad_checksums += 1
            if end == len(buffer):
                self.damaged_id = buffer[start + 2]
            return 0
        return end

    def _parse(self, raw: bytes) -> Packet:
        if self._answers:
            return Packet(raw[2], Instruction.STATUS, raw[5:-1], raw[4])
        return Packet(raw[2], raw[4], raw[5:-1])
