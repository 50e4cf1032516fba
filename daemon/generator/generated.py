"""Motions as the generator gives them, and their conversion to and from messages. Loads no torch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.errors import DaemonError
from daemon.generator.messages import FailureMessage, FromGenerator, GeneratedMessage, MotionArrays
from mmm_core.motion.motion import N_FEATURES, N_JOINTS, Motion
from mmm_core.recognition.seen import Scene

MIN_FRAMES = 2
"""Frames that an answer must have at least to count as a motion."""


class GeneratorError(DaemonError):
    """The generator gave no usable motion; the message says why, and what to do."""

    def __init__(self, code: str, asked: str, found: str, allowed: str, do: str) -> None:
        self.code, self.asked, self.found, self.allowed, self.do = code, asked, found, allowed, do
        super().__init__(f"{asked}: {found}; allowed: {allowed}; {do}")


def no_answer(asked: str, timeout_s: float) -> GeneratorError:
    """The error of a generator that did not answer in time."""
    found, do = f"no answer from the generator in {timeout_s:g} s", "it is started again; say it once more"
    return GeneratorError("generator_timeout", asked, found, "an answer in that time", do)


def still_loading(asked: str, loading_s: float) -> GeneratorError:
    """The error of a text that came before the motion model was loaded.

    Args:
        asked: the request, in words.
        loading_s: seconds since the generator was started.
    """
    found = f"the motion model has been loading for {loading_s:.0f} s and is not ready yet"
    do = "send it again in some seconds; gestures (`mmmd gesture list`) need no motion model"
    return GeneratorError("generator_down", asked, found, "a motion model that is loaded", do)


@dataclass(frozen=True)
class Generated:
    """A motion as the generator gave it.

    Attributes:
        motion: the motion; of length zero when rejected.
        understood: nearest known command and its score, as text.
        reason: why the text was degraded or rejected; else empty.
        timings_ms: milliseconds of each stage of the generator.
        checkpoint_hash: hash of the weights used.
        told: state of a story after this scene, for the next request; else empty.
        draft_of: approximate number of frames of the motion of which this is a draft; 0 for a motion.
        scenes: parts of the motion and the words that each was generated for; empty for a motion of one part.
        commands: commands read in the text, step by step; empty when none was read.
        denied: actions that the text says not to do.
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


def arrays_of(m: Motion) -> MotionArrays:
    """A motion as arrays of bytes, for a message."""
    return MotionArrays(**_fields(m))


def generated_message(request_id: int, generated: Generated) -> GeneratedMessage:
    """The message with a generated motion."""
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
    """The checked motion of a message's arrays.

    Raises:
        ValueError: arrays of the wrong size, or values that are not finite.
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
    """The checked motion of a message.

    Raises:
        GeneratorError: wrong sizes, values that are not finite, too few frames, or a draft that was not requested.
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


def generated_of(
    reply: FromGenerator, asked: str, min_frames: int = MIN_FRAMES, *, may_be_draft: bool = False
) -> Generated:
    """The motion of a reply.

    Raises:
        GeneratorError: the reply is a failure, or holds no usable motion.
    """
    if isinstance(reply, FailureMessage):
        do = "see the daemon's output; say it in other words or with another seed"
        if reply.code in ("bad_edit", "bad_keyframes"):
            do = "correct it"
        elif reply.code == "not_reached":
            do = "edit a longer stretch or more parts of the body, or take other words or another seed"
        raise GeneratorError(reply.code, asked, reply.found, reply.allowed, do)
    if not isinstance(reply, GeneratedMessage):
        raise bad_motion(asked, f"the answer '{type(reply).__name__}'")
    return generated_from(reply, min_frames, may_be_draft=may_be_draft)


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
