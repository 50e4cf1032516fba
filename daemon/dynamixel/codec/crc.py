"""CRC-16 of Protocol 2.0 (polynomial 0x8005, start 0, high bit first), along the bytes and by position.

With start 0 the checksum is linear: that of n bytes is the XOR over positions of a table by position and byte. So one
gather and one XOR-reduce check a frame of known length, or all frames of a group at once.
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray


def _table() -> list[int]:
    table: list[int] = []
    for byte in range(256):
        crc = byte << 8
        for _ in range(8):
            crc = ((crc << 1) ^ 0x8005 if crc & 0x8000 else crc << 1) & 0xFFFF
        table.append(crc)
    return table


_TABLE = _table()


def _pair_table() -> list[int]:
    """Checksum of every two bytes, the first one high: the state is as wide as two bytes and can take both at once."""
    table, pair = np.array(_TABLE, np.uint32), np.arange(1 << 16)
    after_first = table[pair >> 8]
    return (((after_first << 8) & 0xFFFF) ^ table[(after_first >> 8) ^ (pair & 0xFF)]).tolist()


_PAIRS = _pair_table()


def crc16(data: bytes | bytearray | memoryview, start: int = 0) -> int:
    """Checksum of `data`, continued from `start`."""
    crc, odd, table = start, len(data) % 2, _PAIRS
    if odd:
        crc = ((crc << 8) ^ _TABLE[((crc >> 8) ^ data[0]) & 0xFF]) & 0xFFFF
    pairs: tuple[int, ...] = struct.unpack_from(f">{len(data) // 2}H", data, odd)
    for pair in pairs:
        crc = table[crc ^ pair]
    return crc


def position_table(n: int) -> NDArray[np.uint16]:
    """(n, 256) contribution of each byte at each position to the checksum of n bytes."""
    table = np.zeros((n, 256), np.uint16)
    row = base = np.array(_TABLE, np.uint16)
    for position in range(n - 1, -1, -1):
        table[position] = row
        row = ((row << 8) & 0xFFFF) ^ base[row >> 8]
    return table


class FixedCrc:
    """Checksums of rows of `n` bytes, without allocation.

    Args:
        rows: number of rows.
        n: bytes of each row.
    """

    def __init__(self, rows: int, n: int) -> None:
        self._flat = position_table(n).reshape(-1)
        self._base = np.arange(n, dtype=np.intp) * 256
        self._index = np.empty((rows, n), np.intp)
        self._values = np.empty((rows, n), np.uint16)
        self._crc = np.empty(rows, np.uint16)

    def of(self, data: NDArray[np.uint8]) -> NDArray[np.uint16]:
        """(rows,) checksums of (rows, n) bytes; the array is reused by the next call."""
        np.add(self._base, data, out=self._index)
        self._flat.take(self._index, out=self._values, mode="clip")
        return np.bitwise_xor.reduce(self._values, axis=1, out=self._crc)
