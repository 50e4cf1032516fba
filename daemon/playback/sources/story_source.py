"""A story as a source of poses: scenes are requested from the generator a few seconds ahead of the ones being played.

The generator's state comes back with each scene and is sent with the next request, so that the daemon keeps two segments and a
few hundred bytes however long the story is. When the generator is lost, the robot brakes and holds, and the story continues once
there is a generator again.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from dataclasses import dataclass

import numpy as np

from daemon.generator.client import GeneratorClient
from daemon.generator.generated import Generated, GeneratorError
from daemon.poses.aliveness import Aliveness
from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, at_steps, joined, mirrored, scaled, standing
from daemon.state.replies import NotPlayableError, generator_failed
from daemon.wire.events import Progress
from daemon.wire.requests import Story
from mmm_core.language.command_changes import NothingToReferToError
from mmm_core.language.commands import Reading, exactly
from mmm_core.language.context import in_context
from mmm_core.language.reading import read
from mmm_core.recognition.seen import Scene, scenes_seen, sentence

log = logging.getLogger(__name__)

PIECES_AHEAD = 2
"""Number of segments kept ready; a `say` that barges in waits for one scene's request at most."""
SHORTEST_FRAMES = 16
"""Number of frames of a segment at least: shorter scenes are joined to the next one."""
PATIENCE_S = 60.0
"""Seconds that a story waits for a lost generator."""
RETRY_S = 0.2
AFTER_TIMEOUT_S = 2.0
"""Seconds before the next request after a time-out: the generator is started again within about a second, and an earlier request
would get no answer either."""
_LOST = ("generator_down", "generator_timeout")


@dataclass(frozen=True)
class SceneNews:
    """The generator's judgement of a scene.

    Attributes:
        number: number of the scene in the story, from 1 in each repetition.
        text: text of the scene.
        status: "accepted", "degraded", or "rejected" for a scene that is left out.
        reason: why it is not accepted; else empty.
        understood: text of what the scene's motion shows.
        scope_score: score of the text against the known commands.
    """

    number: int
    text: str
    status: str
    reason: str
    understood: str
    scope_score: float


@dataclass(frozen=True)
class _Piece:
    posture: PoseSequence
    last: bool
    news: tuple[SceneNews, ...]


