"""Motions of the newest commands, which may later be kept as gestures, edited, or give a pose."""

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
    """The motion of a command.

    Attributes:
        words: text of the motion, a word or a sentence.
        posture: poses as played, with tempo, size and mirror.
        motion: motion as generated.
        scenes: parts of `posture` and the words that each was generated for.
        plan_id: number of its plan; 0 before it has one.
        in_full: `posture` with all its repetitions; None when it is played once, has several parts or is too long to be judged.
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
    """Motions by command; the oldest are forgotten. A story is not kept, because it may have any length."""

    def __init__(self) -> None:
        self._kept: OrderedDict[str, KeptMotion] = OrderedDict()

    def add(self, command_id: str, kept: KeptMotion) -> None:
        """Keep a command's motion."""
        self._kept[command_id] = kept
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)

    def renew(self, command_id: str, posture: PoseSequence, motion: Motion, scenes: Sequence[Scene]) -> None:
        """Replace the draft kept for a command by its motion, if it is still kept."""
        if command_id in self._kept:
            self._kept[command_id] = replace(self._kept[command_id], posture=posture, motion=motion, scenes=scenes)

    def number(self, command_id: str, plan_id: int) -> None:
        """Set the plan's number of a command's motion."""
        if command_id in self._kept:
            self._kept[command_id] = replace(self._kept[command_id], plan_id=plan_id)

    def newest(self) -> str | None:
        """Id of the newest command; None without one."""
        return next(reversed(self._kept), None)

    def of_command(self, command_id: str) -> KeptMotion | None:
        """The motion of a command; None when it is unknown or forgotten."""
        return self._kept.get(command_id)

    def of_plan(self, plan_id: int) -> KeptMotion | None:
        """The motion of a plan; None when it is unknown or forgotten."""
        return next((kept for kept in self._kept.values() if kept.plan_id == plan_id), None)

    def some(self) -> str:
        """Ids of the newest commands, for messages."""
        return ", ".join(list(self._kept)[-3:]) or "none yet"
