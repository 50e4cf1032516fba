"""Robots that are found in a bad state, and clocks that jump: named, and nothing moves that should not."""

import numpy as np
import pytest

from daemon.control.ptp_trajectory import SPEED_RAD_S
from daemon.shared_memory.bus_link import BusRequest, BusState
from retarget.robot.loading import load_robot
from sim.faults import Fault
from tests.support.rig import rig, swing
from tests.support.sizes import few_and_long

SERVO = 13


def measured_rad(r) -> np.ndarray:
    """(J,) where the joints were found in the last cycle."""
    return r.streamer._ticks.tick_to_rad(r.records[-1]["present_tick"])


@pytest.mark.parametrize(
    ("kind", "amount", "word"),
    [("overload", None, "overload"), ("encoder", None, "encoder"), ("hot", 95.0, "overheating")],
)
def test_a_servo_found_in_fault_is_named_and_no_joint_gets_torque(kind, amount, word):
    """Latched before anybody came: the servo takes no torque, so the robot is not armed around it."""
    with rig("reference", Fault(kind, start_s=0.05, servo_id=SERVO, amount=amount)) as r:
        r.cycle(20)
        before = measured_rad(r)
        r.link.request(BusRequest.ARM)
        r.until(BusState.FAULT, within_s=5.0)
        assert f"servo {SERVO}" in r.link.text and word in r.link.text
        assert not any(r.torque)
        assert r.sim.audit.goals == 0
        r.cycle(50)
        assert r.state is BusState.FAULT and np.abs(measured_rad(r) - before).max() < 0.01


def test_a_servo_that_moves_while_being_armed_is_pinned_where_it_is():
    """Somebody swings the limp arm while the robot is armed: the goal is where the arm is found, and it is led from there."""
    with rig("reference", Fault("push", start_s=0.0, end_s=0.6, servo_id=SERVO, amount=0.25)) as r:
        r.cycle(25)
        swung_tick = np.ptp([x["present_tick"] for x in r.records[5:]], axis=0).max()
        assert swung_tick > 20, "it does move"
        r.link.request(BusRequest.ARM)
        r.until(BusState.HOLDING, BusState.FAULT)
        assert r.state is BusState.HOLDING, r.link.text
        r.assert_limits_kept()


def found_beyond(robot, seed: int) -> np.ndarray:
    """(J,) the rest pose with some joints 0.1 rad outside the robot's range."""
    rng = np.random.default_rng(seed)
    beyond = np.where(rng.random(robot.n_joints) < 0.5, robot.position_min_rad - 0.1, robot.position_max_rad + 0.1)
    return np.where(rng.random(robot.n_joints) < 0.4, beyond, robot.rest_rad)


@pytest.mark.parametrize("seed", few_and_long([0, 1], range(4)))
def test_a_robot_outside_its_limits_is_led_inwards_slowly_or_by_hand(seed):
    """Put away folded: each joint comes back slowly and never goes further out; where its servo refuses, it is named."""
    robot = load_robot("reference")
    with rig(start_rad=found_beyond(robot, seed)) as r:
        r.cycle()
        found = measured_rad(r)
        out = np.maximum(found - robot.position_max_rad, robot.position_min_rad - found)
        assert (out > 0.05).any(), "some are outside"
        r.link.request(BusRequest.ARM)
        r.cycle()
        r.until(BusState.HOLDING, BusState.FAULT)
        if r.state is BusState.FAULT:
            assert "by hand" in r.link.text and "goal where it stands" in r.link.text
            assert not any(r.torque)
            return
        goals = r.goals_rad()
        high, low = np.maximum(found, robot.position_max_rad), np.minimum(found, robot.position_min_rad)
        assert np.maximum(goals - high, low - goals).max() < 0.005, "a tick or two of rounding"
        assert np.abs([x["velocity_rad_s"] for x in r.records]).max() <= SPEED_RAD_S * 1.01
        r.assert_limits_kept()


@pytest.mark.long
def test_both_ways_of_being_outside_are_met():
    """Of the poses above one is led back and one is refused by a servo whose own range it leaves."""
    ends = set()
    for seed in range(4):
        with rig(start_rad=found_beyond(load_robot("reference"), seed)) as r:
            r.link.request(BusRequest.ARM)
            r.cycle()
            r.until(BusState.HOLDING, BusState.FAULT)
            ends.add(r.state)
    assert ends == {BusState.HOLDING, BusState.FAULT}


@pytest.mark.parametrize("jump_s", few_and_long([0.15], [0.005, 0.02, 1.0, 3600.0]))
def test_when_the_clock_jumps_the_robot_stays_within_its_limits(jump_s):
    """A stall, or a machine that slept: frames are skipped, or it is a named fault; never a burst, never a jump.

    The daemon reads no clock but the monotonic one, which does not go back.
    """
    with rig("reference", Fault("clock_jump", start_s=4.0, amount=jump_s)) as r:
        r.arm()
        while r.clock.now_s() < 3.9:
            r.cycle()
        r.push(swing(r.robot, 1.5))
        sent = r.sim.audit.goals
        r.cycle(200)
        assert r.state in (BusState.HOLDING, BusState.FAULT)
        assert r.state is BusState.HOLDING or r.link.text, "a fault has a reason"
        assert r.sim.audit.goals - sent <= 200 * r.robot.n_servos, "no burst"
        r.assert_limits_kept()
