"""The messages between the front and the generator: msgpack, one each way per request. Holds no torch.

`generate`, `scene`, `edit`, `between` or `ping` to the generator; `generated`, `failure` or `pong` back with the same `id`.
Who asks for a draft gets two: a `generated` that is a draft, then the motion, or the failure that there is none.
No request needs one that came before it: what a story needs of its past travels in `told`, so that a generator may be
killed, restarted or changed in the middle of one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from daemon.errors import DaemonError
from mmm_core.motion.motion import N_FEATURES, N_JOINTS, Motion
from mmm_core.recognition.seen import Scene

GENERATION_VERSION = 4
MOST_REQUEST_BYTES = 1 << 20
"""Bytes of a request: it may carry half a minute of motion that is to be edited."""
MOST_TEXT_CHARS, MOST_TIMES, MOST_PARTS, MOST_TOLD_BYTES = 2000, 64, 16, 256 << 10
"""Bounds of a request; those of `cmd` are inside them. A generator may be reached by more than one daemon."""
Text = Annotated[str, Meta(max_length=MOST_TEXT_CHARS)]
Seconds = Annotated[float, Meta(ge=0.0, le=60.0)]
MIN_FRAMES = 2
"""A motion of fewer frames is no motion."""


class GeneratorError(DaemonError):
    """The generator gave no usable motion: why, and what to do."""

    def __init__(self, code: str, asked: str, found: str, allowed: str, do: str) -> None:
        self.code, self.asked, self.found, self.allowed, self.do = code, asked, found, allowed, do
        super().__init__(f"{asked}: {found}; allowed: {allowed}; {do}")


class UnfitRequestError(DaemonError):
    """What was asked does not fit the motion or the model."""

    def __init__(self, code: str, found: str, allowed: str) -> None:
        self.code, self.found, self.allowed = code, found, allowed
        super().__init__(f"{found}; allowed: {allowed}")


class MotionArrays(msgspec.Struct, kw_only=True):
    """A motion of T frames: arrays as little-endian bytes."""

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


class GenerateMessage(msgspec.Struct, tag="generate", kw_only=True):
    """Ask for a motion.

    Attributes:
        text: a command.
        seconds: of the motion; None lets the model choose.
        before: what it is to go on from; None for a motion by itself.
        prefix_s: so much of the end of `before` is context of the new motion.
        draft: whether a draft, which can be played at once, is to come first; where none can be made none comes.
    """

    v: int = GENERATION_VERSION
    id: int
    text: Text
    seed: int = 0
    seconds: Seconds | None = None
    before: MotionArrays | None = None
    prefix_s: Seconds = 0.0
    draft: bool = False


class SceneMessage(msgspec.Struct, tag="scene", kw_only=True):
    """Ask for the next piece of a story.

    Attributes:
        text: of the scene; None only leads to the story's end.
        seconds: of the scene; None lets the model choose.
        seed: of the story.
        told: what the answer to the scene before gave; empty for the first.
        last: whether the story ends here.
    """

    v: int = GENERATION_VERSION
    id: int
    text: Text | None
    seconds: Seconds | None = None
    seed: int = 0
    told: Annotated[bytes, Meta(max_length=MOST_TOLD_BYTES)] = b""
    last: bool = False


class EditMessage(msgspec.Struct, tag="edit", kw_only=True):
    """Ask for a motion of which a stretch or some parts are made again.

    Attributes:
        motion: what is edited.
        text: what the new part is to be.
        parts: of the body; empty for all of it.
        start_s: of the stretch.
        end_s: of the stretch; None is the motion's end.
    """

    v: int = GENERATION_VERSION
    id: int
    motion: MotionArrays
    text: Text
    seed: int = 0
    parts: Annotated[list[Text], Meta(max_length=MOST_PARTS)] = []
    start_s: float = 0.0
    end_s: float | None = None


class BetweenMessage(msgspec.Struct, tag="between", kw_only=True):
    """Ask for a motion through poses.

    Attributes:
        poses: one frame for each pose.
        at_s: when each is due, in order.
        text: what happens between them; may be empty.
    """

    v: int = GENERATION_VERSION
    id: int
    poses: MotionArrays
    at_s: Annotated[list[float], Meta(max_length=MOST_TIMES)]
    text: Text = ""
    seed: int = 0


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
    """It could not: `bad_edit` and `bad_keyframes` when what was asked does not fit the motion or the model."""

    id: int
    code: str
    found: str
    allowed: str


class GeneratedMessage(MotionArrays, tag="generated", kw_only=True):
    """A motion, or a draft of one; `told` is where a story then stands."""

    id: int
    understood: str
    reason: str
    timings_ms: dict[str, float]
    checkpoint_hash: str
    told: bytes = b""
    draft_of: int = 0
    scenes: list[tuple[float, str]] = []
    commands: list[str] = []
    denied: list[str] = []


ToGenerator = GenerateMessage | SceneMessage | EditMessage | BetweenMessage | PingMessage
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
        told: where a story then stands; else empty.
        draft_of: frames that the motion will have, about, of which this is a draft; 0 when it is the motion.
        scenes: parts of the motion and the words that each was made for; empty where it is one.
        commands: what was read in the text, step by step; empty where none was read.
        denied: what the text says not to do.
    """

    motion: Motion
    understood: str
    reason: str
    timings_ms: dict[str, float]
    checkpoint_hash: str
    told: bytes = b""
    draft_of: int = 0
    scenes: tuple[Scene, ...] = ()
    commands: tuple[str, ...] = ()
    denied: tuple[str, ...] = ()


