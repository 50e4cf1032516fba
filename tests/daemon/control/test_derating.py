"""Slower before a servo trips: the share of speed by temperature, voltage and current, and motion along the same path."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from daemon.control.derating import LEAST_SHARE, DeratedBy, Derating, ServoLimits
from daemon.dynamixel.reading import BusReading
from daemon.shared_memory.bus_link import BusState
from sim.faults import Fault
from tests.support.rig import rig, swing

PERIOD_S = 0.01
LIMITS = ServoLimits(np.array([70.0, 80.0]), np.array([60.0, 95.0]), np.array([1000.0, 2000.0]))


def reading(temperature=(30, 30), voltage=(120, 120), current=(100, -100)) -> BusReading:
    r = BusReading.of(2)
    r.temperature_c[:], r.voltage_raw[:], r.current_raw[:] = temperature, voltage, current
    r.valid[:] = True
    return r


@pytest.mark.parametrize(
    ("values", "by", "share"),
    [
        ({}, DeratedBy.NOTHING, 1.0),
        ({"temperature": (59, 30)}, DeratedBy.NOTHING, 1.0),
        ({"temperature": (62, 30)}, DeratedBy.TEMPERATURE, 0.8),
        ({"temperature": (30, 78)}, DeratedBy.TEMPERATURE, LEAST_SHARE),
        ({"voltage": (120, 98)}, DeratedBy.VOLTAGE, 0.65),
        ({"voltage": (50, 120)}, DeratedBy.VOLTAGE, LEAST_SHARE),
        ({"current": (100, -1700)}, DeratedBy.CURRENT, 0.58),
        ({"temperature": (-1, -1), "voltage": (-1, -1)}, DeratedBy.NOTHING, 1.0),  # not read yet
    ],
)
def test_the_share_follows_the_worst_servo(values, by, share):
    derating = Derating(2, PERIOD_S)
    derating.limits = LIMITS
    for _ in range(2000):
        derating.update(reading(**values))
    assert derating.by is by and derating.share == pytest.approx(share, abs=0.01)


def test_a_moment_of_high_current_slows_nothing_and_the_share_never_jumps():
    derating = Derating(2, PERIOD_S)
    derating.limits = LIMITS
    shares = []
    for i in range(3000):
        current = (990, 0) if 500 <= i < 530 or i > 1000 else (100, 0)
        derating.update(reading(current=current))
        shares.append(derating.share)
    assert min(shares[:1000]) == 1.0 and shares[-1] < 0.4
    assert np.abs(np.diff(shares)).max() <= 0.5 * PERIOD_S + 1e-9


def test_a_hot_servo_slows_the_robot_before_it_trips():
    def play(*faults: Fault) -> SimpleNamespace:
        with rig("reference", *faults, slow_every=5) as r:
            r.arm()
            r.cycle(60)
            q = swing(r.robot, 4.0)
            done, first = 0, len(r.records)
            while done < len(q) or r.link.setpoints.queued_frames or r.state is BusState.PLAYING:
                done += r.link.setpoints.push(q[done : done + 20], 1, done, r.link.epoch, last=done + 20 >= len(q))
                r.cycle(5)
                assert len(r.records) - first < 3000
            r.assert_limits_kept()
            assert r.state is BusState.HOLDING, r.link.text
            return SimpleNamespace(cycles=len(r.records) - first, q=q, end=r.goals_rad()[-1], status=r.link.derating)

    cool = play()
    hot = play(Fault("hot", start_s=3.0, servo_id=13, amount=67.0))
    assert cool.status == (1.0, 0, cool.status[2])
    assert hot.status[0] < 0.9 and hot.status[1] == DeratedBy.TEMPERATURE and hot.status[2] == 13
    assert hot.cycles > 1.1 * cool.cycles
    assert np.allclose(hot.end, cool.end, atol=1e-6)
