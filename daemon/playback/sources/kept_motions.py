"""Motions of the newest commands, which may still be kept as gestures, edited, or give a pose."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace

from daemon.poses.pose_sequence import PoseSequence
from mmm_core.motion.motion import Motion
from mmm_core.recognition.seen import Scene

KEPT = 32


@dataclass(frozen=True)
class KeptMotion:
    """What a command played.

    Attributes:
        words: what it was, in a word or a sentence.
        posture: as it was played, with tempo, size and mirror.
        motion: as it was made.
        scenes: parts of `posture` and the words that each was made for.
        plan_id: number of its plan; 0 before it has one.
        in_full: `posture` with all its repetitions; None where it is played once, has several parts or is too long to be judged.
    """

    words: str
    posture: PoseSequence
    motion: Motion
    scenes: Sequence[Scene] = ()
    plan_id: int = 0
    in_full: PoseSequence | None = None

    @property
    def judged(self) -> tuple[PoseSequence, Sequence[Scene]]:
        """The poses by which a performance is judged, and their parts."""
        if self.in_full is None:
            return self.posture, self.scenes
        return self.in_full, [replace(self.scenes[0], end_s=len(self.in_full) / self.in_full.fps)]


class KeptMotions:
    """By command, the oldest are forgotten. A story is not kept: it has any length."""

    def __init__(self) -> None:
        self._kept: OrderedDict[str, KeptMotion] = OrderedDict()

    def add(self, command_id: str, kept: KeptMotion) -> None:
        """A command's motion was made."""
        self._kept[command_id] = kept
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)

    def renew(self, command_id: str, posture: PoseSequence, motion: Motion, scenes: Sequence[Scene]) -> None:
        """What was kept of a command, if it still is, was a draft of this."""
        if command_id in self._kept:
            self._kept[command_id] = replace(self._kept[command_id], posture=posture, motion=motion, scenes=scenes)

    def number(self, command_id: str, plan_id: int) -> None:
        """Its plan got a number."""
        if command_id in self._kept:
            self._kept[command_id] = replace(self._kept[command_id], plan_id=plan_id)

    def newest(self) -> str | None:
        """Id of the newest command."""
        return next(reversed(self._kept), None)

    def of_command(self, command_id: str) -> KeptMotion | None:
        """What a command played; None when it is not known, or no longer."""
        return self._kept.get(command_id)

    def of_plan(self, plan_id: int) -> KeptMotion | None:
        """The motion of a command, by the number of its plan."""
        return next((kept for kept in self._kept.values() if kept.plan_id == plan_id), None)

    def some(self) -> str:
        """Ids of the newest, for messages."""
        return ", ".join(list(self._kept)[-3:]) or "none yet"
