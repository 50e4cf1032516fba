"""The one packet that answers a fast read, and the bytes that each servo adds to it in its turn."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.crc import crc16
from daemon.dynamixel.codec.packet import BROADCAST_ID, Instruction, Part


def shares_of(turns: Sequence[Sequence[Part]], length: int) -> list[list[bytes]]:
    """Bytes sent in each turn: the packet's head in the first, then a part and the checksum of all bytes received so far.

    Args:
        turns: the part of each servo whose turn it is; more than one where servos share an id. They talk at once and the
            next one hears their AND.
        length: of the packet, as its head says.
    """
    head = packet.HEADER + struct.pack("<BHB", BROADCAST_ID, length, Instruction.STATUS)
    shares: list[list[bytes]] = []
    crc = 0
    for parts in turns:
        start = b"" if shares else head
        said = [start + bytes([part.error, part.servo_id]) + part.data for part in parts]
        sums = [crc16(own, crc) for own in said]
        ends = [struct.pack("<H", own) for own in sums]
        shares.append([own + end for own, end in zip(said, ends, strict=True)])
        crc = crc16(ends[0], sums[0]) if len(parts) == 1 else crc16(_heard(shares[-1]), crc)
    return shares


def _heard(said: Sequence[bytes]) -> bytes:
    """Bytes that are received when several servos send at once."""
    heard = int.from_bytes(said[0])
    for own in said[1:]:
        heard &= int.from_bytes(own)
    return heard.to_bytes(len(said[0]))


def share_as(before: Sequence[Sequence[Part]], part: Part, length: int) -> Callable[[int], bytes]:
    """A function from the id to be carried to the bytes that a servo adds to a fast reply."""
    return lambda servo_id: shares_of([*before, [part._replace(servo_id=servo_id)]], length)[-1][0]
