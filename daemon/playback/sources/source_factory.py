"""Makes the source of each command: from the generator for texts, stories, edits and poses, from the library for gestures.

A new kind of command is added here first.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from daemon.errors import ClipError
from daemon.generator.client import GeneratorClient
from daemon.generator.generated import Generated, GeneratorError, no_answer
from daemon.gestures.library import GestureLibrary
from daemon.playback.sources.clip_source import ClipSource, in_full, varied
from daemon.playback.sources.kept_motions import KeptMotion, KeptMotions
from daemon.playback.sources.originals import Originals
from daemon.playback.sources.prepared_source import (
    PreparedSource,
    check_in_scope,
    out_of_scope,
    performance_s,
    prepared_source,
    scenes_or_whole,
    words_of,
)
from daemon.playback.sources.preview_source import PreviewSource
from daemon.playback.sources.showing import LONGEST_S, Showing, Shows, Verdict, at_tempo
from daemon.playback.sources.story_source import SceneNews, StorySource
from daemon.playback.sources.stream_source import StreamSource
from daemon.poses.aliveness import Aliveness
from daemon.poses.cycles import Marks
from daemon.poses.key_poses import KeyPose, led_through
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, joined, mirrored, posture_of
from daemon.settings.config import DaemonConfig
from daemon.state.lease import LeaseClock
from daemon.state.ledger import Entry
from daemon.state.replies import NotPlayableError, generator_failed, too_late
from daemon.wire.events import Rejected
from daemon.wire.requests import Edit, Gesture, Inbetween, Lease, Play, Replay, Say, Story, tag_of
from mmm_core.language.mirroring import mirror_words
from mmm_core.motion.motion import Motion
from mmm_core.recognition.seen import Scene
from retarget.path.safety_filter import SafetyFilter
from retarget.robot.robot import RobotModel

PREFIX_FRAMES = 32
"""Number of frames of the running motion sent to the generator, however short the prefix: ids depend on the frames before."""
FIRST_MAKE_S = 0.1
"""Seconds assumed until a motion with a prefix is generated; later ones are measured."""
_THEIRS = ("bad_edit", "bad_keyframes", "not_reached")
"""Codes of errors caused by the request, not by the generator."""
T = TypeVar("T")


class Played(Protocol):
    """The motion that is played, as far as a source needs it."""

    @property
    def raw_now(self) -> PoseSequence:
        """One frame of the pose that the robot shows, without layers."""
        ...

    def committed(self, n: int, ahead_s: float) -> PoseSequence:
        """`n` frames up to the splice of a motion that takes `ahead_s` seconds to generate."""
        ...


class SourceFactory:
    """Turns requests into sources."""

    def __init__(
        self, config: DaemonConfig, robot: RobotModel, generator: GeneratorClient, library: GestureLibrary
    ) -> None:
        self._config, self._generator, self.library = config, generator, library
        self.kept = KeptMotions()
        self._aliveness = Aliveness(config.alive)
        self._showing = Showing(robot)
        self._robot = robot
        self._make_s = FIRST_MAKE_S
        self._originals = Originals(library, self.kept, config.motions or Path())

    async def prepare(self, entry: Entry, played: Played) -> PreparedSource:
        """The source of a command's motion.

        Raises:
            NotPlayableError: the command has no motion; the error's event ends it.
        """
        request = entry.request
        if isinstance(request, Say):
            return await self._said(entry, request, played)
        if isinstance(request, Story):
            return await self._story(entry, request)
        if isinstance(request, Inbetween):
            return await self._inbetween(entry, request, played.raw_now)
        if isinstance(request, Edit):
            return await self._edit(entry, request)
        if isinstance(request, Replay):
            motion = await asyncio.to_thread(self._originals.motion, request)
            posture = await asyncio.to_thread(posture_of, motion)
            score, shows = await self._score(entry, posture, motion, words=motion.text)
            return PreparedSource(score, performance_s(posture, request), nearest=motion.text, shows=shows)
        if isinstance(request, Gesture):
            clip = self._originals.clip(request.name)
            motion = clip.posture.motion(text=clip.name)
            score, shows = await self._score(entry, clip.posture, motion, marks=clip.marks, words=clip.text)
            nearest = f"{clip.text} (gesture {clip.name})"
            return PreparedSource(score, performance_s(clip.posture, request), nearest=nearest, shows=shows)
        if isinstance(request, Lease):
            return await self._lease(request)
        raise TypeError(f"no source for {type(request).__name__}")

    def keep(self, name: str, command_id: str, *, replace: bool = False) -> str:
        """Keep the motion of a command (the newest when the id is empty) as a gesture; returns the text of the motion.

        Raises:
            GestureExistsError: the name is taken, and `replace` is not given.
            ClipError: the motion is unknown, or cannot be kept.
        """
        key = command_id or self.kept.newest()
        kept = self.kept.of_command(key) if key else None
        if key is None or kept is None:
            raise ClipError(f"no motion of command {command_id!r} to keep; the newest: {self.kept.some()}; "
                            "`mmmd say` one first")  # fmt: skip
        self.library.keep(name, kept.words, kept.posture, f"command {key}", replace=replace)
        return kept.words

    async def _generated(
        self, entry: Entry, ask: Callable[[float], Awaitable[Generated]], keys: list[KeyPose] | None = None
    ) -> PreparedSource:
        """The source of the generator's motion for one request, led through `keys`."""
        generated = await self._asked(entry, ask)
        check_in_scope(entry, generated)
        motion, play = generated.motion, entry.request
        assert isinstance(play, Play), "only motions are generated"
        goes_round = play.loop or play.hold  # a sway has another period than the strokes
        posture = posture_of(motion) if goes_round else self._aliveness.posture_of(motion)
        if keys:
            posture = led_through(posture, keys)
            motion = posture.motion(motion)
        score, shows = await self._score(entry, posture, motion, generated.scenes, words=words_of(generated))
        return prepared_source(generated, score, performance_s(posture, entry.request), shows)

    def verdict(self, entry: Entry, q_rad: NDArray[np.float64], fps: float) -> Verdict:
        """Judge whether the robot has shown what a command's motion shows.

        Args:
            entry: the command.
            q_rad: (T, J) goals that the robot was given for it, radians.
            fps: number of goals a second.
        """
        kept, held = self.kept.of_command(entry.id), isinstance(entry.request, Play) and entry.request.hold
        return Verdict() if kept is None else self._showing.verdict(*kept.judged, q_rad, fps, held=held)

    async def _drafted(self, entry: Entry, request: Say) -> PreparedSource:
        """The source of a preview that can be played at once, while the generator goes on with the motion."""
        ask = self._generator.draft
        first, whole = await self._asked(entry, lambda t: ask(request.text, request.seed, request.seconds, t))
        check_in_scope(entry, first)
        draft = self._aliveness.posture_of(first.motion)
        score, shows = await self._score(
            entry, draft, first.motion, first.scenes, words=words_of(first), draft=whole is not None
        )
        if whole is None:
            return prepared_source(first, score, performance_s(draft, request), shows)

        def posture(generated: Generated) -> PoseSequence:
            return varied(self._aliveness.posture_of(generated.motion), request)

        def keep(done: asyncio.Task[Generated]) -> None:
            if not done.cancelled() and done.exception() is None:
                made = done.result()
                as_played = posture(made)
                scenes = at_tempo(scenes_or_whole(made.scenes, made.motion, words_of(made)), request.tempo)
                self.kept.renew(entry.id, as_played, made.motion, scenes)

        whole.add_done_callback(keep)
        duration_s = first.draft_of / draft.fps / request.tempo
        return prepared_source(first, PreviewSource(varied(draft, request), whole, posture), duration_s, shows)

    async def _said(self, entry: Entry, request: Say, played: Played) -> PreparedSource:
        ask = self._generator.generate
        if not request.prefix_s:
            if request.when == "now" and not (request.loop or request.hold or request.repeat > 1):
                return await self._drafted(entry, request)
            return await self._generated(entry, lambda t: ask(request.text, request.seed, request.seconds, t))
        before, began_s = played.committed(PREFIX_FRAMES, self._make_s), time.monotonic()
        motion, prefix_s = (mirrored(before) if request.mirror else before).motion(), request.prefix_s
        prepared = await self._generated(
            entry, lambda t: ask(request.text, request.seed, request.seconds, t, before=motion, prefix_s=prefix_s)
        )
        self._make_s += 0.3 * (time.monotonic() - began_s - self._make_s)
        return prepared

    async def _lease(self, request: Lease) -> PreparedSource:
        silence_s = self._config.lease_s if request.silence_s is None else request.silence_s
        guard = await asyncio.to_thread(SafetyFilter, self._robot)
        clock = LeaseClock(silence_s, self._config.lease_park_s)
        score = StreamSource(self._robot, guard, clock, request.holder)
        understood = f"joint targets to {self._config.endpoints.stream}, at least one every {silence_s:g} s"
        return PreparedSource(score, 0.0, understood=understood, silence_s=silence_s)

    async def _story(self, entry: Entry, request: Story) -> PreparedSource:
        score = StorySource(request, self._generator, self._config.generate_timeout_s, self._aliveness)

        async def begin(timeout_s: float) -> list[SceneNews]:
            async with asyncio.timeout(timeout_s):
                return await score.begin()

        news = await self._asked(entry, begin)
        away = [f"scene {n.number} ({n.text[:40]!r}) is left out: {n.reason}" for n in news if n.status == "rejected"]
        if score.empty:
            raise out_of_scope(entry, "; ".join(away)[:1000], news[0].understood, max(n.scope_score for n in news))
        first = next(n for n in news if n.status != "rejected")
        status = "degraded" if any(n.status != "accepted" for n in news) else "accepted"
        reason = "; ".join([*away, *(n.reason for n in news if n.status == "degraded")])[:1000]
        return PreparedSource(score, 0.0, status, first.understood, reason, first.scope_score, score.generate_ms)

    async def _inbetween(self, entry: Entry, request: Inbetween, now: PoseSequence) -> PreparedSource:
        keys = [self._originals.pose(asked) for asked in request.poses]
        if keys[0].at_s >= 1 / now.fps:
            near = keys[0].at_s < 0.2  # within the motion's first token: the first pose serves as the start too
            keys = keys if near else [KeyPose(0.0, now), *keys]
        poses = joined([key.pose for key in keys]).motion()
        at_s = [key.at_s for key in keys]
        ask = self._generator.between
        return await self._generated(entry, lambda t: ask(poses, at_s, request.text, request.seed, t), keys)

    async def _edit(self, entry: Entry, request: Edit) -> PreparedSource:
        motion = await asyncio.to_thread(self._originals.motion, request)
        what = (request.parts, request.start_s, request.end_s)
        ask = self._generator.edit
        return await self._generated(entry, lambda t: ask(motion, request.text, request.seed, *what, t))

    async def _asked(self, entry: Entry, ask: Callable[[float], Awaitable[T]]) -> T:
        """The generator's answer, within its time-out and the command's deadline.

        Raises:
            NotPlayableError: the generator failed, refused, or did not answer in time.
        """
        timeout_s, limited = self._config.generate_timeout_s, False
        if entry.request.deadline_s is not None:
            left_s = entry.deadline_s - time.monotonic()
            timeout_s, limited = (left_s, True) if left_s < timeout_s else (timeout_s, False)
        if timeout_s <= 0:
            raise too_late(entry, "no time left to generate it")
        try:
            return await ask(timeout_s)
        except (GeneratorError, TimeoutError) as caught:
            error = caught if isinstance(caught, GeneratorError) else no_answer(tag_of(entry.request), timeout_s)
            if limited and error.code == "generator_timeout":
                raise too_late(entry, "it was not generated in time") from caught
            if error.code in _THEIRS:
                event = Rejected(
                    code=error.code, asked=error.asked, found=error.found, allowed=error.allowed, do=error.do
                )
                raise NotPlayableError(event) from caught
            raise NotPlayableError(generator_failed(error, self._generator.state)) from caught

    async def _score(
        self, entry: Entry, posture: PoseSequence, motion: Motion, scenes: Sequence[Scene] = (), *, words: str,
        marks: Marks | None = None, draft: bool = False,
    ) -> tuple[MotionSource, Callable[[], Shows]]:  # fmt: skip
        """The source of a motion, and a function that describes the motion; the motion is kept under the command's id.

        Args:
            entry: the command.
            posture: the motion before mirror, size and tempo.
            motion: the motion as generated.
            scenes: its parts; empty for a motion of one part, which `words` describe.
            words: text of the motion; the command's own words when empty.
            marks: loop and hold of a clip; None finds them.
            draft: whether the motion is a draft of one to come.
        """
        play = entry.request
        assert isinstance(play, Play), "only motions have a score of posture"
        said = words if isinstance(play, Gesture) and words else play.words
        said = mirror_words(said) if play.mirror else said
        as_played = varied(posture, play)
        parts = at_tempo(scenes_or_whole(scenes, motion, words or play.words), play.tempo)
        kept = KeptMotion(said, as_played, motion, parts)
        if not (play.loop or play.hold or play.repeat > 1):
            self.kept.add(entry.id, kept)
            return ClipSource(posture, play, marks), partial(self._showing.of, as_played, parts, draft=draft)
        score = await asyncio.to_thread(ClipSource, posture, play, marks)  # finding the loop takes a while
        if play.repeat > 1 and len(parts) == 1:
            whole = await asyncio.to_thread(in_full, posture, play, score.marks, LONGEST_S)
            kept = replace(kept, in_full=whole)
        self.kept.add(entry.id, kept)
        uncounted = draft or play.loop or (play.repeat > 1 and kept.in_full is None)
        return score, partial(self._showing.of, *kept.judged, draft=uncounted)
