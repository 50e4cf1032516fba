"""Protocol 2.0 codec: rows from the ROBOTIS manual, every way of feeding them, garbage, and the SDK as oracle."""

from __future__ import annotations

import numpy as np
import pytest
from dynamixel_sdk import DXL_LOBYTE, Protocol2PacketHandler
from hypothesis import given
from hypothesis import strategies as st

from daemon.bus import packet
from daemon.bus.packet import GroupReply, Instruction, Packet, PacketDecoder, crc16, encode

# ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0", sections 5.1 (ping), 5.2 (read), 5.3 (write), 5.8 (reboot), 5.11 (sync
# read), 5.12 (sync write): the packets printed in the examples, transcribed by hand.
MANUAL = [
    ("ping id 1", Packet(1, Instruction.PING), "FF FF FD 00 01 03 00 01 19 4E"),
    ("its answer", Packet(1, Instruction.STATUS, bytes([0x06, 0x04, 0x26])), "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D"),
    ("read position", Packet(1, Instruction.READ, bytes([0x84, 0, 4, 0])), "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15"),
    ("its answer", Packet(1, Instruction.STATUS, bytes([0xA6, 0, 0, 0])), "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0"),
    ("write goal", Packet(1, Instruction.WRITE, bytes([0x74, 0, 0, 2, 0, 0])), "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89"),
    ("its answer", Packet(1, Instruction.STATUS), "FF FF FD 00 01 04 00 55 00 A1 0C"),
    ("reboot", Packet(1, Instruction.REBOOT), "FF FF FD 00 01 03 00 08 2F 4E"),
    (
        "sync read of two",
        Packet(0xFE, Instruction.SYNC_READ, bytes([0x84, 0, 4, 0, 1, 2])),
        "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA",
    ),
    (
        "sync write of two",
        Packet(0xFE, Instruction.SYNC_WRITE, bytes([0x74, 0, 4, 0, 1, 0x96, 0, 0, 0, 2, 0xAA, 0, 0, 0])),
        "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
    ),
]  # fmt: skip
ROWS = [pytest.param(p, bytes.fromhex(raw), id=meaning + raw[-6:]) for meaning, p, raw in MANUAL]
packets = st.builds(
    Packet,
    st.integers(0, 252),
    st.sampled_from([Instruction.PING, Instruction.READ, Instruction.WRITE, Instruction.SYNC_WRITE]),
    st.binary(max_size=60) | st.lists(st.sampled_from([0xFF, 0xFD, 0x00]), max_size=40).map(bytes),
)


@pytest.mark.parametrize(("p", "raw"), ROWS)
def test_the_manuals_bytes_are_written(p: Packet, raw: bytes) -> None:
    assert encode(p) == raw


@pytest.mark.parametrize(("p", "raw"), ROWS)
def test_the_manuals_bytes_are_read_whole_in_pieces_and_amid_noise(p: Packet, raw: bytes) -> None:
    assert PacketDecoder().feed(raw) == [p]
    slow = PacketDecoder()
    assert [found for byte in raw for found in slow.feed(bytes([byte]))] == [p]
    assert PacketDecoder().feed(b"\xff\x00\xfd\xff\xff" + raw + b"\xff\xff") == [p]
    assert PacketDecoder().feed(raw + raw) == [p, p]


@given(packets)
def test_a_packet_survives_stuffing(p: Packet) -> None:
    raw = encode(p)
    assert packet.HEADER not in raw[4:], "a header never occurs inside"
    assert PacketDecoder().feed(raw) == [p]


@given(st.binary(max_size=300), packets)
def test_after_any_garbage_the_next_good_packet_is_found(garbage: bytes, p: Packet) -> None:
    decoder = PacketDecoder()
    decoder.feed(garbage)
    assert p in decoder.feed(encode(p))


@given(packets, st.data())
def test_a_flipped_bit_is_never_taken_for_the_packet(p: Packet, data: st.DataObject) -> None:
    raw = bytearray(encode(p))
    at = data.draw(st.integers(0, len(raw) - 1))
    raw[at] ^= 1 << data.draw(st.integers(0, 7))
    assert PacketDecoder().feed(bytes(raw)) != [p]


@given(st.binary(max_size=200))
def test_the_checksum_is_the_sdks(data: bytes) -> None:
    handler = Protocol2PacketHandler()
    assert crc16(data) == handler.updateCRC(0, list(data), len(data))


@given(st.lists(st.integers(0, 252), min_size=1, max_size=20, unique=True), st.data())
def test_the_fast_group_parser_equals_the_byte_parser(ids: list[int], data: st.DataObject) -> None:
    errors_drawn, bytes_drawn = st.sampled_from([0, 0x80]), st.binary(min_size=10, max_size=10)
    replies = [Packet(i, Instruction.STATUS, data.draw(bytes_drawn), data.draw(errors_drawn)) for i in ids]
    raw = b"".join(encode(p) for p in replies)
    fast = GroupReply(ids, 10).parse(raw)
    assert PacketDecoder().feed(raw) == replies
    if any(packet.STUFFED in p.parameters for p in replies):
        assert fast is None, "a stuffed frame has another length"
    elif fast is not None:
        errors, parameters = fast
        assert errors.tolist() == [p.error for p in replies]
        assert [bytes(row) for row in parameters] == [p.parameters for p in replies]
    else:  # FF FF FD may straddle error byte and data
        assert len(raw) != GroupReply(ids, 10).n_bytes


@given(st.integers(0, 230), st.integers(0, 7))
def test_the_fast_group_parser_refuses_any_flipped_bit(at: int, bit: int) -> None:
    ids = list(range(1, 12))
    raw = bytearray(b"".join(encode(Packet(i, Instruction.STATUS, bytes(range(i, i + 10)))) for i in ids))
    raw[at % len(raw)] ^= 1 << bit
    assert GroupReply(ids, 10).parse(bytes(raw)) is None


class _Captured:
    """A port that keeps what the SDK sends."""

    is_using = False

    def __init__(self) -> None:
        self.sent = b""

    def clearPort(self) -> None:
        pass

    def writePort(self, data: list[int]) -> int:
        self.sent = bytes(data)
        return len(data)


def test_the_sdk_sends_a_payload_with_a_header_in_it_unstuffed() -> None:
    """dynamixel-sdk computes the stuffing and throws it away; a servo reads another packet. Ours is stuffed."""
    port, data = _Captured(), [0xFF, 0xFF, 0xFD, 0x00]
    Protocol2PacketHandler().writeTxOnly(port, 1, 116, 4, data)
    ours = packet.write(1, 116, bytes(data))
    assert len(ours) == len(port.sent) + 1
    assert DXL_LOBYTE(port.sent[5]) == 9
    assert PacketDecoder().feed(ours)[0].parameters[2:] == bytes(data)


def test_plain_writes_are_the_sdks_bytes() -> None:
    port = _Captured()
    Protocol2PacketHandler().writeTxOnly(port, 5, 116, 4, [1, 2, 3, 4])
    assert port.sent == packet.write(5, 116, bytes([1, 2, 3, 4]))


def test_group_parser_returns_arrays_of_the_asked_shape() -> None:
    errors, parameters = GroupReply([1, 2], 10).parse(
        b"".join(encode(Packet(i, Instruction.STATUS, bytes(10))) for i in (1, 2))
    ) or pytest.fail("whole frames must parse")
    assert errors.shape == (2,)
    assert parameters.shape == (2, 10)
    assert parameters.dtype == np.uint8
