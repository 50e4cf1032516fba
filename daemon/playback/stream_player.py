"""Plays a lease: makes its frames in time, reports to its holder what holds the robot, and adds its figures to the last event."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np
from numpy.typing import NDArray

from daemon.host.clock import LoopClock
from daemon.playback.chunk_maker import ChunkMaker
from daemon.playback.motion_player import PlanStart
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.stream_source import SELF_COLLISION, StreamSource
from daemon.playback.splicer import Splicer
from daemon.playback.stream_trajectory import StreamTrajectory
from daemon.wire.events import Progress

REPORTED_EVERY_S = 0.5
"""Seconds at least between two reports of what holds the robot; `status` is always current."""


class StreamPlayer:
    """Plays one lease from its splice to its end. For the event loop.

    Args:
        stream: source of the lease's frames.
        buffer, splicer, maker: as for `MotionPlayer`.
        report: sends an event to the holder.
        clock: clock of the lease.
    """

    ready = revised = False

    def __init__(
        self, stream: StreamSource, buffer: SetpointBuffer, splicer: Splicer, maker: ChunkMaker,
        report: Callable[[Progress], None], clock: LoopClock,
    ) -> None:  # fmt: skip
        self.stream = stream
        self._buffer, self._splicer, self._maker, self._report, self._clock = buffer, splicer, maker, report, clock
        self._plan: StreamTrajectory | None = None
        self._reported = ""
        self._reported_s = float("-inf")

    async def begin(
        self, start: PlanStart, _wanted: Callable[[], bool], _wait_for_rest: Callable[[], Awaitable[None]]
    ) -> bool:
        """Begin the lease in the next frame, without waiting; returns true."""
        self.stream.look(self._maker.gaze_rad())
        with self._splicer.splice_at_once() as splice:
            self.stream.begin(splice.state, self._clock.now_s())
            self._plan = StreamTrajectory(
                start.plan_id, start.command_id, start.epoch, self._buffer.rate_hz,
                self._buffer.statistics(start.plan_id, start.t_received_ns), self.stream, self._maker.person,
            )  # fmt: skip
            self._splicer.follow_with(splice, self._plan)
        return True

    def accept(self, q_rad: NDArray[np.float64]) -> bool:
        """Take a checked target (J,), whose movement begins at once; returns whether the lease takes it."""
        plan = self._plan
        if plan is None or plan is not self._buffer.current or not self.stream.take(q_rad, self._clock.now_s()):
            return False
        if self.stream.targets == 1:
            plan.first_target_s = self._clock.now_s()
            plan.statistics.count_from(round(plan.first_target_s * 1e9))
        self._buffer.stream_on()
        return True

    def watch(self) -> None:
        """Make the due frames and report what holds the robot. Call once a tick."""
        now_s, stream, plan = self._clock.now_s(), self.stream, self._plan
        if plan is None:
            return
        stream.clock.look(now_s)
        self._buffer.stream_on()
        held_by = stream.held_by
        if held_by == self._reported or now_s - self._reported_s < REPORTED_EVERY_S:
            return
        self._reported, self._reported_s = held_by, now_s
        if held_by == SELF_COLLISION:
            where = stream.touching() or "the robot itself, on the way to the target"
            self._report(Progress(plan_id=plan.plan_id, stage="held", reason=f"self-collision: {where}"))
        elif held_by:
            reason = f"no target for {stream.clock.silence_s:g} s: braking, then holding"
            self._report(Progress(plan_id=plan.plan_id, stage="silent", reason=reason))
        else:
            self._report(Progress(plan_id=plan.plan_id, stage="streaming"))

    def begun(self) -> None:
        """Report that targets move the robot from now on."""
        if self._plan is not None:
            self._report(Progress(plan_id=self._plan.plan_id, stage="leased"))
        self._buffer.stream_on()

    def finish(self) -> None:
        """Do nothing: a lease ends when its holder releases it."""

    async def follow_gaze(self) -> None:
        """Hold the head in the direction of the gaze that is now set."""
        self.stream.look(self._maker.gaze_rad())

    async def feed(self, _wanted: Callable[[], bool]) -> None:
        """Do nothing: `watch` makes the frames of a lease, tick by tick."""

    async def revise(self, _wanted: Callable[[], bool]) -> None:
        """Do nothing: targets have no revision."""

    def close(self) -> None:
        """Add to the figures of the last event how often frames were clipped and held."""
        if self._plan is not None:
            self._plan.statistics.take_changes(self.stream.clipped, self.stream.holds)
