"""DYNAMIXEL Protocol 2.0 packets, both roles, without any I/O.

ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0": header FF FF FD 00, id, length (low, high), instruction, parameters, CRC-16
(low, high). A status packet has instruction 0x55 and an error byte before its parameters. Inside a packet FF FF FD is
sent as FF FF FD FD ("byte stuffing"), so a header never occurs in it.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

HEADER = b"\xff\xff\xfd\x00"
STUFFED = b"\xff\xff\xfd"
BROADCAST_ID = 0xFE
MAX_LENGTH = 1024
"""Longest length field taken for real: sixty servos' goals are 312 bytes."""
ALERT_BIT = 0x80
"""In the error byte of a status packet: the servo's hardware error register is not zero."""


class Instruction(IntEnum):
    """What a packet asks for (e-manual, "Instruction")."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REBOOT = 0x08
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83


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


def _crc_table() -> list[int]:
    table: list[int] = []
    for byte in range(256):
        crc = byte << 8
        for _ in range(8):
            crc = ((crc << 1) ^ 0x8005 if crc & 0x8000 else crc << 1) & 0xFFFF
        table.append(crc)
    return table


_CRC_TABLE = _crc_table()


def crc16(data: bytes | bytearray | memoryview) -> int:
    """CRC-16 of the protocol: polynomial 0x8005, start 0, high bit first."""
    crc = 0
    for byte in data:
        crc = ((crc << 8) ^ _CRC_TABLE[((crc >> 8) ^ byte) & 0xFF]) & 0xFFFF
    return crc


def encode(packet: Packet) -> bytes:
    """Bytes of a packet, stuffed and with its checksum."""
    error = bytes([packet.error]) if packet.instruction == Instruction.STATUS else b""
    body = (bytes([packet.instruction]) + error + packet.parameters).replace(STUFFED, STUFFED + b"\xfd")
    framed = HEADER + struct.pack("<BH", packet.servo_id, len(body) + 2) + body
    return framed + struct.pack("<H", crc16(framed))


def ping(servo_id: int) -> bytes:
    """Ask a servo (or all, with BROADCAST_ID) for its model and firmware."""
    return encode(Packet(servo_id, Instruction.PING))


def read(servo_id: int, address: int, length: int) -> bytes:
    """Ask for `length` bytes at `address`."""
    return encode(Packet(servo_id, Instruction.READ, struct.pack("<HH", address, length)))


def write(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes at `address`."""
    return encode(Packet(servo_id, Instruction.WRITE, struct.pack("<H", address) + data))


def reboot(servo_id: int) -> bytes:
    """Restart a servo: clears latched errors, drops torque and RAM."""
    return encode(Packet(servo_id, Instruction.REBOOT))


def sync_read(address: int, length: int, servo_ids: Sequence[int]) -> bytes:
    """Ask several servos for the same bytes; they answer one after another in this order."""
    return encode(Packet(BROADCAST_ID, Instruction.SYNC_READ, struct.pack("<HH", address, length) + bytes(servo_ids)))


def sync_write(address: int, length: int, rows: Sequence[tuple[int, bytes]]) -> bytes:
    """Write `length` bytes at `address` of several servos at once; nobody answers."""
    data = b"".join(bytes([servo_id]) + value for servo_id, value in rows)
    return encode(Packet(BROADCAST_ID, Instruction.SYNC_WRITE, struct.pack("<HH", address, length) + data))


class PacketDecoder:
    """Bytes in, packets out. Garbage is skipped and counted; a length is believed only once the checksum agrees."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self.skipped_bytes = 0
        self.bad_checksums = 0

    def feed(self, data: bytes) -> list[Packet]:
        """Packets completed by `data`."""
        self._buffer += data
        packets: list[Packet] = []
        while (found := self._next()) is not None:
            packets.append(found)
        return packets

    def clear(self) -> None:
        """Forget what was not decoded."""
        self.skipped_bytes += len(self._buffer)
        self._buffer.clear()

    def _next(self) -> Packet | None:
        """First whole packet in the buffer; what stands before it is dropped, what may still grow is kept."""
        buffer, start, keep_from = self._buffer, 0, None
        while (start := buffer.find(HEADER, start)) >= 0:
            end = self._end(start)
            if end is None:  # may still grow; a later packet that is whole wins over it
                keep_from = start if keep_from is None else keep_from
            elif end > 0:
                raw = bytes(buffer[start:end])
                self._drop(end, skipped=start)
                return _parse(raw)
            start += 1
        if keep_from is None:
            keep_from = max(0, len(buffer) - (len(HEADER) - 1))  # the header may have begun
            tail = bytes(buffer[keep_from:])
            while tail and not HEADER.startswith(tail):
                tail = tail[1:]
            keep_from = len(buffer) - len(tail)
        self._drop(keep_from, skipped=keep_from)
        return None

    def _end(self, start: int) -> int | None:
        """Index after the packet at `start`; 0 when there is none, None when bytes are missing."""
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
            return 0
        if buffer[start + 7] == Instruction.STATUS and length < 4:
            return 0
        return end

    def _drop(self, end: int, skipped: int) -> None:
        self.skipped_bytes += skipped
        del self._buffer[:end]


def _parse(raw: bytes) -> Packet:
    body = raw[7:-2].replace(STUFFED + b"\xfd", STUFFED)
    if body[0] == Instruction.STATUS:
        return Packet(raw[4], body[0], body[2:], body[1])
    return Packet(raw[4], body[0], body[1:])


class GroupReply:
    """Fast parser of a sync read's answers: all frames at once, when they are the ones asked for, in order and whole.

    The checksum is linear: with start 0 it is the XOR over positions of a table by position and byte, so one gather and
    one XOR-reduce check every frame. Anything else is left to `PacketDecoder`.
    """

    def __init__(self, servo_ids: Sequence[int], length: int) -> None:
        self.frame_bytes = 11 + length
        self.n_bytes = self.frame_bytes * len(servo_ids)
        frames = [encode(Packet(i, Instruction.STATUS, bytes(length))) for i in servo_ids]
        template = np.frombuffer(b"".join(frames), np.uint8).reshape(len(servo_ids), -1)
        self._fixed = template[:, :8].copy()
        self._table = _position_table(self.frame_bytes - 2)
        self._columns = np.arange(self.frame_bytes - 2)

    def parse(self, raw: bytes) -> tuple[NDArray[np.uint8], NDArray[np.uint8]] | None:
        """(N,) error bytes and (N, length) parameters; None when `raw` is not exactly the expected frames."""
        if len(raw) != self.n_bytes:
            return None
        frames = np.frombuffer(raw, np.uint8).reshape(-1, self.frame_bytes)
        if not np.array_equal(frames[:, :8], self._fixed):
            return None
        crc = np.bitwise_xor.reduce(self._table[self._columns, frames[:, :-2]], axis=1)
        if not np.array_equal(crc, frames[:, -2].astype(np.uint16) | frames[:, -1].astype(np.uint16) << 8):
            return None
        return frames[:, 8], frames[:, 9:-2]  # a stuffed frame would have had another length


def _position_table(n: int) -> NDArray[np.uint16]:
    """(n, 256) contribution of each byte at each position to the checksum of n bytes."""
    table = np.zeros((n, 256), np.uint16)
    row = np.array(_CRC_TABLE, np.uint16)
    base = row
    for position in range(n - 1, -1, -1):
        table[position] = row
        row = ((row << 8) & 0xFFFF) ^ base[row >> 8]
    return table
