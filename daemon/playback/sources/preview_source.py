"""A preview as a source of poses: the robot starts with the preview and continues with the motion once that has come.

Usually the motion has come before the first frame is played. If it comes later, or never (the generator was killed), the preview
is played, and then the rest of the motion, if any. Frames at the beginning in which the person still stands are left out.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import numpy as np

from daemon.generator.generated import Generated
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, distance_deg

HEAD_FRAMES = 40
"""Number of preview frames given out first (2 s): a block, the frames that it has in view, and some more. Solving the poses of
a whole preview takes 1 ms longer on `reference` and 6 ms on OP2, and gives the same path."""
_SHORTEST_REST_FRAMES = 8
"""Number of frames below which the rest of a preview is given out with its head."""
_STILL_DEG, _MOST_STILL_FRAMES = 3.0, 3
"""Degrees by which no bone has left its first direction while the person still stands, and the most such frames (0.15 s) left out:
generated motions begin gently, and nobody sees these frames, but the robot would wait for them."""


class PreviewSource(MotionSource):
    """Gives the first frames of a preview, then its other frames if needed, then the rest of its motion.

    Args:
        preview: poses of the preview.
        whole: task that generates the motion.
        posture: returns the poses of a generated motion as they are played.
    """

    def __init__(
        self, preview: PoseSequence, whole: asyncio.Task[Generated], posture: Callable[[Generated], PoseSequence]
    ) -> None:
        self._preview, self._whole, self._posture = preview, whole, posture
        self._still = still_frames(preview)
        self._given = self._still  # frames of the preview, or of the motion in its place, given out or left out
        self._settled = False

    @property
    def ready(self) -> bool:
        """Whether a part of the preview is still to be given out, or its motion has come or failed."""
        return self._given < len(self._preview) or self._whole.done()

    @property
    def is_at_hand(self) -> bool:
        """Whether the next segment is one of the preview."""
        return not self._whole.done()

    def next(self) -> tuple[PoseSequence, bool]:
        """The next segment of the preview, or the motion as soon as it has come; and whether it is the last."""
        first, n = self._given, len(self._preview)
        if first == self._still and self._has_come:
            self._given, self._settled = n, True
            return self.rest(n - first), True
        if first < n and not self._whole.done():
            head = first == self._still and n >= first + HEAD_FRAMES + _SHORTEST_REST_FRAMES
            self._given = first + HEAD_FRAMES if head else n
            return self._preview[first : self._given], False
        return self.rest(0), True

    @property
    def revised(self) -> bool:
        """Whether the motion has come while the preview is being played."""
        return self._given > self._still and not self._settled and self._has_come

    def settle(self) -> None:
        self._settled = True

    @property
    def _has_come(self) -> bool:
        return self._whole.done() and not self._whole.cancelled() and self._whole.exception() is None

    def rest(self, n_left: int) -> PoseSequence:
        """The poses that follow all but the last `n_left` frames given out: of the motion, or of the preview without one."""
        of = self._posture(self._whole.result()) if self._has_come else self._preview
        place = self._given - n_left
        return of[place:] if place < len(of) else of.at(np.full(2, len(of) - 1))


def still_frames(p: PoseSequence) -> int:
    """Number of frames at the beginning of a motion in which the person still stands as in the first frame."""
    n = min(_MOST_STILL_FRAMES, len(p) - 1)
    if n < 1:
        return 0
    after = p[1 : n + 1]
    moved = distance_deg(p.at(np.zeros(n, np.intp)), after) > _STILL_DEG
    return int(moved.argmax()) if moved.any() else n


def without_stillness(p: PoseSequence) -> PoseSequence:
    """A motion without the frames at its beginning that are left out."""
    return p[still_frames(p) :]
