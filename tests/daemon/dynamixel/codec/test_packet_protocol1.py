"""Protocol 1.0 codec: rows from the ROBOTIS manual, both roles, garbage, and the SDK as oracle."""

from __future__ import annotations

import pytest
from dynamixel_sdk import Protocol1PacketHandler
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import Access, Instruction, Packet
from daemon.dynamixel.codec.packet_protocol1 import PacketDecoder, encode
from daemon.errors import PacketError

# ROBOTIS e-manual, "DYNAMIXEL Protocol 1.0": the packets printed in the text and the examples, transcribed by hand.
REQUESTS = [
    ("checksum example", packet1.write(1, 12, b"\x64\xaa"), Packet(1, 0x03, b"\x0c\x64\xaa"), "FF FF 01 05 03 0C 64 AA DC"),
    ("ping", packet1.ping(1), Packet(1, 0x01), "FF FF 01 02 01 FB"),
    ("read temperature", packet1.read(1, 43, 1), Packet(1, 0x02, b"\x2b\x01"), "FF FF 01 04 02 2B 01 CC"),
    ("write id to all", packet1.write(254, 3, b"\x01"), Packet(254, 0x03, b"\x03\x01"), "FF FF FE 04 03 03 01 F6"),
    ("reg write", packet1.reg_write(1, 30, b"\xf4\x01"), Packet(1, 0x04, b"\x1e\xf4\x01"), "FF FF 01 05 04 1E F4 01 E2"),
    ("action", packet1.action(), Packet(254, 0x05), "FF FF FE 02 05 FA"),
    ("factory reset", packet1.factory_reset(0), Packet(0, 0x06), "FF FF 00 02 06 F7"),
    (
        "sync write", packet1.sync_write(30, 4, [(0, b"\x10\0\x50\x01"), (1, b"\x20\x02\x60\x03")]),
        Packet(254, 0x83, bytes.fromhex("1E 04 00 10 00 50 01 01 20 02 60 03")),
        "FF FF FE 0E 83 1E 04 00 10 00 50 01 01 20 02 60 03 67",
    ),
    (
        "bulk read", packet1.bulk_read([(1, 30, 2), (2, 36, 2)]),
        Packet(254, 0x92, bytes.fromhex("00 02 01 1E 02 02 24")), "FF FF FE 09 92 00 02 01 1E 02 02 24 1D",
    ),
]  # fmt: skip
ANSWERS = [
    ("overload and overheating", packet1.status(1, 0x24), Packet(1, 0x55, b"", 0x24), "FF FF 01 02 24 D8"),
    ("ping answer", packet1.status(1), Packet(1, 0x55), "FF FF 01 02 00 FC"),
    ("read answer", packet1.status(1, 0, b"\x20"), Packet(1, 0x55, b"\x20"), "FF FF 01 03 00 20 DB"),
    ("factory reset answer", packet1.status(0), Packet(0, 0x55), "FF FF 00 02 00 FD"),
    ("bulk answer 1", packet1.status(1, 0, b"\0\x80"), Packet(1, 0x55, b"\0\x80"), "FF FF 01 04 00 00 80 7A"),
    ("bulk answer 2", packet1.status(2, 0, b"\0\x80"), Packet(2, 0x55, b"\0\x80"), "FF FF 02 04 00 00 80 79"),
]
ROWS = [
    pytest.param(built, p, bytes.fromhex(raw), answers, id=meaning)
    for rows, answers in ((REQUESTS, False), (ANSWERS, True))
    for meaning, built, p, raw in rows
]
BODIES = st.binary(max_size=60) | st.lists(st.sampled_from([0xFF, 0xFD, 0x00]), max_size=40).map(bytes)
KINDS = [k for k in Instruction if k < 0x20 or k in (0x83, 0x92)]
requests = st.builds(Packet, st.integers(0, 253), st.sampled_from(KINDS), BODIES)
answers = st.builds(Packet, st.integers(0, 253), st.just(0x55), BODIES, st.integers(0, 255))


@pytest.mark.parametrize(("built", "p", "raw", "is_answer"), ROWS)
def test_the_manuals_bytes_are_written_and_read(built: bytes, p: Packet, raw: bytes, is_answer: bool) -> None:
    assert built == raw
    assert encode(p) == raw
    assert PacketDecoder(answers=is_answer).feed(raw) == [p]
    slow = PacketDecoder(answers=is_answer)
    assert [found for byte in raw for found in slow.feed(bytes([byte]))] == [p]
    assert PacketDecoder(answers=is_answer).feed(b"\xff\x00\xff" + raw + b"\xff\xff") == [p]
    assert PacketDecoder(answers=is_answer).feed(raw + raw) == [p, p]


