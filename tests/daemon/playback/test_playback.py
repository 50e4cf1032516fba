"""Playback in virtual time: taking over, late chunks, loops, gaze, idling and leases end in the right events and keep limits."""

from __future__ import annotations

import asyncio
from functools import partial

import numpy as np
import pytest

from daemon.playback.playback import IDLE_AFTER_S
from daemon.playback.sources.clip_source import ClipSource
from daemon.playback.sources.prepared_source import PreparedSource
from daemon.playback.sources.showing import Shows
from daemon.playback.sources.stream_source import StreamSource
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, posture_of
from daemon.shared_memory.bus_link import BusRequest
from daemon.state.lease import LeaseClock
from daemon.wire.events import Accepted
from daemon.wire.requests import Gesture, Lease
from retarget.errors import MotionError
from retarget.path.safety_filter import SafetyFilter
from tests.support.front_rig import FrontRig, front_rig
from tests.support.kinematic import raised_arm
from tests.support.sizes import few_and_long

ACCEPTED = partial(
    Accepted, plan_id=1, text="", status="accepted", understood="", reason="", scope_score=1.0, duration_s=1.0, generate_ms=1.0
)  # fmt: skip
RIGHT = posture_of(raised_arm("right", 1.0, 1.0, "right"))
LEFT = posture_of(raised_arm("left", 2.5, 0.9, "left"))


async def play(front: FrontRig, command_id: str, source: MotionSource | StreamSource, alive=lambda: True) -> bool:
    request = Lease(secret="s" * 32, holder="test", id=command_id) if isinstance(source, StreamSource) else None
    entry, plan_id = front.entry(command_id, request), front.buffer.new_plan_id()
    return await front.playback.take_over(entry, source, plan_id, front.buffer.epoch, alive)


def clip(poses: PoseSequence, **options) -> ClipSource:
    return ClipSource(poses, Gesture(name="clip", **options))


class Revised(MotionSource):
    """A preview whose motion comes when the test says so."""

    def __init__(self, preview: PoseSequence, whole: PoseSequence) -> None:
        self.preview, self.whole, self.has_come, self.settled = preview, whole, False, False

    @property
    def ready(self) -> bool:
        return self.has_come

    @property
    def revised(self) -> bool:
        return self.has_come and not self.settled

    def next(self) -> tuple[PoseSequence, bool]:
        return (self.whole[len(self.preview) :], True) if self.has_come else (self.preview, False)

    def rest(self, n_left: int) -> PoseSequence:
        return self.whole[len(self.preview) - n_left :]

    def settle(self) -> None:
        self.settled = True


class NotHuman(MotionSource):
    """A second segment that fits no robot."""

    def __init__(self) -> None:
        self._first = True

    def next(self) -> tuple[PoseSequence, bool]:
        first, self._first = self._first, False
        return (RIGHT, False) if first else (RIGHT[:0], True)


def test_a_motion_is_under_way_when_it_is_told_of_and_reported_after():
    with front_rig() as front:
        moving: list[bool] = []

        async def told() -> None:
            await front.tick(20)
            moving.append(front.moves and front.buffer.running)
            front.ledger.emit(front.playback.entry, ACCEPTED())

        async def work() -> None:
            await play(front, "a", clip(RIGHT))
            await front.tick(5)
            entry = front.entry("b")
            number = front.buffer.new_plan_id()
            await front.playback.take_over(entry, clip(LEFT), number, front.buffer.epoch, lambda: True, told)
            await front.until(lambda: front.playback.entry is None)

        front.run(work)
        assert moving == [True]
        assert front.kinds == ["progress a", "accepted b", "cancelled a", "progress b", "done b"]


def test_a_motion_that_cannot_be_read_is_accepted_without_a_word_of_it(caplog):
    def unreadable() -> Shows:
        raise ValueError("no sign fits")

    with front_rig() as front:
        entry = front.entry("wave")
        event = asyncio.run(PreparedSource(clip(RIGHT), 2.0, shows=unreadable).accepted(entry, 3))
    assert (event.text, event.plan_id, event.understood, event.lacks) == ("wave", 3, "", "")
    assert "could not be read" in caplog.text


def test_a_motion_is_played_to_its_end_and_reported():
    with front_rig() as front:

        async def work() -> None:
            assert await play(front, "a", clip(RIGHT))
            await front.until(lambda: front.playback.entry is None)
            assert front.kinds == ["progress a", "done a"]

        front.run(work)
        front.bus.assert_limits_kept()


@pytest.mark.parametrize("late_cycles", few_and_long([3], [0, 3, 25]))
def test_a_command_takes_over_however_long_its_chunk_takes(late_cycles):
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", clip(LEFT))
            await front.tick(20)
            front.late_cycles = late_cycles
            assert await play(front, "b", clip(RIGHT))
            assert "cancelled a" in front.kinds
            await front.until(lambda: "done b" in front.kinds)

        front.run(work)
        front.bus.assert_limits_kept()
        assert not any(r["underrun"] for r in front.bus.records) or late_cycles == 25


def test_a_command_that_is_called_off_leaves_the_running_one_alone():
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", clip(LEFT))
            await front.tick(20)
            wanted = iter([True, True])
            assert not await play(front, "b", clip(RIGHT), lambda: next(wanted, False))
            await front.until(lambda: front.playback.entry is None)
            assert front.kinds == ["progress a", "done a"]

        front.run(work)


