"""Disturbances of a servo bus: echoes, foreign and late packets, double ids, noise, lost answers, unplugging."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.dynamixel.codec.packet import ping, status, sync_read
from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.feedback_cycle import TWICE_CYCLES
from daemon.dynamixel.timing import MARGIN_S
from daemon.errors import LinkLostError
from tests.support.mixed_bus import X20, bus_of, kinds, put


@pytest.mark.parametrize(
    "names", [X20[:4], ("2XL430-W250",) * 4, ("MX-28",) * 3, ("AX-12A",) * 2], ids=["fast", "sync", "mx", "ax"]
)
def test_an_adapter_that_echoes_is_noticed_and_lived_with(names: tuple[str, ...]) -> None:
    bus, far, _ = bus_of(*names, verify=False)
    far.echo = True
    bus.verify()
    put(far)
    goals = np.full(len(names), 300, np.int32)
    bus.exchange(goals)
    far.writes.clear()
    reading = bus.exchange(goals)
    assert reading.valid.all() and reading.position_tick.tolist() == [1001 + i for i in range(len(names))]
    assert kinds(bus).count(BusEventKind.ECHO) == 1
    bus.write_item(1, "led", 1)
    assert bus.read_item(1, "led") == 1


@pytest.mark.parametrize(
    ("stranger", "said"),
    [
        (ping(9), "did not send"),
        (status(77, 0, bytes(10)), "servo 77"),
        (sync_read(132, 4, [1, 2]), "another controller"),
    ],
)
def test_a_foreign_packet_is_named_and_costs_nobody_his_answer(stranger: bytes, said: str) -> None:
    bus, far, _ = bus_of(*("2XL430-W250",) * 4)
    put(far)
    far.before = stranger
    reading = bus.exchange(None)
    assert reading.valid.all() and reading.position_tick.tolist() == [1001, 1002, 1003, 1004]
    events = [e for e in bus.chains[0].link.events.take() if e.kind is BusEventKind.FOREIGN_PACKET]
    assert len(events) == 1 and said in events[0].text


def test_two_servos_with_one_id_are_named() -> None:
    bus, far, _ = bus_of(*("2XL430-W250",) * 4)
    far.servos[2].doubled = True
    for _ in range(TWICE_CYCLES - 1):
        bus.exchange(None)
    assert BusEventKind.DUPLICATE_ID not in kinds(bus)
    for _ in range(4):
        bus.exchange(None)
    (event,) = [e for e in bus.chains[0].link.events.take() if e.kind is BusEventKind.DUPLICATE_ID]
    assert event.servo_id == 2 and "mmmd servo" in event.text


def test_a_late_answer_of_the_last_cycle_is_not_a_second_servo() -> None:
    bus, far, _ = bus_of(*("2XL430-W250",) * 3)
    bus.exchange(None)
    far.servos[2].silent = True
    bus.exchange(None)
    far.servos[2].silent = False
    put(far)
    far.before = status(2, 0, bytes(10))
    reading = bus.exchange(None)
    assert reading.valid.all() and reading.position_tick[1] == 1002, "the newer one counts"
    assert BusEventKind.DUPLICATE_ID not in kinds(bus) and bus.chains[0].link.health.counters.late[1] == 1


def test_a_late_answer_taken_for_a_later_one_is_no_second_servo() -> None:
    """The late answer of one cycle was taken for the next one's, whose own came in the cycle after that, beside a third."""
    bus, far, _ = bus_of(*("2XL430-W250",) * 3)
    for n_late in (0, 1, 1, 0, 1):
        put(far)
        far.before = n_late * status(2, 0, bytes(10))
        reading = bus.exchange(None)
        assert reading.valid.all() and reading.position_tick[1] == 1002, "the newer one counts"
    assert BusEventKind.DUPLICATE_ID not in kinds(bus) and bus.chains[0].link.health.counters.late[1] == 3


def test_noise_before_the_answers_costs_nothing_but_time() -> None:
    bus, far, _ = bus_of(*("2XL430-W250",) * 4)
    far.before = b"\xff\xff\xfd\x00\x01\x40\x00\x55" + bytes(30)
    assert bus.exchange(None).valid.all()


def test_a_lost_middle_answer_is_known_by_the_last_ones_coming() -> None:
    """No deadline is waited for: the servos answer in order."""
    bus, far, clock = bus_of(*("2XL430-W250",) * 6)
    start_s = clock.now_s()
    bus.exchange(None)
    whole_s, start_s = clock.now_s() - start_s, clock.now_s()
    far.spoil = lambda raw, servo_id: b"" if servo_id == 3 else raw
    reading = bus.exchange(None)
    assert clock.now_s() - start_s < whole_s
    assert reading.valid.tolist() == [True, True, False, True, True, True]
    far.spoil = lambda raw, servo_id: b"" if servo_id == 6 else raw
    start_s = clock.now_s()
    bus.exchange(None)
    assert whole_s < clock.now_s() - start_s < whole_s + MARGIN_S + 0.001


def test_bad_checksums_are_counted_and_late_answers_too() -> None:
    bus, far, clock = bus_of(*("2XL430-W250",) * 3)
    far.spoil = lambda raw, servo_id: raw[:-1] + bytes([raw[-1] ^ 1]) if servo_id == 2 else raw
    bus.exchange(None)
    assert bus.chains[0].link.health.counters.crc.tolist() == [0, 1, 0]
    far.spoil = lambda raw, _servo_id: raw
    far.turnaround_s = 0.02
    assert not bus.exchange(None).valid.any()
    far.turnaround_s = 0.0
    clock.sleep_until(clock.now_s() + 0.05)
    assert bus.exchange(None).valid.all()
    assert bus.chains[0].link.health.counters.late.tolist() == [1, 1, 1]


def test_an_unplugged_port_comes_back_by_itself_and_says_so() -> None:
    bus, far, clock = bus_of(*X20[:4])
    far.unplugged = True
    for _ in range(5):
        with pytest.raises(LinkLostError):
            bus.exchange(None)
        clock.sleep_until(clock.now_s() + 0.2)
    far.unplugged = False
    clock.sleep_until(clock.now_s() + 0.6)
    assert bus.exchange(None).valid.all() and far.reopened == 1
    assert kinds(bus) == [BusEventKind.LOST, BusEventKind.REPLUGGED]
