"""Plays one source at a time: takes over, makes the next chunk before it is due, and follows the bus process to the end.

Retargeting runs in a worker thread, one chunk at a time; a lock guards every change of the trajectory.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.host.background_tasks import BackgroundTasks
from daemon.host.clock import REAL_CLOCK, LoopClock, sleep_while
from daemon.playback.bus_follower import BusFollower
from daemon.playback.chunk_maker import ChunkMaker
from daemon.playback.motion_player import MotionPlayer, PlanStart
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.showing import ShownCheck, Verdict
from daemon.playback.sources.stream_source import StreamSource
from daemon.playback.splicer import Splicer
from daemon.playback.stream_player import StreamPlayer
from daemon.playback.trajectory import Trajectory
from daemon.playback.trajectory_statistics import SAMPLED_HZ
from daemon.poses.idle import IdleSource
from daemon.poses.layers import Layers
from daemon.poses.motion_source import HeldPose, MotionSource
from daemon.poses.pose_sequence import PoseSequence
from daemon.state.ledger import Entry, Ledger
from daemon.state.machine import RobotState
from daemon.state.replies import NotPlayableError, as_failure, ending, failed
from daemon.wire.events import Cancelled, Failed, Progress, Rejected
from daemon.wire.requests import Play
from daemon.wire.status import CurrentCommand
from retarget.errors import RetargetError

log = logging.getLogger(__name__)

FEED_AHEAD_S = 0.8
"""Seconds of frames still to push at which the next chunk is made."""
STALL_S = 0.5
"""Seconds for which the bus process holds before unplayed frames that were pushed count as dropped."""
IDLE_AFTER_S = 0.8
"""Seconds of stillness before idle movements begin."""
GAZE_S, BRAKING_TIMEOUT_S = 0.8, 2.0


class Playback:
    """Plays a command from its splice to its last event.

    Attributes:
        entry: the command that is played; None without one, and for idle movements.
    """

    def __init__(
        self, buffer: SetpointBuffer, follower: BusFollower, ledger: Ledger, layers: Layers,
        judge: ShownCheck | None = None, clock: LoopClock = REAL_CLOCK,
    ) -> None:  # fmt: skip
        self._buffer, self._follower, self._ledger, self._layers = buffer, follower, ledger, layers
        self._judge, self._clock = judge, clock
        self._splicer, self._maker = Splicer(buffer, clock), ChunkMaker(buffer.robot, layers)
        self.entry: Entry | None = None
        self._plan_id = 0
        self._player: MotionPlayer | StreamPlayer | None = None
        self._lock = asyncio.Lock()
        self._background = BackgroundTasks()
        self._feeding = self._moving_reported = self._held = self._telling = False
        self._held_since_s: float | None = None
        self._still_since_s = clock.now_s()

    async def take_over(
        self, entry: Entry | None, source: MotionSource | StreamSource, plan_id: int, epoch: int,
        alive: Callable[[], bool], told: Callable[[], Awaitable[None]] | None = None,
    ) -> bool:  # fmt: skip
        """Play a source from the joints' state on; returns false when it was ended meanwhile. `told` is awaited once it begins.

        Raises:
            RetargetError: the source's motion does not fit the robot; the motion being played goes on.
        """
        async with self._lock:
            player = self._player_of(entry, source)
            received_ns = entry.t_received_ns if entry is not None else round(self._clock.now_s() * 1e9)
            start = PlanStart(plan_id, "" if entry is None else entry.id, epoch, received_ns)
            if self._buffer.dry:
                await self._until_at_rest()
            if not alive() or not await player.begin(start, alive, self._until_at_rest):
                return False
            before, plan_id_before = self.entry, self._plan_id
            self._begin(entry, player, plan_id)
            self._telling = True
            try:
                if told is not None:
                    await told()
            finally:
                self._telling = False
                if before is not None and entry is not None:
                    self._ledger.emit(before, Cancelled(plan_id=plan_id_before, by=entry.named))
            player.begun()
            return True

    def _player_of(self, entry: Entry | None, source: MotionSource | StreamSource) -> MotionPlayer | StreamPlayer:
        def report(event: Progress) -> None:
            if entry is not None:
                self._ledger.emit(entry, event)

        if isinstance(source, StreamSource):
            return StreamPlayer(source, self._buffer, self._splicer, self._maker, report, self._clock)
        return MotionPlayer(source, self._buffer, self._splicer, self._maker, report)

    def end(self, by: str, failure: Failed | None = None) -> None:
        """End the command that is played."""
        entry, plan = self.entry, self._buffer.current
        self._forget()
        self._buffer.drop()
        if entry is not None:
            self._ledger.emit(entry, ending(plan.plan_id if plan is not None else 0, by, failure))

    @property
    def stream(self) -> StreamSource | None:
        """The stream of the lease that is played; None without one."""
        return None if self._player is None else self._player.stream

    def target(self, q_rad: NDArray[np.float64]) -> bool:
        """Take a checked target (J,) of the lease that is played, radians; returns whether the lease takes it."""
        return self._player is not None and self._player.accept(q_rad)

    @property
    def raw_now(self) -> PoseSequence:
        """One frame of the person whose pose the robot shows, without layers."""
        return self._buffer.raw_now

    def committed(self, n: int, ahead_s: float) -> PoseSequence:
        """`n` frames up to the splice of a motion that takes `ahead_s` seconds to generate."""
        return self._splicer.committed(n, ahead_s)

    def current_command(self) -> CurrentCommand | None:
        """The command that is played, for `status`; None without one."""
        entry, plan = self.entry, self._buffer.current
        if entry is None or plan is None:
            return None
        return CurrentCommand(entry.id, plan.plan_id, entry.request.words, plan.expected_frames, plan.pushed)

    def watch(self, *, finish_loop: bool, is_to_last: bool) -> None:
        """Report the first motion, make the next chunk in time, end a command that is over.

        Args:
            finish_loop: whether a motion that repeats is to end with its present repetition.
            is_to_last: whether no command is about to take over, so that it is worth replacing a preview by its motion.
        """
        player, plan, entry = self._player, self._buffer.current, self.entry
        if player is None or self._telling:
            return
        if plan is None:
            if not self._lock.locked():  # the command that was to follow a trajectory that ran dry was cancelled
                self._fail(entry, "the bus ran out of frames", 0)
            return
        self._report_moving(plan)
        player.watch()
        if finish_loop and entry is not None:
            player.finish()
        if player.revised and is_to_last and not self._feeding:
            self._feeding = True
            self.start(self._revise(player))
        if plan.complete:
            self._watch_end(plan)
            return
        due = self._buffer.ahead_s < FEED_AHEAD_S and plan.epoch == self._buffer.epoch
        if player.ready and due and not self._feeding:
            self._feeding = True
            self.start(self._feed(player))

    def _report_moving(self, plan: Trajectory) -> None:
        if self.entry is None or self._moving_reported or plan.statistics.first_motion_ms is None:
            return
        self._moving_reported = True
        first_ms, came_s = round(plan.statistics.first_motion_ms, 2), plan.first_target_s
        moving = Progress(plan_id=plan.plan_id, stage="moving", first_motion_ms=first_ms, target_t_mono=came_s)
        self._ledger.emit(self.entry, moving)

    def _watch_end(self, plan: Trajectory) -> None:
        """End the command once the bus process has played all of its frames, or dropped them."""
        entry, player, statistics, now_s = self.entry, self._player, plan.statistics, self._clock.now_s()
        holds = plan.all_pushed and self._follower.holds
        self._held_since_s = (self._held_since_s or now_s) if holds else None
        stalled = self._held_since_s is not None and now_s - self._held_since_s > STALL_S
        if plan.played or (stalled and statistics.dropped):
            self._forget()
            if player is not None:
                player.close()
            if entry is not None:
                verdict = self._judge(entry, statistics.goals_rad, SAMPLED_HZ) if self._judge else Verdict()
                self._ledger.emit(entry, statistics.done(plan.n_frames, verdict.shown, verdict.seen, verdict.missing))
        elif stalled:
            self._fail(entry, f"{statistics.last_frame + 1} of {plan.n_frames} frames were played", plan.plan_id)

    def idle(self, *, free: bool) -> None:
        """Begin idle movements after `IDLE_AFTER_S` of stillness, and end them when they are switched off."""
        wanted = self._layers.idle_style and not self._follower.stopped and not self._held
        if self._follower.idling and self._player is not None and not self._layers.idle_style:
            self._player.finish()
        still = free and self._player is None and self._follower.machine.state is RobotState.IDLE
        now_s = self._clock.now_s()
        if not (wanted and still and self._follower.can_take_over):
            self._still_since_s = now_s
        elif now_s - self._still_since_s > IDLE_AFTER_S and not self._lock.locked():
            self._still_since_s = now_s
            self.start(self._take_idle(IdleSource(self._layers.idle_style)))

    async def follow_gaze(self) -> None:
        """Continue the motion that is played, or the pose that is held, with the gaze that is now set."""
        if await self._moves_with_gaze():
            return
        machine = self._follower.machine
        await sleep_while(self._clock, lambda: machine.state is RobotState.MOVING, BRAKING_TIMEOUT_S)
        if not await self._moves_with_gaze() and self._follower.can_take_over:  # a motion may have begun meanwhile
            held = self._buffer.raw_now
            await self._take_idle(HeldPose(held.at(np.zeros(round(GAZE_S * held.fps), np.intp))))

    async def _moves_with_gaze(self) -> bool:
        """Make the rest of the motion that is played with the gaze that is now set; returns false when none is played."""
        player = self._player
        if player is None or (player.stream is None and not self._buffer.running):
            return False
        async with self._lock:
            if player is self._player:
                await player.follow_gaze()
        return True

    def start(self, work: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background."""
        self._background.start(work, "a chunk could not be made")

    def _begin(self, entry: Entry | None, player: MotionPlayer | StreamPlayer, plan_id: int) -> None:
        self.entry, self._player, self._plan_id = entry, player, plan_id
        self._moving_reported, self._held_since_s = False, None
        self._held = entry is not None and isinstance(entry.request, Play) and entry.request.hold
        self._follower.stopped &= entry is None
        self._follower.idling = entry is None

    def _forget(self) -> None:
        self.entry, self._player = None, None  # `idling` stays true until the bus process has played the rest
        self._still_since_s = self._clock.now_s()

    def _fail(self, entry: Entry | None, found: str, plan_id: int) -> None:
        self._forget()
        if entry is not None:
            failure = failed("bus_dropped", found, "all of them", "see the daemon's log")
            self._ledger.emit(entry, ending(plan_id, "", failure))

    async def _take_idle(self, source: MotionSource) -> None:
        """Play idle movements, or the held pose with a new gaze; neither ever takes the place of a command."""
        epoch, halted = self._buffer.epoch, self._follower.stopped

        def alive() -> bool:
            same = self.entry is None and epoch == self._buffer.epoch and halted == self._follower.stopped
            return same and self._follower.machine.state in (RobotState.IDLE, RobotState.HOLDING)

        try:
            await self.take_over(None, source, self._buffer.new_plan_id(), epoch, alive)
        except RetargetError as error:
            log.error("idle movements could not be made: %s", error)

    async def _revise(self, player: MotionPlayer | StreamPlayer) -> None:
        """Replace the rest of a preview by its motion."""
        try:
            async with self._lock:
                await player.revise(lambda: player is self._player)
        except RetargetError as error:  # the preview goes on
            log.error("the motion of a preview does not fit the robot: %s", error)
        finally:
            self._feeding = False

    async def _feed(self, player: MotionPlayer | StreamPlayer) -> None:
        """Make the next chunk and append it; a chunk that cannot be made ends the command."""
        try:
            async with self._lock:
                if player is self._player:
                    await player.feed(lambda: player is self._player)
        except NotPlayableError as error:
            self._give_up(player, error.event)
        except RetargetError as error:
            event = failed("retarget", str(error), "a motion that fits the robot", "say it in other words")
            self._give_up(player, event)
        except Exception as error:
            self._give_up(player, failed("internal", str(error), "", "see the daemon's log"))
            raise
        finally:
            self._feeding = False

    def _give_up(self, player: MotionPlayer | StreamPlayer, event: Rejected | Failed) -> None:
        """End the command whose next chunk failed; the frames in the bus process are played, then it brakes and holds."""
        if player is self._player:
            self.end("", as_failure(event))

    async def _until_at_rest(self) -> None:
        await sleep_while(self._clock, lambda: not self._follower.at_rest, BRAKING_TIMEOUT_S)
