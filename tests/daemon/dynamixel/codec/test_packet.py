"""Protocol 2.0 codec: rows from the ROBOTIS manual, every way of feeding them, garbage, and the SDK as oracle."""

from __future__ import annotations

import struct

import pytest
from dynamixel_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    DXL_LOBYTE,
    GroupSyncRead,
    Protocol2PacketHandler,
)
from hypothesis import assume, given
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.crc import crc16
from daemon.dynamixel.codec.packet import Access, FactoryReset, Instruction, Packet, PacketDecoder, Part, encode
from daemon.errors import PacketError

# ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0", "Instruction Details": the packets printed in the examples, transcribed by
# hand: what builds it here, what it says, its bytes.
MANUAL = [
    ("ping", packet.ping(1), Packet(1, 0x01), "FF FF FD 00 01 03 00 01 19 4E"),
    ("ping all", packet.ping(254), Packet(254, 0x01), "FF FF FD 00 FE 03 00 01 31 42"),
    ("ping answer 1", packet.status(1, 0, b"\x06\x04\x26"), Packet(1, 0x55, b"\x06\x04\x26"), "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D"),
    ("ping answer 2", packet.status(2, 0, b"\x06\x04\x26"), Packet(2, 0x55, b"\x06\x04\x26"), "FF FF FD 00 02 07 00 55 00 06 04 26 6F 6D"),
    ("read position", packet.read(1, 132, 4), Packet(1, 0x02, b"\x84\0\x04\0"), "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15"),
    ("read answer", packet.status(1, 0, b"\xa6\0\0\0"), Packet(1, 0x55, b"\xa6\0\0\0"), "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0"),
    ("write goal", packet.write(1, 116, struct.pack("<i", 512)), Packet(1, 0x03, b"\x74\0\0\x02\0\0"), "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89"),
    ("write answer", packet.status(1), Packet(1, 0x55), "FF FF FD 00 01 04 00 55 00 A1 0C"),
    ("reg write", packet.reg_write(1, 104, struct.pack("<i", 200)), Packet(1, 0x04, b"\x68\0\xc8\0\0\0"), "FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E"),
    ("action", packet.action(1), Packet(1, 0x05), "FF FF FD 00 01 03 00 05 02 CE"),
    ("factory reset", packet.factory_reset(1, FactoryReset.EXCEPT_ID), Packet(1, 0x06, b"\x01"), "FF FF FD 00 01 04 00 06 01 A1 E6"),
    ("reboot", packet.reboot(1), Packet(1, 0x08), "FF FF FD 00 01 03 00 08 2F 4E"),
    ("clear", packet.clear_multi_turn(1), Packet(1, 0x10, b"\x01DXL\x22"), "FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC"),
    ("backup", packet.backup(1), Packet(1, 0x20, b"\x01CTRL"), "FF FF FD 00 01 08 00 20 01 43 54 52 4C 16 F5"),
    ("sync read", packet.sync_read(132, 4, [1, 2]), Packet(254, 0x82, b"\x84\0\x04\0\x01\x02"), "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA"),
    ("sync read answer", packet.status(2, 0, b"\x1f\x08\0\0"), Packet(2, 0x55, b"\x1f\x08\0\0"), "FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE"),
    (
        "sync write", packet.sync_write(116, 4, [(1, b"\x96\0\0\0"), (2, b"\xaa\0\0\0")]),
        Packet(254, 0x83, b"\x74\0\x04\0\x01\x96\0\0\0\x02\xaa\0\0\0"),
        "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
    ),
    (
        "bulk read", packet.bulk_read([(1, 144, 2), (2, 146, 1)]),
        Packet(254, 0x92, b"\x01\x90\0\x02\0\x02\x92\0\x01\0"), "FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05",
    ),
    ("bulk read answer 1", packet.status(1, 0, b"\x77\0"), Packet(1, 0x55, b"\x77\0"), "FF FF FD 00 01 06 00 55 00 77 00 C3 69"),
    ("bulk read answer 2", packet.status(2, 0, b"\x24"), Packet(2, 0x55, b"\x24"), "FF FF FD 00 02 05 00 55 00 24 8B A9"),
    (
        "bulk write", packet.bulk_write([(1, 32, b"\xa0\0"), (2, 31, b"\x50")]),
        Packet(254, 0x93, b"\x01\x20\0\x02\0\xa0\0\x02\x1f\0\x01\0\x50"),
        "FF FF FD 00 FE 10 00 93 01 20 00 02 00 A0 00 02 1F 00 01 00 50 B7 68",
    ),
    (
        "fast sync read", packet.sync_read(132, 4, [3, 7, 4], fast=True), Packet(254, 0x8A, b"\x84\0\x04\0\x03\x07\x04"),
        "FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2",
    ),
    (
        "fast sync answer",
        packet.fast_status([Part(3, 0, b"\xa6\0\0\0"), Part(7, 0, b"\x1f\x08\0\0"), Part(4, 0, b"\xff\x03\0\0")]),
        Packet(254, 0x55, bytes.fromhex("03 A6 00 00 00 84 08 00 07 1F 08 00 00 16 CA 00 04 FF 03 00 00")),
        "FF FF FD 00 FE 19 00 55 00 03 A6 00 00 00 84 08 00 07 1F 08 00 00 16 CA 00 04 FF 03 00 00 D1 9E",
    ),
    (
        "fast bulk answer",
        packet.fast_status([Part(3, 0, b"\xa6\0\0\0"), Part(7, 0, b"\xa5\x01"), Part(4, 0, b"\x1f")]),
        Packet(254, 0x55, bytes.fromhex("03 A6 00 00 00 67 A4 00 07 A5 01 24 74 00 04 1F")),
        "FF FF FD 00 FE 14 00 55 00 03 A6 00 00 00 67 A4 00 07 A5 01 24 74 00 04 1F D9 C1",
    ),
]  # fmt: skip
ROWS = [pytest.param(built, p, bytes.fromhex(raw), id=meaning) for meaning, built, p, raw in MANUAL]
BODIES = st.binary(max_size=60) | st.lists(st.sampled_from([0xFF, 0xFD, 0x00]), max_size=40).map(bytes)
requests = st.builds(Packet, st.integers(0, 252), st.sampled_from([i for i in Instruction if i != 0x55]), BODIES)
answers = st.builds(Packet, st.integers(0, 252), st.just(0x55), BODIES, st.integers(0, 255))
packets = requests | answers


