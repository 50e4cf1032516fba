"""What is lost costs what it has to and no more: a port, a servo, a reply."""

from __future__ import annotations

import numpy as np
import pytest
from emulator import fake
from rig_bus import bus_rig
from test_multi import joined, two_ports

from daemon.bus.health import Health
from daemon.bus.servo_bus import ServoBus
from daemon.errors import LinkLostError
from sim.faults import Fault


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
    assert (rig.bus.health.state == Health.MISSING).all()
    assert rig.bus.timeouts.tolist() == [0] * 16, "no servo is to blame"


def test_a_port_that_goes_while_a_single_servo_is_asked_leaves_nothing_valid() -> None:
    """Outside the cycle too: torque off, a poll."""
    rig = bus_rig(Fault("unplug", start_s=1.0))
    for ask in (lambda: rig.bus.poll_item(3, "led"), rig.bus.send_torque_off):
        rig.bus.reading.valid[:] = True
        rig.clock.sleep_until(1.0)
        with pytest.raises(LinkLostError):
            ask()
        assert not rig.bus.reading.valid.any()


def test_sent_ahead_or_not_a_lost_port_leaves_nothing_valid() -> None:
    far, servos, clock = fake(*("XM430-W350",) * 6)
    bus = ServoBus(far, servos, clock)
    bus.verify()
    for _ in range(3):
        bus.exchange_ahead(None)
    assert bus.reading.valid.all()
    far.unplugged = True
    with pytest.raises(LinkLostError):
        bus.exchange_ahead(None)
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
