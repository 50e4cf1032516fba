"""Two servos with one id: they answer at once, and what arrives is what the wire makes of it, in every kind of read."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.crc import crc16
from daemon.dynamixel.codec.packet import PacketDecoder
from sim.faults import Fault
from sim.wire.wire import Wire, WireSettings
from tests.support.servo_bench import Bench, spec
from tests.support.sizes import examples, few_and_long

THREE = ("XM430-W350",) * 3
ROWS = [(2, 132, 4), (1, 132, 4), (3, 132, 4)]
READS = {
    "ping": packet.ping(1),
    "ping of all": packet.ping(packet.BROADCAST_ID),
    "read": packet.read(1, 132, 4),
    "sync": packet.sync_read(132, 4, [2, 1, 3]),
    "fast sync": packet.sync_read(132, 4, [2, 1, 3], fast=True),
    "bulk": packet.bulk_read(ROWS),
    "fast bulk": packet.bulk_read(ROWS, fast=True),
}
FAST_TURNS = {1: (0, 16), 2: (16, 24), 3: (24, 32)}
"""Bytes of each turn of a fast read of three: head and part, part, part."""


def with_a_twin(tick: int = 2048, **options) -> Bench:
    """Servos 1, 2 and 3, and another one with the id of servo 1 that stands at `tick`."""
    b = Bench(*THREE, extra=(spec("XM430-W350", 1),), **options)
    b.world.all[3].position_tick = tick
    return b


def alone(tick: int = 2048) -> Bench:
    """Servos 1, 2 and 3, the first of them at `tick`."""
    b = Bench(*THREE)
    b.world.all[0].position_tick = tick
    return b


@pytest.mark.parametrize("kind", READS)
def test_twins_that_say_the_same_are_heard_as_one(kind: str) -> None:
    both, one = with_a_twin(), alone()
    assert both.send(READS[kind]) == one.send(READS[kind])
    assert both.bus.wire.collisions == 1 and both.t_s == pytest.approx(one.t_s)


@settings(max_examples=examples(20))
@given(tick=st.integers(0, 4095))
@pytest.mark.parametrize("kind", few_and_long(["read", "sync"], [k for k in READS if "fast" not in k]))
def test_of_twins_that_differ_the_and_is_heard(kind: str, tick: int) -> None:
    heard = with_a_twin(tick).send(READS[kind])
    assert heard == bytes(x & y for x, y in zip(alone().send(READS[kind]), alone(tick).send(READS[kind]), strict=True))


@settings(max_examples=examples(20))
@given(tick=st.integers(0, 4095))
@pytest.mark.parametrize("kind", ["fast sync", "fast bulk"])
def test_in_a_fast_read_the_next_servo_goes_on_from_the_and(kind: str, tick: int) -> None:
    """Its checksum is of what was on the wire: the end of the packet is right though the middle is not."""
    heard, one, other = with_a_twin(tick).send(READS[kind]), alone().send(READS[kind]), alone(tick).send(READS[kind])
    last = FAST_TURNS[2][1]
    assert heard[:last] == bytes(x & y for x, y in zip(one, other, strict=True))[:last]
    assert heard[last:-2] == one[last:-2]
    assert heard[-2:] == crc16(heard[:-2]).to_bytes(2, "little")


@pytest.mark.parametrize("kind", ["read", "sync", "bulk"])
def test_twins_that_answer_at_different_times_garble_only_themselves(kind: str) -> None:
    b = with_a_twin()
    b.world.all[3].write(9, b"\1")  # 2 us of return delay, a fifth of a byte
    assert [p.servo_id for p in PacketDecoder().feed(b.send(READS[kind]))] == ([] if kind == "read" else [2, 3])


def test_nobody_goes_on_behind_a_head_that_two_said_at_different_times() -> None:
    b = with_a_twin()
    b.world.all[3].write(9, b"\1")
    heard = b.send(packet.sync_read(132, 4, [1, 2, 3], fast=True))
    assert len(heard) == FAST_TURNS[1][1] and PacketDecoder().feed(heard) == []
    assert len(b.send(packet.sync_read(132, 4, [2, 1, 3], fast=True))) == 32, "but later turns follow each other"


def test_a_twin_that_takes_no_part_in_fast_reads_changes_nothing() -> None:
    b = Bench(*THREE, extra=(spec("2XL430-W250", 1),))
    assert b.send(READS["fast sync"]) == alone().send(READS["fast sync"])


def test_an_answer_that_is_late_takes_nothing_from_those_that_are_in_time() -> None:
    b = Bench(*THREE, faults=(Fault("delay", servo_id=2, amount=0.005),))
    heard = PacketDecoder().feed(b.send(packet.sync_read(132, 4, [1, 2, 3])))
    assert [p.servo_id for p in heard] == [1, 3, 2]


TALK = st.lists(st.tuples(st.integers(0, 30), st.binary(min_size=1, max_size=12)), min_size=1, max_size=6)


@given(TALK, st.booleans())
def test_what_lines_up_is_anded_whoever_talks_and_in_whatever_order(
    talk: list[tuple[int, bytes]], pieces: bool
) -> None:
    wire = Wire(WireSettings(piece_bytes=(1, 4) if pieces else None))
    slots: dict[int, int] = {}
    for start, data in talk:
        wire.answer(start * 1e-5, data, 1_000_000)
        for at, byte in enumerate(data, start):
            slots[at] = slots.get(at, 0xFF) & byte
    heard = b""
    while (ready_s := wire.ready_s()) is not None:
        heard += wire.take(ready_s)
    assert heard == bytes(slots[at] for at in sorted(slots))
