"""Fast frames of a fixed group of servos: goals out, feedback in, all servos at once, no allocation in the loop.

Only frames of exactly the expected layout are decoded here; all others (a loss, stuffing, another order) are left to
`packet.PacketDecoder`, which gives the same result byte by byte.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.crc import FixedCrc, crc16, position_table
from daemon.dynamixel.codec.packet import BROADCAST_ID, HEADER, STUFFED, Instruction, Packet, encode, sync_write

_HEAD_BYTES = 8  # header, id, length, instruction
_CRC_BYTES = 2


class GroupWrite:
    """A sync write of one little-endian number to each servo of a group.

    Args:
        servo_ids: ids of the servos, in the order of the values.
        address: address of the item.
        size: bytes of the item, 1, 2 or 4.
    """

    def __init__(self, servo_ids: Sequence[int], address: int, size: int) -> None:
        self._frame = np.frombuffer(
            bytearray(sync_write(address, size, [(i, bytes(size)) for i in servo_ids])), np.uint8
        )
        n, at = len(servo_ids), _HEAD_BYTES + 4 + 1
        self._values = np.ndarray((n,), f"<i{size}", self._frame.data, at, (size + 1,))
        self._body = self._frame[:-_CRC_BYTES].reshape(1, -1)
        self._crc = np.ndarray((1,), "<u2", self._frame.data, len(self._frame) - _CRC_BYTES)
        self._crc_of = FixedCrc(1, len(self._frame) - _CRC_BYTES)

    @property
    def n_bytes(self) -> int:
        """Length of the frame when nothing in it needs stuffing."""
        return len(self._frame)

    def frame(self, values: NDArray[np.int32]) -> bytes:
        """The packet that writes (N,) `values`."""
        self._values[:] = values
        self._crc[:] = self._crc_of.of(self._body)
        raw = self._frame.tobytes()
        if raw.find(STUFFED, _HEAD_BYTES) < 0:
            return raw
        return encode(Packet(BROADCAST_ID, raw[7], raw[_HEAD_BYTES:-_CRC_BYTES]))


class GroupReply:
    """The answers to a sync read: one status packet from each servo, in order.

    Args:
        servo_ids: ids of the servos, in the order of the request.
        length: bytes asked of each.
    """

    def __init__(self, servo_ids: Sequence[int], length: int) -> None:
        n = len(servo_ids)
        self.frame_bytes = 11 + length
        self.n_bytes = self.frame_bytes * n
        self._buffer = np.zeros(self.n_bytes, np.uint8)
        frames = [encode(Packet(i, Instruction.STATUS, bytes(length))) for i in servo_ids]
        self._heads = np.array([struct.unpack("<Q", f[:_HEAD_BYTES])[0] for f in frames], np.uint64)
        rows, stride = self._buffer.reshape(n, self.frame_bytes), (self.frame_bytes,)
        self._body = rows[:, :-_CRC_BYTES]
        self._head = np.ndarray((n,), "<u8", self._buffer.data, 0, stride)
        self._crc = np.ndarray((n,), "<u2", self._buffer.data, self.frame_bytes - _CRC_BYTES, stride)
        self._crc_of = FixedCrc(n, self.frame_bytes - _CRC_BYTES)
        self.errors, self.data = rows[:, 8], rows[:, 9:-_CRC_BYTES]
        """(N,) error bytes and (N, length) parameters of what `parse` took last; views, overwritten by the next."""
        self._last_head = frames[-1][:_HEAD_BYTES] if frames else b""

    def column(self, offset: int, dtype: str) -> NDArray[np.int32]:
        """(N,) view of the number at `offset` of each servo's data; `dtype` like "<i4"."""
        return np.ndarray((len(self.errors),), dtype, self._buffer.data, 9 + offset, (self.frame_bytes,))

    def parse(self, raw: bytes | bytearray) -> bool:
        """Whether `raw` is exactly the expected frames; `errors`, `data` and the columns then contain their values.

        A stuffed frame has another length, so nothing taken here needs unstuffing.
        """
        if len(raw) != self.n_bytes or raw.count(STUFFED) != len(self._heads):
            return False
        self._buffer[:] = np.frombuffer(raw, np.uint8)
        return bool((self._head == self._heads).all() and (self._crc_of.of(self._body) == self._crc).all())

    def ends(self, raw: bytes | bytearray) -> bool:
        """Whether `raw` ends in the complete frame of the last servo, after which no other answers."""
        frame = bytes(raw[-self.frame_bytes :])
        if len(frame) < self.frame_bytes or not frame.startswith(self._last_head):
            return False
        return crc16(frame[:-_CRC_BYTES]) == frame[-2] | frame[-1] << 8


