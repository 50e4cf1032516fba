"""Fields that every event has. No I/O."""

from __future__ import annotations

from typing import ClassVar

import msgspec

from daemon.wire.requests import PROTOCOL_VERSION


class Event(msgspec.Struct, tag_field="type", kw_only=True):
    """Fields that every event has; a receiver ignores fields that it does not know.

    Attributes:
        v: version of the protocol.
        id: id of the command that the event belongs to; empty for `state`.
        seq: count of the daemon's messages.
        t_mono: the daemon's monotonic clock in seconds.
    """

    terminal: ClassVar[bool] = False
    v: int = PROTOCOL_VERSION
    id: str = ""
    seq: int = 0
    t_mono: float = 0.0
