"""The frames of one command for the bus process, and the trajectory whose frames come from retargeted poses.

Played frames are forgotten, so that a loop or a story may last for ever.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daemon.playback.trajectory_statistics import TrajectoryStatistics
from daemon.poses.pose_sequence import PoseSequence, joined
from retarget.path.paths import JointPath, JointState

Array = NDArray[np.float64]

KEPT_FRAMES = 512
"""Number of frames kept after they were pushed: the bus process has at most 256 of them still to play."""


class Trajectory(ABC):
    """The frames of one command. For one thread.

    Attributes:
        plan_id: number of the trajectory, as in the log.
        command_id: id of the command that it carries out; empty for idle movements.
        epoch: the link's epoch when its command arrived; setpoints of an older epoch are thrown away.
        statistics: statistics of its frames at the bus.
        n_frames: number of frames made so far.
        complete: whether no more frames will come.
        end: number of frames that may be pushed; None for all, fewer once another trajectory takes over.
        pushed: number of frames pushed so far.
        first_target_s: monotonic time of a stream's first target; None for other trajectories and before.
    """

    resumes = False
    """Whether the trajectory's command continues after the bus process ran out of frames."""

    def __init__(
        self, plan_id: int, command_id: str, epoch: int, rate_hz: float, statistics: TrajectoryStatistics
    ) -> None:
        self.plan_id, self.command_id, self.epoch, self.statistics = plan_id, command_id, epoch, statistics
        self._rate_hz = rate_hz
        self.n_frames: int = 0
        self.complete = False
        self.end: int | None = None
        self.pushed = 0
        self.first_target_s: float | None = None

    @abstractmethod
    def frames(self, first: int, end: int) -> Array:
        """(n, J) setpoints from frame `first` to before `end`, at bus rate, radians."""

    @abstractmethod
    def state_at(self, frame: int) -> JointState:
        """Position and velocity at a frame."""

    @abstractmethod
    def posture_from(self, frame: int, n: int, *, raw: bool = False) -> PoseSequence:
        """`n` frames of poses that follow bus frame `frame`, with layers unless `raw`."""

    @property
    @abstractmethod
    def oldest_frame(self) -> int:
        """Index of the oldest frame that is not forgotten."""

    def extend(self, n: int) -> None:  # noqa: B027 - frames of a motion are appended
        """Make frames up to the `n`-th, for a trajectory whose frames are made on demand."""

    def resume(self, goal_rad: Array, *, stands: bool) -> bool:
        """Whether frames are made on demand now, continuing from the goals (J,) after the bus process ran out of frames."""
        del goal_rad, stands
        return False

    def ran_dry(self, queued: int) -> bool:
        """Whether the bus process, with `queued` frames to play, has none of these left though more were to come."""
        return 0 < self.pushed and not self.all_pushed and self.pushed >= self.limit and queued == 0

    @property
    def expected_frames(self) -> int:
        """Number of frames of the whole trajectory, as far as it is known."""
        return self.n_frames

    @property
    def limit(self) -> int:
        """Number of frames that may be pushed."""
        return self.n_frames if self.end is None else min(self.end, self.n_frames)

    @property
    def ends_here(self) -> bool:
        """Whether the bus process may hold after the last frame so far."""
        return self.complete

    @property
    def all_pushed(self) -> bool:
        """Whether the bus process has the last frame."""
        return self.complete and self.pushed >= self.n_frames

    @property
    def played(self) -> bool:
        """Whether the bus process has played the last frame."""
        return self.complete and self.statistics.last_frame >= self.n_frames - 1

    def step_at(self, frame: int) -> JointState:
        """Position at a frame and the difference quotient up to it, from which the limiter continues."""
        if frame <= self.oldest_frame:
            return self.state_at(frame)
        before, here = self.frames(frame - 1, frame + 1)
        return JointState(here.copy(), (here - before) * self._rate_hz)


@dataclass(frozen=True)
class Chunk:
    """A block of a path.

    Attributes:
        path: path of the joints.
        posture: poses from its first frame to the end of its segment, later chunks included.
        raw: these poses without layers.
        is_last: whether the segment ends with this chunk.
        complete: whether the trajectory ends with this chunk.
    """

    path: JointPath
    posture: PoseSequence
    raw: PoseSequence
    is_last: bool
    complete: bool


