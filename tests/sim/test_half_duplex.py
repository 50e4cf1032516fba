"""The wire: when each byte is where, what collisions leave, lumps and pieces of the adapter."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.packet import PacketDecoder
from sim.clock import VirtualClock
from sim.errors import SimSettingError
from sim.port import SimPort
from sim.wire.wire import Wire, WireSettings
from sim.wire.wire_bytes import Burst
from tests.support.servo_bench import Bench

TWENTY = ("XM430-W350",) * 20


@pytest.mark.parametrize(
    ("baud", "fast", "wanted_s"),
    [(1_000_000, False, 568e-5), (1_000_000, True, 436e-5), (4_000_000, False, 142e-5), (57_600, False, 5680 / 57_600)],
)
def test_a_cycle_of_twenty_servos_takes_the_time_of_its_bytes(baud: int, fast: bool, wanted_s: float) -> None:
    """Goals for twenty, then ten bytes from each: 114 + 34 + 420 bytes, or 288 back when fast. Ten bits a byte."""
    b = Bench(*TWENTY, baud=baud)
    ids = list(range(1, 21))
    request = packet.sync_write(116, 4, [(i, (2048).to_bytes(4, "little")) for i in ids])
    request += packet.sync_read(126, 10, ids, fast=fast)
    assert len(b.send(request)) == (288 if fast else 420)
    assert b.t_s == pytest.approx(wanted_s, rel=1e-9)


def test_each_answer_pays_return_delay_but_a_fast_read_only_once() -> None:
    for fast, answers in ((False, 20), (True, 1)):
        b = Bench(*TWENTY, wire=WireSettings(turnaround_s=20e-6))
        for servo in b.world.all:
            servo.write(9, b"\xfa")  # 250: 500 us, as from the factory
        b.send(packet.sync_read(126, 10, range(1, 21), fast=fast))
        n_bytes = 34 + (288 if fast else 420)
        assert b.t_s == pytest.approx(n_bytes * 1e-5 + answers * 520e-6, rel=1e-9)


def test_a_missing_servo_costs_the_time_of_its_answer_in_a_group() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    found = b.ask(packet.sync_read(132, 4, [1, 99, 2]))
    assert [p.servo_id for p in found] == [1, 2]
    assert b.t_s == pytest.approx((17 + 3 * 15) * 1e-5, rel=1e-9)


def test_a_fast_read_ends_at_the_first_servo_that_cannot() -> None:
    b = Bench("XM430-W350", "2XL430-W250", "XM430-W350")
    assert len(b.send(packet.sync_read(132, 4, [1, 2, 3], fast=True))) == 8 + 8
    assert b.send(packet.sync_read(132, 4, [2, 1], fast=True)) == b""
    assert len(b.send(packet.sync_read(132, 4, [3, 1], fast=True))) == 8 + 16


def test_two_instructions_at_once_collide_with_the_first_ones_answer() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    heard = b.send(packet.ping(1) + packet.ping(2))
    assert PacketDecoder().feed(heard) == [] and b.bus.wire.collisions > 0
    assert len(b.ask(packet.ping(1))) == 1, "and afterwards all is well"


def test_talking_into_an_answer_garbles_both() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    b.bus.receive(packet.ping(1), 0.0, 1_000_000)
    b.t_s = 150e-6  # the answer runs from 100 to 240 us
    heard = b.send(packet.ping(2))
    assert heard[:5] == packet.status(1)[:5], "what was through before is whole"
    assert PacketDecoder().feed(heard) == []


def test_two_servos_with_one_id_garble_each_other_unless_alike() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    b.write("id", 1, servo_id=2)
    assert len(b.ask(packet.ping(1))) == 1, "the same bytes at the same time"
    b.world.all[1].position_tick = 1000
    assert b.ask(packet.read(1, 132, 4)) == []


def test_an_adapters_timer_hands_bytes_on_in_lumps() -> None:
    """20 answers of 21 bytes at 1 Mbit/s behind a 1 ms timer: seven lumps of at most 62 bytes."""
    b = Bench(*TWENTY, wire=WireSettings(latency_s=0.001))
    b.bus.receive(packet.sync_read(126, 10, range(1, 21)), 0.0, 1_000_000)
    times, lumps = [], []
    while (ready_s := b.bus.wire.ready_s()) is not None:
        times.append(ready_s)
        lumps.append(len(b.bus.wire.take(ready_s)))
    assert sum(lumps) == 420 and max(lumps) <= 62
    assert times == sorted(times)
    assert times[0] == pytest.approx(0.00034 + 62e-5), "a full packet does not wait for the timer"
    b.t_s = 1.0
    b.send(packet.ping(1))
    assert b.t_s > 1.0 + 24e-5
    assert b.t_s - 1.0 <= 0.00124 + 1e-9


def test_sixteen_milliseconds_is_what_a_new_adapter_costs() -> None:
    b = Bench(wire=WireSettings(latency_s=0.016))
    waited = []
    for _ in range(50):
        start_s = b.t_s
        b.send(packet.ping(1))
        waited.append(b.t_s - start_s)
    assert 0.01 < sum(waited) / 50 <= 0.01624


@given(st.integers(1, 9), st.integers(0, 30), st.integers(0, 2**32 - 1))
def test_pieces_cut_anywhere_are_the_same_bytes(least: int, more: int, seed: int) -> None:
    request = packet.sync_read(126, 10, range(1, 4))
    b = Bench(*TWENTY[:3], wire=WireSettings(piece_bytes=(least, least + more), seed=seed))
    assert b.send(request) == Bench(*TWENTY[:3]).send(request)


@given(st.integers(1, 50), st.floats(0.0, 0.01))
def test_reading_little_by_little_or_with_short_patience_loses_nothing(most: int, patience_s: float) -> None:
    request = packet.sync_read(126, 10, range(1, 4))
    b, clock = Bench(*TWENTY[:3]), VirtualClock()
    port, data = SimPort(b.bus, clock), b""
    port.write(request)
    while clock.now_s() < 0.05 and len(data) < 63:
        piece = port.read(most, patience_s)
        assert len(piece) <= most
        data += piece
        clock.sleep_until(clock.now_s() + 1e-5)
    assert data == Bench(*TWENTY[:3]).send(request)


def test_a_deadline_within_a_burst_brings_what_is_there_by_then() -> None:
    b, clock = Bench(*TWENTY[:3]), VirtualClock()
    port = SimPort(b.bus, clock)
    port.write(packet.sync_read(126, 10, [1, 2, 3]))  # 17 bytes; answers from 170 us to 800 us
    data = port.read(1000, 300e-6)
    assert len(data) == 13 and clock.now_s() == pytest.approx(300e-6)
    assert len(port.read(1000, 0.01)) == 50


def test_without_wire_delay_answers_are_there_at_once() -> None:
    b = Bench(*TWENTY, wire=WireSettings(no_wire_delay=True))
    assert len(b.send(packet.sync_read(126, 10, range(1, 21)))) == 420
    assert b.t_s == 0.0


def test_same_bytes_at_the_same_time_are_anded() -> None:
    wire = Wire()
    wire.answer(0.0, b"\xf0\xff", 1_000_000)
    wire.answer(0.0, b"\x3f\xff\x01", 1_000_000)
    assert wire.take(1.0) == b"\x30\xff\x01"


@given(
    shift=st.integers(-20, 20),
    lengths=st.tuples(st.integers(1, 20), st.integers(1, 20)),
    baud=st.sampled_from([57_600, 1_000_000, 4_000_000]),
    hours=st.floats(0, 100),
)
def test_bytes_meet_after_hours_as_they_do_in_the_first_second(
    shift: int, lengths: tuple[int, int], baud: int, hours: float
) -> None:
    """Times of hours have lost digits; a soak of 4.6 hours once fell over it."""

    def met(start_s: float) -> tuple[bytes, list[tuple[int, bytes]]]:
        byte_s, n = 10 / baud, lengths
        burst = Burst(start_s, byte_s, bytearray(range(128, 128 + n[0])))
        other = Burst(start_s + shift * byte_s, byte_s, bytearray(range(64, 64 + n[1])))
        rest = burst.meet(other, random.Random(0))
        return bytes(burst.data), [(round((r.start_s - start_s) / byte_s), bytes(r.data)) for r in rest]

    assert met(hours * 3600) == met(0.0)


@pytest.mark.parametrize(
    "wrong", [{"latency_s": -1.0}, {"turnaround_s": 2.0}, {"usb_packet_bytes": 0}, {"piece_bytes": (5, 2)}]
)
def test_a_wire_that_cannot_be_is_refused(wrong: dict) -> None:
    with pytest.raises(SimSettingError, match=next(iter(wrong))):
        WireSettings(**wrong)


def test_a_collision_takes_goals_but_is_no_violation_of_the_clients() -> None:
    b = Bench("XM430-W350")
    b.write("torque_enable", 1)
    goals = [2048 + round(0.4 * i * i) for i in range(20)]
    for i, tick in enumerate(goals):
        if i == 12:  # a question whose answer the next goal runs into
            b.bus.receive(packet.read(1, 126, 10), b.t_s, b.baud)
            b.t_s += 150e-6
        b.send(packet.sync_write(116, 4, [(1, tick.to_bytes(4, "little"))]))
        b.wait(0.01)
    assert b.bus.wire.collisions > 0 and b.bus.audit.goals == 19
    assert not b.bus.audit.violations


def test_a_patient_client_waits_for_the_answers() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    for i in (1, 2):
        b.bus.receive(packet.ping(i), 0.0, b.baud, patient=True)
    assert [p.servo_id for p in b.ask(b"")] == [1, 2]
    assert b.bus.wire.collisions == 0