@pytest.mark.parametrize("stream", few_and_long([True], [False, True]))
def test_a_motion_that_fits_no_robot_leaves_the_running_one_alone(stream):
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", lease(front) if stream else clip(LEFT))
            await front.tick(20)
            with pytest.raises(MotionError):
                await play(front, "b", clip(RIGHT[:0]))
            if stream:
                assert front.playback.target(front.bus.robot.rest_rad)
                front.playback.stream.clock.release()
            await front.until(lambda: "done a" in front.kinds)

        front.run(work)


def test_a_segment_that_cannot_be_played_ends_its_command_and_holds():
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", NotHuman())
            await front.until(lambda: front.playback.entry is None)
            assert front.kinds[-1] == "failed a"
            await front.until(lambda: front.follower.at_rest)

        front.run(work)
        front.bus.assert_limits_kept()


def test_a_motion_takes_the_place_of_its_preview():
    with front_rig() as front:

        async def work() -> None:
            source = Revised(LEFT[:30], LEFT)
            await play(front, "a", source)
            await front.tick(20)
            assert front.buffer.current.expected_frames == pytest.approx(30 / 20 * front.buffer.rate_hz)
            source.has_come = True
            await front.until(lambda: source.settled)
            assert front.buffer.current.expected_frames == pytest.approx(len(LEFT) / 20 * front.buffer.rate_hz, abs=5)
            await front.until(lambda: "done a" in front.kinds)

        front.run(work)
        front.bus.assert_limits_kept()


@pytest.mark.long
def test_a_gaze_turns_the_head_of_the_motion_and_of_the_held_pose():
    with front_rig() as front:
        yaw = front.bus.robot.joint_with_role("head_yaw")

        async def work() -> None:
            await play(front, "a", clip(LEFT))
            await front.tick(20)
            for turn in (0.3, -0.3):
                front.layers.gaze_deg = (np.rad2deg(turn), 0.0)
                front.playback.start(front.playback.follow_gaze())
                await front.tick(150)
                assert front.bus.records[-1]["goal_rad"][yaw] == pytest.approx(turn, abs=0.01)
                await front.until(lambda: front.playback.entry is None and not front.moves)

        front.run(work)
        front.bus.assert_limits_kept()


def test_a_gaze_set_as_a_motion_ends_takes_no_command_away():
    """The gaze waited for the robot to stop. Then it replaced the next motion, which had just begun, and no event ended it."""
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", clip(RIGHT))
            await front.until(lambda: front.playback.entry is None)
            assert front.moves, "the bus process has not reported yet that it holds"
            front.layers.gaze_deg = (10.0, 0.0)
            front.playback.start(front.playback.follow_gaze())
            await asyncio.sleep(0)
            for _ in range(5):
                front.bus.cycle()
            front.late_cycles = 0
            assert await play(front, "b", clip(LEFT))
            front.follower.update()
            assert not front.moves, "it is seen to hold, and no frame of the new motion yet"
            front.bus.cycle()
            for _ in range(5):
                await asyncio.sleep(0)
            await front.until(lambda: "done b" in front.kinds)

        front.run(work)
        front.bus.assert_limits_kept()


def test_idle_movements_begin_after_a_while_and_give_way():
    with front_rig(idle="calm") as front:

        async def work() -> None:
            began_s = front.bus.clock.now_s()
            await front.until(lambda: front.buffer.running and front.follower.idling)
            assert front.bus.clock.now_s() - began_s == pytest.approx(IDLE_AFTER_S, abs=0.1)
            assert await play(front, "a", clip(RIGHT))
            await front.until(lambda: "done a" in front.kinds)

        front.run(work)
        front.bus.assert_limits_kept()


def test_a_stop_while_a_chunk_is_made_ends_both():
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", clip(LEFT))
            await front.tick(20)
            epoch, entry = front.buffer.epoch, front.entry("b")
            front.bus.link.request(BusRequest.STOP)
            alive = lambda: front.buffer.epoch == epoch
            assert not await front.playback.take_over(entry, clip(RIGHT), front.buffer.new_plan_id(), epoch, alive)
            front.playback.end("stop")
            await front.until(lambda: not front.moves)
            assert "cancelled a" in front.kinds

        front.run(work)
        front.bus.assert_limits_kept()


def lease(front: FrontRig) -> StreamSource:
    return StreamSource(front.bus.robot, SafetyFilter(front.bus.robot), LeaseClock(0.2, 5.0), "test")


def test_a_lease_takes_over_a_motion_and_a_motion_takes_over_a_lease():
    with front_rig() as front:

        async def work() -> None:
            await play(front, "a", clip(LEFT))
            await front.tick(20)
            assert await play(front, "b", lease(front))
            assert front.kinds[-2:] == ["cancelled a", "progress b"]
            q_rad = front.bus.robot.rest_rad.copy()
            for _ in range(30):
                assert front.playback.target(q_rad)
                await front.tick()
            assert await play(front, "c", clip(RIGHT))
            assert "cancelled b" in front.kinds and not front.playback.target(q_rad)
            await front.until(lambda: "done c" in front.kinds)

        front.run(work)
        front.bus.assert_limits_kept()
