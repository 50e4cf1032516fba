"""E-stop, torque off and what follows: when torque goes, and that nothing brings it back unasked."""

import numpy as np
import pytest

from daemon.control.front_watch import FAULT_LIMP_S
from daemon.control.torque_switch import TORQUE_OFF_REPEATS
from daemon.shared_memory.bus_link import BusRequest, BusState
from retarget.robot.loading import list_robots
from sim.faults import Fault
from tests.support.rig import assert_brakes_within_limits, lead_to, rig, swing
from tests.support.sizes import few_and_long


def test_a_reset_and_an_arm_that_came_before_an_e_stop_do_not_undo_it():
    """Requests of one cycle were once served by kind: e-stop, reset, arm; the robot was armed again after its e-stop."""
    with rig() as r:
        r.arm()
        for request in (BusRequest.RESET, BusRequest.ARM, BusRequest.ESTOP):
            r.link.request(request)
        r.cycle(5)
        assert r.state is BusState.ESTOP and not any(r.torque)
        for request in (BusRequest.ESTOP, BusRequest.RESET, BusRequest.ARM):  # given after it they are carried out
            r.link.request(request)
        assert [BusState(int(r.cycle()["state"])) for _ in range(3)] == [BusState.ESTOP, BusState.LIMP, BusState.ARMING]


@pytest.mark.parametrize("state", few_and_long(["arming", "playing", "parking"], ["holding", "stopping"]))
def test_e_stop_cuts_torque_in_its_cycle_and_is_latched(state):
    with rig() as r:
        if state == "arming":
            r.link.request(BusRequest.ARM)
            r.cycle(5)
        else:
            lead_to(r, state)
        assert r.state.name.lower() == state
        r.link.request(BusRequest.ARM)
        r.link.request(BusRequest.ESTOP)
        r.cycle()
        assert not any(r.torque)
        assert r.state is BusState.ESTOP and not r.records[-1]["torque"]
        goals = r.sim.audit.goals
        for request in (BusRequest.ARM, BusRequest.PARK, BusRequest.STOP):
            r.link.request(request)
            r.push(swing(r.robot, 0.2))
            r.cycle(5)
            assert r.state is BusState.ESTOP and not any(r.torque)
        assert r.sim.audit.goals == goals
        r.link.request(BusRequest.RESET)
        r.cycle(5)
        assert r.state is BusState.LIMP and not any(r.torque), "reset arms nothing"
        r.arm()
        r.assert_limits_kept()


@pytest.mark.parametrize("state", few_and_long(["arming", "playing"], ["holding", "stopping", "parking"]))
def test_an_e_stop_that_holds_brakes_within_limits_and_the_second_cuts(state):
    with rig() as r:
        if state == "arming":
            r.link.request(BusRequest.ARM)
            r.until(BusState.ARMING)
            while not any(r.torque):
                r.cycle()
            r.cycle(30)
        else:
            lead_to(r, state, parking_cycles=40)
        assert r.state.name.lower() == state
        r.link.request(BusRequest.ESTOP_HOLD)
        began = len(r.records) - 1
        for request in (BusRequest.ARM, BusRequest.PARK, BusRequest.STOP, BusRequest.TORQUE_OFF):
            r.cycle(25)
            assert r.state is BusState.ESTOP and all(r.torque)
            r.link.request(request)
            r.push(swing(r.robot, 0.2))
        assert_brakes_within_limits(r.records[began:], r.robot)
        assert np.array_equal(r.records[-1]["goal_rad"], r.records[-20]["goal_rad"])
        r.link.request(BusRequest.ESTOP_HOLD)
        r.cycle()
        assert r.state is BusState.ESTOP and not any(r.torque)
        r.link.request(BusRequest.RESET)
        r.cycle(3)
        r.arm()
        r.assert_limits_kept()


def test_a_reset_makes_limp_what_an_e_stop_holds():
    with rig() as r:
        r.link.request(BusRequest.ARM)
        r.cycle(2)
        r.link.request(BusRequest.ESTOP_HOLD)
        r.cycle(50)
        assert r.state is BusState.ESTOP and not any(r.torque)
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        r.link.request(BusRequest.ESTOP_HOLD)
        r.cycle(10)
        assert all(r.torque)
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        assert r.state is BusState.LIMP and not any(r.torque)
        r.assert_limits_kept()


