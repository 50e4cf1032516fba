"""CRC-16 of Protocol 2.0 (polynomial 0x8005, start 0, high bit first), byte by byte and by position.

With start 0 the checksum is linear: that of n bytes is the XOR over positions of a table by position and byte. So one
gather and one XOR-reduce check a frame of known length, or all frames of a group at once.
"""

from __future__ import annotations

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


def crc16(data: bytes | bytearray | memoryview, start: int = 0) -> int:
    """Checksum of `data`, going on from `start`."""
    crc = start
    for byte in data:
        crc = ((crc << 8) ^ _TABLE[((crc >> 8) ^ byte) & 0xFF]) & 0xFFFF
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
        rows: how many rows at once.
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
