"""A motion takes over from another, in virtual time: at any instant every limit is kept and nothing jumps."""

from __future__ import annotations

import contextlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from daemon.playback.latency_estimate import LatencyEstimate
from daemon.poses.pose_sequence import at_tempo, distance_deg, posture_of, standing
from retarget.errors import RetargetError
from retarget.path.limits import JointLimits
from tests.support.playback_bench import LEFT, LEFT_POSTURE, PERIOD_S, RIGHT, ROBOT, Bench, assert_within_limits
from tests.support.sizes import examples, few_and_long


@pytest.mark.long
@settings(max_examples=examples(12), deadline=None, suppress_health_check=list(HealthCheck))
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


@pytest.mark.parametrize("fps", few_and_long([24.0], [20.0]))
@pytest.mark.parametrize("ahead_s", few_and_long([0.3], [0.05]))
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


@pytest.mark.parametrize(("late", "most_jump_rad"), few_and_long([(7, 0.5)], [(0, 0.01), (1, 0.01), (2, 0.02)]))
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


@pytest.mark.parametrize("error", [RetargetError("no way"), pytest.param(None, marks=pytest.mark.long)])
def test_a_splice_that_is_left_lets_the_running_trajectory_end(bench, error):
    bench.arm()
    plan = bench.play(RIGHT)
    bench.cycle(20)
    with contextlib.suppress(RetargetError), bench.splicer.splice():
        if error is not None:
            raise error
    bench.finish()
    assert plan.played