def test_what_an_e_stop_holds_goes_limp_when_nobody_is_there(monkeypatch):
    with rig(watch_front=True) as r:
        age_s = 0.0
        monkeypatch.setattr(type(r.link), "heartbeat_age_s", property(lambda _: age_s))
        r.arm()
        r.link.request(BusRequest.ESTOP_HOLD)
        age_s = FAULT_LIMP_S - 0.5
        r.cycle(30)
        assert r.state is BusState.ESTOP and all(r.torque) and not r.streamer.made_limp
        age_s = FAULT_LIMP_S + 0.5
        r.cycle(TORQUE_OFF_REPEATS + 2)
        assert r.state is BusState.ESTOP and not any(r.torque) and r.streamer.made_limp


@pytest.mark.parametrize("state", few_and_long(["arming", "playing"], ["limp", "holding", "parking"]))
def test_torque_off_brakes_within_limits_and_goes_limp_where_it_stands(state):
    with rig() as r:
        if state == "arming":
            r.link.request(BusRequest.ARM)
            r.cycle(3)
        elif state != "limp":
            lead_to(r, state, parking_cycles=20)
        r.link.request(BusRequest.TORQUE_OFF)
        began = len(r.records) - 1
        r.cycle(100)
        assert r.state is BusState.LIMP and not any(r.torque)
        if state == "playing":
            assert_brakes_within_limits([x for x in r.records[began:] if x["torque"]], r.robot)
            assert np.abs(r.records[-1]["goal_rad"] - r.robot.park_rad).max() > 0.1, "it was not led to park"
        r.arm()
        r.assert_limits_kept()


def test_a_stop_that_follows_torque_off_before_it_stands_holds():
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(30)
        r.link.request(BusRequest.TORQUE_OFF)
        r.cycle()
        r.link.request(BusRequest.STOP)
        r.cycle(100)
        assert r.state is BusState.HOLDING and all(r.torque)


def test_an_e_stop_while_unplugged_is_carried_out_when_the_bus_is_back():
    """The torque-off that could not be sent is not forgotten: the person who pressed it believes the robot is limp."""
    with rig("reference", Fault("unplug", start_s=3.0, end_s=3.5)) as r:
        r.arm()
        while r.clock.now_s() < 3.1:
            r.cycle()
        assert all(r.torque)
        r.link.request(BusRequest.ESTOP)
        r.cycle()
        assert r.state is BusState.ESTOP
        while r.clock.now_s() < 3.6:
            r.cycle()
        assert not any(r.torque)
        assert r.state is BusState.ESTOP


@pytest.mark.parametrize("request_", few_and_long([BusRequest.ESTOP], [BusRequest.PARK]))
def test_a_servo_that_heard_no_torque_off_is_told_again_when_it_hears(request_):
    """A loose cable while the robot goes limp: the five packets that nobody answers were all lost on one servo."""
    deaf = Fault("deaf", start_s=4.0, end_s=8.0, servo_id=5)
    with rig("reference", deaf, slow_every=10) as r:
        r.cycle(3)
        r.arm()
        r.cycle(max(0, round((4.2 - r.clock.true_s) * 100)))
        r.link.request(request_)
        r.until(BusState.ESTOP, BusState.LIMP)
        r.cycle(20)
        if r.clock.true_s < 8.0:
            assert [i for i, s in r.sim.servos.items() if s.torque] == [5]
        r.cycle(700)
        assert not any(r.torque), "it is limp once it hears again"
        r.assert_limits_kept()


@pytest.mark.parametrize("before", few_and_long(["fault"], ["estop", "limp"]))
def test_the_end_of_the_process_leaves_no_servo_with_torque(before):
    """One packet, or three, were sent at the end: a servo that was deaf meanwhile kept its torque, with no process left."""
    deaf = Fault("deaf", start_s=100.0, end_s=100.06, servo_id=5)
    with rig("reference", deaf) as r:
        r.arm()
        r.clock.sleep_until(100.0)
        if before == "fault":
            r.link.request(BusRequest.FAULT)
        else:
            r.link.request(BusRequest.ESTOP if before == "estop" else BusRequest.TORQUE_OFF)
        r.link.request(BusRequest.SHUTDOWN)
        r.streamer.run()
        assert not any(r.torque)


@pytest.mark.parametrize("name", few_and_long(["op3"], list_robots()))
def test_at_the_end_each_servo_says_that_it_has_no_torque(name, caplog):
    with rig(name) as r:
        r.arm()
        r.link.request(BusRequest.SHUTDOWN)
        r.streamer.run()
        assert not any(r.torque) and not [x for x in caplog.records if x.levelname == "ERROR"]


def test_a_servo_that_keeps_its_torque_at_the_end_is_named(caplog):
    with rig("reference", Fault("deaf", start_s=100.0, servo_id=5)) as r:
        r.arm()
        r.clock.sleep_until(100.0)
        r.link.request(BusRequest.SHUTDOWN)
        r.streamer.run()
        assert sum(r.torque) == 1 and "servo 5 may still have torque" in caplog.text
