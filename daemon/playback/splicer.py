"""The only owner of splices: lets new setpoints follow a frame of the running trajectory without a jump.

New frames start from the position and velocity of a frame that is not yet played, so far ahead that they are made in time.
The trajectory runs on beyond that frame meanwhile, and frames that come too late are made again from a later one. Without
a running trajectory, new frames start at rest from the goals that the servos hold.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from daemon.host.clock import REAL_CLOCK, Clock
from daemon.playback.chunk_maker import FADE_FRAMES
from daemon.playback.latency_estimate import LatencyEstimate
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.trajectory import Chunk, PathTrajectory, Trajectory
from daemon.poses.pose_sequence import PoseSequence, joined
from mmm_core.motion.motion import FPS
from retarget.path.paths import JointState

FIRST_RETARGET_S = 0.03
"""Seconds assumed until the first chunk of the first trajectory is made; later ones are measured."""
Purpose = Literal["command", "idle", "revision"]
"""Purposes of new frames. Each has its own estimate: a revision is not urgent and takes longer than the first frames of a command,
and idle movements take less time than either."""
RETRY_MARGIN = 1.2
"""Factor on the duration of a late first attempt that gives the distance of the second attempt's splice."""


@dataclass
class Splice:
    """The place of new frames in the running trajectory, valid inside its `with` block.

    Attributes:
        state: position and velocity of the joints at the splice.
        before: poses that would have followed.
        frame: last frame of the running trajectory to be played; None at rest.
        began_s: time at which the attempt began, seconds.
        latency: estimate of the time that frames of this purpose take.
        made: whether new frames were placed. A splice without new frames lets the trajectory run to its end.
    """

    state: JointState
    before: PoseSequence
    frame: int | None
    began_s: float
    latency: LatencyEstimate
    made: bool = False


