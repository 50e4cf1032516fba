"""Plays a source of poses: makes its chunks before they are due, and makes the rest anew for a new gaze or a revised motion."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.playback.chunk_maker import ChunkMaker
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.splicer import Splice, Splicer
from daemon.playback.trajectory import Chunk, PathTrajectory
from daemon.poses.motion_source import MotionSource
from daemon.wire.events import Progress

MOST_REVISIONS = 5
"""Number of attempts to splice in a revised motion; after as many late ones the preview is played to its end."""


@dataclass(frozen=True)
class PlanStart:
    """The facts of a trajectory that are known before its frames.

    Attributes:
        plan_id: its number.
        command_id: id of its command; empty for idle movements.
        epoch: epoch of the link when the command arrived.
        t_received_ns: monotonic time at which the request arrived, nanoseconds.
    """

    plan_id: int
    command_id: str
    epoch: int
    t_received_ns: int


class MotionPlayer:
    """Plays one source from its splice to its end. For the event loop, under the lock of `Playback`.

    Args:
        source: source of the poses.
        buffer: buffer with the running trajectory.
        splicer: splicer of the robot's trajectories.
        maker: maker of the robot's chunks.
        report: publishes an event of the command.
    """

    stream = None

    def __init__(
        self, source: MotionSource, buffer: SetpointBuffer, splicer: Splicer, maker: ChunkMaker,
        report: Callable[[Progress], None],
    ) -> None:  # fmt: skip
        self.source = source
        self._buffer, self._splicer, self._maker, self._report = buffer, splicer, maker, report
        self._chunks: Iterator[Chunk] | None = None
        self._is_last = False
        self._plan: PathTrajectory | None = None

    async def begin(
        self, start: PlanStart, wanted: Callable[[], bool], wait_for_rest: Callable[[], Awaitable[None]]
    ) -> bool:
        """Splice the source's first chunk into the running trajectory; returns false when it was no longer wanted.

        Raises:
            RetargetError: the motion does not fit the robot.
        """
        source = self.source
        raw, last = source.next() if source.is_at_hand else await asyncio.to_thread(source.next)
        idle = not start.command_id

        def chunks_at(splice: Splice) -> Iterator[Chunk]:
            return self._maker.chunks(raw, splice.state, splice.before, complete=last, easy=idle, first_at_once=True)

        def place(splice: Splice, chunk: Chunk) -> bool:
            if not wanted():
                return False
            statistics = self._buffer.statistics(start.plan_id, start.t_received_ns)
            rate_hz = self._buffer.rate_hz
            self._plan = PathTrajectory(start.plan_id, start.command_id, start.epoch, rate_hz, statistics)
            self._plan.append(chunk)
            self._splicer.follow_with(splice, self._plan)
            return True

        purpose = "idle" if idle else "command"
        made = await self._splicer.first_chunk(chunks_at, place, wanted, wait_for_rest, purpose)
        if made is not None:
            self._keep(*made, is_last=last)
        return made is not None

    @property
    def ready(self) -> bool:
        """Whether the next chunk can be made now."""
        return self._chunks is not None or self.source.ready

    @property
    def revised(self) -> bool:
        """Whether a better motion waits to replace the rest of the one being played."""
        return self.source.revised

    async def feed(self, wanted: Callable[[], bool]) -> None:
        """Make the next chunk, of the next segment if this one is done, and append it if it is still wanted.

        Raises:
            NotPlayableError: the source has failed; the error's event ends the command.
            RetargetError: the segment does not fit the robot.
        """
        plan = self._plan
        if plan is None or plan is not self._buffer.current or plan.complete or plan.end is not None:
            return
        chunks, last = self._chunks, self._is_last
        if chunks is None:
            raw, last = await asyncio.to_thread(self.source.next)
            chunks = self._maker.chunks(raw, plan.state_at(plan.n_frames - 1), None, complete=last)
        chunk = await asyncio.to_thread(next, chunks)
        if self._is_current(plan) and wanted():
            plan.append(chunk)
            self._keep(chunks, chunk, is_last=last)
            self._buffer.pump()

    async def revise(self, wanted: Callable[[], bool]) -> None:
        """Replace the rest of the motion being played by the source's revised motion.

        Raises:
            RetargetError: the revised motion does not fit the robot; the motion being played goes on.
        """
        try:
            await self._make_rest_again(wanted, MOST_REVISIONS, revised=True)
        finally:
            self.source.settle()

    async def follow_gaze(self) -> None:
        """Make the rest of the trajectory anew, with the gaze that is now set."""
        await self._make_rest_again(lambda: True, 1)

    async def _make_rest_again(self, wanted: Callable[[], bool], tries: int, *, revised: bool = False) -> None:
        plan, last, left = self._plan, self._is_last or revised, iter(range(tries))

        def chunks_at(splice: Splice) -> Iterator[Chunk] | None:
            if plan is None or splice.frame is None or next(left, None) is None:
                return None
            rest = plan.rest_raw(splice.frame)
            rest = self.source.rest(len(rest)) if revised else rest
            return self._maker.chunks(rest, splice.state, splice.before, complete=last)

        def place(splice: Splice, chunk: Chunk) -> bool:
            if plan is None or not self._is_current(plan):
                return False
            self._splicer.replace_tail(splice, plan, chunk)
            return True

        made = await self._splicer.first_chunk(
            chunks_at, place, lambda: self._buffer.running and wanted(), purpose="revision"
        )
        if made is not None:
            self._keep(*made, is_last=last)

    def _is_current(self, plan: PathTrajectory) -> bool:
        return plan is self._buffer.current and plan.epoch == self._buffer.epoch

    def _keep(self, chunks: Iterator[Chunk], made: Chunk, *, is_last: bool) -> None:
        """Keep the remaining chunks of a segment, and whether it is the trajectory's last."""
        self._chunks, self._is_last = None if made.is_last else chunks, is_last

    def accept(self, q_rad: NDArray[np.float64]) -> bool:
        """A motion accepts no targets."""
        del q_rad
        return False

    def begun(self) -> None:
        """Do nothing: `Playback` reports when the robot moves."""

    def watch(self) -> None:
        """Report the source's events. Call once a tick."""
        if self._plan is not None:
            for event in self.source.reports(self._plan.plan_id):
                self._report(event)

    def finish(self) -> None:
        """Lead to the end instead of repeating."""
        self.source.finish()

    def close(self) -> None:
        """Do nothing: a motion adds nothing to the trajectory's figures."""
