"""What the front and the generator say to each other, and the front's side of it. Holds no torch.

msgpack messages over ZeroMQ, one each way per request: `generate` or `ping` to the generator; `generated`, `failure` or
`pong` back with the same `id`. The generator is a ROUTER, its clients are DEALERs.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import time
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np
import zmq
import zmq.asyncio
from numpy.typing import NDArray

from daemon.errors import DaemonError
from daemon.keys import KeyFolder, connect_curve
from mmm_core.motion import N_FEATURES, N_JOINTS, Motion

log = logging.getLogger(__name__)

GENERATION_VERSION = 1
START_TIMEOUT_S = 10.0
"""Longest wait of a text for a generator that is being started."""
MIN_FRAMES = 2
"""A motion of fewer frames is no motion."""


class GeneratorError(DaemonError):
    """The generator gave no usable motion: why, and what to do."""

    def __init__(self, code: str, asked: str, found: str, allowed: str, do: str) -> None:
        self.code, self.asked, self.found, self.allowed, self.do = code, asked, found, allowed, do
        super().__init__(f"{asked}: {found}; allowed: {allowed}; {do}")


class GenerateMessage(msgspec.Struct, tag="generate", kw_only=True):
    """Ask for a motion."""

    v: int = GENERATION_VERSION
    id: int
    text: str
    seed: int = 0
    seconds: float | None = None


class PingMessage(msgspec.Struct, tag="ping", kw_only=True):
    """Ask whether the generator lives."""

    v: int = GENERATION_VERSION
    id: int


class PongMessage(msgspec.Struct, tag="pong", kw_only=True):
    """It lives, with this checkpoint."""

    id: int
    checkpoint_hash: str
    version: str = ""


class FailureMessage(msgspec.Struct, tag="failure", kw_only=True):
    """It could not."""

    id: int
    code: str
    found: str
    allowed: str


class GeneratedMessage(msgspec.Struct, tag="generated", kw_only=True):
    """A motion: arrays as little-endian bytes, T frames."""

    id: int
    n_frames: int
    joints_m: bytes
    fps: float
    head_quat_wxyz: bytes
    forearm_twist_rad: bytes
    features: bytes
    tokens: bytes
    text: str
    seed: int
    status: str
    scope_score: float
    understood: str
    reason: str
    timings_ms: dict[str, float]
    checkpoint_hash: str


ToGenerator = GenerateMessage | PingMessage
FromGenerator = GeneratedMessage | FailureMessage | PongMessage
_ENCODER = msgspec.msgpack.Encoder()
_TO_DECODER = msgspec.msgpack.Decoder(ToGenerator)
_FROM_DECODER = msgspec.msgpack.Decoder(FromGenerator)


@dataclass(frozen=True)
class Generated:
    """A motion as the generator gave it.

    Attributes:
        motion: the motion; of length zero when rejected.
        understood: nearest known command and its score.
        reason: why degraded or rejected, else empty.
        timings_ms: the generator's stages.
        checkpoint_hash: the weights it used.
    """

    motion: Motion
    understood: str
    reason: str
    timings_ms: dict[str, float]
    checkpoint_hash: str


def encode(message: ToGenerator | FromGenerator) -> bytes:
    """The bytes of a message."""
    return _ENCODER.encode(message)


def decode_request(frame: bytes) -> ToGenerator:
    """What a client asks.

    Raises:
        msgspec.MsgspecError: no such message.
    """
    return _TO_DECODER.decode(frame)


def generated_message(request_id: int, generated: Generated) -> GeneratedMessage:
    """The message of a motion."""
    m = generated.motion
    return GeneratedMessage(
        id=request_id,
        n_frames=len(m.joints_m),
        joints_m=m.joints_m.astype("<f4").tobytes(),
        fps=m.fps,
        head_quat_wxyz=m.head_quat_wxyz.astype("<f4").tobytes(),
        forearm_twist_rad=m.forearm_twist_rad.astype("<f4").tobytes(),
        features=m.features.astype("<f4").tobytes(),
        tokens=m.tokens.astype("<i4").tobytes(),
        text=m.text,
        seed=m.seed,
        status=m.status,
        scope_score=m.scope_score,
        understood=generated.understood,
        reason=generated.reason,
        timings_ms=generated.timings_ms,
        checkpoint_hash=generated.checkpoint_hash,
    )


def generated_from(message: GeneratedMessage) -> Generated:
    """The motion in a message, checked.

    Raises:
        GeneratorError: wrong sizes, not finite, or too few frames.
    """
    n = message.n_frames
    try:
        motion = Motion(
            joints_m=_array(message.joints_m, "<f4", (n, N_JOINTS, 3)),
            fps=message.fps,
            head_quat_wxyz=_array(message.head_quat_wxyz, "<f4", (n, 4)),
            forearm_twist_rad=_array(message.forearm_twist_rad, "<f4", (n, 2)),
            features=_array(message.features, "<f4", (n, N_FEATURES)),
            tokens=_array(message.tokens, "<i4", (-1,)),
            text=message.text,
            seed=message.seed,
            status=message.status,  # type: ignore[arg-type]  # checked by Motion
            scope_score=message.scope_score,
        )
    except ValueError as error:
        raise _bad_motion(message.text, str(error)) from error
    if motion.status != "rejected" and n < MIN_FRAMES:
        raise _bad_motion(message.text, f"{n} frames")
    return Generated(motion, message.understood, message.reason, message.timings_ms, message.checkpoint_hash)


def _bad_motion(text: str, found: str) -> GeneratorError:
    allowed = f"at least {MIN_FRAMES} frames, all finite"
    return GeneratorError(
        "bad_motion", f"a motion for {text!r}", found, allowed, "say it in other words or with another seed"
    )


def _array(data: bytes, dtype: str, shape: tuple[int, ...]) -> NDArray[Any]:
    return np.frombuffer(data, dtype).reshape(shape)


class GeneratorClient:
    """Asks the generator without blocking the event loop; several requests may be open.

    Attributes:
        state: what people are told about the generator; `mark_ready` and `mark_down` set it.
        checkpoint_hash: of the weights it said it uses last, empty before.
        timeouts: requests that were not answered in time.
    """

    def __init__(
        self, context: zmq.asyncio.Context, endpoint: str, keys: KeyFolder | None = None, model_hash: str = ""
    ) -> None:
        self._model_hash = model_hash
        self._socket = context.socket(zmq.DEALER)
        if keys is not None and endpoint.startswith("tcp://"):
            connect_curve(self._socket, keys, "generator")
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.setsockopt(zmq.RECONNECT_IVL, 20)
        self._socket.setsockopt(zmq.RECONNECT_IVL_MAX, 200)
        self._socket.connect(endpoint)
        self._ids = itertools.count(1)
        self._open: dict[int, asyncio.Future[FromGenerator]] = {}
        self._reader: asyncio.Task[None] | None = None
        self._ready = asyncio.Event()
        self._down_reason = ""
        self.state = "starting"
        self.checkpoint_hash = ""
        self.timeouts = 0

    def mark_ready(self, checkpoint_hash: str) -> None:
        """The generator answers."""
        self.state, self._down_reason = f"ready (checkpoint {checkpoint_hash[:12]})", ""
        self.checkpoint_hash = checkpoint_hash
        self._ready.set()

    def mark_starting(self) -> None:
        """The generator is being started; requests wait for it."""
        self.state, self._down_reason = "starting", ""
        self._ready.clear()

    def mark_down(self, reason: str) -> None:
        """The generator is gone; requests fail at once."""
        self.state, self._down_reason = f"down: {reason}", reason
        self._ready.clear()

    @property
    def busy(self) -> bool:
        """Whether an answer is outstanding."""
        return bool(self._open)

    async def generate(self, text: str, seed: int, seconds: float | None, timeout_s: float) -> Generated:
        """The motion for `text`.

        Raises:
            GeneratorError: it failed, gave no usable motion, or not in time (`code` tells which).
        """
        await self._until_ready(f"a motion for {text!r}")
        request = GenerateMessage(id=next(self._ids), text=text, seed=seed, seconds=seconds)
        reply = await self._ask(request, timeout_s, f"a motion for {text!r}")
        if isinstance(reply, FailureMessage):
            do = "see the daemon's output; say it in other words or with another seed"
            raise GeneratorError(reply.code, f"a motion for {text!r}", reply.found, reply.allowed, do)
        if not isinstance(reply, GeneratedMessage):
            raise _bad_motion(text, f"the answer '{type(reply).__name__}'")
        return generated_from(reply)

    async def ping(self, timeout_s: float) -> str:
        """The hash of the generator's checkpoint.

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
            if self._down_reason or time.monotonic() - began_s > START_TIMEOUT_S:
                found = f"the generator is {self.state}"
                raise GeneratorError("generator_down", asked, found, "a generator that runs", "see the daemon's output")
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._ready.wait(), 0.1)

    async def _ask(self, request: ToGenerator, timeout_s: float, asked: str) -> FromGenerator:
        if self._reader is None:
            self._reader = asyncio.create_task(self._read())
        answer: asyncio.Future[FromGenerator] = asyncio.get_running_loop().create_future()
        self._open[request.id] = answer
        try:
            async with asyncio.timeout(timeout_s):
                await self._socket.send(encode(request))
                return await answer
        except TimeoutError:
            self.timeouts += 1
            do = "it is started again; say it once more"
            raise GeneratorError(
                "generator_timeout",
                asked,
                f"no answer from the generator in {timeout_s:g} s",
                "an answer in that time",
                do,
            ) from None
        finally:
            self._open.pop(request.id, None)

    async def _read(self) -> None:
        while True:
            frame = await self._socket.recv()
            try:
                reply = _FROM_DECODER.decode(frame)
            except msgspec.MsgspecError as error:
                log.warning("the generator sent what is no message: %s", error)
                continue
            waiting = self._open.get(reply.id)
            if waiting is not None and not waiting.done():
                waiting.set_result(reply)

    async def close(self) -> None:
        """Drop what is open and close the socket."""
        if self._reader is not None:
            self._reader.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._reader
        self._socket.close(0)
