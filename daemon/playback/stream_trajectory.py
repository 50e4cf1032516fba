"""A plan whose frames are made when they are due: as few as possible ahead, so that a target moves the robot at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daemon.playback.sources.stream_source import StreamSource
from daemon.playback.trajectory import KEPT_FRAMES, Trajectory
from daemon.playback.trajectory_statistics import TrajectoryStatistics
from daemon.poses.pose_sequence import PoseSequence
from retarget.path.paths import JointState

Array = NDArray[np.float64]


class StreamTrajectory(Trajectory):
    """Frames of a lease. For one thread.

    Args:
        score: makes the frames.
        shown: the posture of a person who is held as the robot in a pose (J,).

    Attributes:
        score: the same.
        resting: whether the last frame stands where it is until something changes; the bus process then holds.
        first_target_s: when the first target came, monotonic; None before.
        lost: whether the bus process ran out of frames: it brakes, and the frames go on from where it stands.
    """

    def __init__(
        self, plan_id: int, command_id: str, epoch: int, rate_hz: float, statistics: TrajectoryStatistics,
        score: StreamSource, shown: Callable[[Array], PoseSequence],
    ) -> None:  # fmt: skip
        super().__init__(plan_id, command_id, epoch, rate_hz, statistics)
        self.score, self._shown = score, shown
        self._made: deque[tuple[Array, Array]] = deque(maxlen=KEPT_FRAMES)  # position and velocity
        self._start = score.state
        self.resting: bool = False
        self.lost: bool = False
        self.first_target_s: float | None = None
        self._good_from: int = 0

    def extend(self, n: int) -> None:
        """Make frames up to the `n`-th, as far as there is motion."""
        while self.n_frames < n and not self.complete:
            q_rad, rests, ends = self.score.frame(), self.score.at_rest, self.score.released
            if rests and self.resting and not ends:
                return
            self._made.append((q_rad, self.score.state.velocity_rad_s))
            self.n_frames += 1
            self.resting, self.complete = rests, rests and ends

    def check_lost(self) -> None:
        """Notice that the bus process ran out of frames."""
        self.lost = self.lost or self.statistics.last_underrun_frame >= self._good_from

    def go_on(self, position_rad: Array) -> None:
        """The bus process holds here and has no frame left."""
        self.score.go_on(JointState(position_rad.copy(), np.zeros_like(position_rad)))
        self.lost, self._good_from = False, self.n_frames

    @property
    def ends_here(self) -> bool:
        """Whether the bus process may hold after the last frame so far."""
        return self.complete or self.resting

    @property
    def all_played(self) -> bool:
        """Whether the bus process has played every frame so far."""
        return self.statistics.last_frame >= self.n_frames - 1

    def frames(self, first: int, end: int) -> Array:
        """(n, J) setpoints from `first` to before `end`."""
        oldest = self.n_frames - len(self._made)
        return np.array([self._made[k - oldest][0] for k in range(first, min(end, self.n_frames))])

    def state_at(self, frame: int) -> JointState:
        """Position and difference quotient at a frame; where it began when that is not known."""
        at = frame - (self.n_frames - len(self._made))
        return JointState(*self._made[at]) if 0 <= at < len(self._made) else self._start

    def posture_from(self, frame: int, n: int, *, raw: bool = False) -> PoseSequence:
        """The person who is held as the robot at a frame, `n` times: what a target leads to nobody knows."""
        del raw
        return self._shown(self.state_at(frame).position_rad).at(np.zeros(n, np.intp))