@pytest.mark.parametrize(("built", "p", "raw"), ROWS)
def test_the_manuals_bytes_are_written(built: bytes, p: Packet, raw: bytes) -> None:
    assert built == raw
    assert encode(p) == raw


@pytest.mark.parametrize(("built", "p", "raw"), ROWS)
def test_the_manuals_bytes_are_read_whole_in_pieces_and_amid_noise(built: bytes, p: Packet, raw: bytes) -> None:
    assert PacketDecoder().feed(raw) == [p]
    slow = PacketDecoder()
    assert [found for byte in raw for found in slow.feed(bytes([byte]))] == [p]
    assert PacketDecoder().feed(b"\xff\x00\xfd\xff\xff" + raw + b"\xff\xff") == [p]
    assert PacketDecoder().feed(raw + raw) == [p, p]


@pytest.mark.parametrize(
    ("built", "printed"),
    [
        # ends in 20 F2, the CRC of the fast sync read printed before it; its answers' CRCs are right
        (
            packet.bulk_read([(3, 132, 4), (7, 124, 2), (4, 146, 1)], fast=True),
            "FF FF FD 00 FE 12 00 9A 03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00 20 F2",
        ),
        # 92 F5 for 9E F5
        (packet.restore(1), "FF FF FD 00 01 08 00 20 02 43 54 52 4C 92 F5"),
    ],
)
def test_two_requests_are_printed_with_a_wrong_crc_in_the_manual(built: bytes, printed: str) -> None:
    """The SDK's checksum function agrees with ours on both."""
    raw = bytes.fromhex(printed)
    assert built[:-2] == raw[:-2]
    assert built[-2:] != raw[-2:]
    assert Protocol2PacketHandler().updateCRC(0, list(raw), len(raw) - 2).to_bytes(2, "little") == built[-2:]
    assert PacketDecoder().feed(raw) == []


@given(packets)
def test_a_packet_survives_stuffing(p: Packet) -> None:
    raw = encode(p)
    assert packet.STUFFED + b"\x00" not in raw[4:], "a header never occurs inside"
    assert PacketDecoder().feed(raw) == [p]


