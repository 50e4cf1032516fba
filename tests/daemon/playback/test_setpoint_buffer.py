"""Plans at the bus, in virtual time: taking over at any instant keeps every limit and never jumps."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from daemon.control.control_loop import ControlLoop
from daemon.dynamixel.servo_bus import ServoBus
from daemon.playback.chunk_maker import ChunkMaker
from daemon.playback.latency_estimate import LatencyEstimate
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.splicer import Splice, Splicer
from daemon.playback.trajectory import Chunk, PathTrajectory
from daemon.poses.layers import Layers
from daemon.poses.pose_sequence import at_tempo, distance_deg, posture_of, standing
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from daemon.state.bus_view import BusView
from retarget.errors import RetargetError
from retarget.path.limits import JointLimits
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.port import SimPort
from tests.support.kinematic import raised_arm
from tests.support.robots import packaged
from tests.support.sizes import examples, few_and_long

ROBOT = packaged("reference")
RIGHT = raised_arm("right", 1.0, 1.0, "right")
LEFT = raised_arm("left", 0.8, 0.9, "left")
LEFT_POSTURE = posture_of(LEFT)
PERIOD_S = ROBOT.bus.period_s


class Bench:
    """Front half and bus half of the daemon on one virtual clock."""

    def __init__(self, queue_s: float = 0.1) -> None:
        self.clock = VirtualClock()
        self.sim = SimBus(ROBOT)
        port = SimPort(self.sim, self.clock)
        self.link = BusLink.create(ROBOT.n_joints)
        self.streamer = ControlLoop(
            ROBOT, ServoBus.on_port(port, ROBOT.servos, self.clock), self.link, self.clock, watch_front=False
        )
        self.view = BusView(self.link, ROBOT, self.clock)
        self.buffer = SetpointBuffer(ROBOT, self.link, self.view, queue_s, clock=self.clock)
        self.splicer, self.maker = Splicer(self.buffer, self.clock), ChunkMaker(ROBOT, Layers("off"))
        self.records: list[np.ndarray] = []

    def cycle(self, n: int = 1, pump: bool = True) -> None:
        for _ in range(n):
            due_s = self.clock.now_s() + PERIOD_S
            self.streamer.cycle()
            self.clock.sleep_until(due_s)
            before = self.view.index
            self.buffer.read_cycles()
            self.records += list(self.link.cycles.since(before)[0])
            if pump:
                self.buffer.pump()

    def arm(self) -> None:
        self.link.request(BusRequest.ARM)
        for _ in range(2000):
            self.cycle()
            if self.view.state is BusState.HOLDING:
                return
        raise AssertionError(f"not armed: {self.view.state}, {self.link.text}")

    def play(self, motion, plan_name: str = "c", retarget_cycles: int = 2) -> PathTrajectory:
        """Take over as a `MotionPlayer` does; retargeting takes some bus cycles meanwhile."""
        posture, late_s = posture_of(motion), 0.0
        while True:
            with self.splicer.splice(late_s=late_s) as splice:
                chunks = list(self.chunks(posture, splice))
                self.cycle(retarget_cycles)
                if not self.splicer.missed(splice):
                    return self.place(splice, chunks, plan_name)
            late_s += PERIOD_S * (retarget_cycles + 1)

    def chunks(self, posture, splice: Splice) -> Iterator[Chunk]:
        return self.maker.chunks(posture, splice.state, None, complete=True)

    def place(self, splice: Splice, chunks: list[Chunk], plan_name: str = "c") -> PathTrajectory:
        statistics = self.buffer.statistics(plan_id := self.buffer.new_plan_id(), 0)
        plan = PathTrajectory(plan_id, plan_name, self.buffer.epoch, ROBOT.bus.rate_hz, statistics)
        plan.append(chunks[0])
        self.splicer.follow_with(splice, plan)
        for chunk in chunks[1:]:
            plan.append(chunk)
        return plan

    def finish(self) -> None:
        for _ in range(1500):
            self.cycle()
            if self.view.state is BusState.HOLDING:
                return
        raise AssertionError(f"still {self.view.state}")

    def goals(self) -> np.ndarray:
        return np.array([r["goal_rad"] for r in self.records])

    def close(self) -> None:
        self.link.close()


@pytest.fixture
def bench():
    made = Bench()
    yield made
    made.close()


def assert_within_limits(bench: Bench) -> None:
    limits = JointLimits.of(ROBOT)
    goals = bench.goals()[-1500:]
    speed = np.abs(np.diff(goals, axis=0)) / PERIOD_S
    acceleration = np.abs(np.diff(goals, n=2, axis=0)) / PERIOD_S**2
    assert (speed <= limits.velocity_rad_s * (1 + 1e-6)).all()
    assert (acceleration <= limits.acceleration_rad_s2 * (1 + 1e-6)).all()
    report = bench.sim.audit.report()
    assert report["violations"] == 0, report


def test_a_motion_is_played_to_its_end_unchanged_by_the_gate(bench):
    bench.arm()
    plan = bench.play(RIGHT)
    bench.finish()
    assert plan.played and plan.all_pushed
    done = plan.statistics.done(plan.n_frames)
    assert done.frames == plan.n_frames
    assert done.gate_clipped_frames == 0 and done.underruns == 0 and done.log_dropped == 0
    assert done.duration_s == pytest.approx(plan.n_frames * PERIOD_S, abs=2 * PERIOD_S)
    assert 0 < done.peak_speed_share <= 1.0 + 1e-9
    assert done.first_motion_ms is not None
    assert_within_limits(bench)


def test_about_the_asked_time_of_setpoints_is_in_hand(bench):
    bench.arm()
    bench.play(RIGHT)
    bench.cycle(20)
    assert 8 <= bench.link.setpoints.queued_frames <= 10


def test_the_length_of_a_plan_is_told_from_its_first_piece_on(bench):
    bench.arm()
    long = posture_of(RIGHT).at(np.arange(100))
    with bench.splicer.splice() as splice:
        chunks = list(bench.chunks(long, splice))
        assert len(chunks) > 2
        plan = bench.place(splice, chunks[:1])
    assert plan.expected_frames == 5 * ROBOT.bus.rate_hz
    for chunk in chunks[1:]:
        plan.append(chunk)
    assert plan.complete and 0 <= plan.expected_frames - 5 * ROBOT.bus.rate_hz <= 0.8 * ROBOT.bus.rate_hz


def test_what_is_in_hand_is_taken_back_when_another_motion_takes_over(bench):
    """A piece that is made in no time is played after some frames, however much of the plan before was pushed."""
    bench.arm()
    bench.play(RIGHT)
    bench.cycle(40)
    for _ in range(20):  # first chunks have been quick
        bench.splicer.latencies["command"].took(0.03)
    bench.buffer._queue_frames = 40
    bench.cycle(10)
    assert bench.link.setpoints.queued_frames >= 35
    lead = bench.splicer.latencies["command"].seconds * ROBOT.bus.rate_hz
    plan = bench.play(LEFT, retarget_cycles=0)
    first = len(bench.records)
    bench.cycle(60)
    of_new = [i for i, r in enumerate(bench.records[first:]) if r["plan_id"] == plan.plan_id]
    assert of_new[0] <= lead + 1 < 30
    bench.finish()
    assert_within_limits(bench)
    assert not np.concatenate([r["clipped"] for r in bench.records]).any()


def test_slow_revisions_delay_no_command(bench):
    bench.arm()
    bench.play(RIGHT)
    bench.cycle(20)
    for _ in range(20):
        bench.splicer.latencies["command"].took(0.01)
        bench.splicer.latencies["revision"].took(0.2)
    with bench.splicer.splice("revision") as revision:
        pass
    with bench.splicer.splice() as command:
        pass
    assert revision.frame is not None and command.frame is not None
    assert revision.frame - command.frame >= 0.15 * ROBOT.bus.rate_hz


@settings(max_examples=examples(15), deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(st.tuples(st.integers(1, 90), st.integers(0, 3)), min_size=1, max_size=4))
def test_a_takeover_at_any_instant_keeps_limits_without_the_gate(instants):
    bench = Bench()
    try:
        bench.arm()
        bench.play(RIGHT)
        for k, (wait, retarget_cycles) in enumerate(instants):
            bench.cycle(wait)
            bench.play((LEFT, RIGHT)[k % 2], retarget_cycles=retarget_cycles)
        bench.finish()
        played = [r for r in bench.records if r["plan_id"] > 0]
        assert not any(r["underrun"] for r in played)
        assert not any(r["clipped"].any() for r in played)
        assert_within_limits(bench)
    finally:
        bench.close()


@pytest.mark.parametrize("fps", [20.0, 24.0])
@pytest.mark.parametrize("ahead_s", [0.05, 0.3])
def test_what_is_committed_is_what_will_have_been_played(bench, ahead_s, fps):
    """The generator is shown the frames up to the take-over, some of them before their time, at its own rate."""
    bench.arm()
    plan = bench.play(replace(RIGHT, fps=fps))
    whole = at_tempo(posture_of(RIGHT), fps / 20.0)
    bench.cycle(30)
    bench.splicer.latencies["command"] = LatencyEstimate(0.03)  # measured, else
    shown = bench.splicer.committed(8, ahead_s)
    assert shown.fps == whole.fps == 20.0
    end_s = (plan.statistics.last_frame + 1) * PERIOD_S + ahead_s + bench.splicer.latencies["command"].seconds
    at = round(end_s * whole.fps)
    off_deg = [distance_deg(shown, whole.at(np.arange(at + d - 7, at + d + 1))).max() for d in (-1, 0, 1)]
    assert min(off_deg) < (1e-4 if fps == 20.0 else 10) < max(off_deg)


def test_what_is_committed_at_rest_is_how_the_robot_is_held(bench):
    bench.arm()
    assert float(distance_deg(bench.splicer.committed(32, 0.1), standing()).max()) < 1e-4
    bench.play(RIGHT)
    bench.finish()
    held = bench.splicer.committed(32, 0.1)
    assert len(held) == 32 and float(distance_deg(held, posture_of(RIGHT)[-1:]).max()) < 1e-4


def test_velocity_goes_over_without_a_step(bench):
    """The first frame of the new plan moves as fast as the last of the old one, but for what one period may change."""
    bench.arm()
    bench.play(RIGHT)
    bench.cycle(25)
    plan = bench.play(LEFT)
    bench.cycle(60)
    first = next(i for i, r in enumerate(bench.records) if r["plan_id"] == plan.plan_id)
    before, after = bench.records[first - 1]["velocity_rad_s"], bench.records[first]["velocity_rad_s"]
    assert np.abs(before).max() > 0.3  # it does move
    assert (np.abs(after - before) <= JointLimits.of(ROBOT).acceleration_rad_s2 * PERIOD_S * (1 + 1e-6)).all()


def test_after_a_stop_nothing_of_the_old_plan_is_played(bench):
    bench.arm()
    plan = bench.play(RIGHT)
    bench.cycle(30)
    bench.link.request(BusRequest.STOP)
    bench.cycle(1)
    bench.finish()
    held = bench.goals()[-1]
    bench.cycle(50)  # the pump goes on; nothing of the stopped plan comes
    assert np.array_equal(bench.goals()[-1], held)
    assert not plan.played and not bench.buffer.running
    bench.play(LEFT)  # starts from where it was stopped
    bench.finish()
    assert_within_limits(bench)


def test_a_late_front_brakes_and_the_next_motion_starts_from_there(bench):
    bench.arm()
    bench.play(RIGHT)
    bench.cycle(20)
    with bench.splicer.splice() as splice:
        next(bench.chunks(LEFT_POSTURE, splice))
        bench.cycle(60, pump=True)  # retargeting takes far longer than foreseen
        assert bench.splicer.missed(splice)
    for _ in range(300):
        bench.cycle()
        if not bench.records[-1]["velocity_rad_s"].any():
            break
    with bench.splicer.splice() as splice:
        start = splice.state
        assert np.array_equal(start.position_rad, bench.view.goal_rad) and not start.velocity_rad_s.any()
        bench.place(splice, list(bench.chunks(LEFT_POSTURE, splice)))
    bench.finish()
    assert_within_limits(bench)


@pytest.mark.parametrize(("late", "most_jump_rad"), few_and_long([(1, 0.01), (7, 0.5)], [(0, 0.01), (2, 0.02)]))
def test_a_front_held_up_before_a_takeover_leaves_out_played_frames(bench, late, most_jump_rad):
    """The bus process has come some frames beyond the hand-over: what it has played of the old ones is left out of the new."""
    bench.arm()
    old = bench.play(RIGHT)
    bench.cycle(25)
    with bench.splicer.splice() as splice:
        chunks = list(bench.chunks(LEFT_POSTURE, splice))
        assert splice.frame is not None
        while bench.records[-1]["frame"] < splice.frame:
            bench.cycle()
        assert not bench.splicer.missed(splice), "the frame after the splice is still to be played"
        bench.cycle(late, pump=False)  # between the look and the splice
        assert bench.splicer.missed(splice) == (late > 0)
        plan = bench.place(splice, chunks)
    first = len(bench.records)
    bench.cycle(30)
    played = [(int(r["plan_id"]), int(r["frame"])) for r in bench.records[first - late : first + 20]]
    assert played[:late] == [(old.plan_id, splice.frame + 1 + k) for k in range(late)]
    assert played[late:] == [(plan.plan_id, late + k) for k in range(20)], "frame by frame, none of the old ones again"
    jumps = np.abs(np.diff(np.array([r["setpoint_rad"] for r in bench.records[first - 3 : first + 10]]), n=2, axis=0))
    assert jumps.max() < most_jump_rad, "both begin alike; what they differ by later, the gate smooths"
    bench.finish()
    assert_within_limits(bench)


@pytest.mark.parametrize("error", [None, RetargetError("no way")])
def test_a_splice_that_is_left_lets_the_running_trajectory_end(bench, error):
    bench.arm()
    plan = bench.play(RIGHT)
    bench.cycle(20)
    with contextlib.suppress(RetargetError), bench.splicer.splice():
        if error is not None:
            raise error
    bench.finish()
    assert plan.played
