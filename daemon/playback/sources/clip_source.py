"""A clip as a source of poses: played once, several times, or for ever."""

from __future__ import annotations

import numpy as np

from daemon.poses.cycles import Marks, after_loop, closed, marks_of
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, at_tempo, faded_in, joined, mirrored, scaled
from daemon.wire.requests import Play

AGAIN_FADE_FRAMES = 8
"""Number of frames over which a motion without a loop is blended out of its own end when it is repeated."""
LOOP_STRETCH_S = 1.5
"""Seconds of a segment at least: repetitions are joined to reach this length."""


class ClipSource(MotionSource):
    """Gives the poses of a clip as the options of `Play` require.

    Attributes:
        marks: loop and hold of the clip.
    """

    def __init__(self, posture: PoseSequence, play: Play, marks: Marks | None = None) -> None:
        needed = play.loop or play.hold or play.repeat > 1
        self.marks = marks or (marks_of(posture) if needed else Marks(None, len(posture) - 1))
        self._posture, self._play = posture, play
        self._rounds_left = -1 if play.loop else play.repeat - 1
        self._begun = False

    def next(self) -> tuple[PoseSequence, bool]:
        stretch, last = self._next()
        return varied(stretch, self._play), last

    def finish(self) -> None:
        """Stop repeating: the next segment leads to the end."""
        self._rounds_left = 0

    def _next(self) -> tuple[PoseSequence, bool]:
        p, loop = self._posture, self.marks.loop
        begun, self._begun = self._begun, True
        end = self.marks.hold + 1 if self._play.hold else len(p)
        if not self._rounds_left:
            if not begun or loop is None:
                return (p[:end] if not begun else self._again(end)), True
            return self._last_rounds()
        if loop is None:  # the whole clip is repeated, blended out of its own end
            stretch = self._again(len(p)) if begun else p
            self._rounds_left -= 1
            return stretch, False
        if not begun:
            head = p[: loop[0]]
            whole = joined([head, closed(p, loop)]) if len(head) else closed(p, loop)
            return whole, False
        rounds = self._take_rounds(loop)
        return closed(p, loop).at(np.arange(rounds * (loop[1] - loop[0])) % (loop[1] - loop[0])), False

    def _take_rounds(self, loop: tuple[int, int]) -> int:
        wanted = max(1, round(LOOP_STRETCH_S * self._posture.fps / (loop[1] - loop[0])))
        rounds = wanted if self._rounds_left < 0 else min(wanted, self._rounds_left)
        if self._rounds_left > 0:
            self._rounds_left -= rounds
        return rounds

    def _last_rounds(self) -> tuple[PoseSequence, bool]:
        loop = self.marks.loop
        assert loop is not None, "asked only of a clip that goes round"
        tail = after_loop(self._posture, loop)
        if self._play.hold:  # held in the loop or after it: one more repetition up to the frame to hold
            a, b = loop
            hold = self.marks.hold
            tail = closed(self._posture, loop)[: hold - a + 1] if a <= hold < b else tail[: max(1, hold - b + 1)]
        if not len(tail):
            tail = closed(self._posture, loop)
        return tail, True

    def _again(self, end: int) -> PoseSequence:
        p = self._posture
        return faded_in(p[:end], p[len(p) - 1 :], AGAIN_FADE_FRAMES)


def in_full(posture: PoseSequence, play: Play, marks: Marks, longest_s: float) -> PoseSequence | None:
    """All poses of a clip with its repetitions, as `play` requires; None for an endless one or more than `longest_s` seconds."""
    if play.loop or play.repeat * len(posture) > 4 * longest_s * posture.fps:
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
