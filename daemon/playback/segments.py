"""What is played, made into pieces of path: a stretch after the other, and again where the gaze or a draft's motion changes it.

For the event loop, under the player's lock; retargeting itself runs in a worker thread, one piece at a time.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterator

from daemon.playback.setpoint_buffer import FADE_FRAMES, SetpointBuffer, SplicePoint
from daemon.playback.sources.clip_source import MotionSource
from daemon.playback.sources.preview_source import PreviewSource
from daemon.playback.trajectory import Chunk
from daemon.poses.layers import Layers
from daemon.poses.pose_sequence import PoseSequence, distance_deg, faded_in

_EASY_DEG_S = 60.0
"""Idle movements lead back to standing no faster."""


class Segments:
    """Of one plan at a time."""

    def __init__(self, planner: SetpointBuffer, layers: Layers) -> None:
        self._planner, self._layers = planner, layers
        self._pieces: Iterator[Chunk] | None = None
        self._is_last = False

    @property
    def unfinished(self) -> bool:
        """Whether of the stretch that is played there are pieces still to be made."""
        return self._pieces is not None

    def forget(self) -> None:
        """What was to come is not wanted any more."""
        self._pieces = None

    def making(self, raw: PoseSequence, start: SplicePoint, *, complete: bool, easy: bool = False) -> Iterator[Chunk]:
        """The path of a stretch, growing out of what was before, piece by piece. Asked for in a worker thread.

        Args:
            raw: the stretch without layers.
            start: where the path begins.
            complete: whether the plan ends with it.
            easy: lead there slowly.
        """
        posture = self._layers.over(raw)
        if start.before is not raw:
            n = FADE_FRAMES
            if easy:
                far_deg = float(distance_deg(start.before[-1:], posture[:1])[0])
                n = max(n, math.ceil(far_deg / _EASY_DEG_S * posture.fps))
            posture = faded_in(posture, start.before, n)
        yield from self._planner.pieces(posture, raw, start.state, complete=complete)

    def go_on(self, pieces: Iterator[Chunk], made: Chunk, *, is_last: bool) -> None:
        """Keep what is left of a stretch of which one piece is made, and whether it is the plan's last."""
        self._pieces, self._is_last = None if made.is_last else pieces, is_last

    async def append(self, score: MotionSource, wanted: Callable[[], bool]) -> None:
        """Make the next piece of the plan, of the next stretch where need be, and append it if it is still wanted then.

        Raises:
            NotPlayableError: there is no next stretch; its event ends the command.
            RetargetError: it does not fit the robot.
        """
        plan = self._planner.current
        if plan is None or plan.complete or plan.end is not None:
            return
        pieces, last = self._pieces, self._is_last
        if pieces is None:
            raw, last = await asyncio.to_thread(score.next)
            start = SplicePoint(plan.state_at(plan.n_frames - 1), raw, plan.n_frames - 1)
            pieces = self.making(raw, start, complete=last)
        piece = await asyncio.to_thread(next, pieces)
        if plan is self._planner.current and plan.epoch == self._planner.epoch and wanted():
            plan.append(piece)
            self.go_on(pieces, piece, is_last=last)
            self._planner.pump()

    async def make_again(self, draft: PreviewSource | None = None, *, took_s: float = 0.0) -> bool:
        """What is left of the plan, with the layers as they now are; of a draft, the motion that it was of.

        Whether that is what is played now.

        Args:
            draft: what is played, where its motion has come.
            took_s: an attempt before, which came too late.

        Raises:
            RetargetError: it does not fit the robot.
        """
        if self._planner.dry:
            return False
        start = self._planner.hand_over(took_s=took_s)
        plan = self._planner.current
        if plan is None or start.frame is None:
            return False
        last, rest = self._is_last, plan.rest_raw(start.frame)
        if draft is not None:
            last, rest = True, draft.rest(len(rest))
        pieces = self.making(rest, start, complete=last)
        piece = await asyncio.to_thread(next, pieces)
        if plan is not self._planner.current or plan.epoch != self._planner.epoch or self._planner.hand_over_missed:
            self._planner.give_up()
            return False
        self._planner.go_on_otherwise(piece)
        self.go_on(pieces, piece, is_last=last)
        return True
