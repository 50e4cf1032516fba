"""A source that is ready to be played, with the facts that its `accepted` event reports."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from daemon.generator.generated import Generated
from daemon.playback.sources.showing import Shows
from daemon.playback.sources.stream_source import StreamSource
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence
from daemon.state.ledger import Entry
from daemon.state.replies import NotPlayableError
from daemon.wire.events import Accepted, Rejected
from daemon.wire.requests import Command, Play, tag_of
from mmm_core.motion.motion import Motion
from mmm_core.recognition.seen import Scene

log = logging.getLogger(__name__)

OUT_OF_SCOPE_DO = "ask for gestures of head, arms and torso, in English, e.g. 'wave with your right hand'"


@dataclass(frozen=True)
class PreparedSource:
    """A source ready to be played, and the facts for its `accepted` event.

    Attributes:
        shows: finds what the motion shows, in some milliseconds and in any thread; None when `understood` says it all.
    """

    score: MotionSource | StreamSource
    duration_s: float
    status: str = "accepted"
    understood: str = ""
    reason: str = ""
    scope_score: float = 1.0
    generate_ms: float = 0.0
    silence_s: float | None = None
    nearest: str = ""
    commands: tuple[str, ...] = ()
    denied: tuple[str, ...] = ()
    shows: Callable[[], Shows] | None = None

    async def accepted(self, entry: Entry, plan_id: int) -> Accepted:
        """The `accepted` event; without a description when the motion cannot be read."""
        shows = Shows(self.understood, "")
        if self.shows is not None:
            try:
                shows = await asyncio.to_thread(self.shows)
            except Exception:  # the robot may be playing the motion already, which is sound
                log.exception("what the motion of %r shows could not be read", entry.request.words)
        return Accepted(
            plan_id=plan_id,
            text=entry.asked.words,
            status=self.status,
            understood=shows.sentence,
            reason=self.reason,
            scope_score=round(self.scope_score, 4),
            duration_s=round(self.duration_s, 3),
            generate_ms=round(self.generate_ms, 2),
            silence_s=self.silence_s,
            nearest=self.nearest,
            lacks=shows.lacks,
            commands=self.commands,
            denied=self.denied,
            refers_to=entry.refers_to,
            goes_on=isinstance(entry.request, Play) and entry.request.loop,
        )


def prepared_source(
    generated: Generated, score: MotionSource, duration_s: float, shows: Callable[[], Shows]
) -> PreparedSource:
    """A source with the generator's facts about its motion, and `shows` for its description."""
    motion, made_ms = generated.motion, sum(generated.timings_ms.values())
    return PreparedSource(
        score,
        duration_s,
        motion.status,
        reason=generated.reason,
        scope_score=motion.scope_score,
        generate_ms=made_ms,
        nearest=generated.understood,
        commands=generated.commands,
        denied=generated.denied,
        shows=shows,
    )


def scenes_or_whole(scenes: Sequence[Scene], motion: Motion, words: str) -> Sequence[Scene]:
    """The scenes of a motion; one scene for a motion without any."""
    return scenes or [Scene(motion.duration_s, words)]


def words_of(generated: Generated) -> str:
    """Words that may name what a generated motion shows: its text, and the nearest known command."""
    return f"{generated.motion.text}\n{generated.understood}"


def check_in_scope(entry: Entry, generated: Generated) -> None:
    """Raise NotPlayableError for a text that was rejected."""
    if generated.motion.status == "rejected":
        raise out_of_scope(entry, generated.reason, generated.understood, generated.motion.scope_score)


def out_of_scope(entry: Entry, reason: str, understood: str, score: float) -> NotPlayableError:
    """The error of a text that the model cannot carry out."""
    return NotPlayableError(Rejected(
        code="out_of_scope",
        asked=f"{tag_of(entry.request)} {entry.asked.words[:200]!r}",
        found=reason or "nothing the model knows",
        allowed="upper-body motion of one person without objects",
        do=OUT_OF_SCOPE_DO,
        understood=understood,
        scope_score=round(score, 4),
    ))  # fmt: skip


def performance_s(posture: PoseSequence, request: Command) -> float:
    """Seconds of a performance at the requested tempo, with its repetitions; of one round where it goes round for ever."""
    tempo, repeat = (request.tempo, request.repeat) if isinstance(request, Play) else (1.0, 1)
    return repeat * len(posture) / posture.fps / tempo
