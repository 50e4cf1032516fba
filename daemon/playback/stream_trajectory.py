"""A trajectory whose frames are made when they are due: as few as possible ahead, so that a target moves the robot at once."""

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
    """The frames of a lease. For one thread.

    Args:
        source: makes the frames.
        person: returns a person in the pose (J,) of the robot.

    Attributes:
        source: makes the frames.
        resting: whether the last frame stands still until something changes; the bus process then holds.
        lost: whether the bus process ran out of frames: it brakes, and the frames continue from where the joints stand.
    """

    resumes = True

    def __init__(
        self, plan_id: int, command_id: str, epoch: int, rate_hz: float, statistics: TrajectoryStatistics,
        source: StreamSource, person: Callable[[Array], PoseSequence],
    ) -> None:  # fmt: skip
        super().__init__(plan_id, command_id, epoch, rate_hz, statistics)
        self.source, self._person = source, person
        self._made: deque[tuple[Array, Array]] = deque(maxlen=KEPT_FRAMES)  # position and velocity
        self._start = source.state
        self.resting: bool = False
        self.lost: bool = False
        self._good_from: int = 0

    def extend(self, n: int) -> None:
        """Make frames up to the `n`-th, unless the joints rest."""
        while self.n_frames < n and not self.complete:
            q_rad, rests, ends = self.source.frame(), self.source.at_rest, self.source.released
            if rests and self.resting and not ends:
                return
            self._made.append((q_rad, self.source.state.velocity_rad_s))
            self.n_frames += 1
            self.resting, self.complete = rests, rests and ends

    def resume(self, goal_rad: Array, *, stands: bool) -> bool:
        """Whether frames may be made now; after a loss they continue from the goals (J,) once the joints stand."""
        self.lost = self.lost or self.statistics.last_underrun_frame >= self._good_from
        if self.lost or self.resting:
            stands = stands and self.all_played
            if self.lost and not stands:
                return False
            if self.lost or (stands and not np.array_equal(goal_rad, self.source.state.position_rad)):
                self.source.go_on(JointState(goal_rad.copy(), np.zeros_like(goal_rad)))
                self.lost, self._good_from = False, self.n_frames
        return True

    def ran_dry(self, queued: int) -> bool:
        """Whether the bus process ran out of frames; frames that are merely not made yet follow in a moment."""
        return self.lost if self.end is None and not self.resting else super().ran_dry(queued)

    @property
    def oldest_frame(self) -> int:
        return self.n_frames - len(self._made)

    @property
    def ends_here(self) -> bool:
        """Whether the bus process may hold after the last frame so far."""
        return self.complete or self.resting

    @property
    def all_played(self) -> bool:
        """Whether the bus process has played every frame so far."""
        return self.statistics.last_frame >= self.n_frames - 1

    def frames(self, first: int, end: int) -> Array:
        return np.array([self._made[k - self.oldest_frame][0] for k in range(first, min(end, self.n_frames))])

    def state_at(self, frame: int) -> JointState:
        """Position and difference quotient at a frame; the start of the lease for an unknown frame."""
        at = frame - self.oldest_frame
        return JointState(*self._made[at]) if 0 <= at < len(self._made) else self._start

    def posture_from(self, frame: int, n: int, *, raw: bool = False) -> PoseSequence:
        """The person in the robot's pose at a frame, `n` times: the poses to which targets lead are not known."""
        del raw
        return self._person(self.state_at(frame).position_rad).at(np.zeros(n, np.intp))
