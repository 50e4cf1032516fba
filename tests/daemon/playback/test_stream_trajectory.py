"""A lease on the simulated bus in virtual time: real planner, bus process, gate and servos; the audit is the judge."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.playback.chunk_maker import ChunkMaker
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.stream_source import StreamSource
from daemon.playback.splicer import Splicer
from daemon.playback.stream_trajectory import StreamTrajectory
from daemon.poses.layers import Layers
from daemon.shared_memory.bus_link import BusRequest, BusState
from daemon.state.bus_view import BusView
from daemon.state.lease import LeaseClock, LeaseState
from retarget.path.collision import SelfContact
from retarget.path.safety_filter import SafetyFilter
from tests.support.rig import Rig, rig
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

BODIES = ByName(("reference", "toddlerbot"), lambda name: SelfContact(packaged(name), margin_m=0.0))


class Streaming:
    """The front's part of a lease, by hand: one `cycle` is one bus period and one tick."""

    def __init__(self, bench: Rig) -> None:
        self.bench, self.robot = bench, bench.robot
        self.view = BusView(bench.link, bench.robot)
        self.planner = SetpointBuffer(bench.robot, bench.link, self.view, 0.1, clock=bench.clock)
        self.splicer, self.person = Splicer(self.planner, bench.clock), ChunkMaker(bench.robot, Layers("off")).person
        self.guard = SafetyFilter(bench.robot)
        self.plan_ids = 0
        self.score = self.lease()

    @property
    def now_s(self) -> float:
        return self.bench.clock.now_s()

    @property
    def plan(self) -> StreamTrajectory:
        assert isinstance(self.planner.current, StreamTrajectory)
        return self.planner.current

    def lease(self) -> StreamSource:
        """A new lease from where the robot is led."""
        self.planner.read_cycles()
        score = StreamSource(self.robot, self.guard, LeaseClock(0.2, 5.0), "test")
        self.score = score
        self.plan_ids += 1
        with self.splicer.splice_at_once() as splice:
            score.begin(splice.state, self.now_s)
            statistics, rate_hz = self.planner.statistics(self.plan_ids, 0), self.robot.bus.rate_hz
            plan = StreamTrajectory(
                self.plan_ids, f"lease {self.plan_ids}", self.planner.epoch, rate_hz, statistics, score, self.person
            )
            self.splicer.follow_with(splice, plan)
        return score

    def cycle(self, n: int = 1, *, fed: bool = True) -> None:
        for _ in range(n):
            self.bench.cycle()
            self.planner.read_cycles()
            self.score.clock.look(self.now_s)
            if fed:
                self.planner.stream_on()

    def to(self, q_rad: np.ndarray, n: int = 1) -> None:
        """Send the same target in every cycle."""
        for _ in range(n):
            self.score.take(q_rad, self.now_s)
            self.cycle()

    def assert_clean(self) -> None:
        self.bench.assert_limits_kept()
        assert self.bench.sim.audit.report()["self_contacts"] == 0
        goals = self.bench.goals_rad()
        between = np.concatenate([goals, (goals[1:] + goals[:-1]) / 2])
        assert BODIES[self.robot.name].clearance_m(between).min() > 0.0


@contextmanager
def streaming(name: str = "reference") -> Iterator[Streaming]:
    with rig(name) as bench:
        bench.arm()
        yield Streaming(bench)


def reach(robot, share: float = 0.5) -> np.ndarray:
    return robot.rest_rad + share * np.clip(0.4, None, robot.position_max_rad - robot.rest_rad)


actions = st.lists(
    st.tuples(
        st.sampled_from(["pose", "jump", "far", "sine", "silence", "stall", "stop", "again", "slow"]),
        st.integers(0, 2**32 - 1), st.integers(1, 50),
    ),
    min_size=1, max_size=12,
)  # fmt: skip


@pytest.mark.parametrize("name", few_and_long(["reference"], ["toddlerbot"]))
@settings(max_examples=examples(12), deadline=None)
@given(actions=actions)
def test_no_stream_breaks_a_limit_or_touches(name, actions):
    """Random, jumping, adversarial and interrupted streams, a front that stalls, stops in the middle, a slowed robot."""
    with streaming(name) as s:
        low, high = s.guard.limits.position_min_rad, s.guard.limits.position_max_rad
        for kind, seed, n in actions:
            draw = np.random.default_rng(seed)
            if kind == "pose":
                s.to(draw.uniform(low, high), n)
            elif kind == "jump":
                for _ in range(n):
                    s.to(draw.uniform(low, high) * draw.uniform(0.2, 1.5))
            elif kind == "far":
                s.to(np.where(draw.random(s.robot.n_joints) < 0.5, -900.0, 900.0), n)
            elif kind == "sine":
                joint = int(draw.integers(s.robot.n_joints))
                for k in range(n):
                    q_rad = np.full(s.robot.n_joints, np.nan)
                    q_rad[joint] = (high[joint] - low[joint]) * np.sin(0.3 * k)
                    s.to(q_rad)
            elif kind == "silence":
                s.cycle(n)
            elif kind == "stall":
                s.cycle(n, fed=False)
            elif kind == "slow":
                s.bench.streamer._derating.share = float(draw.uniform(0.3, 1.0))
                s.to(draw.uniform(low, high), n)
            elif kind == "stop":
                s.bench.link.request(BusRequest.STOP)
                s.cycle(1, fed=False)
                s.bench.until(BusState.HOLDING)
                s.lease()
            else:
                s.lease()
        s.cycle(120)
        s.assert_clean()


