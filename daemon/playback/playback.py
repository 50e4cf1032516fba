"""Plays one score at a time: takes over, makes the next stretch before it is due, watches what the bus made of it.

Retargeting runs in a worker thread, one at a time; whoever changes the plan holds the lock.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Coroutine
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.playback.bus_follower import BusFollower
from daemon.playback.segments import Segments
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.clip_source import ClipSource, MotionSource
from daemon.playback.sources.preview_source import PreviewSource
from daemon.playback.sources.showing import Verdict
from daemon.playback.sources.story_source import StorySource
from daemon.playback.sources.stream_source import StreamSource
from daemon.playback.stream_trajectory import StreamTrajectory
from daemon.playback.stream_watch import StreamWatch
from daemon.playback.trajectory import Trajectory
from daemon.playback.trajectory_statistics import SAMPLED_HZ
from daemon.poses.idle import IdleSource
from daemon.poses.layers import Layers
from daemon.poses.pose_sequence import PoseSequence, standing
from daemon.state.ledger import Entry, Ledger
from daemon.state.machine import RobotState
from daemon.state.replies import NotPlayableError, as_failure, ending, failed
from daemon.wire.events import Cancelled, Failed, Progress, Rejected
from daemon.wire.requests import Play, tag_of
from daemon.wire.status import CurrentCommand
from retarget.errors import RetargetError

log = logging.getLogger(__name__)

FEED_AHEAD_S = 0.8
"""A stretch is made when less than this of the one before is left."""
STALL_S = 0.5
"""A plan whose frames are all pushed and whose bus holds so long without playing them was dropped by the bus."""
IDLE_AFTER_S = 0.8
"""Stillness before idle movements begin."""
GAZE_S = 0.8
BRAKING_TIMEOUT_S = 2.0

ShownCheck = Callable[[Entry, NDArray[np.float64], float], Verdict]
"""Whether goals (T, J) of so many a second have shown what a command's motion shows."""


def _not_judged(_entry: Entry, _q_rad: NDArray[np.float64], _fps: float) -> Verdict:
    return Verdict()


