"""The messages between the front and the generator: msgpack, one each way per request. Holds no torch.

`generate`, `scene`, `edit`, `between` or `ping` to the generator; `generated`, `failure` or `pong` back with the same `id`.
A request for a draft gets two answers: a `generated` that is a draft, then the motion or a failure.
No request depends on an earlier one: the state of a story travels in `told`, so that a generator may be killed, restarted or
changed in the middle of a story.
"""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from daemon.errors import DaemonError

GENERATION_VERSION = 4
MOST_REQUEST_BYTES = 1 << 20
"""Bytes of a request at most: it may carry half a minute of motion to edit."""
MOST_TEXT_CHARS, MOST_TIMES, MOST_PARTS, MOST_TOLD_BYTES = 2000, 64, 16, 256 << 10
"""Characters, times, parts and bytes of a request at most. The bounds of `cmd` are tighter, but more than one daemon may reach a
generator."""
Text = Annotated[str, Meta(max_length=MOST_TEXT_CHARS)]
Seconds = Annotated[float, Meta(ge=0.0, le=60.0)]


class UnfitRequestError(DaemonError):
    """A request does not fit the motion or the model."""

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
    """Requests a motion.

    Attributes:
        text: a command.
        seconds: length of the motion; None lets the model choose.
        before: the motion that the new one continues; None for a motion by itself.
        prefix_s: seconds at the end of `before` that the new motion continues from.
        draft: whether a draft, which can be played at once, is to come first; none comes when none can be made.
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
    """Requests the next scene of a story.

    Attributes:
        text: text of the scene; None only leads to the story's end.
        seconds: length of the scene; None lets the model choose.
        seed: seed of the story.
        told: state in the answer to the scene before; empty for the first.
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
    """Requests a motion of which an interval or some parts of the body are generated anew.

    Attributes:
        motion: motion to edit.
        text: text of the new part.
        parts: parts of the body to generate anew; empty for the whole body.
        start_s: start of the interval, seconds.
        end_s: end of the interval, seconds; None is the motion's end.
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
    """Requests a motion through poses.

    Attributes:
        poses: one frame for each pose.
        at_s: time of each pose, seconds, in order.
        text: text of the motion between the poses; may be empty.
    """

    v: int = GENERATION_VERSION
    id: int
    poses: MotionArrays
    at_s: Annotated[list[float], Meta(max_length=MOST_TIMES)]
    text: Text = ""
    seed: int = 0


class PingMessage(msgspec.Struct, tag="ping", kw_only=True):
    """Requests a sign of life."""

    v: int = GENERATION_VERSION
    id: int


class PongMessage(msgspec.Struct, tag="pong", kw_only=True):
    """The generator lives, with this checkpoint."""

    id: int
    checkpoint_hash: str
    version: str = ""


class FailureMessage(msgspec.Struct, tag="failure", kw_only=True):
    """A request failed; codes `bad_edit` and `bad_keyframes` mean that it does not fit the motion or the model."""

    id: int
    code: str
    found: str
    allowed: str


class GeneratedMessage(MotionArrays, tag="generated", kw_only=True):
    """A motion, or a draft of one; fields as in `daemon.generator.generated.Generated`."""

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


def encode(message: ToGenerator | FromGenerator) -> bytes:
    """The bytes of a message."""
    return _ENCODER.encode(message)


def decode_request(frame: bytes) -> ToGenerator:
    """The request in a client's frame.

    Raises:
        msgspec.MsgspecError: no such message.
        RecursionError: the frame is nested too deeply.
    """
    return _TO_DECODER.decode(frame)


def decode_reply(frame: bytes) -> FromGenerator:
    """The reply in a generator's frame.

    Raises:
        msgspec.MsgspecError: no such message.
        RecursionError: the frame is nested too deeply.
    """
    return _FROM_DECODER.decode(frame)
