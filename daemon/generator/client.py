"""The front's client of the generator: sends requests without blocking the event loop. It loads no torch.

The generator is a ROUTER, its clients are DEALERs; the messages are in `daemon.generator.messages`.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import time
from collections.abc import Sequence

import zmq
import zmq.asyncio

from daemon.generator.generated import (
    MIN_FRAMES,
    Generated,
    GeneratorError,
    arrays_of,
    generated_of,
    no_answer,
    still_loading,
)
from daemon.generator.messages import (
    MOST_REQUEST_BYTES,
    BetweenMessage,
    EditMessage,
    FailureMessage,
    FromGenerator,
    GenerateMessage,
    PingMessage,
    PongMessage,
    SceneMessage,
    ToGenerator,
    decode_reply,
    encode,
)
from daemon.network.keys import KeyFolder, connect_curve
from daemon.wire.showing import shortened
from mmm_core.motion.motion import Motion

log = logging.getLogger(__name__)

MOST_ANSWER_BYTES = 8 << 20
"""Bytes of an answer at most: a motion of five minutes."""
START_TIMEOUT_S = 10.0
"""Seconds that a text waits at most for a generator that is being started."""


class GeneratorClient:
    """Sends requests to the generator without blocking the event loop; several may be open at once.

    Attributes:
        state: state of the generator in words, for people; `mark_ready`, `mark_starting` and `mark_down` set it.
        checkpoint_hash: hash of the weights that the generator last reported; empty before.
        timeouts: number of requests not answered in time by the generator process to which they were sent.
    """

    def __init__(
        self, context: zmq.asyncio.Context, endpoint: str, keys: KeyFolder | None = None, model_hash: str = ""
    ) -> None:
        self._model_hash = model_hash
        self._socket = context.socket(zmq.DEALER)
        if keys is not None and endpoint.startswith("tcp://"):
            connect_curve(self._socket, keys, "generator")
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.setsockopt(zmq.MAXMSGSIZE, MOST_ANSWER_BYTES)
        self._socket.setsockopt(zmq.RECONNECT_IVL, 20)
        self._socket.setsockopt(zmq.RECONNECT_IVL_MAX, 200)
        self._socket.connect(endpoint)
        self._ids = itertools.count(1)
        self._open: dict[int, asyncio.Future[FromGenerator]] = {}
        self._follows: dict[int, asyncio.Future[FromGenerator]] = {}  # a draft
        self._reader: asyncio.Task[None] | None = None
        self._ready = asyncio.Event()
        self._down_reason = ""
        self.state = "starting"
        self.checkpoint_hash = ""
        self.timeouts = 0
        self._lives = 0
        self._starting_since_s = time.monotonic()

    def mark_ready(self, checkpoint_hash: str) -> None:
        """Note that the generator answers."""
        self.state, self._down_reason = f"ready (checkpoint {checkpoint_hash[:12]})", ""
        self.checkpoint_hash = checkpoint_hash
        self._ready.set()

    def mark_starting(self) -> None:
        """Note that the generator is being started: open requests fail, new ones wait for it."""
        self.state, self._down_reason = "starting", ""
        self._starting_since_s = time.monotonic()
        self._ready.clear()
        self._lives += 1
        self._lose_requests()

    def mark_down(self, reason: str, *, ended: bool = True) -> None:
        """Note that the generator is down: new requests fail at once, and open ones too if its process has `ended`.

        A generator on another machine that is silent may still answer what is open, which has a time-out of its own.
        """
        self.state, self._down_reason = f"down: {reason}", reason
        self._ready.clear()
        if ended:
            self._lose_requests()

    def _lose_requests(self) -> None:
        """Fail all open requests: the process that they were sent to is gone, so no answer will come."""
        found, do = f"the generator is {self.state}", "see the daemon's output"
        waiting = [(answer, "an answer") for answer in self._open.values()]
        waiting += [(follows, "a motion after its draft") for follows in self._follows.values()]
        for answer, asked in waiting:
            if not answer.done():
                answer.set_exception(GeneratorError("generator_down", asked, found, "a generator that runs", do))

    @property
    def busy(self) -> bool:
        """Whether an answer is outstanding."""
        return bool(self._open or self._follows)

    async def generate(
        self, text: str, seed: int, seconds: float | None, timeout_s: float, *, before: Motion | None = None,
        prefix_s: float = 0.0,
    ) -> Generated:  # fmt: skip
        """The motion for `text`; with `before`, one that continues from the last `prefix_s` seconds of that motion.

        Raises:
            GeneratorError: the generator failed, gave no usable motion, or did not answer in time (`code` says which).
        """
        asked = f"a motion for {text!r}"
        await self._until_ready(asked)
        request = GenerateMessage(
            id=next(self._ids), text=text, seed=seed, seconds=seconds, prefix_s=prefix_s,
            before=None if before is None else arrays_of(before),
        )  # fmt: skip
        return await self._motion(request, timeout_s, asked)

    async def draft(
        self, text: str, seed: int, seconds: float | None, timeout_s: float
    ) -> tuple[Generated, asyncio.Task[Generated] | None]:
        """A draft of the motion for `text`, and the motion to come; or the motion and None.

        Raises:
            GeneratorError: as `generate`; the task raises it too.
        """
        asked = f"a motion for {text!r}"
        await self._until_ready(asked)
        request = GenerateMessage(id=next(self._ids), text=text, seed=seed, seconds=seconds, draft=True)
        follows = self._follows[request.id] = asyncio.get_running_loop().create_future()
        whole: asyncio.Task[Generated] | None = None
        try:
            first = generated_of(await self._ask(request, timeout_s, asked), asked, may_be_draft=True)
            if first.draft_of:
                whole = asyncio.create_task(self._whole(request.id, follows, timeout_s, asked))
                whole.add_done_callback(_heard)
            return first, whole
        finally:
            if whole is None:
                del self._follows[request.id]

    async def _whole(
        self, request_id: int, follows: asyncio.Future[FromGenerator], timeout_s: float, asked: str
    ) -> Generated:
        """The motion that follows a draft."""
        life = self._lives
        try:
            async with asyncio.timeout(timeout_s):
                return generated_of(await follows, asked)
        except TimeoutError:
            self.timeouts += life == self._lives
            raise no_answer(asked, timeout_s) from None
        finally:
            del self._follows[request_id]

    async def scene(
        self, text: str | None, seed: int, seconds: float | None, told: bytes, timeout_s: float, *, last: bool
    ) -> Generated:
        """The next scene of a story, which may have no frames; `told` is the state that the scene before returned.

        Raises:
            GeneratorError: as `generate`.
        """
        asked = "the end of a story" if text is None else f"a scene for {text!r}"
        await self._until_ready(asked)
        request = SceneMessage(id=next(self._ids), text=text, seconds=seconds, seed=seed, told=told, last=last)
        return await self._motion(request, timeout_s, asked, min_frames=0)

    async def edit(
        self, motion: Motion, text: str, seed: int, parts: Sequence[str], start_s: float, end_s: float | None,
        timeout_s: float,
    ) -> Generated:  # fmt: skip
        """`motion` with an interval or some parts of the body generated anew for `text`.

        Raises:
            GeneratorError: as `generate`; `bad_edit` when the edit does not fit the motion or the model, `not_reached` when no
                edited motion shows the text.
        """
        asked = f"an edit for {text!r}"
        await self._until_ready(asked)
        request = EditMessage(
            id=next(self._ids), motion=arrays_of(motion), text=text, seed=seed, parts=list(parts), start_s=start_s,
            end_s=end_s,
        )  # fmt: skip
        return await self._motion(request, timeout_s, asked)

    async def between(self, poses: Motion, at_s: Sequence[float], text: str, seed: int, timeout_s: float) -> Generated:
        """A motion that shows each frame of `poses` at its time.

        Raises:
            GeneratorError: as `generate`; `bad_keyframes` when the times do not fit.
        """
        asked = f"a motion through {len(at_s)} poses"
        await self._until_ready(asked)
        request = BetweenMessage(id=next(self._ids), poses=arrays_of(poses), at_s=list(at_s), text=text, seed=seed)
        return await self._motion(request, timeout_s, asked)

    async def _motion(
        self, request: ToGenerator, timeout_s: float, asked: str, min_frames: int = MIN_FRAMES
    ) -> Generated:
        return generated_of(await self._ask(request, timeout_s, asked), asked, min_frames)

    async def ping(self, timeout_s: float) -> str:
        """Ask the generator for a sign of life; returns the hash of its checkpoint.

        Raises:
            GeneratorError: no answer in time, another version of the protocol, another checkpoint than agreed.
        """
        reply = await self._ask(PingMessage(id=next(self._ids)), timeout_s, "a sign of life")
        if isinstance(reply, FailureMessage):
            do = "install the same version of mmmd on both machines"
            raise GeneratorError(reply.code, "a sign of life", reply.found, reply.allowed, do)
        found = reply.checkpoint_hash if isinstance(reply, PongMessage) else ""
        if not found.startswith(self._model_hash):
            allowed, do = f"checkpoint {self._model_hash}", "start the generator with the model that was agreed on"
            raise GeneratorError("checkpoint", "a sign of life", f"checkpoint {found[:12]}", allowed, do)
        return found

    async def _until_ready(self, asked: str) -> None:
        began_s = time.monotonic()
        while not self._ready.is_set():
            if self._down_reason:
                found = f"the generator is {self.state}"
                do = "see the daemon's output; gestures (`mmmd gesture list`) need no generator"
                raise GeneratorError("generator_down", asked, found, "a generator that runs", do)
            if time.monotonic() - began_s > START_TIMEOUT_S:
                raise still_loading(asked, time.monotonic() - self._starting_since_s)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._ready.wait(), 0.1)

    async def _ask(self, request: ToGenerator, timeout_s: float, asked: str) -> FromGenerator:
        frame = encode(request)
        if len(frame) > MOST_REQUEST_BYTES:  # the generator would drop the connection, and be taken for dead
            found, allowed = f"a motion of {len(frame)} bytes", f"at most {MOST_REQUEST_BYTES}, about 35 s"
            raise GeneratorError("bad_edit", asked, found, allowed, "edit a shorter motion")
        if self._reader is None:
            self._reader = asyncio.create_task(self._read())
        answer: asyncio.Future[FromGenerator] = asyncio.get_running_loop().create_future()
        self._open[request.id] = answer
        life = self._lives
        try:
            async with asyncio.timeout(timeout_s):
                await self._socket.send(frame)
                return await answer
        except TimeoutError:
            self.timeouts += life == self._lives  # a generator started since then is not to blame
            raise no_answer(asked, timeout_s) from None
        finally:
            self._open.pop(request.id, None)

    async def _read(self) -> None:
        while True:
            frame = await self._socket.recv()
            try:
                reply = decode_reply(frame)
            except Exception as error:  # RecursionError among them: one frame must not end the reader of all answers
                log.warning("the generator sent what is no message: %s", shortened(error))
                continue
            for waiting in (self._open.get(reply.id), self._follows.get(reply.id)):
                if waiting is not None and not waiting.done():
                    waiting.set_result(reply)
                    break

    async def close(self) -> None:
        """Drop open requests and close the socket."""
        if self._reader is not None:
            self._reader.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._reader
        self._socket.close(0)


def _heard(whole: asyncio.Task[Generated]) -> None:
    """Log the failure of a motion after its draft, because possibly no caller waits for the task any more."""
    if not whole.cancelled() and whole.exception() is not None:
        log.warning("a draft goes on without its motion: %s", whole.exception())