def test_a_target_moves_the_robot_in_the_next_cycle_and_is_met_exactly():
    with streaming() as s:
        s.cycle(5)
        assert s.bench.state is BusState.HOLDING and s.plan.resting
        q_rad, before = reach(s.robot), s.view.goal_rad.copy()
        s.score.take(q_rad, s.now_s)
        s.planner.stream_on()
        s.cycle()
        assert s.bench.state is BusState.PLAYING and not np.array_equal(s.view.goal_rad, before)
        s.to(q_rad, 150)
        assert np.array_equal(s.view.goal_rad, q_rad) and s.plan.statistics.gate_clipped == 0
        assert s.bench.state is BusState.HOLDING, "what stands needs no frames"
        s.assert_clean()


@pytest.mark.long
def test_silence_brakes_and_holds_and_the_next_target_goes_on():
    with streaming() as s:
        far = reach(s.robot, 1.0)
        s.to(far, 12)
        moving = s.view.goal_rad.copy()
        s.cycle(20)
        assert s.score.clock.state is LeaseState.SILENT and s.score.held_by == "silence"
        s.cycle(60)
        held = s.view.goal_rad.copy()
        s.cycle(100)
        assert np.array_equal(s.view.goal_rad, held) and s.bench.state is BusState.HOLDING
        assert not np.array_equal(held, moving) or np.array_equal(held, far)
        s.to(far, 150)
        assert np.array_equal(s.view.goal_rad, far) and s.score.held_by == ""
        s.assert_clean()


def test_a_stalled_front_brakes_the_robot_which_resumes_where_it_stands():
    """Frames that were made before the stall lead nowhere any more: their successors begin at the braked goal."""
    with streaming() as s:
        far = reach(s.robot, 1.0)
        s.to(far, 10)
        s.cycle(40, fed=False)
        assert s.view.at_rest and s.plan.statistics.underruns > 0
        s.to(far, 200)
        assert np.array_equal(s.view.goal_rad, far) and s.plan.statistics.gate_clipped == 0
        s.assert_clean()


def test_release_goes_to_the_last_target_and_completes():
    with streaming() as s:
        q_rad = reach(s.robot)
        s.to(q_rad, 5)
        s.score.clock.release()
        s.cycle(150)
        assert s.plan.complete and s.plan.played and np.array_equal(s.view.goal_rad, q_rad)
        assert s.bench.state is BusState.HOLDING and s.plan.statistics.underruns == 0


def test_release_at_rest_completes_as_well():
    with streaming() as s:
        s.cycle(10)
        s.score.clock.release()
        s.cycle(5)
        assert s.plan.complete and s.plan.played


@pytest.mark.parametrize("name", few_and_long(["reference"], ["toddlerbot"]))
def test_it_holds_before_the_body_and_says_so(name):
    with streaming(name) as s:
        body = BODIES[name]
        poses = np.random.default_rng(3).uniform(
            s.robot.position_min_rad, s.robot.position_max_rad, (2000, s.robot.n_joints)
        )
        inside = poses[body.clearance_m(poses).argmin()]
        s.to(inside, 300)
        assert s.score.held_by == "self-collision" and s.score.holds >= 1 and s.score.touching()
        assert s.bench.state is BusState.HOLDING
        s.to(s.robot.rest_rad, 400)
        assert s.score.held_by == "" and np.array_equal(s.view.goal_rad, s.robot.rest_rad)
        s.assert_clean()


@pytest.mark.long
@pytest.mark.parametrize("hz", few_and_long([15], [40, 100, 300]))
def test_a_smooth_stream_is_followed_smoothly_at_any_rate(hz):
    """Between messages the robot moves on: no joint stops and starts again with each of them."""
    with streaming() as s:
        joint, sent_s = 3, -1.0
        low, high = s.robot.position_min_rad[joint], s.robot.position_max_rad[joint]
        amplitude = min(0.3, (high - low) / 4)
        middle = float(np.clip(s.robot.rest_rad[joint], low + amplitude, high - amplitude))
        q_rad = s.robot.rest_rad.copy()
        q_rad[joint] = middle
        s.to(q_rad, 100)
        start_s, goals = s.now_s, []
        while s.now_s - start_s < 3.0:
            if s.now_s - sent_s >= 1 / hz - 1e-9:
                sent_s = s.now_s
                q_rad[joint] = middle + amplitude * np.sin(2 * np.pi * 0.5 * (s.now_s - start_s))
                s.score.take(q_rad, s.now_s)
            s.cycle()
            goals.append(s.view.goal_rad[joint])
        speed = np.abs(np.diff(goals[100:])) * s.robot.bus.rate_hz
        peak = amplitude * 2 * np.pi * 0.5
        assert speed.max() < 1.5 * peak
        assert (speed < 0.02 * peak).mean() < 0.1, "it stands only where the sine turns"
        s.assert_clean()