class FastGroupReply:
    """The common answer to a fast sync read; each servo's part is checked by itself.

    Each part's CRC continues from the CRC before it, so a part is good when it follows from the CRC that was received before it:
    bytes lost from one servo's part cost that part alone. The last CRC alone proves nothing about the other parts: the servos
    compute it over the bytes that they receive, and they receive two answers sent at once by two servos of one id as we do.

    Args:
        servo_ids: ids of the servos, in the order of the request.
        length: bytes asked of each.
    """

    def __init__(self, servo_ids: Sequence[int], length: int) -> None:
        n = len(servo_ids)
        self._part_bytes = 4 + length  # error, id, data, CRC
        self.n_bytes = _HEAD_BYTES + self._part_bytes * n
        self._head = HEADER + struct.pack("<BHB", BROADCAST_ID, self.n_bytes - 7, Instruction.STATUS)
        self._buffer = np.zeros(self.n_bytes, np.uint8)
        stride = (self._part_bytes,)
        parts = self._buffer[_HEAD_BYTES:].reshape(n, self._part_bytes)
        self._body = parts[:, :-_CRC_BYTES]
        self._ids = np.array(servo_ids, np.uint8)
        self._id = parts[:, 1]
        self._crc = np.ndarray((n,), "<u2", self._buffer.data, _HEAD_BYTES + self._part_bytes - _CRC_BYTES, stride)
        self._low, self._high = parts[:, -2], parts[:, -1]
        self._crc_of = FixedCrc(n, self._part_bytes - _CRC_BYTES)
        body_zeros = bytes(self._part_bytes - _CRC_BYTES)
        # With state (high, low) the two CRC bytes that follow it, low first, both become low ^ high.
        start = position_table(2)
        self._carry = np.array([crc16(body_zeros, int(start[0, x] ^ start[1, x])) for x in range(256)], np.uint16)
        self._first = np.uint16(crc16(body_zeros, crc16(self._head)))
        self._start = np.empty(n, np.uint16)
        self.errors, self.data = parts[:, 0], parts[:, 2:-_CRC_BYTES]
        """(N,) error bytes and (N, length) parameters of what `parse` took last; views, overwritten by the next."""

    def column(self, offset: int, dtype: str) -> NDArray[np.int32]:
        """(N,) view of the number at `offset` of each servo's data; `dtype` like "<i4"."""
        at = _HEAD_BYTES + 2 + offset
        return np.ndarray((len(self.errors),), dtype, self._buffer.data, at, (self._part_bytes,))

    def parse(self, raw: bytes | bytearray) -> NDArray[np.bool_]:
        """(N,) whether each servo's part is complete; `errors`, `data` and the columns contain the values of complete parts."""
        n = len(raw)
        if not raw.startswith(self._head) or n > self.n_bytes:
            return np.zeros(len(self._ids), bool)
        self._buffer[:n] = np.frombuffer(raw, np.uint8)
        self._start[0] = self._first
        self._carry.take(self._low[:-1] ^ self._high[:-1], out=self._start[1:])
        whole = ((self._crc_of.of(self._body) ^ self._start) == self._crc) & (self._id == self._ids)
        if n < self.n_bytes:
            whole[(n - _HEAD_BYTES) // self._part_bytes :] = False
        return whole if whole.all() else self._salvaged(raw, whole)

    def _salvaged(self, raw: bytes | bytearray, whole: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Add the parts whose checksum follows from all bytes received before them.

        A servo behind two of one id continues from the bytes that it received, which neither of the two meant. When no part but the
        last is right, the servos leave the other checksums empty, as the manual lets them. With only two servos this case cannot be
        distinguished from a collision.
        """
        crc, end, follows = crc16(self._head), _HEAD_BYTES, False
        for i in range(len(self._ids)):
            start, end = end, end + self._part_bytes
            if end > len(raw):
                return whole
            crc = crc16(raw[start : end - _CRC_BYTES], crc)
            follows = raw[end - _CRC_BYTES : end] == struct.pack("<H", crc) and raw[start + 1] == self._ids[i]
            whole[i] |= follows
            crc = crc16(raw[end - _CRC_BYTES : end], crc)
        if follows and len(self._ids) > 2 and not whole[:-1].any() and self._id.tobytes() == self._ids.tobytes():
            whole[:] = True
        return whole


class GroupWrite1:
    """A group write on protocol 1.0: for few servos, with a checksum that needs no table."""

    def __init__(self, servo_ids: Sequence[int], address: int, size: int) -> None:
        self._ids, self._address, self._size = tuple(servo_ids), address, size
        self.n_bytes = 8 + len(servo_ids) * (1 + size)

    def frame(self, values: NDArray[np.int32]) -> bytes:
        """The packet that writes (N,) `values`."""
        rows = values.astype(f"<i{self._size}").view(np.uint8).reshape(-1, self._size)
        pairs = [(servo_id, row.tobytes()) for servo_id, row in zip(self._ids, rows, strict=True)]
        return packet1.sync_write(self._address, self._size, pairs)
