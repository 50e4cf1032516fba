"""Faults at the servos, on the wire and in the front: each is named, and the robot stands or goes limp."""

import itertools
from contextlib import closing

import pytest

from daemon.control.front_watch import HEARTBEAT_LOST_S, PARK_AFTER_S
from daemon.shared_memory import bus_link as shared
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from daemon.shared_memory.request_words import Asker
from retarget.robot.loading import load_robot
from sim.faults import Fault
from tests.support.rig import rig, swing
from tests.support.sizes import few_and_long


def test_a_silent_front_holds_then_parks(monkeypatch):
    """Time of the heartbeat is the machine's; here it goes with the virtual clock."""
    with rig(watch_front=True) as r:
        monkeypatch.setattr(shared.time, "monotonic_ns", lambda: int(r.clock.now_s() * 1e9))
        r.link.heartbeat()
        r.link.request(BusRequest.ARM)
        for _ in range(400):
            r.link.heartbeat()
            r.cycle()
        assert r.state is BusState.HOLDING
        r.push(swing(r.robot, 2.0))
        for _ in range(15):
            r.link.heartbeat()
            r.cycle()
        lost_s, first = r.clock.now_s(), len(r.records)
        r.until(BusState.STOPPING, BusState.HOLDING, within_s=HEARTBEAT_LOST_S + 0.1)
        assert r.clock.now_s() - lost_s == pytest.approx(HEARTBEAT_LOST_S, abs=0.05)
        r.until(BusState.HOLDING, within_s=1.0)
        assert all(r.torque)
        r.until(BusState.PARKING, within_s=PARK_AFTER_S)
        r.until(BusState.LIMP)
        assert not any(r.torque)
        states = [BusState(int(x["state"])).name for x in r.records[first:]]
        assert [k for k, _ in itertools.groupby(states)] == ["PLAYING", "STOPPING", "HOLDING", "PARKING", "LIMP"]
        r.cycle(100)
        assert r.state is BusState.LIMP
        r.assert_limits_kept()


@pytest.mark.parametrize("playing", few_and_long([True], [False]))
def test_a_servo_that_trips_is_a_named_fault_and_nothing_rearms(playing):
    with rig("reference", Fault("trip", start_s=4.0, servo_id=13)) as r:
        r.arm()
        while r.clock.now_s() < 4.2:
            if playing and r.link.setpoints.queued_frames < 20:
                r.push(swing(r.robot, 1.0))
            r.cycle()
        assert r.state is BusState.FAULT
        assert "servo 13" in r.link.text and "overload" in r.link.text
        r.link.request(BusRequest.ARM)
        r.cycle(200)
        assert r.state is BusState.FAULT
        assert not r.records[-1]["velocity_rad_s"].any()
        r.assert_limits_kept()
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        assert r.state is BusState.LIMP and not any(r.torque)
        r.link.request(BusRequest.ARM)
        r.cycle(20)
        assert r.state is BusState.FAULT and "servo 13" in r.link.text, "it has not been rebooted"
        assert not any(r.torque)


def test_torque_lost_without_a_word_is_a_fault():
    """A servo that rebooted (a brown-out) answers as if nothing had happened, but holds nothing."""
    with rig() as r:
        r.arm()
        servo = list(r.sim.servos.values())[6]
        servo.reboot()
        r.until(BusState.FAULT, within_s=2.0)
        assert f"servo {servo.servo_id} " in r.link.text and "torque" in r.link.text
        r.cycle(100)
        assert r.state is BusState.FAULT and not servo.torque


def test_unplugged_is_a_fault_and_plugged_in_again_nothing_moves():
    with rig("reference", Fault("unplug", start_s=4.0, end_s=5.0)) as r:
        r.arm()
        while r.clock.now_s() < 6.0:
            if r.state in (BusState.HOLDING, BusState.PLAYING) and r.link.setpoints.queued_frames < 20:
                r.push(swing(r.robot, 1.0))
            r.cycle()
        assert r.state is BusState.FAULT and "unplugged" in r.link.text
        before = [s.position_tick for s in r.sim.servos.values()]
        r.link.request(BusRequest.ARM)
        r.cycle(100)
        assert r.state is BusState.FAULT
        assert [s.position_tick for s in r.sim.servos.values()] == pytest.approx(before, abs=1)
        r.assert_limits_kept()
        r.link.request(BusRequest.RESET)
        r.cycle()
        r.arm()
        r.assert_limits_kept()


def test_half_of_the_servos_silent_is_a_fault():
    robot = load_robot("reference")
    silent = [Fault("silent", start_s=4.0, servo_id=i) for i in robot.servo_ids[: robot.n_joints // 2]]
    with rig("reference", *silent) as r:
        r.arm()
        r.until(BusState.FAULT, within_s=8.0)
        assert "silent" in r.link.text
        assert 4.0 < r.clock.now_s() < 5.0


@pytest.mark.parametrize("kind", few_and_long(["corrupt"], ["drop"]))
def test_lost_replies_do_not_stop_the_robot(kind):
    """One reply in fifty lost or spoilt: the values go stale for a cycle and say so, the motion goes on."""
    with rig("reference", Fault(kind, start_s=3.0, probability=0.02)) as r:
        r.arm()
        for _ in range(3):
            r.push(swing(r.robot, 1.0))
            r.cycle(105)
            assert r.state is BusState.HOLDING, r.link.text
        invalid = sum((~x["valid"].astype(bool)).sum() for x in r.records)
        assert invalid > 20
        r.assert_limits_kept()


def test_arming_fails_by_name_when_a_servo_is_silent():
    with rig("reference", Fault("silent", servo_id=15)) as r:
        r.link.request(BusRequest.ARM)
        r.cycle(3)
        assert r.state is BusState.FAULT and "15" in r.link.text and "no answer" in r.link.text
        assert not any(r.torque)
        assert r.sim.audit.goals == 0


def test_a_stall_longer_than_the_servos_watchdog_is_a_fault():
    """Frozen for a second while moving: the servos stopped by themselves and would refuse goals from then on."""
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.clock.sleep_until(r.clock.now_s() + 1.0)
        r.cycle(10)
        assert r.state is BusState.FAULT and "1.0" in r.link.text
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        r.assert_limits_kept()


def test_a_stop_while_an_orphan_parks_holds_it_for_a_while(monkeypatch):
    """The park was begun again in the cycle of the stop, which was answered as carried out."""
    with rig(watch_front=True) as r, closing(BusLink.attach(r.link.path, r.robot.n_joints, asker=Asker.CTL)) as ctl:
        age_s = 0.0
        monkeypatch.setattr(type(r.link), "heartbeat_age_s", property(lambda _: age_s))
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(30)
        age_s = PARK_AFTER_S + 0.1
        r.until(BusState.PARKING)
        r.cycle(20)
        ctl.request(BusRequest.STOP)
        stopped_s, first = r.clock.now_s(), len(r.records)
        r.cycle()
        assert r.state in (BusState.STOPPING, BusState.HOLDING)
        r.until(BusState.PARKING)
        assert r.clock.now_s() - stopped_s == pytest.approx(PARK_AFTER_S, abs=0.1)
        assert all(r.torque)
        r.until(BusState.LIMP)
        states = [BusState(int(x["state"])).name for x in r.records[first:]]
        assert [k for k, _ in itertools.groupby(states)] == ["STOPPING", "HOLDING", "PARKING", "LIMP"]
        r.assert_limits_kept()
