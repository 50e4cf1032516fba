"""The robot is never led through itself, whatever it is sent and wherever it stands: by the simulator's audit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.control.point_to_point import NO_WAY_LIMP_S
from daemon.control.time_scaling import WAIT_S
from daemon.shared_memory.bus_link import BusRequest, BusState
from retarget.path import rrt_connect
from retarget.path.collision import SelfContact
from retarget.path.limits import JointLimits
from retarget.path.paths import JointState
from retarget.pipeline import Retargeter
from tests.retarget.gestures import gesture
from tests.support.rig import Rig, rig, with_known_turns
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

ROBOTS = ("op2", "reference", "toddlerbot")
BODIES = ByName(ROBOTS, lambda name: SelfContact(packaged(name), margin_m=0.0))
seeds = st.integers(0, 2**32 - 1)


def drawn(name: str, draw: np.random.Generator) -> np.ndarray:
    """(J,) any pose inside the limits in which it can be armed."""
    limits = JointLimits.of(packaged(name))
    return with_known_turns(packaged(name), draw.uniform(limits.position_min_rad, limits.position_max_rad))


def assert_never_in_itself(r: Rig) -> None:
    """No goal in contact but those that came with the start, no limit passed."""
    report = r.sim.audit.report()
    assert report["poses_checked"] > 0
    assert report["self_contacts"] == 0, report["contact_details"]
    assert report["violations"] == 0, report["details"]


def assert_parks(r: Rig) -> None:
    """It goes to the park pose, goes limp there, and was never in itself."""
    r.link.request(BusRequest.PARK)
    r.cycle()
    r.until(BusState.LIMP, within_s=60)
    assert r.goals_rad()[-1] == pytest.approx(r.robot.park_rad, abs=1e-9)
    assert_never_in_itself(r)


def into_itself(name: str, seed: int = 0) -> np.ndarray:
    """A pose in which the robot is deep in itself."""
    poses = np.array([drawn(name, np.random.default_rng((seed, k))) for k in range(500)])
    return poses[BODIES[name].clearance_m(poses).argmin()]


@pytest.mark.parametrize("name", few_and_long(["reference"], ROBOTS))
@settings(max_examples=examples(10), deadline=None)
@given(seed=seeds)
def test_from_any_pose_it_arms_and_parks_off_itself(name, seed):
    """Where it stands in contact (led there by hand) the contact only grows shallower, or it holds, says so and goes limp."""
    start = drawn(name, np.random.default_rng(seed))
    with rig(name, start_rad=start) as r:
        r.link.request(BusRequest.ARM)
        r.cycle()
        r.until(BusState.HOLDING, BusState.FAULT, within_s=90)
        if r.state is BusState.FAULT:
            assert "no free way to the rest pose" in r.link.text
            assert BODIES[name].clearance_m(start[None])[0] < 0.01, "only a robot in its own way may find none"
        else:
            assert r.goals_rad()[-1] == pytest.approx(r.robot.rest_rad, abs=1e-9)
        assert_never_in_itself(r)


@pytest.mark.long
@settings(max_examples=examples(10), deadline=None)
@given(st.sampled_from(ROBOTS), seeds, st.lists(st.sampled_from(["jump", "noise", "stop", "wait", "park"]), max_size=6))
def test_whatever_it_is_sent_it_is_led_to_park_off_itself(name, seed, actions):
    """Frames that no front would send: jumps into the body, noise; stops and parks at any instant."""
    draw = np.random.default_rng(seed)
    with rig(name) as r:
        r.arm()
        for plan_id, action in enumerate(actions, 1):
            n = int(draw.integers(5, 100))
            if action in ("jump", "noise"):
                to = np.repeat(drawn(name, draw)[None], n, 0)
                r.push(to if action == "jump" else to + draw.normal(0, 3, to.shape), plan_id)
            elif action in ("stop", "park"):
                r.link.request(BusRequest.STOP if action == "stop" else BusRequest.PARK)
            r.cycle(n)
            if r.state is BusState.LIMP:
                r.arm()
        assert_parks(r)


@pytest.mark.parametrize("name", few_and_long(["reference"], ROBOTS))
def test_a_plan_into_the_body_is_held_before_it_and_parked_from_there(name):
    with rig(name) as r:
        r.arm()
        inside = np.repeat(into_itself(name)[None], 250, 0)
        r.push(inside)
        r.cycle(250)
        assert r.streamer._gate.held
        assert BODIES[name].clearance_m(inside[:1])[0] < 0 < BODIES[name].clearance_m(r.goals_rad()[-1:])[0]
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP, within_s=60)
        assert_never_in_itself(r)


@pytest.mark.parametrize("name", few_and_long(["reference"], ROBOTS))
def test_after_a_plan_into_the_body_the_next_motion_is_played(name):
    """It stands nearer to itself than paths keep, and is led away all the same; the plan before does not wait for ever."""
    with rig(name) as r:
        r.arm()
        r.push(np.repeat(into_itself(name)[None], round(r.robot.bus.rate_hz), 0))
        r.cycle(5)
        assert r.state is BusState.PLAYING
        r.until(BusState.HOLDING, within_s=1.0 + 2 * WAIT_S)
        stands = r.goals_rad()[-1]
        path = Retargeter(r.robot).retarget(gesture("wave"), JointState(stands, np.zeros(r.robot.n_joints)))
        q = path.at_rate(r.robot.bus.rate_hz)
        r.push(q[:100], 2)
        r.cycle(120)
        assert np.abs(r.goals_rad()[-1] - stands).max() > 0.2
        assert np.abs(r.goals_rad()[-1] - q[99]).max() < 0.1  # where it then brakes
        assert_parks(r)


def blocked(name: str) -> np.ndarray:
    """(J,) a clear pose from which the straight line to the park pose goes through the robot."""
    park_rad, contact = packaged(name).park_rad, SelfContact(packaged(name))
    for seed in range(1000):
        start = drawn(name, np.random.default_rng(seed))
        if (contact.slack_m(start) > 0).all() and BODIES[name].clearance_m(
            np.linspace(start, park_rad, 100)
        ).min() < -0.01:
            return start
    raise AssertionError("no such pose")


@pytest.mark.parametrize("name", few_and_long(["reference"], ["toddlerbot"]))
def test_a_way_to_park_goes_round_the_robot_instead_of_through_it(name):
    start = blocked(name)
    with rig(name, start_rad=start) as r:
        r.streamer.rest_rad = start
        r.arm()
        assert_parks(r)


def test_without_a_free_way_to_park_it_holds_says_so_and_goes_limp(monkeypatch):
    start = blocked("reference")
    with rig("reference", start_rad=start) as r:
        r.streamer.rest_rad = start
        r.arm()
        monkeypatch.setattr(rrt_connect, "TRIES", 0)
        held = r.goals_rad()[-1]
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.FAULT, within_s=2)
        since_s = r.clock.now_s()
        assert "no free way to the park pose" in r.link.text and "limp in 10 s" in r.link.text
        assert all(r.torque), "it holds"
        while any(r.torque):
            r.cycle()
        assert r.clock.now_s() - since_s == pytest.approx(NO_WAY_LIMP_S, abs=0.1)
        assert np.array_equal(r.goals_rad()[-1], held), "and did not move"
        monkeypatch.undo()
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        assert_never_in_itself(r)


def test_a_stop_while_it_looks_for_a_way_holds():
    with rig() as r:
        r.arm()
        r.push(np.repeat(into_itself("reference")[None], 200, 0))
        r.cycle(210)
        r.link.request(BusRequest.PARK)
        r.cycle(2)
        r.link.request(BusRequest.STOP)
        r.cycle(100)
        assert r.state is BusState.HOLDING and all(r.torque)
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP, within_s=60)
        assert_never_in_itself(r)
