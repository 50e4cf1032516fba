"""A clip as a source of poses: played once, several times, or for ever."""

from __future__ import annotations

import numpy as np

from daemon.poses.cycles import Marks, after_loop, closed, marks_of
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, at_tempo, faded_in, joined, mirrored, scaled
from daemon.wire.requests import Play

AGAIN_FADE_FRAMES = 8
"""Number of frames over which a motion is blended out of its own end when it is repeated."""
LOOP_STRETCH_S = 1.5
"""Seconds of a segment at least: repetitions are joined to reach this length."""


class ClipSource(MotionSource):
    """Gives the poses of a clip as the options of `Play` require.

    Attributes:
        marks: loop and hold of the clip.
    """

    def __init__(self, posture: PoseSequence, play: Play, marks: Marks | None = None) -> None:
        needed = play.loop or play.hold
        self.marks = marks or (marks_of(posture) if needed else Marks(None, len(posture) - 1))
        self._posture, self._play = posture, play
        self._goes_round = play.loop
        self._n_left = play.repeat
        self._begun = False

    def next(self) -> tuple[PoseSequence, bool]:
        stretch, last = self._next()
        return varied(stretch, self._play), last

    def finish(self) -> None:
        """Stop repeating: the next segment leads to the end."""
        self._goes_round, self._n_left = False, 1

    def _next(self) -> tuple[PoseSequence, bool]:
        loop, begun = self.marks.loop, self._begun
        self._begun = True
        if self._play.loop and loop is not None:
            if self._goes_round:
                return (self._rounds(loop) if begun else self._first_round(loop)), False
            if begun:
                return self._after_rounds(loop), True
        self._n_left -= not self._goes_round
        last = not self._n_left
        end = self.marks.hold + 1 if self._play.hold and last else len(self._posture)
        return (self._again(end) if begun else self._posture[:end]), last

    def _first_round(self, loop: tuple[int, int]) -> PoseSequence:
        """The motion up to the end of the part that can loop."""
        return joined([self._posture[: loop[0]], closed(self._posture, loop)])

    def _rounds(self, loop: tuple[int, int]) -> PoseSequence:
        """Rounds of the part that can loop."""
        n_frames = loop[1] - loop[0]
        n_rounds = max(1, round(LOOP_STRETCH_S * self._posture.fps / n_frames))
        return closed(self._posture, loop).at(np.arange(n_rounds * n_frames) % n_frames)

    def _after_rounds(self, loop: tuple[int, int]) -> PoseSequence:
        """What follows the last round; another round where the motion ends with it."""
        tail = after_loop(self._posture, loop)
        return tail if len(tail) else closed(self._posture, loop)

    def _again(self, end: int) -> PoseSequence:
        """The motion up to a frame, blended out of its own end."""
        p = self._posture
        return faded_in(p[:end], p[len(p) - 1 :], AGAIN_FADE_FRAMES)


def in_full(posture: PoseSequence, play: Play, marks: Marks, longest_s: float) -> PoseSequence | None:
    """All poses of a clip with its repetitions, as `play` requires; None for an endless one or more than `longest_s` seconds."""
    if play.loop or (play.repeat - 1) * len(posture) > longest_s * posture.fps:
        return None
    source = ClipSource(posture, play, marks)
    stretches: list[PoseSequence] = []
    last = False
    while not last:
        stretch, last = source.next()
        stretches.append(stretch)
    whole = joined(stretches)
    return whole if len(whole) <= longest_s * posture.fps else None


def varied(p: PoseSequence, play: Play) -> PoseSequence:
    """`p` with mirror, size and tempo of `play`."""
    if play.mirror:
        p = mirrored(p)
    if play.amplitude != 1.0:
        p = scaled(p, play.amplitude)
    if play.tempo != 1.0:
        p = at_tempo(p, play.tempo)
    return p
