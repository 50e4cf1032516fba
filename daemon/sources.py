"""Where motions come from: the generator for texts, the library for gestures. A new kind of command begins here."""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict
from dataclasses import dataclass

from daemon.config import DaemonConfig
from daemon.errors import ClipError, UnknownGestureError
from daemon.events import Accepted, Failed, Rejected
from daemon.generation import GeneratorClient, GeneratorError
from daemon.gestures.library import GestureLibrary
from daemon.ledger import Entry
from daemon.posture import Posture, posture_of
from daemon.replies import NotPlayableError, too_late
from daemon.requests import Gesture, Play, Say
from daemon.score import ClipScore, Marks, Score, varied

OUT_OF_SCOPE_DO = "ask for gestures of head, arms and torso, in English, e.g. 'wave with your right hand'"
KEPT = 32
"""Motions of the newest commands, which may still be kept as gestures."""


@dataclass(frozen=True)
class Prepared:
    """A motion ready to be played, and what is told about it when it is accepted."""

    score: Score
    duration_s: float
    status: str = "accepted"
    understood: str = ""
    reason: str = ""
    scope_score: float = 1.0
    generate_ms: float = 0.0

    def accepted(self, entry: Entry, plan_id: int) -> Accepted:
        """The event."""
        return Accepted(
            plan_id=plan_id,
            text=entry.request.words,
            status=self.status,
            understood=self.understood,
            reason=self.reason,
            scope_score=round(self.scope_score, 4),
            duration_s=round(self.duration_s, 3),
            generate_ms=round(self.generate_ms, 2),
        )


class Sources:
    """Turns requests into scores."""

    def __init__(self, config: DaemonConfig, generator: GeneratorClient, library: GestureLibrary) -> None:
        self._config, self._generator, self.library = config, generator, library
        self._kept: OrderedDict[str, tuple[str, Posture]] = OrderedDict()

    async def prepare(self, entry: Entry) -> Prepared:
        """The motion of a command.

        Raises:
            NotPlayableError: there is none; its event ends the command.
        """
        request = entry.request
        if isinstance(request, Say):
            return await self._say(entry, request)
        if isinstance(request, Gesture):
            return await self._gesture(entry, request)
        raise TypeError(f"no source for {type(request).__name__}")

    def keep(self, name: str, command_id: str) -> str:
        """Keep the motion of a command (the newest when the id is empty) as a gesture; what it shows.

        Raises:
            ClipError: there is no such motion, or it cannot be kept.
        """
        if not self._kept or (command_id and command_id not in self._kept):
            known = ", ".join(list(self._kept)[-3:]) or "none yet"
            raise ClipError(f"no motion of command {command_id!r} to keep; the newest: {known}; `mmmd say` one first")
        key = command_id or next(reversed(self._kept))
        text, posture = self._kept[key]
        self.library.keep(name, text, posture, f"command {key}")
        return text

    async def _say(self, entry: Entry, request: Say) -> Prepared:
        timeout_s, limited = self._config.generate_timeout_s, False
        if request.deadline_s is not None:
            left_s = entry.deadline_s - time.monotonic()
            timeout_s, limited = (left_s, True) if left_s < timeout_s else (timeout_s, False)
        if timeout_s <= 0:
            raise too_late(entry, "no time left to generate it")
        try:
            generated = await self._generator.generate(request.text, request.seed, request.seconds, timeout_s)
        except GeneratorError as error:
            if limited and error.code == "generator_timeout":
                raise too_late(entry, "it was not generated in time") from error
            found = f"{error.found} (generator: {self._generator.state})"
            event = Failed(code=error.code, asked=error.asked, found=found, allowed=error.allowed, do=error.do)
            raise NotPlayableError(event) from error
        motion = generated.motion
        if motion.status == "rejected":
            rejected = Rejected(
                code="out_of_scope",
                asked=f"say {request.text!r}",
                found=generated.reason or "nothing the model knows",
                allowed="upper-body motion of one person without objects",
                do=OUT_OF_SCOPE_DO,
                understood=generated.understood,
                scope_score=round(motion.scope_score, 4),
            )
            raise NotPlayableError(rejected)
        posture = posture_of(motion)
        return Prepared(
            await self._score(entry, posture),
            _duration_s(posture, request),
            motion.status,
            generated.understood,
            generated.reason,
            motion.scope_score,
            sum(generated.timings_ms.values()),
        )

    async def _gesture(self, entry: Entry, request: Gesture) -> Prepared:
        try:
            clip = self.library.get(request.name)
        except UnknownGestureError as error:
            near = ", ".join(error.near) or "see `mmmd gesture list`"
            event = Rejected(
                code="unknown_gesture", asked=f"gesture {request.name!r}", found="no gesture of that name", allowed=near,
                do="`mmmd gesture list` shows all",
            )  # fmt: skip
            raise NotPlayableError(event) from error
        except ClipError as error:
            event = Failed(code="bad_gesture", asked=f"gesture {request.name!r}", found=str(error), allowed="", do="")
            raise NotPlayableError(event) from error
        score = await self._score(entry, clip.posture, clip.marks)
        return Prepared(score, _duration_s(clip.posture, request), understood=f"{clip.text} (gesture {clip.name})")

    async def _score(self, entry: Entry, posture: Posture, marks: Marks | None = None) -> Score:
        play = entry.request
        self._kept[entry.id] = (play.words, varied(posture, play))
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)
        if play.loop or play.hold or play.repeat > 1:  # looking for the loop takes a while
            return await asyncio.to_thread(ClipScore, posture, play, marks)
        return ClipScore(posture, play, marks)


def _duration_s(posture: Posture, play: Play) -> float:
    """Length of one performance at the asked tempo."""
    return len(posture) / posture.fps / play.tempo
