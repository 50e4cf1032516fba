"""Calls of both clients for composed or repeated motion: story, inbetween, edit, replay."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Generic, TypeVar, Unpack

from daemon.wire.events import Accepted, AnyEvent
from daemon.wire.requests import Edit, Inbetween, KeyPoseOf, Play, PlayOptions, Replay, SceneOf, Story

R = TypeVar("R")
REPLY_TIMEOUT_S = 5.0
"""Seconds to wait for a reply that depends on no motion."""
FIRST_REPLY_TIMEOUT_S = 15.0
"""Seconds to wait for the first event of a text: longer than the daemon waits for its generator."""
MOTION_TIMEOUT_S = 60.0
"""Seconds to wait for the end of a motion: the longest is 10 s, before which the robot may have to be armed."""
NOT_MOVING = ("limp", "idle", "holding", "fault", "estop")
"""States in which nothing is played."""


class CompositionCalls(Generic[R]):
    """Mixed into a client, whose `play` sends a request and returns its result."""

    def play(self, request: Play, *, wait: bool = True, timeout_s: float | None = None) -> R:
        """Send a request that plays something; each client implements this."""
        raise NotImplementedError

    def story(
        self,
        scenes: Sequence[str | tuple[str, float | None] | SceneOf],
        *,
        seed: int = 0,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> R:
        """Play several scenes one after the other in one motion.

        Args:
            scenes: texts, or (text, seconds).
            seed: seed of the story; equal scenes and seed give equal motions.
            wait: whether to return when the story has ended; else once it is accepted.
            timeout_s: seconds to wait for the end at most; None takes a time that fits the number of scenes.
            command_id: the same id twice is one command; empty chooses one.
            options: as for `say`; a story has no `hold`.

        Raises:
            RefusedError, CancelledByError, NoAnswerError: as for `say`.
            ValueError: options that contradict each other.
        """
        parts = [scene_of(scene) for scene in scenes]
        request = Story(id=command_id or uuid.uuid4().hex, scenes=parts, seed=seed, **options)
        return self.play(request, wait=wait, timeout_s=timeout_s)

    def inbetween(
        self,
        poses: Sequence[KeyPoseOf],
        text: str = "",
        *,
        seed: int = 0,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> R:
        """Pass poses at given times, e.g. `[KeyPoseOf(at_s=1, gesture="bow"), KeyPoseOf(at_s=2, standing=True)]`.

        Args:
            poses: the poses, in order of time.
            text: text of the motion between the poses.
            seed: seed of the motion; equal poses, text and seed give equal motions.
            wait: return when the motion has ended; else once it is accepted.
            timeout_s: longest wait for the end.
            command_id: the same id twice is one command; empty chooses one.
            options: as for `say`.

        Raises:
            RefusedError, CancelledByError, NoAnswerError: as for `say`.
            ValueError: poses or options that contradict each other.
        """
        request = Inbetween(id=command_id or uuid.uuid4().hex, poses=list(poses), text=text, seed=seed, **options)
        return self.play(request, wait=wait, timeout_s=timeout_s)

    def edit(
        self,
        text: str,
        *,
        gesture: str | None = None,
        command: str | None = None,
        plan: int | None = None,
        file: str | None = None,
        parts: Sequence[str] = (),
        start_s: float = 0.0,
        end_s: float | None = None,
        seed: int = 0,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> R:
        """Play a motion of which an interval or some parts of the body are generated anew for `text`.

        Args:
            text: text of the new part.
            gesture: name of the clip to edit, if it is a clip.
            command: id of the command whose motion is edited, if it is a command.
            plan: id of the plan whose motion is edited, if it is a plan.
            file: name of the file to edit in the daemon's folder of motions, if it is a file.
            parts: "upper", "lower", or parts of the model; empty for the whole body.
            start_s: start of the interval in the motion's own time, seconds.
            end_s: end of the interval, seconds; None is the end of the motion.
            seed: seed of the edit; equal motion, edit and seed give equal results.
            wait: return when the motion has ended; else once it is accepted.
            timeout_s: longest wait for the end.
            command_id: the same id twice is one command; empty chooses one.
            options: as for `say`.

        Raises:
            RefusedError, CancelledByError, NoAnswerError: as for `say`.
            ValueError: fields that contradict each other.
        """
        request = Edit(
            id=command_id or uuid.uuid4().hex, text=text, gesture=gesture, command=command, plan=plan, file=file,
            parts=list(parts), start_s=start_s, end_s=end_s, seed=seed, **options,
        )  # fmt: skip
        return self.play(request, wait=wait, timeout_s=timeout_s)

    def replay(
        self,
        *,
        command: str | None = None,
        plan: int | None = None,
        file: str | None = None,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> R:
        """Play a motion once more: that of a command, of a plan, or of a file in the daemon's folder of motions.

        Raises:
            RefusedError, CancelledByError, NoAnswerError: as for `say`.
            ValueError: fields that contradict each other.
        """
        request = Replay(id=command_id or uuid.uuid4().hex, command=command, plan=plan, file=file, **options)
        return self.play(request, wait=wait, timeout_s=timeout_s)


def scene_of(scene: str | tuple[str, float | None] | SceneOf) -> SceneOf:
    """A scene of a text, or of a text and its seconds."""
    if isinstance(scene, SceneOf):
        return scene
    text, seconds = (scene, None) if isinstance(scene, str) else scene
    return SceneOf(text=text, seconds=seconds)


def patience_s(request: Play) -> float:
    """Seconds to wait for a motion to end; infinite for a loop, and for a motion whose beginning is unknown."""
    if request.loop or request.when != "now":
        return float("inf")
    n = len(request.scenes) if isinstance(request, Story) else 1
    return MOTION_TIMEOUT_S * max(1.0, n * request.repeat / request.tempo)


def has_no_end(event: AnyEvent, request: Play) -> bool:
    """Whether a motion goes round until something ends it because its text says so ("keep waving"), not the request's `loop`."""
    return isinstance(event, Accepted) and event.goes_on and not request.loop