@given(requests, answers)
def test_a_packet_survives_the_bytes(request: Packet, answer: Packet) -> None:
    assert PacketDecoder(answers=False).feed(encode(request)) == [request]
    assert PacketDecoder(answers=True).feed(encode(answer)) == [answer]


@given(st.binary(max_size=300), answers)
def test_after_any_garbage_the_next_good_packet_is_found(garbage: bytes, p: Packet) -> None:
    """One byte of checksum: garbage is a packet once in 256, and may take the first bytes of the next with it."""
    decoder = PacketDecoder()
    false = len(decoder.feed(garbage))
    found = decoder.feed(encode(p))
    assert p in found or len(found) + false > 0
    assert p in found or p in decoder.feed(encode(p)) + decoder.feed(encode(p))


@given(answers, st.data())
def test_a_flipped_bit_is_never_taken_for_the_packet(p: Packet, data: st.DataObject) -> None:
    raw = bytearray(encode(p))
    at = data.draw(st.integers(0, len(raw) - 1))
    raw[at] ^= 1 << data.draw(st.integers(0, 7))
    assert PacketDecoder().feed(bytes(raw)) != [p]


ids = st.integers(0, 252)
reads = st.lists(st.tuples(ids, st.integers(0, 73), st.integers(1, 60)), min_size=1, max_size=20)
writes = st.lists(st.tuples(ids, st.integers(0, 73), st.binary(min_size=1, max_size=9)), min_size=1, max_size=20)


def decoded(raw: bytes) -> list[Access]:
    (request,) = PacketDecoder(answers=False).feed(raw)
    return packet1.accesses(request)


@given(reads, writes)
def test_a_servo_reads_out_of_every_request_what_the_controller_put_in(
    wanted: list[tuple[int, int, int]], written: list[tuple[int, int, bytes]]
) -> None:
    assert decoded(packet1.read(*wanted[0])) == [Access(*wanted[0])]
    assert decoded(packet1.bulk_read(wanted)) == [Access(*w) for w in wanted]
    servo_id, address, data = written[0]
    for build in (packet1.write, packet1.reg_write):
        assert decoded(build(servo_id, address, data)) == [Access(servo_id, address, len(data), data)]
    same = [(i, d[:1] * 3) for i, _, d in written]
    assert decoded(packet1.sync_write(address, 3, same)) == [Access(i, address, 3, d) for i, d in same]


@given(requests)
def test_parameters_that_say_nothing_are_refused_by_name(p: Packet) -> None:
    try:
        found = packet1.accesses(p)
    except PacketError:
        return
    assert all(len(a.data) in (0, a.length) for a in found)


def test_what_does_not_fit_the_length_byte_is_refused() -> None:
    with pytest.raises(PacketError, match="at most 253"):
        encode(Packet(1, Instruction.WRITE, bytes(254)))


def test_error_bits_in_words() -> None:
    assert packet1.error_text(0x24) == "overheating error, overload error"
    assert packet1.error_text(0) == "none"


class _Wire:
    is_using = False

    def __init__(self) -> None:
        self.sent = b""

    def clearPort(self) -> None:
        pass

    def writePort(self, data: list[int]) -> int:
        self.sent = bytes(data)
        return len(data)

    def setPacketTimeout(self, _length: int) -> None:
        pass


def test_requests_are_the_sdks_bytes() -> None:
    handler = Protocol1PacketHandler()
    for ask, ours in (
        (lambda w: handler.writeTxOnly(w, 5, 30, 2, [1, 2]), packet1.write(5, 30, b"\x01\x02")),
        (lambda w: handler.regWriteTxOnly(w, 5, 30, 2, [1, 2]), packet1.reg_write(5, 30, b"\x01\x02")),
        (lambda w: handler.readTx(w, 5, 36, 2), packet1.read(5, 36, 2)),
        (lambda w: handler.action(w, 254), packet1.action()),
        (lambda w: handler.syncWriteTxOnly(w, 30, 1, [1, 9, 2, 8], 4), packet1.sync_write(30, 1, [(1, b"\x09"), (2, b"\x08")])),
        (lambda w: handler.bulkReadTx(w, [2, 1, 30, 2, 2, 36], 6), packet1.bulk_read([(1, 30, 2), (2, 36, 2)])),
    ):  # fmt: skip
        wire = _Wire()
        ask(wire)
        assert wire.sent == ours
