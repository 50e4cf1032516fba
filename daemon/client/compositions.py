"""Calls that both clients have for motion that is put together or played again: story, inbetween, edit, replay."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Generic, TypeVar, Unpack

from daemon.wire.requests import Edit, Inbetween, KeyPoseOf, Play, PlayOptions, Replay, SceneOf, Story

R = TypeVar("R")
REPLY_TIMEOUT_S = 5.0
"""For a reply that no motion has to be waited for."""
FIRST_REPLY_TIMEOUT_S = 15.0
"""For the first word about a text: longer than the daemon waits for its generator."""
MOTION_TIMEOUT_S = 60.0
"""For a motion to end: the longest is 10 s, before which the robot may have to be armed."""
NOT_MOVING = ("limp", "idle", "holding", "fault", "estop")
"""States in which nothing is played."""


class CompositionCalls(Generic[R]):
    """Mixed into a client, whose `play` sends a request and returns what became of it."""

    def play(self, request: Play, *, wait: bool = True, timeout_s: float | None = None) -> R:
        """Send a request that plays something; the client says how."""
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
        """Do one thing after the other in one motion.

        Args:
            scenes: texts, or (text, seconds).
            seed: the same scenes and seed give the same motion.
            wait: return when the story has ended; else once it is accepted.
            timeout_s: longest wait for the end; None takes one that fits the number of scenes.
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
        """Go through poses at given times, e.g. `[KeyPoseOf(at_s=1, gesture="bow"), KeyPoseOf(at_s=2, standing=True)]`.

        Args:
            poses: in order of time.
            text: what happens between them.
            seed: the same poses, text and seed give the same motion.
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
        """Play a motion of which a stretch or some parts of the body are made again for `text`.

        Args:
            text: what the new part is to be.
            gesture: what is edited: a named clip,
            command: or the motion of a command,
            plan: or of a plan,
            file: or a file in the daemon's folder of motions.
            parts: upper, lower, or parts of the model; none is all of the body.
            start_s: of the stretch, in the motion's own time.
            end_s: of the stretch; None is the end.
            seed: the same motion, edit and seed give the same result.
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
    """How long to wait for a motion to end: without limit where it has no end, or begins nobody knows when."""
    if request.loop or request.when != "now":
        return float("inf")
    n = len(request.scenes) if isinstance(request, Story) else 1
    return MOTION_TIMEOUT_S * max(1.0, n * request.repeat / request.tempo)
