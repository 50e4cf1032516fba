"""DYNAMIXEL Protocol 2.0 packets, both roles, without any I/O.

ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0": header FF FF FD 00, id, length (low, high), instruction, parameters, CRC-16
(low, high). A status packet has instruction 0x55 and an error byte before its parameters. Inside a packet FF FF FD is
sent as FF FF FD FD ("byte stuffing"), so a header never occurs in it; only the common answer to a fast read, a status
of the broadcast id, is sent as it is.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

from daemon.dynamixel.codec.crc import crc16
from daemon.dynamixel.codec.decoder import StreamDecoder
from daemon.errors import PacketError

HEADER = b"\xff\xff\xfd\x00"
STUFFED = b"\xff\xff\xfd"
BROADCAST_ID, MAX_ID = 0xFE, 252
MAX_LENGTH = 4096
"""Length field in bytes, at most: 252 servos' goals are 1,300 bytes, a fast reply of 252 with 10 each 3,600."""
ALERT_BIT = 0x80
"""Bit of a status packet's error byte: the servo's hardware error register is not zero."""
CLEAR_MULTI_TURN = b"\x01DXL\x22"
BACKUP_STORE, BACKUP_RESTORE = b"\x01CTRL", b"\x02CTRL"


class Instruction(IntEnum):
    """Instructions of a packet (e-manual, "Instruction")."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    REBOOT = 0x08
    CLEAR = 0x10
    CONTROL_TABLE_BACKUP = 0x20
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93
    FAST_BULK_READ = 0x9A


class FactoryReset(IntEnum):
    """Items that a factory reset keeps."""

    ALL = 0xFF
    EXCEPT_ID = 0x01
    EXCEPT_ID_AND_BAUD = 0x02


class ErrorCode(IntEnum):
    """Low seven bits of a status packet's error byte (e-manual, "Error")."""

    NONE = 0
    RESULT_FAIL = 1
    INSTRUCTION = 2
    CRC = 3
    DATA_RANGE = 4
    DATA_LENGTH = 5
    DATA_LIMIT = 6
    ACCESS = 7


def error_text(code: int) -> str:
    """An error code in words."""
    names = {int(e): e.name.lower().replace("_", " ") for e in ErrorCode}
    return names.get(code, f"error {code}")


@dataclass(frozen=True)
class Packet:
    """One packet, parameters not stuffed. `error` is the error byte of a status packet, else 0."""

    servo_id: int
    instruction: int
    parameters: bytes = b""
    error: int = 0


def encode(packet: Packet) -> bytes:
    """Bytes of a packet, stuffed (but for fast replies) and with its checksum."""
    status = packet.instruction == Instruction.STATUS
    body = bytes([packet.instruction, packet.error] if status else [packet.instruction]) + packet.parameters
    if not (status and packet.servo_id == BROADCAST_ID):
        body = body.replace(STUFFED, STUFFED + b"\xfd")
    framed = HEADER + struct.pack("<BH", packet.servo_id, len(body) + 2) + body
    return framed + struct.pack("<H", crc16(framed))


# Requests: the controller's role.


def ping(servo_id: int) -> bytes:
    """Ask a servo (or all, with BROADCAST_ID) for its model and firmware."""
    return encode(Packet(servo_id, Instruction.PING))


def read(servo_id: int, address: int, length: int) -> bytes:
    """Ask for `length` bytes at `address`."""
    return encode(Packet(servo_id, Instruction.READ, struct.pack("<HH", address, length)))