class Splicer:
    """Makes splices, one at a time, and learns how long the first chunk of a trajectory takes.

    Attributes:
        latencies: estimate for each purpose.

    Args:
        buffer: buffer with the running trajectory.
        clock: clock of the measurements.
    """

    def __init__(self, buffer: SetpointBuffer, clock: Clock = REAL_CLOCK) -> None:
        self._buffer, self._clock = buffer, clock
        self.latencies: dict[Purpose, LatencyEstimate] = {
            purpose: LatencyEstimate(FIRST_RETARGET_S) for purpose in get_args(Purpose)
        }

    @contextmanager
    def splice(self, purpose: Purpose = "command", *, late_s: float = 0.0) -> Generator[Splice]:
        """Open a splice so far ahead that a first chunk will be made in time.

        Args:
            purpose: purpose of the new frames.
            late_s: seconds that a late attempt took; 0 for a first attempt.
        """
        began_s, latency = self._clock.now_s(), self.latencies[purpose]
        if late_s:
            latency.took(late_s)
        plan = self._buffer.current
        if plan is None or not self._buffer.running or self._buffer.dry:
            splice = self._at_rest(plan, began_s, latency)
        else:
            frame = self._buffer.frame_within(plan, max(latency.seconds, RETRY_MARGIN * late_s))
            plan.extend(frame + 1)
            frame = max(0, min(frame, plan.n_frames - 1))
            splice = Splice(plan.state_at(frame), plan.posture_from(frame, FADE_FRAMES), frame, began_s, latency)
        with self._open(splice):
            yield splice

    @contextmanager
    def splice_at_once(self) -> Generator[Splice]:
        """Open a splice after the last frame pushed, with the difference quotient as velocity, from which the limiter continues."""
        began_s, plan, latency = self._clock.now_s(), self._buffer.current, self.latencies["command"]
        if plan is None or not self._buffer.running or self._buffer.dry:
            splice = self._at_rest(plan, began_s, latency)
        else:
            plan.extend(plan.pushed)
            frame = max(0, min(plan.pushed, plan.n_frames) - 1)
            splice = Splice(plan.step_at(frame), plan.posture_from(frame, FADE_FRAMES), frame, began_s, latency)
        with self._open(splice):
            yield splice

    @contextmanager
    def _open(self, splice: Splice) -> Generator[None]:
        try:
            yield
        finally:
            if not splice.made and (plan := self._buffer.current) is not None:
                plan.end = None

    def _at_rest(self, plan: Trajectory | None, began_s: float, latency: LatencyEstimate) -> Splice:
        if plan is not None and plan.resumes and self._buffer.running:
            plan.end = plan.pushed  # frames are not pushed until the splice is made or left
            return Splice(
                self._buffer.at_rest, plan.posture_from(plan.n_frames - 1, FADE_FRAMES), None, began_s, latency
            )
        self._buffer.drop()
        return Splice(self._buffer.at_rest, self._buffer.posture_now, None, began_s, latency)

    def missed(self, splice: Splice) -> bool:
        """Whether the bus process has played beyond the splice, or ran dry, before its new frames were made."""
        plan = self._buffer.current
        if plan is None or splice.frame is None or plan.epoch != self._buffer.epoch:
            return False
        if self._buffer.dry:
            return True
        at_end = plan.complete and splice.frame == plan.n_frames - 1
        return self._buffer.next_frame(plan) > splice.frame + 1 and not at_end

    def follow_with(self, splice: Splice, plan: Trajectory) -> None:
        """Let a trajectory replace all frames after the splice.

        The new trajectory leaves out as many of its first frames as the bus process has played beyond the splice meanwhile: they
        begin alike.
        """
        beyond = self._buffer.end_after(splice.frame)
        self._buffer.follow_with(plan)
        if plan.n_frames:
            splice.latency.took(self._clock.now_s() - splice.began_s)
            plan.pushed = min(beyond, plan.n_frames - 1)
            self._buffer.pump()
        splice.made = True

    def replace_tail(self, splice: Splice, plan: PathTrajectory, chunk: Chunk) -> None:
        """Let a chunk replace all frames after the splice in the running trajectory `plan`."""
        assert plan is self._buffer.current and splice.frame is not None, "a splice of the running trajectory"
        beyond = self._buffer.end_after(splice.frame)
        plan.cut(splice.frame)
        plan.append(chunk)
        splice.latency.took(self._clock.now_s() - splice.began_s)
        plan.end, plan.pushed = None, min(plan.pushed + beyond, plan.n_frames - 1)
        self._buffer.pump()
        splice.made = True

    async def first_chunk(
        self,
        chunks_at: Callable[[Splice], Iterator[Chunk] | None],
        place: Callable[[Splice, Chunk], bool],
        wanted: Callable[[], bool],
        wait_for_rest: Callable[[], Awaitable[None]] | None = None,
        purpose: Purpose = "command",
    ) -> tuple[Iterator[Chunk], Chunk] | None:
        """Make the first chunk in a worker thread and place it, again and again until it comes in time.

        Args:
            chunks_at: returns the chunks that start at a splice; None when none can.
            place: places the chunk at the splice; returns false when the chunk is no longer wanted.
            wanted: returns whether to try; called before each attempt.
            wait_for_rest: waits until the joints rest after the bus process ran dry; None gives up then.
            purpose: purpose of the chunk.

        Returns:
            The chunks, the first already placed, and that first chunk; None when none was placed.

        Raises:
            RetargetError: the chunk does not fit the robot; the running trajectory goes on.
        """
        late_s = 0.0
        while True:
            if self._buffer.dry:
                if wait_for_rest is None:
                    return None
                await wait_for_rest()
            if not wanted():
                return None
            with self.splice(purpose, late_s=late_s) as splice:
                chunks = chunks_at(splice)
                if chunks is None:
                    return None
                chunk = await asyncio.to_thread(next, chunks)
                if not self.missed(splice):
                    return (chunks, chunk) if place(splice, chunk) else None
            late_s = self._clock.now_s() - splice.began_s

    def committed(self, n: int, ahead_s: float) -> PoseSequence:
        """`n` frames at 20 fps as they are played, up to about the splice of a motion that takes `ahead_s` seconds to generate."""
        plan = self._buffer.current
        if plan is None or not self._buffer.running:
            return replace(self._buffer.posture_now.at(np.zeros(n, np.intp)), fps=FPS)
        ahead_s += self.latencies["command"].seconds
        last = min(self._buffer.frame_within(plan, ahead_s), plan.n_frames - 1)
        places = [last - round(k * self._buffer.rate_hz / FPS) for k in reversed(range(n))]
        return replace(joined([plan.posture_from(place, 1) for place in places]), fps=FPS)
