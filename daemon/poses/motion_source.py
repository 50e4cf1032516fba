"""Poses of one command in time order, segment by segment: a clip, a preview, a story, idle movements, a pose that is held."""

from __future__ import annotations

from abc import ABC, abstractmethod

from daemon.poses.pose_sequence import PoseSequence
from daemon.wire.events import Progress


class MotionSource(ABC):
    """Segments of poses. `next` and `rest` may run in a worker thread, all else in the event loop."""

    @property
    def ready(self) -> bool:
        """Whether `next` has a segment without waiting; polled often."""
        return True

    @property
    def is_at_hand(self) -> bool:
        """Whether `next` only gives out what is there, so that a worker thread would take longer than the call."""
        return False

    @property
    def revised(self) -> bool:
        """Whether a better motion than the one being played has come, whose `rest` may take its place."""
        return False

    @abstractmethod
    def next(self) -> tuple[PoseSequence, bool]:
        """The next segment, and whether it is the last; not called again after the last."""

    def rest(self, n_left: int) -> PoseSequence:
        """The poses of a revised motion that take the place of the last `n_left` frames of the one being played."""
        raise NotImplementedError

    def settle(self) -> None:  # noqa: B027 - most sources have no revision
        """The revised motion is being played, or cannot be."""

    def reports(self, plan_id: int) -> list[Progress]:
        """Events since the last call, of the trajectory `plan_id`."""
        del plan_id
        return []

    def finish(self) -> None:  # noqa: B027 - most sources end by themselves
        """Lead to the end instead of going round again."""


class HeldPose(MotionSource):
    """One segment, which holds a pose."""

    def __init__(self, segment: PoseSequence) -> None:
        self._segment = segment

    def next(self) -> tuple[PoseSequence, bool]:
        return self._segment, True