def write(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes at `address`."""
    return encode(Packet(servo_id, Instruction.WRITE, struct.pack("<H", address) + data))


def reg_write(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes at `address` once `action` is sent."""
    return encode(Packet(servo_id, Instruction.REG_WRITE, struct.pack("<H", address) + data))


def action(servo_id: int = BROADCAST_ID) -> bytes:
    """Carry out what `reg_write` registered."""
    return encode(Packet(servo_id, Instruction.ACTION))


def reboot(servo_id: int) -> bytes:
    """Restart a servo: clears latched errors, drops torque and RAM."""
    return encode(Packet(servo_id, Instruction.REBOOT))


def factory_reset(servo_id: int, keep: FactoryReset) -> bytes:
    """Set a servo's table to the factory's values."""
    return encode(Packet(servo_id, Instruction.FACTORY_RESET, bytes([keep])))


def clear_multi_turn(servo_id: int) -> bytes:
    """Bring present_position back within one turn; the servo must stand still."""
    return encode(Packet(servo_id, Instruction.CLEAR, CLEAR_MULTI_TURN))


def backup(servo_id: int) -> bytes:
    """Store the servo's table in its backup area; torque must be off."""
    return encode(Packet(servo_id, Instruction.CONTROL_TABLE_BACKUP, BACKUP_STORE))


def restore(servo_id: int) -> bytes:
    """Bring the EEPROM back from the backup area; the servo then reboots."""
    return encode(Packet(servo_id, Instruction.CONTROL_TABLE_BACKUP, BACKUP_RESTORE))


def sync_read(address: int, length: int, servo_ids: Sequence[int], *, fast: bool = False) -> bytes:
    """Request the same bytes of several servos; they answer in this order, with `fast` in one common packet."""
    instruction = Instruction.FAST_SYNC_READ if fast else Instruction.SYNC_READ
    return encode(Packet(BROADCAST_ID, instruction, struct.pack("<HH", address, length) + bytes(servo_ids)))


def sync_write(address: int, length: int, rows: Sequence[tuple[int, bytes]]) -> bytes:
    """Write `length` bytes at `address` of several servos at once; no servo answers."""
    data = b"".join(bytes([servo_id]) + value for servo_id, value in rows)
    return encode(Packet(BROADCAST_ID, Instruction.SYNC_WRITE, struct.pack("<HH", address, length) + data))


def bulk_read(rows: Sequence[tuple[int, int, int]], *, fast: bool = False) -> bytes:
    """Ask each servo (id, address, length) for its own bytes; they answer in this order."""
    instruction = Instruction.FAST_BULK_READ if fast else Instruction.BULK_READ
    return encode(Packet(BROADCAST_ID, instruction, b"".join(struct.pack("<BHH", *row) for row in rows)))


def bulk_write(rows: Sequence[tuple[int, int, bytes]]) -> bytes:
    """Write to each servo (id, address, bytes) its own bytes; no servo answers."""
    data = b"".join(struct.pack("<BHH", servo_id, address, len(value)) + value for servo_id, address, value in rows)
    return encode(Packet(BROADCAST_ID, Instruction.BULK_WRITE, data))


# Contents of requests, and answers: the servo's role.


class Access(NamedTuple):
    """One servo's part of a request: `length` bytes at `address`, and the bytes to write, if any."""

    servo_id: int
    address: int
    length: int
    data: bytes = b""


def accesses(request: Packet) -> list[Access]:
    """The accesses that a read or write of any kind requests of each servo, in the order of their answers.

    Raises:
        PacketError: the parameters of the request are cut short.
    """
    p, kind = request.parameters, request.instruction
    if kind == Instruction.READ and len(p) == 4:
        return [Access(request.servo_id, *struct.unpack("<HH", p))]
    if kind in (Instruction.WRITE, Instruction.REG_WRITE) and len(p) >= 3:
        return [Access(request.servo_id, struct.unpack_from("<H", p)[0], len(p) - 2, p[2:])]
    if kind in (Instruction.SYNC_READ, Instruction.FAST_SYNC_READ) and len(p) >= 4:
        address, length = struct.unpack_from("<HH", p)
        return [Access(servo_id, address, length) for servo_id in p[4:]]
    if kind == Instruction.SYNC_WRITE and len(p) >= 4:
        address, length = struct.unpack_from("<HH", p)
        if length and (len(p) - 4) % (length + 1) == 0:
            starts = range(4, len(p), length + 1)
            return [Access(p[at], address, length, p[at + 1 : at + 1 + length]) for at in starts]
    if kind in (Instruction.BULK_READ, Instruction.FAST_BULK_READ) and len(p) % 5 == 0:
        return [Access(*row) for row in struct.iter_unpack("<BHH", p)]
    if kind == Instruction.BULK_WRITE:
        return _bulk_write_rows(p)
    raise PacketError(f"instruction {kind:#04x} with {len(p)} parameters is no whole read or write")


def _bulk_write_rows(p: bytes) -> list[Access]:
    rows: list[Access] = []
    at = 0
    while at < len(p):
        if at + 5 > len(p):
            raise PacketError(f"bulk write ends within the head of its row {len(rows)}")
        servo_id, address, length = struct.unpack_from("<BHH", p, at)
        at += 5 + length
        if not length or at > len(p):
            raise PacketError(f"bulk write: row of servo {servo_id} says {length} bytes, {len(p)} in all")
        rows.append(Access(servo_id, address, length, p[at - length : at]))
    return rows


def status(servo_id: int, error: int = 0, parameters: bytes = b"") -> bytes:
    """A servo's answer."""
    return encode(Packet(servo_id, Instruction.STATUS, parameters, error))


class Part(NamedTuple):
    """One servo's part of a fast reply."""

    servo_id: int
    error: int
    data: bytes


def fast_status(parts: Sequence[Part]) -> bytes:
    """The common answer of all servos to a fast read.

    Each servo's part ends in the CRC of everything before it, the parts of the others and their CRCs included.
    """
    length = 1 + sum(4 + len(part.data) for part in parts)
    out = HEADER + struct.pack("<BHB", BROADCAST_ID, length, Instruction.STATUS)
    for part in parts:
        out += bytes([part.error, part.servo_id]) + part.data
        out += struct.pack("<H", crc16(out))
    return out


def fast_parts(reply: Packet, lengths: Sequence[int]) -> list[Part]:
    """The parts of a complete fast reply; `lengths` are the bytes requested of each servo.

    Raises:
        PacketError: the packet has another length.
    """
    p, parts, error, at = reply.parameters, list[Part](), reply.error, 0
    if len(p) != sum(lengths) + 4 * len(lengths) - 3:
        raise PacketError(f"fast reply of {len(p)} bytes for {len(lengths)} servos that were asked {sum(lengths)}")
    for length in lengths:
        parts.append(Part(p[at], error, p[at + 1 : at + 1 + length]))
        at += 3 + length
        error = p[at] if at < len(p) else 0
        at += 1
    return parts


class PacketDecoder(StreamDecoder[Packet]):
    """Packets of both roles."""

    header = HEADER

    def _end(self, start: int) -> int | None:
        buffer = self._buffer
        if len(buffer) < start + 7:
            return None
        length = buffer[start + 5] | buffer[start + 6] << 8
        if not 3 <= length <= MAX_LENGTH:
            return 0
        end = start + 7 + length
        if len(buffer) < end:
            return None
        if crc16(memoryview(buffer)[start : end - 2]) != buffer[end - 2] | buffer[end - 1] << 8:
            self.bad_checksums += 1
            if end == len(buffer):
                self.damaged_id = buffer[start + 4]
            return 0
        if buffer[start + 7] == Instruction.STATUS and length < 4:
            return 0
        return end

    def _parse(self, raw: bytes) -> Packet:
        body, is_status = raw[7:-2], raw[7] == Instruction.STATUS
        if not (is_status and raw[4] == BROADCAST_ID):
            body = body.replace(STUFFED + b"\xfd", STUFFED)
        return Packet(raw[4], body[0], body[2:], body[1]) if is_status else Packet(raw[4], body[0], body[1:])
