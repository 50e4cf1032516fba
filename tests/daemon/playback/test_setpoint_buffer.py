"""Plans at the bus, in virtual time: played to their end, kept in hand, revised, stopped."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.poses.pose_sequence import posture_of
from daemon.shared_memory.bus_link import BusRequest
from tests.support.playback_bench import LEFT, PERIOD_S, RIGHT, ROBOT, assert_within_limits


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
