"""JSON schemas of a log's topics: those of the wire, so that viewers know fields and types. No I/O."""

from __future__ import annotations

from typing import Any

import msgspec

from daemon.wire.events import EVENTS
from daemon.wire.requests import CMD_TYPES, STREAM_TYPES
from daemon.wire.status import HealthEvent, LogEvent, StateEvent

LOG_LINES = "v1/log"
"""Topic of the daemon's log lines."""
DROPPED_TOPIC = "v1/dropped"
"""Topic of the number of the front's messages that the recorder has lost so far, `{"messages": N}`, at the place of the loss."""


class PlainText(msgspec.Struct):
    """A text for `say` that came without JSON around it."""

    text: str


class Dropped(msgspec.Struct):
    """Number of messages that were not recorded since the start."""

    messages: int


_KINDS: dict[str, tuple[type[msgspec.Struct], ...]] = {
    "v1/state": (StateEvent,),
    "v1/health": (HealthEvent,),
    "v1/event": EVENTS,
    LOG_LINES: (LogEvent,),
    "cmd": (*CMD_TYPES, PlainText),
    "stream": STREAM_TYPES,
    DROPPED_TOPIC: (Dropped,),
}


def schema_of(topic: str) -> bytes:
    """The schema of a topic's messages: that of its only type, `anyOf` several types, or any object for an unknown topic."""
    kinds = _KINDS.get(topic, ())
    if not kinds:
        return b'{"type": "object"}'
    references, definitions = msgspec.json.schema_components(kinds)
    found: dict[str, Any] = {"title": topic, "type": "object", "$defs": definitions}
    if len(kinds) == 1:  # its fields at the top, where viewers look for them
        found |= definitions.pop(kinds[0].__name__)
    else:
        found["anyOf"] = references
    return msgspec.json.encode(found)
