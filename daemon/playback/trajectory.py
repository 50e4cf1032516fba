"""A plan: the frames of one command on their way to the bus, made stretch by stretch.

What was played is forgotten, so that a loop or a story may last for ever.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daemon.playback.trajectory_statistics import TrajectoryStatistics
from daemon.poses.pose_sequence import PoseSequence, joined
from retarget.path.paths import JointPath, JointState

Array = NDArray[np.float64]

KEPT_FRAMES = 512
"""Frames kept after they were pushed: the bus process has at most 256 of them still in hand."""


@dataclass(frozen=True)
class Chunk:
    """A path, as far as it is made.

    Attributes:
        path: of the joints.
        posture: what it was made of, from its first frame to the end of what is being made, later pieces included.
        raw: the same without layers.
        is_last: whether nothing of that is left.
        complete: whether the plan ends with it.
    """

    path: JointPath
    posture: PoseSequence
    raw: PoseSequence
    is_last: bool
    complete: bool


@dataclass(frozen=True)
class Segment:
    """A piece in its plan: its bus frames begin at `first` and end before `end`."""

    first: int
    end: int
    piece: Chunk


class Trajectory:
    """Frames of one command. For one thread.

    Attributes:
        plan_id: number in the log.
        command_id: the command that it carries out, empty for idle movements.
        epoch: the link's epoch when its command arrived; setpoints of an older epoch are thrown away.
        statistics: what it did at the bus.
        n_frames: frames so far.
        complete: whether no more will come.
        end: frames that may be pushed; None for all, fewer once another plan takes over.
        pushed: frames pushed so far.
    """

    def __init__(
        self, plan_id: int, command_id: str, epoch: int, rate_hz: float, statistics: TrajectoryStatistics
    ) -> None:
        self.plan_id, self.command_id, self.epoch, self.statistics = plan_id, command_id, epoch, statistics
        self._rate_hz = rate_hz
        self._stretches: list[Segment] = []
        self._frames: list[Array] = []
        self._kept_from = 0
        self.n_frames: int = 0
        self.complete = False
        self.end: int | None = None
        self.pushed = 0

    def append(self, piece: Chunk) -> None:
        """Add a piece, which must begin where `state_at(n_frames - 1)` ends."""
        frames, report = piece.path.at_rate(self._rate_hz), piece.path.report
        self._stretches.append(Segment(self.n_frames, self.n_frames + len(frames), piece))
        self._frames.append(frames)
        self.n_frames += len(frames)
        self.complete = piece.complete
        self.statistics.take_report(report, len(frames))
        while len(self._stretches) > 1 and self._stretches[1].first < self.pushed - KEPT_FRAMES:
            self._kept_from += len(self._frames.pop(0))
            del self._stretches[0]

    def cut(self, frame: int) -> None:
        """Forget what comes after `frame`, to go on otherwise."""
        n = frame + 1
        while len(self._stretches) > 1 and self._stretches[-1].first >= n:
            self._frames.pop()
            self._stretches.pop()
        last = self._stretches[-1]
        # What it was made of still tells what was to follow, so what comes next does not.
        self._stretches[-1] = replace(last, end=n, piece=replace(last.piece, is_last=False))
        self._frames[-1] = self._frames[-1][: n - last.first]
        self.n_frames, self.complete = n, False

    @property
    def expected_frames(self) -> int:
        """Frames so far and those that what is being made will have, but for the last ones in which it settles."""
        if not self._stretches or self._stretches[-1].piece.is_last:
            return self.n_frames
        last = self._stretches[-1]
        posture = last.piece.posture
        return max(self.n_frames, last.first + round(len(posture) / posture.fps * self._rate_hz))

    @property
    def limit(self) -> int:
        """Frames that may be pushed."""
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

    def frames(self, first: int, end: int) -> Array:
        """(n, J) setpoints from `first` to before `end`, at bus rate."""
        parts: list[Array] = []
        at = self._kept_from
        for part in self._frames:
            if at < end and at + len(part) > first:
                parts.append(part[max(0, first - at) : end - at])
            at += len(part)
        return np.concatenate(parts) if len(parts) != 1 else parts[0]

    def state_at(self, frame: int) -> JointState:
        """Position and velocity at a frame."""
        stretch = self._stretch(frame)
        path = stretch.piece.path
        t_s = min((frame - stretch.first + 1) / self._rate_hz, path.duration_s)
        return JointState(self.frames(frame, frame + 1)[0].copy(), path.velocity_at(np.array([t_s]))[0])

    def step_at(self, frame: int) -> JointState:
        """Position at a frame and the difference quotient up to it, which is what the gate goes on from."""
        if frame <= self._kept_from:
            return self.state_at(frame)
        before, here = self.frames(frame - 1, frame + 1)
        return JointState(here.copy(), (here - before) * self._rate_hz)

    def posture_from(self, frame: int, n: int, *, raw: bool = False) -> PoseSequence:
        """`n` frames of posture that follow bus frame `frame`; what is not planned stays as the last one is."""
        stretch = self._stretch(max(0, min(frame, self.n_frames - 1)))
        posture = stretch.piece.raw if raw else stretch.piece.posture
        return posture.at(self._posture_frame(stretch, frame) + np.arange(n))

    def rest_raw(self, frame: int) -> PoseSequence:
        """What is to follow bus frame `frame`, made already or not, without layers; at least one frame."""
        stretch = self._stretch(frame)
        first = self._posture_frame(stretch, frame)
        parts = [stretch.piece.raw[min(first, len(stretch.piece.raw) - 1) :]]
        for before, following in pairwise(self._stretches[self._stretches.index(stretch) :]):
            if before.piece.is_last:  # else it is in what the one before was made of
                parts.append(following.piece.raw)
        return joined(parts)

    def _posture_frame(self, stretch: Segment, frame: int) -> int:
        return round((frame - stretch.first + 1) / self._rate_hz * stretch.piece.posture.fps)

    def _stretch(self, frame: int) -> Segment:
        for stretch in self._stretches:
            if frame < stretch.end:
                return stretch
        return self._stretches[-1]