@dataclass(frozen=True)
class _Placed:
    """A chunk in its trajectory: its bus frames begin at `first` and end before `end`."""

    first: int
    end: int
    chunk: Chunk


class PathTrajectory(Trajectory):
    """Frames of a motion, appended chunk by chunk."""

    def __init__(
        self, plan_id: int, command_id: str, epoch: int, rate_hz: float, statistics: TrajectoryStatistics
    ) -> None:
        super().__init__(plan_id, command_id, epoch, rate_hz, statistics)
        self._placed: list[_Placed] = []
        self._frames: list[Array] = []
        self._kept_from = 0

    def append(self, chunk: Chunk) -> None:
        """Add a chunk, which must begin where `state_at(n_frames - 1)` ends."""
        frames = chunk.path.at_rate(self._rate_hz)
        self._placed.append(_Placed(self.n_frames, self.n_frames + len(frames), chunk))
        self._frames.append(frames)
        self.n_frames += len(frames)
        self.complete = chunk.complete
        self.statistics.take_path(chunk.path, len(frames))
        while len(self._placed) > 1 and self._placed[1].first < self.pushed - KEPT_FRAMES:
            self._kept_from += len(self._frames.pop(0))
            del self._placed[0]

    def cut(self, frame: int) -> None:
        """Forget the frames after `frame`, which others will replace."""
        n = frame + 1
        while len(self._placed) > 1 and self._placed[-1].first >= n:
            self._frames.pop()
            self._placed.pop()
        last = self._placed[-1]
        # The poses that were to follow are still those of this chunk, so the next chunk does not add to them.
        self._placed[-1] = replace(last, end=n, chunk=replace(last.chunk, is_last=False))
        self._frames[-1] = self._frames[-1][: n - last.first]
        self.n_frames, self.complete = n, False

    @property
    def oldest_frame(self) -> int:
        return self._kept_from

    @property
    def expected_frames(self) -> int:
        """Number of frames made and still expected of the present segment, without the last ones in which the joints settle."""
        if not self._placed or self._placed[-1].chunk.is_last:
            return self.n_frames
        last = self._placed[-1]
        posture = last.chunk.posture
        return max(self.n_frames, last.first + round(len(posture) / posture.fps * self._rate_hz))

    def frames(self, first: int, end: int) -> Array:
        parts: list[Array] = []
        at = self._kept_from
        for part in self._frames:
            if at < end and at + len(part) > first:
                parts.append(part[max(0, first - at) : end - at])
            at += len(part)
        return np.concatenate(parts) if len(parts) != 1 else parts[0]

    def state_at(self, frame: int) -> JointState:
        placed = self._at(frame)
        path = placed.chunk.path
        t_s = min((frame - placed.first + 1) / self._rate_hz, path.duration_s)
        return JointState(self.frames(frame, frame + 1)[0].copy(), path.velocity_at(np.array([t_s]))[0])

    def posture_from(self, frame: int, n: int, *, raw: bool = False) -> PoseSequence:
        """`n` frames of poses that follow bus frame `frame`; the last pose made is repeated as needed."""
        placed = self._at(max(0, min(frame, self.n_frames - 1)))
        posture = placed.chunk.raw if raw else placed.chunk.posture
        return posture.at(self._posture_frame(placed, frame) + np.arange(n))

    def rest_raw(self, frame: int) -> PoseSequence:
        """The poses without layers that follow bus frame `frame`, whether their frames are made or not; at least one."""
        placed = self._at(frame)
        first = self._posture_frame(placed, frame)
        parts = [placed.chunk.raw[min(first, len(placed.chunk.raw) - 1) :]]
        for before, following in pairwise(self._placed[self._placed.index(placed) :]):
            if before.chunk.is_last:  # else the poses of the chunk before include them already
                parts.append(following.chunk.raw)
        return joined(parts)

    def _posture_frame(self, placed: _Placed, frame: int) -> int:
        return round((frame - placed.first + 1) / self._rate_hz * placed.chunk.posture.fps)

    def _at(self, frame: int) -> _Placed:
        return next((placed for placed in self._placed if frame < placed.end), self._placed[-1])