@given(st.binary(max_size=300), packets)
def test_after_any_garbage_the_next_good_packet_is_found(garbage: bytes, p: Packet) -> None:
    decoder = PacketDecoder()
    decoder.feed(garbage)
    assert p in decoder.feed(encode(p))


def test_a_header_that_promises_much_does_not_hide_the_packets_after_it() -> None:
    decoder = PacketDecoder()
    liar = packet.HEADER + b"\x01\xff\x0f\x55"
    assert decoder.feed(liar + packet.ping(7)) == [Packet(7, Instruction.PING)]


@given(packets, st.data())
def test_a_flipped_bit_is_never_taken_for_the_packet(p: Packet, data: st.DataObject) -> None:
    raw = bytearray(encode(p))
    at = data.draw(st.integers(0, len(raw) - 1))
    raw[at] ^= 1 << data.draw(st.integers(0, 7))
    assert PacketDecoder().feed(bytes(raw)) != [p]


ids = st.integers(0, 252)
reads = st.lists(st.tuples(ids, st.integers(0, 700), st.integers(1, 60)), min_size=1, max_size=20)
writes = st.lists(st.tuples(ids, st.integers(0, 700), st.binary(min_size=1, max_size=20)), min_size=1, max_size=20)


def decoded(raw: bytes) -> list[Access]:
    (request,) = PacketDecoder().feed(raw)
    return packet.accesses(request)


@given(reads, writes, st.booleans())
def test_a_servo_reads_out_of_every_request_what_the_controller_put_in(
    wanted: list[tuple[int, int, int]], written: list[tuple[int, int, bytes]], fast: bool
) -> None:
    _, address, length = wanted[0]
    group = [w[0] for w in wanted]
    assert decoded(packet.read(*wanted[0])) == [Access(*wanted[0])]
    assert decoded(packet.bulk_read(wanted, fast=fast)) == [Access(*w) for w in wanted]
    assert decoded(packet.sync_read(address, length, group, fast=fast)) == [Access(i, address, length) for i in group]
    rows = [Access(i, a, len(d), d) for i, a, d in written]
    assert decoded(packet.bulk_write(written)) == rows
    for build in (packet.write, packet.reg_write):
        assert decoded(build(*written[0])) == [rows[0]]
    same = [(i, d[:1] * 3) for i, _, d in written]
    assert decoded(packet.sync_write(address, 3, same)) == [Access(i, address, 3, d) for i, d in same]


@given(requests)
def test_parameters_that_say_nothing_are_refused_by_name(p: Packet) -> None:
    try:
        found = packet.accesses(p)
    except PacketError:
        return
    assert all(len(a.data) in (0, a.length) for a in found)


@given(st.lists(st.builds(Part, ids, st.integers(0, 255), BODIES), min_size=1, max_size=12))
def test_a_fast_reply_comes_apart_as_it_was_put_together(parts: list[Part]) -> None:
    """Parts of any lengths, as in a fast bulk read; never stuffed, whatever is in them."""
    raw = packet.fast_status(parts)
    (reply,) = PacketDecoder().feed(raw)
    assert packet.fast_parts(reply, [len(part.data) for part in parts]) == parts
    with pytest.raises(PacketError, match="bytes for"):
        packet.fast_parts(reply, [len(part.data) + 1 for part in parts])


# dynamixel-sdk as oracle where it is right, and where it is not.


class _Wire:
    """A port for the SDK that keeps what is sent and answers with bytes of ours."""

    is_using = False

    def __init__(self, answer: bytes = b"") -> None:
        self.sent, self._answer = b"", bytearray(answer)

    def clearPort(self) -> None:
        pass

    def writePort(self, data: list[int]) -> int:
        self.sent = bytes(data)
        return len(data)

    def readPort(self, length: int) -> list[int]:
        out = list(self._answer[:length])
        del self._answer[:length]
        return out

    def setPacketTimeout(self, _length: int) -> None:
        pass

    def isPacketTimeout(self) -> bool:
        return not self._answer


@given(st.binary(max_size=200))
def test_the_checksum_is_the_sdks(data: bytes) -> None:
    assert crc16(data) == Protocol2PacketHandler().updateCRC(0, list(data), len(data))