def encode(message: ToGenerator | FromGenerator) -> bytes:
    """The bytes of a message."""
    return _ENCODER.encode(message)


def decode_request(frame: bytes) -> ToGenerator:
    """What a client asks.

    Raises:
        msgspec.MsgspecError: no such message.
        RecursionError: it is nested too deeply.
    """
    return _TO_DECODER.decode(frame)


def decode_reply(frame: bytes) -> FromGenerator:
    """What the generator answers.

    Raises:
        msgspec.MsgspecError: no such message.
        RecursionError: it is nested too deeply.
    """
    return _FROM_DECODER.decode(frame)


def arrays_of(m: Motion) -> MotionArrays:
    """A motion as it travels."""
    return MotionArrays(**_fields(m))


def generated_message(request_id: int, generated: Generated) -> GeneratedMessage:
    """The message of a motion."""
    return GeneratedMessage(
        id=request_id,
        **_fields(generated.motion),
        understood=generated.understood,
        reason=generated.reason,
        timings_ms=generated.timings_ms,
        checkpoint_hash=generated.checkpoint_hash,
        told=generated.told,
        draft_of=generated.draft_of,
        scenes=[(scene.end_s, scene.words) for scene in generated.scenes],
        commands=list(generated.commands),
        denied=list(generated.denied),
    )


def motion_from(arrays: MotionArrays) -> Motion:
    """The motion that travelled, checked.

    Raises:
        ValueError: wrong sizes, or not finite.
    """
    n = arrays.n_frames
    return Motion(
        joints_m=_array(arrays.joints_m, "<f4", (n, N_JOINTS, 3)),
        fps=arrays.fps,
        head_quat_wxyz=_array(arrays.head_quat_wxyz, "<f4", (n, 4)),
        forearm_twist_rad=_array(arrays.forearm_twist_rad, "<f4", (n, 2)),
        features=_array(arrays.features, "<f4", (n, N_FEATURES)),
        tokens=_array(arrays.tokens, "<i4", (-1,)),
        text=arrays.text,
        seed=arrays.seed,
        status=arrays.status,  # type: ignore[arg-type]  # checked by Motion
        scope_score=arrays.scope_score,
    )


def generated_from(message: GeneratedMessage, min_frames: int = MIN_FRAMES, *, may_be_draft: bool = False) -> Generated:
    """The motion in a message, checked.

    Raises:
        GeneratorError: wrong sizes, not finite, too few frames, or a draft that nobody asked for.
    """
    if message.draft_of and not may_be_draft:
        raise bad_motion(message.text, "a draft that nobody asked for")
    try:
        motion = motion_from(message)
    except ValueError as error:
        raise bad_motion(message.text, str(error)) from error
    if motion.status != "rejected" and message.n_frames < min_frames:
        raise bad_motion(message.text, f"{message.n_frames} frames")
    how = (message.understood, message.reason, message.timings_ms, message.checkpoint_hash)
    scenes = tuple(Scene(end_s, words) for end_s, words in message.scenes)
    return Generated(
        motion, *how, message.told, message.draft_of, scenes, tuple(message.commands), tuple(message.denied)
    )


def bad_motion(text: str, found: str) -> GeneratorError:
    """The error of an answer that is no motion."""
    allowed = f"at least {MIN_FRAMES} frames, all finite"
    return GeneratorError(
        "bad_motion", f"a motion for {text!r}", found, allowed, "say it in other words or with another seed"
    )


def _fields(m: Motion) -> dict[str, Any]:
    return {
        "n_frames": len(m.joints_m),
        "joints_m": m.joints_m.astype("<f4").tobytes(),
        "fps": m.fps,
        "head_quat_wxyz": m.head_quat_wxyz.astype("<f4").tobytes(),
        "forearm_twist_rad": m.forearm_twist_rad.astype("<f4").tobytes(),
        "features": m.features.astype("<f4").tobytes(),
        "tokens": m.tokens.astype("<i4").tobytes(),
        "text": m.text,
        "seed": m.seed,
        "status": m.status,
        "scope_score": m.scope_score,
    }


def _array(data: bytes, dtype: str, shape: tuple[int, ...]) -> NDArray[Any]:
    return np.frombuffer(data, dtype).reshape(shape)
