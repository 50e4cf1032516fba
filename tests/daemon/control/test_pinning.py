"""Torque comes on only over goals pinned to where the joints stand, also when they move meanwhile."""

from __future__ import annotations

import pytest

from daemon.shared_memory.bus_link import BusRequest, BusState
from sim.faults import Fault
from sim.servos.servo_power import OVERLOAD_BIT
from tests.support.rig import Rig, rig, swing
from tests.support.sizes import few_and_long

ID = 13


class Pushed:
    """A hand at one joint: moves its limp servo by some ticks whenever another goal has been pinned, so many times."""

    def __init__(self, r: Rig, ticks: int, times: int) -> None:
        self.left, self._ticks, self._servo = times, ticks, r.sim.servos[ID]
        self._last = r.robot.servo_ids[-1]
        r.sim.on_goal = self._pinned

    def _pinned(self, _t_s: float, servo_id: int, _tick: int) -> None:
        if servo_id == self._last and self.left and not self._servo.torque:
            self.left -= 1
            self._servo.position_tick = self._servo.position_tick + self._ticks


@pytest.mark.parametrize("times", few_and_long([1], [1, 2]))
def test_a_joint_that_is_moved_while_goals_are_pinned_is_pinned_anew(times):
    with rig() as r:
        hand = Pushed(r, 60, times)
        before = r.sim.servos[ID].position_tick
        r.arm()
        assert hand.left == 0
        first = next(k for k in r.records if k["torque"])["goal_tick"][r.robot.servo_ids.index(ID)]
        assert first == pytest.approx(before + 60 * times, abs=2)
        r.assert_limits_kept()


def test_a_joint_that_never_stands_still_while_pinned_is_a_named_fault():
    with rig() as r:
        Pushed(r, 60, 99)
        r.link.request(BusRequest.ARM)
        r.cycle()
        r.until(BusState.FAULT)
        assert (
            r.state is BusState.FAULT
            and f"servo {ID}:" in r.link.text
            and "to stand still while its goal is pinned" in r.link.text
        )
        assert not any(r.torque)
        assert r.sim.audit.report()["violations"] == 0


def test_a_joint_moved_within_the_tolerance_is_no_reason_to_pin_anew():
    with rig() as r:
        hand = Pushed(r, 4, 1)
        r.arm()
        assert hand.left == 0
        r.assert_limits_kept()


@pytest.mark.parametrize("name", ["reference", "op3", "reachy_2021", "poppy_torso"])
def test_a_servo_that_trips_while_pinned_is_named_and_none_gets_torque(name: str) -> None:
    """A soak of 4.8 hours met it: torque was asked of all, the tripped one among them, and only then was it noticed."""
    with rig(name) as r:
        last = r.robot.servo_ids[-1]
        tripped = r.robot.servo_ids[2]
        r.sim.on_goal = lambda _t_s, servo_id, _tick: (
            r.sim.servos[tripped].trip(OVERLOAD_BIT) if servo_id == last else None
        )
        r.link.request(BusRequest.ARM)
        r.cycle()
        r.until(BusState.FAULT, BusState.HOLDING)
        assert r.state is BusState.FAULT and f"servo {tripped}: " in r.link.text and "overload" in r.link.text
        assert not any(x["torque"] for x in r.records) and not any(r.torque)
        assert r.sim.audit.report()["violations"] == 0


@pytest.mark.parametrize("probability", few_and_long([0.3], [0.05, 0.3]))
def test_a_joint_that_sinks_during_pinning_is_pinned_where_it_hangs(probability):
    """Answers are lost, so pinning takes long enough for an arm to sink: torque came on over a goal that the joint had left."""
    with rig("reference", Fault("drop", 0.0, 1.5, probability)) as r:
        servo = r.sim.servos[ID]
        hangs_at = servo.position_tick + 90

        def sink(_t_s: float, _servo_id: int, _tick: int) -> None:
            if not servo.torque and servo.position_tick < hangs_at:
                servo.position_tick = servo.position_tick + 3

        r.sim.on_goal = sink
        for _ in range(9):  # a servo that does not answer at all is a fault of its own
            r.link.request(BusRequest.ARM)
            r.cycle()
            r.until(BusState.HOLDING, BusState.FAULT)
            if r.state is BusState.HOLDING:
                break
            r.link.request(BusRequest.RESET)
            r.cycle(20)
        assert r.sim.audit.report()["violations"] == 0, r.sim.audit.report()["details"]
        first = next(k for k in r.records if k["torque"])["goal_tick"][r.robot.servo_ids.index(ID)]
        assert first == pytest.approx(hangs_at, abs=3)


@pytest.mark.parametrize("name", few_and_long(["reachy_2021"], ["poppy_torso"]))
@pytest.mark.parametrize("outage_s", few_and_long([1.0], [0.05]))
def test_servos_that_a_goal_wakes_get_none_after_their_power_failed(name, outage_s):
    """AX and MX switch torque on with a goal: after a brown-out the held goal took limp arms up with a jerk, wherever they hung."""
    with rig(name, Fault("brown_out", 6.0, 6.0 + outage_s)) as r:
        r.arm()
        while r.clock.now_s() < 6.0 + outage_s / 2:
            r.cycle()
        for servo in r.sim.servos.values():  # arms fall
            servo.position_tick = servo.position_tick + 40
        r.cycle(60)
        assert r.state is BusState.FAULT
        assert "silent" in r.link.text and "reset and arm" in r.link.text
        assert not any(r.torque), "they answer again and hang limp"
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        r.assert_limits_kept()


def test_a_servo_without_power_gets_no_goal_and_the_others_come_to_rest():
    with rig("reachy_2021") as r:
        r.arm()
        servo = r.sim.servos[13]
        r.push(swing(r.robot, 3.0))
        r.cycle(20)
        servo.reboot()
        servo.position_tick = servo.position_tick + 60
        r.until(BusState.FAULT, within_s=1.0)
        assert "servo 13 (r_elbow_pitch) silent" in r.link.text
        r.cycle(60)
        assert not servo.torque and all(s.torque for s in r.sim.servos.values() if s is not servo)
        assert not r.records[-1]["velocity_rad_s"].any()
        r.assert_limits_kept()


def test_answers_lost_now_and_then_withhold_no_goal():
    with rig("reachy_2021", Fault("drop", start_s=3.0, probability=0.05)) as r:
        r.arm()
        for _ in range(2):
            r.push(swing(r.robot, 1.5))
            r.cycle(85)
            assert r.state is BusState.HOLDING, r.link.text
        assert sum((~x["valid"].astype(bool)).sum() for x in r.records) > 50
        r.assert_limits_kept()


@pytest.mark.parametrize("limit", few_and_long([200], [200, 600]))
def test_a_servo_of_a_lower_pwm_limit_is_armed_and_ends_at_its_own_limit(limit):
    """Of limit 200 it could not be armed; of 600 the ramp ended at 568, for later steps were refused."""
    with rig() as r:
        r.sim.servos[ID]._set("pwm_limit", limit)
        r.arm()
        r.cycle(100)
        assert {s.spec.servo_id: s.get("goal_pwm") for s in r.sim.servos.values()} == {
            i: limit if i == ID else 885 for i in r.robot.servo_ids
        }
        r.assert_limits_kept()
