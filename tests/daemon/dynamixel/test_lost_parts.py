"""What is lost costs what it has to and no more: a port, a servo, a reply."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.health import Health
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import LinkLostError
from sim.clock import VirtualClock
from sim.faults import Fault
from tests.daemon.dynamixel.test_multi import joined, two_ports
from tests.support.bus_rig import bus_rig
from tests.support.servo_emulator import fake
from tests.support.sizes import few_and_long


def test_while_the_port_is_gone_nothing_is_valid_and_everything_ages() -> None:
    """A second after the cable was out every value was still said to be of this cycle, and no servo to be silent."""
    rig = bus_rig(Fault("unplug", start_s=1.0))
    rig.bus.verify()
    assert rig.bus.exchange(None).valid.all()
    rig.clock.sleep_until(1.0)
    for lost in range(1, 101):
        with pytest.raises(LinkLostError):
            rig.bus.exchange(None)
        assert not rig.bus.reading.valid.any()
        assert rig.bus.reading.age_cycles.tolist() == [lost] * 16
        rig.clock.sleep_until(1.0 + 0.01 * lost)
    assert (rig.bus.chains[0].link.health.state == Health.MISSING).all()
    assert rig.bus.timeouts.tolist() == [0] * 16, "no servo is to blame"


def test_a_port_lost_during_a_single_read_leaves_nothing_valid() -> None:
    """Outside the cycle too: torque off, a poll."""
    rig = bus_rig(Fault("unplug", start_s=1.0))
    for ask in (lambda: rig.bus.poll_item(3, "led"), rig.bus.send_torque_off):
        rig.bus.reading.valid[:] = True
        rig.clock.sleep_until(1.0)
        with pytest.raises(LinkLostError):
            ask()
        assert not rig.bus.reading.valid.any()


def test_a_port_lost_in_the_exchange_leaves_nothing_valid() -> None:
    far, servos, clock = fake(*("XM430-W350",) * 6)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    for _ in range(3):
        bus.exchange(None)
    assert bus.reading.valid.all()
    far.unplugged = True
    with pytest.raises(LinkLostError):
        bus.exchange(None)
    assert not bus.reading.valid.any() and (bus.reading.age_cycles > 0).all()


def test_of_two_ports_the_lost_one_ages_alone() -> None:
    ports, clock = two_ports()
    bus = joined(ports, clock)
    bus.exchange(None)
    ports[0].unplugged = True
    for _ in range(5):
        with pytest.raises(LinkLostError):
            bus.exchange(None)
    on_lost = np.array([i % 2 == 0 for i in bus.ids])
    assert (bus.reading.age_cycles == np.where(on_lost, 5, 0)).all()
    assert (bus.reading.valid == ~on_lost).all()


def rate_hz(bus: ServoBus, clock: VirtualClock, cycles: int) -> float:
    """Cycles a second of this many."""
    start_s = clock.now_s()
    for _ in range(cycles):
        bus.exchange(np.full(len(bus.ids), 100, np.int32))
    return cycles / (clock.now_s() - start_s)


@pytest.mark.parametrize("name", few_and_long(["MX-28"], ["XM430-W350", "AX-12A"]))
@pytest.mark.parametrize("dead", few_and_long([1], [2]))
def test_one_dead_servo_of_two_is_quarantined_as_the_other_answers(name: str, dead: int) -> None:
    """One of two is half of them, and was taken for a brown-out for good: the rate fell from 1316 to 208 Hz."""
    far, servos, clock = fake(name, name)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    before_hz = rate_hz(bus, clock, 50)
    far.servos[dead].silent = True
    rate_hz(bus, clock, 40)
    assert bus.chains[0].link.health.state[dead - 1] == Health.QUARANTINED
    assert BusEventKind.BROWN_OUT not in [e.kind for e in bus.take_events()]
    assert rate_hz(bus, clock, 3000) > 0.95 * before_hz


def test_servos_that_die_one_by_one_are_quarantined_down_to_the_last() -> None:
    far, servos, clock = fake(*("XM430-W350",) * 4)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    for servo_id in (1, 2, 3, 4):
        far.servos[servo_id].silent = True
        rate_hz(bus, clock, 40)
        assert bus.chains[0].link.health.asked.tolist() == [i > servo_id for i in (1, 2, 3, 4)]
    for servo in far.servos.values():
        servo.silent = False
    while not bus.chains[0].link.health.asked.all():
        clock.sleep_until(clock.now_s() + 0.01)
        bus.exchange(None)
    assert bus.exchange(None).valid.all()


@pytest.mark.parametrize("n", [2, 3, 8])
def test_many_silent_at_once_are_a_brown_out_and_nobody_is_given_up(n: int) -> None:
    far, servos, clock = fake(*("2XL430-W250",) * n)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    for servo_id in range(1, 1 + max(2, (n + 1) // 2)):
        far.servos[servo_id].silent = True
    bus.exchange(None)
    assert bus.take_events() == [], "one cycle may be a spoilt answer"
    rate_hz(bus, clock, 40)
    assert [e.kind for e in bus.take_events()] == [BusEventKind.BROWN_OUT]
    assert bus.chains[0].link.health.asked.all()
