"""Poses of one command in time order, segment by segment: a clip, a preview, a story, idle movements, a held pose."""

from __future__ import annotations

from abc import ABC, abstractmethod

from daemon.poses.pose_sequence import PoseSequence
from daemon.wire.events import Progress


class MotionSource(ABC):
    """Segments of poses. `next` and `rest` may run in a worker thread, all other methods run in the event loop."""

    @property
    def ready(self) -> bool:
        """Whether `next` has a segment without waiting; polled often."""
        return True

    @property
    def is_at_hand(self) -> bool:
        """Whether `next` returns an existing segment at once, so that a worker thread would cost more than the call."""
        return False

    @property
    def revised(self) -> bool:
        """Whether a better motion than the running one is available, whose `rest` may replace the remaining poses."""
        return False

    @abstractmethod
    def next(self) -> tuple[PoseSequence, bool]:
        """The next segment, and whether it is the last; not called again after the last."""

    def rest(self, n_left: int) -> PoseSequence:
        """The poses of a revised motion that replace the last `n_left` frames of the running one."""
        raise NotImplementedError

    def settle(self) -> None:  # noqa: B027 - most sources have no revision
        """Note that the revised motion is being played, or cannot be."""

    def reports(self, plan_id: int) -> list[Progress]:
        """Events since the last call, of the trajectory `plan_id`."""
        del plan_id
        return []

    def finish(self) -> None:  # noqa: B027 - most sources end by themselves
        """Lead to the end instead of starting another round."""


class HeldPose(MotionSource):
    """A single segment, which holds a pose."""

    def __init__(self, segment: PoseSequence) -> None:
        self._segment = segment

    def next(self) -> tuple[PoseSequence, bool]:
        return self._segment, True
