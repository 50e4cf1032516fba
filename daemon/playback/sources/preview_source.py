"""A draft as a score, until the motion it is a draft of has come: the robot sets out on it and goes over to the motion.

Usually the motion is there before the first frame is played. Where it comes later, or never (the generator was killed), the
draft is played, and what is left of the motion after it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import numpy as np

from daemon.generator.messages import Generated
from daemon.poses.pose_sequence import PoseSequence

MOST_TRIES = 5
"""A machine that is late so often plays the draft to its end."""


class PreviewSource:
    """A draft, then what follows it. In the event loop, but for `next`, which may run in a worker thread.

    Attributes:
        tries_left: how often the motion may still be tried to be put in the draft's place; 0 once it is there.
    """

    def __init__(
        self, draft: PoseSequence, whole: asyncio.Task[Generated], posture: Callable[[Generated], PoseSequence]
    ) -> None:
        """Begin with `draft`; `posture` is how what the generator gives is played."""
        self._draft, self._whole, self._posture = draft, whole, posture
        self._begun, self.tries_left = False, MOST_TRIES

    @property
    def ready(self) -> bool:
        """Whether the draft has not been given out, or it is known what follows it."""
        return not self._begun or self._whole.done()

    def next(self) -> tuple[PoseSequence, bool]:
        """The draft, or the motion if that is there already; then what the motion has after the draft."""
        if not self._begun:
            self._begun = True
            if not self._has_come:
                return self._draft, False
            self.tries_left = 0
            return self.rest(len(self._draft)), True
        return self.rest(0), True

    @property
    def may_go_over(self) -> bool:
        """Whether the motion has come, and the draft is being played."""
        return self._begun and self.tries_left > 0 and self._has_come

    @property
    def _has_come(self) -> bool:
        return self._whole.done() and not self._whole.cancelled() and self._whole.exception() is None

    def rest(self, n_left: int) -> PoseSequence:
        """What is to follow where `n_left` frames of the draft are left: of the motion, or of the draft if there is none."""
        of = self._posture(self._whole.result()) if self._has_come else self._draft
        place = len(self._draft) - n_left
        return of[place:] if place < len(of) else of.at(np.full(2, len(of) - 1))
