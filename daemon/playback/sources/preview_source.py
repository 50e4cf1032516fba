"""A preview as a source of poses: the robot starts with the preview and continues with the motion once that has come.

Usually the motion has come before the first frame is played. If it comes later, or never (the generator was killed), the preview
is played, and then the rest of the motion, if any.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import numpy as np

from daemon.generator.generated import Generated
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence

HEAD_FRAMES = 40
"""Number of preview frames given out first (2 s): a block, the frames that it has in view, and some more. Solving the poses of
a whole preview takes 1 ms longer on `reference` and 6 ms on OP2, and gives the same path."""
_SHORTEST_REST_FRAMES = 8
"""Number of frames below which the rest of a preview is given out with its head."""


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
        self._given = 0  # frames of the preview, or of the motion in its place
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
        if first == 0 and self._has_come:
            self._given, self._settled = n, True
            return self.rest(n), True
        if first < n and not self._whole.done():
            head = first == 0 and n >= HEAD_FRAMES + _SHORTEST_REST_FRAMES
            self._given = HEAD_FRAMES if head else n
            return self._preview[first : self._given], False
        return self.rest(0), True

    @property
    def revised(self) -> bool:
        """Whether the motion has come while the preview is being played."""
        return self._given > 0 and not self._settled and self._has_come

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