class Playback:
    """What is played, and its end.

    Attributes:
        entry: the command that is played; None for none, and for idle movements.
    """

    def __init__(
        self,
        planner: SetpointBuffer,
        follower: BusFollower,
        ledger: Ledger,
        layers: Layers,
        judge: ShownCheck = _not_judged,
    ) -> None:
        self._planner, self._follower, self._ledger, self._layers = planner, follower, ledger, layers
        self._judge = judge
        self.entry: Entry | None = None
        self._score: MotionSource | StreamSource | None = None
        self._stream = StreamWatch(planner, ledger)
        self._lock = asyncio.Lock()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._feeding = False
        self._stretches = Segments(planner, layers)
        self._moving_told = False
        self._held = False
        self._held_since_s: float | None = None
        self._still_since_s = time.monotonic()

    async def take_over(
        self,
        entry: Entry | None,
        score: MotionSource | StreamSource,
        plan_id: int,
        epoch: int,
        alive: Callable[[], bool],
    ) -> bool:
        """Play a score from the state of the joints on; false when it was ended meanwhile.

        Raises:
            RetargetError: its motion does not fit the robot; what was played goes on.
        """
        async with self._lock:
            if isinstance(score, StreamSource):
                assert entry is not None, "a lease is a command"
                return await self._take_over_stream(entry, score, plan_id, epoch, alive)
            stretch: tuple[PoseSequence, bool] | None = None
            took_s = 0.0
            while True:
                if self._planner.dry:
                    await self._until_at_rest()  # it brakes: from rest on nothing can be missed
                if not alive():
                    return False
                stretch = stretch or await asyncio.to_thread(score.next)
                raw, last = stretch
                start, began_s = self._planner.hand_over(took_s=took_s), time.monotonic()
                pieces = self._stretches.making(raw, start, complete=last, easy=entry is None)
                piece = await asyncio.to_thread(next, pieces)
                if not alive():
                    self._planner.give_up()
                    return False
                if not self._planner.hand_over_missed:
                    break
                took_s = time.monotonic() - began_s
            before, previous = self.entry, self._planner.current
            if isinstance(previous, StreamTrajectory):
                self._stream.end(previous)
            self._begin(entry, score)
            t_received_ns = entry.t_received_ns if entry is not None else time.monotonic_ns()
            command_id = entry.id if entry is not None else ""
            self._planner.commit(piece, plan_id, command_id, epoch, t_received_ns)
            self._stretches.go_on(pieces, piece, is_last=last)
            self._tell_taken_over(before, previous, entry)
            return True

    async def _take_over_stream(
        self, entry: Entry, score: StreamSource, plan_id: int, epoch: int, alive: Callable[[], bool]
    ) -> bool:
        """Let a lease begin in the next frame. Its first target is measured from its own arrival."""
        if self._planner.dry:
            await self._until_at_rest()
        if not alive():
            return False
        start = self._planner.hand_over_at_once()
        before, previous = self.entry, self._planner.current
        gaze = self._layers.over(standing()) if self._layers.gaze_deg is not None else None
        score.look({} if gaze is None else self._planner.gaze_rad(gaze))
        self._begin(entry, score)
        score.begin(start.state, time.monotonic())
        self._planner.commit_stream(score, plan_id, entry.id, epoch, entry.t_received_ns)
        self._tell_taken_over(before, previous, entry)
        self._stream.begin(entry, plan_id)
        return True

    def _tell_taken_over(self, before: Entry | None, previous: Trajectory | None, entry: Entry | None) -> None:
        if before is not None and entry is not None:
            by = f"{tag_of(entry.request)} {entry.id}"
            self._ledger.emit(before, Cancelled(plan_id=previous.plan_id if previous else 0, by=by))

    def end(self, by: str, failure: Failed | None = None) -> None:
        """End what is played."""
        entry, plan = self.entry, self._planner.current
        self._forget()
        self._planner.drop()
        if entry is not None:
            self._ledger.emit(entry, ending(plan.plan_id if plan is not None else 0, by, failure))

    @property
    def stream(self) -> StreamSource | None:
        """The lease that is played, None when there is none."""
        return self._score if isinstance(self._score, StreamSource) else None

    def target(self, q_rad: NDArray[np.float64]) -> bool:
        """A checked target (J,) of the lease that is played; false when it takes none any more."""
        plan = self._planner.current
        return isinstance(plan, StreamTrajectory) and self._stream.take(plan, q_rad)

    def current_command(self) -> CurrentCommand | None:
        """What is being played."""
        entry, plan = self.entry, self._planner.current
        if entry is None or plan is None:
            return None
        return CurrentCommand(entry.id, plan.plan_id, entry.request.words, plan.expected_frames, plan.pushed)

    def watch(self, *, finish_loop: bool, is_to_last: bool) -> None:
        """Tell of the first motion, make the next stretch in time, end what is over.

        Args:
            finish_loop: what goes round is to end with its round.
            is_to_last: nothing is about to take over, so that a draft's motion is worth being put in its place.
        """
        plan, entry = self._planner.current, self.entry
        if self._score is None:
            return
        if plan is None:
            if not self._lock.locked():  # what was to take over from a plan that ran dry has been called off
                self._fail(entry, "the bus ran out of frames", 0)
            return
        statistics = plan.statistics
        if entry is not None and not self._moving_told and statistics.first_motion_ms is not None:
            self._moving_told = True
            first_ms = round(statistics.first_motion_ms, 2)
            came_s = plan.first_target_s if isinstance(plan, StreamTrajectory) else None
            moving = Progress(plan_id=plan.plan_id, stage="moving", first_motion_ms=first_ms, target_t_mono=came_s)
            self._ledger.emit(entry, moving)
        self._follow_score(self._score, plan.plan_id, finish_loop=finish_loop, is_to_last=is_to_last)
        if isinstance(plan, StreamTrajectory) and entry is not None:
            self._stream.look(plan, entry)
        if not plan.complete:
            ready = self._stretches.unfinished or self._score.ready
            due = self._planner.ahead_s < FEED_AHEAD_S and plan.epoch == self._planner.epoch
            if ready and due and not self._feeding:
                self._feeding = True
                self.start(self._feed())
            return
        idle = plan.all_pushed and self._follower.holds
        self._held_since_s = (self._held_since_s or time.monotonic()) if idle else None
        stalled = self._held_since_s is not None and time.monotonic() - self._held_since_s > STALL_S
        if plan.played or (stalled and statistics.dropped):
            self._forget()
            if isinstance(plan, StreamTrajectory):
                self._stream.end(plan)
            if entry is not None:
                verdict = self._judge(entry, statistics.goals_rad, SAMPLED_HZ)
                self._ledger.emit(entry, statistics.done(plan.n_frames, verdict.shown, verdict.seen, verdict.missing))
        elif stalled:
            self._fail(entry, f"{statistics.last_frame + 1} of {plan.n_frames} frames were played", plan.plan_id)

    def idle(self, *, free: bool) -> None:
        """Begin idle movements after a while of stillness, end them when they are switched off."""
        wanted = self._layers.idle_style and not self._follower.stopped and not self._held
        if self._follower.idling and self._score is not None and not self._layers.idle_style:
            if isinstance(self._score, IdleSource):
                self._score.finish()
        still = free and self._score is None and self._follower.machine.state is RobotState.IDLE
        if not (wanted and still and self._follower.can_take_over):
            self._still_since_s = time.monotonic()
        elif time.monotonic() - self._still_since_s > IDLE_AFTER_S and not self._lock.locked():
            self._still_since_s = time.monotonic()
            self.start(self._take_idle(IdleSource(self._layers.idle_style)))

    async def follow_gaze(self) -> None:
        """Let what is played, or the pose that is held, go on with the gaze that is now set."""
        if isinstance(self._score, StreamSource):
            async with self._lock:
                gaze = self._layers.over(standing()) if self._layers.gaze_deg is not None else None
                self._score.look({} if gaze is None else self._planner.gaze_rad(gaze))
            return
        if self._planner.running and self._score is not None:
            async with self._lock:
                await self._stretches.make_again()
            return
        end_s = time.monotonic() + BRAKING_TIMEOUT_S
        while self._follower.machine.state is RobotState.MOVING and time.monotonic() < end_s:
            await asyncio.sleep(0.005)  # the last frames of a motion, or a stop
        if self._follower.machine.state in (RobotState.IDLE, RobotState.HOLDING) and self._follower.can_take_over:
            await self._take_idle(None)

    def start(self, work: Coroutine[Any, Any, None]) -> None:
        """Run work that nobody waits for; its failure is logged."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._finished)

    def _finished(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            log.error("a stretch could not be made", exc_info=error)

    def _begin(self, entry: Entry | None, score: MotionSource | StreamSource) -> None:
        self.entry, self._score = entry, score
        self._stretches.forget()
        self._moving_told, self._held_since_s = False, None
        self._held = entry is not None and isinstance(entry.request, Play) and entry.request.hold
        if entry is not None:
            self._follower.stopped = False
        self._follower.idling = entry is None

    def _forget(self) -> None:
        self.entry, self._score = None, None  # what was idling stays so until the bus process has played it out
        self._stretches.forget()
        self._still_since_s = time.monotonic()

    def _fail(self, entry: Entry | None, found: str, plan_id: int) -> None:
        self._forget()
        if entry is not None:
            failure = failed("bus_dropped", found, "all of them", "see the daemon's log")
            self._ledger.emit(entry, ending(plan_id, "", failure))

    async def _take_idle(self, score: MotionSource | None) -> None:
        """Play idle movements, or without a score just the pose that is held, with the gaze."""
        epoch, entry, halted = self._planner.epoch, self.entry, self._follower.stopped
        if score is None:
            held = self._planner.raw_now
            score = _Pose(held.at(np.zeros(round(GAZE_S * held.fps), np.intp)))

        def alive() -> bool:
            same = self.entry is entry and epoch == self._planner.epoch and halted == self._follower.stopped
            return same and self._follower.machine.state in (RobotState.IDLE, RobotState.HOLDING)

        try:
            await self.take_over(None, score, self._planner.new_plan_id(), epoch, alive)
        except RetargetError as error:
            self._planner.give_up()
            log.error("idle movements could not be made: %s", error)

    def _follow_score(
        self, score: MotionSource | StreamSource, plan_id: int, *, finish_loop: bool, is_to_last: bool
    ) -> None:
        """What is to be done of a score beside playing it."""
        if isinstance(score, StorySource):
            self._tell_scenes(score, plan_id)
        if finish_loop and isinstance(score, (ClipSource, StorySource)):
            score.finish()
        if isinstance(score, PreviewSource) and score.may_go_over and is_to_last and not self._feeding:
            self._feeding = True
            self.start(self._go_over(score))

    async def _go_over(self, score: PreviewSource) -> None:
        """Let the motion take the place of its draft, from where the draft is being played."""
        took_s = 0.0
        try:
            async with self._lock:
                while self._score is score and score.tries_left and self._planner.running:
                    score.tries_left -= 1
                    began_s = time.monotonic()
                    if await self._stretches.make_again(score, took_s=took_s):
                        score.tries_left = 0
                    took_s = time.monotonic() - began_s
        except RetargetError as error:  # the draft goes on
            score.tries_left = 0
            self._planner.give_up()
            log.error("the motion of a draft does not fit the robot: %s", error)
        finally:
            self._feeding = False

    async def _feed(self) -> None:
        """Make the next stretch and append it; one that cannot be made ends the command."""
        score = self._score
        try:
            await self._append(score)
        except NotPlayableError as error:
            self._give_up(score, error.event)
        except RetargetError as error:
            self._give_up(
                score, failed("retarget", str(error), "a motion that fits the robot", "say it in other words")
            )
        except Exception as error:
            self._give_up(score, failed("internal", str(error), "", "see the daemon's log"))
            raise
        finally:
            self._feeding = False

    async def _append(self, score: MotionSource | StreamSource | None) -> None:
        async with self._lock:
            if score is not None and score is self._score and not isinstance(score, StreamSource):
                await self._stretches.append(score, lambda: score is self._score)

    def _give_up(self, score: MotionSource | StreamSource | None, event: Rejected | Failed) -> None:
        """End the command whose next stretch failed; what is in the bus process is played, then it brakes and holds."""
        entry, plan = self.entry, self._planner.current
        if score is None or score is not self._score:
            return
        self._forget()
        self._planner.drop()
        if entry is not None:
            self._ledger.emit(entry, ending(plan.plan_id if plan is not None else 0, "", as_failure(event)))

    def _tell_scenes(self, score: StorySource, plan_id: int) -> None:
        while self.entry is not None and score.news:
            n = score.news.popleft()
            self._ledger.emit(self.entry, Progress(
                plan_id=plan_id, stage="scene", scene=n.number, text=n.text, status=n.status, reason=n.reason,
                understood=n.understood, scope_score=round(n.scope_score, 4),
            ))  # fmt: skip

    async def _until_at_rest(self) -> None:
        end_s = time.monotonic() + BRAKING_TIMEOUT_S
        while not self._follower.at_rest and time.monotonic() < end_s:
            await asyncio.sleep(0.005)


class _Pose:
    """A pose that is held."""

    ready = True

    def __init__(self, stretch: PoseSequence) -> None:
        self._stretch = stretch

    def next(self) -> tuple[PoseSequence, bool]:
        """All of it."""
        return self._stretch, True
