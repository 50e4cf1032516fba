"""Requests whose text is for the safety socket `ctl`: a stop brakes the robot, and no rate limit delays it; others are refused."""

from __future__ import annotations

import re

from daemon.wire.codec import WireError, decode_cmd
from daemon.wire.events import Rejected
from daemon.wire.requests import Command, Say
from mmm_core.language.stop_words import may_stop, means_stop

_LONGEST_FRAME_BYTES = 600
_VERBS = re.compile(
    r"\W*(?:please |now )?"
    r"(?:(?P<arm>(?:re)?arm|(?:torque|power|motors|servos) on|(?:turn|switch|power) (?:yourself )?(?:on|up))|"
    r"(?P<park>park)|(?P<reset>reset))"
    r"(?: (?:yourself|the robot|robot|please|now))*\W*",
    re.IGNORECASE,
)


def verb_refusal(request: Command) -> Rejected | None:
    """The refusal of a text that is a verb of `ctl`: "arm" would move an arm; None for other requests."""
    verb = _VERBS.fullmatch(request.text) if isinstance(request, Say) else None
    if verb is None:
        return None
    found = "a verb of the socket `ctl`, which no text carries out"
    do = f"`mmmd {verb.lastgroup}`"
    return Rejected(code="out_of_scope", asked=f"say {verb[0][:200]!r}", found=found, allowed="motions", do=do)


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