def test_requests_are_the_sdks_bytes() -> None:
    handler = Protocol2PacketHandler()
    for ask, ours in (
        (lambda w: handler.writeTxOnly(w, 5, 116, 4, [1, 2, 3, 4]), packet.write(5, 116, bytes([1, 2, 3, 4]))),
        (lambda w: handler.regWriteTxOnly(w, 5, 116, 4, [1, 2, 3, 4]), packet.reg_write(5, 116, bytes([1, 2, 3, 4]))),
        (lambda w: handler.readTx(w, 5, 132, 4), packet.read(5, 132, 4)),
        (lambda w: handler.action(w, 254), packet.action()),
        (lambda w: handler.reboot(w, 5), packet.reboot(5)),
        (lambda w: handler.factoryReset(w, 5, 2), packet.factory_reset(5, FactoryReset.EXCEPT_ID_AND_BAUD)),
        (lambda w: handler.syncReadTx(w, 132, 4, [1, 2, 3], 3, False), packet.sync_read(132, 4, [1, 2, 3])),
        (lambda w: handler.syncWriteTxOnly(w, 116, 1, [1, 9, 2, 8], 4), packet.sync_write(116, 1, [(1, b"\x09"), (2, b"\x08")])),
        (lambda w: handler.bulkReadTx(w, [1, 144, 0, 2, 0, 2, 146, 0, 1, 0], 10, False), packet.bulk_read([(1, 144, 2), (2, 146, 1)])),
        (lambda w: handler.bulkWriteTxOnly(w, [1, 31, 0, 1, 0, 80], 6), packet.bulk_write([(1, 31, b"\x50")])),
    ):  # fmt: skip
        wire = _Wire()
        ask(wire)
        assert wire.sent == ours


@given(answers)
def test_the_sdk_reads_our_answers_stuffed_ones_included(p: Packet) -> None:
    _, stuffed, rest = p.parameters.partition(packet.STUFFED)
    assume(not stuffed or b"\xfd\xfd" not in rest)  # where it is wrong: the next test
    data, result = Protocol2PacketHandler().rxPacket(_Wire(encode(p)), False)
    assert result == COMM_SUCCESS
    body = [p.error, *p.parameters]
    assert data[8 : 8 + len(body)] == body


def test_the_sdk_takes_a_byte_too_much_out_behind_a_stuffed_one() -> None:
    """It removes stuffing in place and looks for FF FF FD in bytes it has already overwritten."""
    p = Packet(0, Instruction.STATUS, bytes.fromhex("FF FF FD FF FD FD"))
    data, result = Protocol2PacketHandler().rxPacket(_Wire(encode(p)), False)
    assert result == COMM_SUCCESS
    assert bytes(data[9:15]) != p.parameters
    assert PacketDecoder().feed(encode(p)) == [p]


def test_the_sdk_sends_a_payload_with_a_header_in_it_unstuffed() -> None:
    """dynamixel-sdk computes the stuffing and throws it away; a servo reads another packet. Ours is stuffed."""
    wire, data = _Wire(), [0xFF, 0xFF, 0xFD, 0x00]
    Protocol2PacketHandler().writeTxOnly(wire, 1, 116, 4, data)
    ours = packet.write(1, 116, bytes(data))
    assert len(ours) == len(wire.sent) + 1
    assert DXL_LOBYTE(wire.sent[5]) == 9
    assert PacketDecoder().feed(ours)[0].parameters[2:] == bytes(data)


def test_the_sdk_reads_zero_for_a_silent_servo_and_drops_alerts() -> None:
    """One silent servo of a group: both are lost, their positions read 0, and the alert bit of the other is gone."""
    wire = _Wire(packet.status(1, packet.ALERT_BIT, struct.pack("<i", 2048)))
    read = GroupSyncRead(wire, Protocol2PacketHandler(), 132, 4)
    assert read.addParam(1) and read.addParam(2)
    assert read.txRxPacket() == COMM_RX_TIMEOUT
    assert [read.getData(i, 132, 4) for i in (1, 2)] == [0, 0]
    assert not hasattr(read, "error_dict"), "where the error byte would have to be kept"
    (kept,) = PacketDecoder().feed(packet.status(1, packet.ALERT_BIT, struct.pack("<i", 2048)))
    assert kept.error == packet.ALERT_BIT
