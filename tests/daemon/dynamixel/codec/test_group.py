"""The fast frames of a group equal the byte parser, take nothing else, and salvage what is whole."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.crc import FixedCrc, crc16, position_table
from daemon.dynamixel.codec.group import FastGroupReply, GroupReply, GroupWrite
from daemon.dynamixel.codec.packet import STUFFED, PacketDecoder, Part, fast_status, status

groups = st.lists(st.integers(0, 252), min_size=1, max_size=20, unique=True)
bodies = st.binary(min_size=10, max_size=10) | st.lists(st.sampled_from([0xFF, 0xFD, 0]), min_size=10, max_size=10).map(
    bytes
)
errors = st.sampled_from([0, 0x80, 0x84, 0xFF])


@given(st.integers(1, 40), st.integers(1, 6), st.data())
def test_checksums_by_position_are_those_byte_by_byte(n: int, rows: int, data: st.DataObject) -> None:
    body = data.draw(st.binary(min_size=n * rows, max_size=n * rows))
    array = np.frombuffer(body, np.uint8).reshape(rows, n)
    assert FixedCrc(rows, n).of(array).tolist() == [crc16(bytes(row)) for row in array]
    assert position_table(n).shape == (n, 256)


@given(groups, st.sampled_from([(116, 4), (100, 2), (64, 1)]), st.data())
def test_a_group_write_is_the_sync_write_of_the_codec(
    ids: list[int], item: tuple[int, int], data: st.DataObject
) -> None:
    """Negative and header-like values included: they are stuffed."""
    address, size = item
    top = 1 << 8 * size - 1
    header_like = [v for v in (-1, -513, 0x00FDFFFF, -131073) if -top <= v < top]
    value = st.integers(-top, top - 1) | st.sampled_from(header_like)
    values = data.draw(st.lists(value, min_size=len(ids), max_size=len(ids)))
    rows = [(i, v.to_bytes(size, "little", signed=True)) for i, v in zip(ids, values, strict=True)]
    write = GroupWrite(ids, address, size)
    assert write.frame(np.array(values, np.int32)) == packet.sync_write(address, size, rows)
    assert write.n_bytes == 14 + len(ids) * (1 + size)


@given(groups, st.data())
def test_the_fast_group_parser_equals_the_byte_parser(ids: list[int], data: st.DataObject) -> None:
    replies = [packet.Packet(i, 0x55, data.draw(bodies), data.draw(errors)) for i in ids]
    raw = b"".join(packet.encode(p) for p in replies)
    fast = GroupReply(ids, 10)
    assert PacketDecoder().feed(raw) == replies
    if fast.parse(raw):
        assert fast.errors.tolist() == [p.error for p in replies]
        assert [bytes(row) for row in fast.data] == [p.parameters for p in replies]
        assert fast.column(6, "<i4").tolist() == [struct.unpack_from("<i", p.parameters, 6)[0] for p in replies]
    else:
        assert raw.count(STUFFED) > len(ids), "only what is stuffed, or looks so, is left to the byte parser"
    assert fast.ends(raw) == (STUFFED not in raw[-len(packet.encode(replies[-1])) :][4:-2])


@given(st.integers(0, 230), st.integers(0, 7))
def test_the_fast_group_parser_refuses_any_flipped_bit(at: int, bit: int) -> None:
    ids = list(range(1, 12))
    raw = bytearray(b"".join(status(i, 0, bytes(range(i, i + 10))) for i in ids))
    raw[at % len(raw)] ^= 1 << bit
    assert not GroupReply(ids, 10).parse(bytes(raw))


@given(groups, st.data())
def test_fast_replies_equal_the_byte_parser(ids: list[int], data: st.DataObject) -> None:
    parts = [Part(i, data.draw(errors), data.draw(bodies)) for i in ids]
    raw = fast_status(parts)
    fast = FastGroupReply(ids, 10)
    assert fast.parse(raw).all()
    (whole,) = PacketDecoder().feed(raw)
    assert packet.fast_parts(whole, [10] * len(ids)) == parts
    assert fast.errors.tolist() == [p.error for p in parts]
    assert [bytes(row) for row in fast.data] == [p.data for p in parts]
    assert fast.column(2, "<i4").tolist() == [struct.unpack_from("<i", p.data, 2)[0] for p in parts]


@given(st.integers(0, 10), st.integers(0, 13), st.integers(0, 7))
def test_a_flipped_bit_costs_its_servo_and_at_most_the_next(row: int, at: int, bit: int) -> None:
    """The next part goes on from the checksum before it: only where that is hit are two parts in doubt."""
    ids = list(range(1, 12))
    raw = bytearray(fast_status([Part(i, 0, bytes(range(i, i + 10))) for i in ids]))
    raw[8 + 14 * row + at] ^= 1 << bit
    whole = FastGroupReply(ids, 10).parse(bytes(raw))
    assert not whole[row]
    lost = {row, row + 1} if at >= 12 else {row}
    assert [i for i, ok in enumerate(whole) if not ok] == [i for i in sorted(lost) if i < 11]


@given(st.integers(0, 162))
def test_a_fast_reply_that_breaks_off_gives_the_parts_that_came(n: int) -> None:
    """Behind a silent servo nobody goes on: the packet never becomes whole."""
    ids = list(range(1, 12))
    raw = fast_status([Part(i, 0, bytes(range(i, i + 10))) for i in ids])
    fast = FastGroupReply(ids, 10)
    assert fast.parse(raw).all(), "and what stood in the buffer before is not taken for new"
    whole = fast.parse(raw[:n])
    assert whole.sum() == max(0, n - 8) // 14
    assert whole[: int(whole.sum())].all()


def test_servos_with_empty_checksums_between_are_read_by_the_last_one() -> None:
    """Manual: the CRCs between are for the servos; the controller may check the last alone."""
    ids = [1, 2, 3]
    raw = bytearray(fast_status([Part(i, 0, bytes(10)) for i in ids])[:-2])
    raw[20:22] = raw[34:36] = b"\0\0"
    raw += struct.pack("<H", crc16(raw))
    fast = FastGroupReply(ids, 10)
    assert fast.parse(bytes(raw)).all()
    raw[-1] ^= 1
    assert not fast.parse(bytes(raw))[1:].any()


@pytest.mark.parametrize("raw", [b"", b"\xff", bytes(8), packet.ping(1)])
def test_anything_else_is_no_reply(raw: bytes) -> None:
    assert not GroupReply([1, 2], 10).parse(raw)
    assert not FastGroupReply([1, 2], 10).parse(raw).any()
    assert not GroupReply([1, 2], 10).ends(raw)


@pytest.mark.parametrize("at", range(5))
def test_a_collision_of_two_equal_ids_is_rejected_despite_its_checksum(at: int) -> None:
    """The servos behind go on from what they heard, and what was heard came to us: the last checksum proved it all."""
    ids, n = [3, 1, 2, 9, 7], 5
    raw, crc = fast_status([Part(i, 0, bytes(10)) for i in ids])[:8], 0
    for i, servo_id in enumerate(ids):
        own = (raw if not i else b"") + bytes([0, servo_id]) + bytes(range(i, i + 10))
        said = own + struct.pack("<H", crc16(own, crc))
        if i == at:
            twin = own[:-10] + bytes(range(5, 15))
            other = twin + struct.pack("<H", crc16(twin, crc))
            said = bytes(a & b for a, b in zip(said, other, strict=True))
        crc = crc16(said, crc)
        raw = said if not i else raw + said
    assert FastGroupReply(ids, 10).parse(raw).tolist() == [i != at for i in range(n)]
