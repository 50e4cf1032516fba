"""Requests whose text means to stop: they brake the robot, and no rate limit delays them."""

from __future__ import annotations

from daemon.wire.codec import WireError, decode_cmd
from daemon.wire.requests import Command
from mmm_core.language.stop_words import may_stop, means_stop

_LONGEST_FRAME_BYTES = 600


def asks_to_stop(request: Command) -> bool:
    """Whether any text of a request means to stop."""
    return any(means_stop(text) for text in request.texts)


def stops(frames: list[bytes]) -> bool:
    """Whether the frames are one request that means to stop; checked for a client above its rate limit."""
    if len(frames) != 1 or len(frames[0]) > _LONGEST_FRAME_BYTES or not may_stop(frames[0]):
        return False  # not read any further: a flood must cost little
    try:
        request = decode_cmd(frames[0])
    except WireError:
        return False
    return isinstance(request, Command) and asks_to_stop(request)
