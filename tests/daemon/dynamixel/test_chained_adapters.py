"""Chained reads: a reply that breaks off now and then, again and again, always."""

from __future__ import annotations

import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.chained_adapters import ChainedReads
from daemon.dynamixel.codec.packet import Instruction
from daemon.dynamixel.health import QUARANTINE_AFTER
from daemon.dynamixel.servo_bus import ServoBus
from sim.clock import VirtualClock
from tests.support.servo_emulator import FakePort, fake
from tests.support.sizes import few_and_long

N, PART_BYTES = 20, 14
GOALS = np.full(N, 2048, np.int32)


def group(name: str = "XM430-W350") -> tuple[ServoBus, FakePort, VirtualClock]:
    far, servos, clock = fake(*(name,) * N)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    return bus, far, clock


def lose(far: FakePort, share: float, seed: int = 0) -> None:
    """Of every servo's part of an answer; a fast answer ends where one is lost."""
    draw = random.Random(seed)

    def spoil(raw: bytes, _servo_id: int) -> bytes:
        if raw[4] != 0xFE:
            return b"" if draw.random() < share else raw
        lost = next((i for i in range(N) if draw.random() < share), None)
        return raw if lost is None else raw[: 8 + lost * PART_BYTES if lost else 0]

    far.spoil = spoil


def rate_and_valid(bus: ServoBus, clock: VirtualClock, cycles: int = 4000) -> tuple[float, float]:
    """Cycles a second, and the share of values that were valid."""
    start_s, valid = clock.now_s(), 0
    for _ in range(cycles):
        valid += int(bus.exchange(GOALS).valid.sum())
    return cycles / (clock.now_s() - start_s), valid / cycles / N


@pytest.mark.long
@pytest.mark.parametrize(("share", "rate", "valid"), few_and_long([(0.001, 0.97, 0.98)], [(0.01, 0.75, 0.9)]))
def test_lost_parts_of_fast_answers_cost_their_cycle_only(share: float, rate: float, valid: float) -> None:
    """One in a thousand lost 12 % of the rate: after each, 25 cycles went by the slower read."""
    bus, far, clock = group()
    whole_hz, _ = rate_and_valid(bus, clock, 200)
    lose(far, share)
    hz, found = rate_and_valid(bus, clock)
    assert hz >= rate * whole_hz, hz / whole_hz
    assert found >= valid


def test_at_a_rate_only_fast_reads_allow_a_lost_part_is_one_late_cycle() -> None:
    bus, far, clock = group()
    start_s = clock.now_s()
    bus.exchange(GOALS)
    fast_s = clock.now_s() - start_s
    far.spoil = lambda raw, _servo_id: raw[: 8 + 6 * PART_BYTES]
    assert bus.exchange(GOALS).valid.tolist() == [i < 6 for i in range(N)]
    far.spoil = lambda raw, _servo_id: raw
    for _ in range(50):
        start_s = clock.now_s()
        assert bus.exchange(GOALS).valid.all()
        assert clock.now_s() - start_s == pytest.approx(fast_s)


def test_spoilt_parts_are_counted_by_servo_and_leave_the_others_alone() -> None:
    bus, far, _ = group()
    at = 8 + 4 * PART_BYTES + 3
    far.spoil = lambda raw, _servo_id: raw[:at] + bytes([raw[at] ^ 1]) + raw[at + 1 :] if raw[4] == 0xFE else raw
    for _ in range(5):
        assert np.flatnonzero(~bus.exchange(GOALS).valid).tolist() == [4]
    assert (
        np.flatnonzero(bus.chains[0].link.health.counters.crc).tolist() == [4]
        and bus.chains[0].link.health.counters.crc[4] == 5
    )
    assert all(w[-30:].count(Instruction.FAST_SYNC_READ) for w in far.writes[-5:])


@pytest.mark.long
def test_fast_reads_that_always_break_off_are_tried_more_and_more_rarely() -> None:
    """A firmware that answers fast reads when it is asked at start, and not under load."""
    bus, far, clock = group()
    far.spoil = lambda raw, _servo_id: raw[: -PART_BYTES * 10] if raw[4] == 0xFE else raw
    _, early = rate_and_valid(bus, clock, 1000)
    _, later = rate_and_valid(bus, clock, 5000)
    assert bus.chains[0].link.health.asked.all(), "nobody is given up for it"
    assert early > 0.98 and later > 0.999
    far.spoil = lambda raw, _servo_id: raw
    rate_and_valid(bus, clock, 3300)
    far.writes.clear()
    bus.exchange(GOALS)
    assert bus.ids == tuple(far.writes[0][-2 - N : -2]) and far.writes[0][-7 - N] == Instruction.FAST_SYNC_READ


@given(st.lists(st.one_of(st.none(), st.integers(0, N - 1)), max_size=400))
def test_servos_behind_a_break_are_never_silent_until_quarantine(
    broke: list[int | None],
) -> None:
    chained, in_a_row = ChainedReads(), 0
    for row in broke:
        in_a_row = in_a_row + 1 if chained.used and row is not None else 0
        assert in_a_row < QUARANTINE_AFTER
        chained.after_cycle(row if chained.used else None)