class StorySource(MotionSource):
    """Gives the poses of a story as the options of `Play` require."""

    def __init__(
        self, request: Story, generator: GeneratorClient, timeout_s: float, aliveness: Aliveness | None = None
    ) -> None:
        self._request, self._generator, self._timeout_s = request, generator, timeout_s
        self._aliveness = aliveness or Aliveness(on=False)
        n_scenes = len(request.scenes)
        self._n_all = None if request.loop else n_scenes * request.repeat
        self._n_asked = self._n_barren = 0
        self._before: Reading | None = None
        self._asked_as = (-1, "")
        self._parts: list[PoseSequence] = []
        self._news: list[SceneNews] = []
        self._told = b""
        self._complete = False
        self._pieces: deque[_Piece] = deque()
        self._task: asyncio.Task[None] | None = None
        self._failure: NotPlayableError | None = None
        self._tempo = _Tempo(request.tempo)
        self._unreported: deque[SceneNews] = deque()
        self.generate_ms = 0.0

    async def begin(self) -> list[SceneNews]:
        """Make the first segment; returns the judgements of the scenes up to it.

        Raises:
            NotPlayableError: the generator failed.
            GeneratorError: the generator is down, or did not answer in time.
        """
        await self._make()
        return list(self._pieces[0].news)

    @property
    def empty(self) -> bool:
        """Whether the story ended without a frame, because every scene was left out."""
        return self._complete and not any(len(piece.posture) for piece in self._pieces)

    @property
    def ready(self) -> bool:
        """Whether a segment is ready, or the error that ends the story; requests the next scenes as a side effect."""
        if self._task is not None and self._task.done():
            self._task = None
        if self._task is None and self._failure is None and not self._complete and len(self._pieces) < PIECES_AHEAD:
            self._task = asyncio.create_task(self._make_patiently())
        return bool(self._pieces) or self._failure is not None

    def next(self) -> tuple[PoseSequence, bool]:
        """The next segment, and whether it is the last.

        Raises:
            NotPlayableError: the generator failed; the error's event ends the command.
        """
        if not self._pieces:
            assert self._failure is not None, "asked only when it is ready"
            raise self._failure
        piece = self._pieces.popleft()
        self._unreported.extend(piece.news)
        return piece.posture, piece.last

    def reports(self, plan_id: int) -> list[Progress]:
        """Events with the judgements of the scenes whose poses were given out since the last call."""
        events: list[Progress] = []
        while self._unreported:
            n = self._unreported.popleft()
            events.append(Progress(
                plan_id=plan_id, stage="scene", scene=n.number, text=n.text, status=n.status, reason=n.reason,
                understood=n.understood, scope_score=round(n.scope_score, 4),
            ))  # fmt: skip
        return events

    def finish(self) -> None:
        """Stop repeating: the story ends with the present repetition."""
        if self._n_all is None:
            n = len(self._request.scenes)
            self._n_all = -(-self._n_asked // n) * n

    async def _make_patiently(self) -> None:
        """Make a segment; wait when the generator is lost."""
        began_s, said = time.monotonic(), ""
        while True:
            try:
                await self._make()
                return
            except GeneratorError as error:
                if error.code not in _LOST or time.monotonic() - began_s > PATIENCE_S:
                    self._failure = NotPlayableError(generator_failed(error, self._generator.state))
                    return
                if error.found != said:
                    said = error.found
                    log.warning("the story waits for the generator: %s", said)
                await asyncio.sleep(AFTER_TIMEOUT_S if error.code == "generator_timeout" else RETRY_S)
            except Exception as error:  # an error of the motion ends the story, not the daemon
                log.exception("a piece of a story could not be made")
                bad = GeneratorError("internal", "a piece of a story", str(error), "a motion", "see the daemon's log")
                self._failure = NotPlayableError(generator_failed(bad, self._generator.state))
                return

    async def _make(self) -> None:
        """Request scenes until a segment is long enough, or the story ends."""
        while not self._complete and sum(map(len, self._parts)) < SHORTEST_FRAMES:
            generated = await self._ask()
            if len(generated.motion.joints_m):
                self._parts.append(self._varied(self._aliveness.posture_of(generated.motion, self._n_asked)))
            self._n_barren = 0 if generated.motion.status != "rejected" else self._n_barren + 1
            if self._n_barren >= len(self._request.scenes):
                self._complete = True  # every scene of the story was rejected
        posture = joined(self._parts) if self._parts else standing()[:0]
        self._pieces.append(_Piece(posture, self._complete, tuple(self._news)))
        self._parts, self._news = [], []

    async def _ask(self) -> Generated:
        scenes, n_all = self._request.scenes, self._n_all
        place = self._n_asked % len(scenes)
        over = n_all is not None and self._n_asked >= n_all  # `finish` came after the last scene was requested
        scene = None if over else scenes[place]
        last = over or (n_all is not None and self._n_asked == n_all - 1)
        text, seconds = (None, None) if scene is None else (self._in_full(scene.text, place), scene.seconds)
        timeout_s = self._timeout_s
        generated = await self._generator.scene(text, self._request.seed, seconds, self._told, timeout_s, last=last)
        self._told, self._complete = generated.told, last
        self.generate_ms += sum(generated.timings_ms.values())
        if scene is not None:
            self._n_asked += 1
            m = generated.motion
            words = f"{scene.text}\n{generated.understood}"
            shows = sentence(scenes_seen(m, [Scene(m.duration_s, words)])) if len(m.joints_m) else generated.understood
            self._news.append(SceneNews(place + 1, scene.text, m.status, generated.reason, shows, m.scope_score))
        return generated

    def _in_full(self, text: str, place: int) -> str:
        """The text of the next scene, with the full meaning of one that refers to the scene before it: "again", "slower"."""
        if self._asked_as[0] == self._n_asked:  # it was lost, and is asked for again
            return self._asked_as[1]
        try:
            meant = in_context(text, self._before if place else None)
            self._before = read(text) if meant is None else meant.reading
            full = text if meant is None else exactly(meant.reading.steps)
        except NothingToReferToError:
            full = text
        self._asked_as = (self._n_asked, full)
        return full

    def _varied(self, p: PoseSequence) -> PoseSequence:
        """`p` with mirror, size and tempo, segment by segment as if applied to the whole."""
        if self._request.mirror:
            p = mirrored(p)
        if self._request.amplitude != 1.0:
            p = scaled(p, self._request.amplitude)
        return self._tempo.of(p)


class _Tempo:
    """Changes the tempo of a motion that comes in segments, without a step at their borders."""

    def __init__(self, tempo: float) -> None:
        self._tempo, self._at = tempo, 0.0
        self._before: PoseSequence | None = None

    def of(self, p: PoseSequence) -> PoseSequence:
        """The frames that fall into a segment; its last frame is kept for those between it and the next segment."""
        if self._tempo == 1.0:
            return p
        whole = p if self._before is None else joined([self._before, p])
        n = int((len(whole) - 1 - self._at) / self._tempo + 1e-9) + 1
        places = self._at + self._tempo * np.arange(n, dtype=np.float64)
        self._before, self._at = whole[len(whole) - 1 :], self._at + n * self._tempo - (len(whole) - 1)
        return at_steps(whole, places)
