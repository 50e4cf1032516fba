"""The streamer in virtual time: nothing moves unasked, arming, playing, stopping, parking."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.dynamixel.registers.models import CONTROL_TABLES
from daemon.shared_memory.bus_link import BusRequest, BusState
from retarget.path.collision import SelfContact
from retarget.robot.loading import list_robots, load_robot
from tests.support.rig import assert_brakes_within_limits, rig, swing, with_known_turns
from tests.support.sizes import examples, few_and_long

ROBOTS = [
    name
    for name in list_robots()
    if all(s.model.protocol == 2.0 and s.model.model_number in CONTROL_TABLES for s in load_robot(name).servos)
]
"""Those whose servos the bus knows how to talk to."""


def test_nothing_moves_because_a_process_started():
    with rig() as r:
        r.push(swing(r.robot, 0.5))
        before = [s.position_tick for s in r.sim.servos.values()]
        r.cycle(100)
        assert r.state is BusState.LIMP and not any(r.torque)
        assert r.sim.audit.goals == 0
        assert [s.position_tick for s in r.sim.servos.values()] == before
        assert r.records[-1]["valid"].all(), "but it is measured"


@pytest.mark.parametrize("name", few_and_long(["reference"], ROBOTS))
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.soak) for seed in (1, 2))])
def test_arming_pins_then_goes_slowly_to_rest(name, seed):
    """From any pose in which it is not in itself; those are in `test_park.py`."""
    robot = load_robot(name)
    drawn = np.random.default_rng(seed).uniform(robot.position_min_rad, robot.position_max_rad, (100, robot.n_joints))
    drawn = with_known_turns(robot, drawn)
    start_rad = drawn[SelfContact(robot).clearance_m(drawn) > 0][0]
    with rig(name, start_rad=start_rad) as r:
        r.arm()
        assert all(r.torque)
        ticks = np.rint(r.streamer._ticks.to_ticks(robot.rest_rad)).astype(int)
        assert list(r.records[-1]["goal_tick"]) == list(ticks)
        assert np.abs(r.goals_rad()[0] - start_rad).max() < 0.01
        assert np.abs([v["velocity_rad_s"] for v in r.records]).max() <= 1.0
        r.assert_limits_kept()


def test_setpoints_inside_the_limits_reach_the_servos_bit_for_bit():
    with rig() as r:
        r.arm()
        q = swing(r.robot, 2.0)
        first = len(r.records)
        r.push(q, plan_id=9)
        r.cycle(len(q) + 5)
        played = [x for x in r.records[first:] if x["plan_id"] == 9][: len(q)]
        assert np.array([x["goal_rad"] for x in played]).tobytes() == q.tobytes()
        assert [x["frame"] for x in played] == list(range(len(q)))
        assert not any(x["clipped"].any() for x in played)
        assert r.state is BusState.HOLDING
        r.assert_limits_kept()


def test_stop_brakes_within_limits_and_holds():
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.link.request(BusRequest.STOP)
        r.cycle(100)
        assert r.state is BusState.HOLDING and all(r.torque)
        assert_brakes_within_limits(r.records[-101:], r.robot)
        assert r.link.setpoints.queued_frames == 0
        r.assert_limits_kept()


def test_a_late_front_makes_it_slow_down_and_go_on():
    with rig() as r:
        r.arm()
        q = swing(r.robot, 2.0)
        r.push(q[:60], last=False)
        r.cycle(61)
        assert r.state is BusState.PLAYING and r.records[-1]["underrun"]
        r.cycle(60)
        assert_brakes_within_limits(r.records[-62:], r.robot)
        assert r.state is BusState.PLAYING, "the plan has not ended"
        r.push(q[60:])
        r.cycle(len(q))
        assert r.state is BusState.HOLDING
        assert np.array_equal(r.records[-1]["goal_rad"], q[-1])
        r.assert_limits_kept()


def test_parking_ends_limp_in_the_park_pose():
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP)
        assert not any(r.torque)
        r.cycle(20)
        ticks = r.streamer._ticks.rad_to_tick(r.robot.park_rad)
        assert np.abs(r.records[-1]["present_tick"] - ticks).max() <= 6, "half a degree: friction stops a servo short"
        r.assert_limits_kept()


def test_a_park_may_stay_in_the_park_pose_before_it_goes_limp():
    """A lease that fell silent leads there; a plain park, also while it stays, goes limp at once."""
    with rig() as r:
        r.arm()
        r.link.request(BusRequest.PARK, stay_s=1.5)
        r.cycle()
        r.until(BusState.LIMP)
        stood = [
            i for i, k in enumerate(r.records) if k["torque"] and not k["velocity_rad_s"].any() and k["state"] == 5
        ]
        assert len(stood) / r.robot.bus.rate_hz == pytest.approx(1.5, abs=0.2)
        r.arm()
        r.link.request(BusRequest.PARK, stay_s=60.0)
        r.cycle(200)
        assert r.state is BusState.PARKING and all(r.torque)
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP, within_s=1.0)
        r.assert_limits_kept()


actions = st.lists(
    st.tuples(st.sampled_from([*BusRequest, "swing", "wild", "nan", "wait"]), st.integers(1, 120)), max_size=12
)


@settings(max_examples=examples(12), deadline=None)
@given(actions, st.integers(0, 2**32 - 1))
def test_no_order_of_requests_and_setpoints_breaks_a_limit(sequence, seed):
    random = np.random.default_rng(seed)
    with rig() as r:
        r.link.request(BusRequest.ARM)
        r.cycle()
        for plan_id, (action, n) in enumerate(sequence, 1):
            if isinstance(action, BusRequest):
                r.link.request(action)
            elif action != "wait":
                q = swing(r.robot, 1.0)[: min(n, 200)].copy()
                if action != "swing":
                    q[:] = random.uniform(-4, 4, q.shape)
                if action == "nan":
                    q[random.integers(len(q))] = random.choice([np.nan, np.inf, 1e300])
                r.link.setpoints.push(q, plan_id, 0, r.link.epoch, last=True)
            r.cycle(n)
        assert r.sim.audit.report()["violations"] == 0, r.sim.audit.report()["details"]
        torque = any(r.torque)
        assert not torque or not r.streamer.made_limp
        assert torque or r.state in (BusState.LIMP, BusState.ESTOP, BusState.FAULT, BusState.ARMING)
