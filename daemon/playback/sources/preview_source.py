"""A preview as a source of poses until its motion has come: the robot sets out on the preview and continues with the motion.

Usually the motion has come before the first frame is played. Where it comes later, or never (the generator was killed), the
preview is played, and the rest of the motion after it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import numpy as np

from daemon.generator.generated import Generated
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence


class PreviewSource(MotionSource):
    """A preview, then the rest of its motion.

    Args:
        preview: poses of the preview.
        whole: the generation of the motion.
        posture: gives the poses of a generated motion as they are played.
    """

    def __init__(
        self, preview: PoseSequence, whole: asyncio.Task[Generated], posture: Callable[[Generated], PoseSequence]
    ) -> None:
        self._preview, self._whole, self._posture = preview, whole, posture
        self._begun = self._settled = False

    @property
    def ready(self) -> bool:
        """Whether the preview has not been given out, or its motion has come or failed."""
        return not self._begun or self._whole.done()

    def next(self) -> tuple[PoseSequence, bool]:
        """The preview, or the motion if that has come already; then the motion's frames after the preview."""
        if not self._begun:
            self._begun = True
            if not self._has_come:
                return self._preview, False
            self._settled = True
            return self.rest(len(self._preview)), True
        return self.rest(0), True

    @property
    def revised(self) -> bool:
        """Whether the motion has come while the preview is being played."""
        return self._begun and not self._settled and self._has_come

    def settle(self) -> None:
        self._settled = True

    @property
    def _has_come(self) -> bool:
        return self._whole.done() and not self._whole.cancelled() and self._whole.exception() is None

    def rest(self, n_left: int) -> PoseSequence:
        """The poses after all but `n_left` frames of the preview: of the motion, or of the preview if there is none."""
        of = self._posture(self._whole.result()) if self._has_come else self._preview
        place = len(self._preview) - n_left
        return of[place:] if place < len(of) else of.at(np.full(2, len(of) - 1))
