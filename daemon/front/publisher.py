"""The socket `pub`: state, health, events and log lines for all subscribers; state and health are also sent on subscribing."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

import msgspec
import zmq
import zmq.asyncio

from daemon.front.subscriptions import MOST_BYTES, RECEIVE_QUEUE, LastValues
from daemon.logs.log_feed import EVENT_LOGGER
from daemon.network.connections import ConnectionGuard
from daemon.network.inbox import Inbox
from daemon.network.sockets import publish_now
from daemon.wire.codec import encode
from daemon.wire.event_base import Event

event_log = logging.getLogger(EVENT_LOGGER)

TOPICS = {
    "v1/state": "the robot and the daemon, several times a second; the last one at once on subscribing",
    "v1/health": "every servo's state and counters, once a second; the last one at once on subscribing",
    "v1/event": "every event of every command",
    "v1/log": "the lines that the daemon's processes log",
}
SOCKET_BOUNDS = {"most_bytes": MOST_BYTES, "queue": RECEIVE_QUEUE}
"""Bounds of the socket's incoming messages, for `daemon.network.sockets.bind`."""
Record = Callable[[str, bytes], None]


class Publisher:
    """Publishes messages.

    Attributes:
        socket: `pub`; the front binds it.
        overruns: number of messages that a subscriber was too slow to receive.

    Args:
        context: context of the asyncio sockets.
        record: called with (topic, payload) for every message, for the log.
    """

    def __init__(self, context: zmq.asyncio.Context, record: Record | None) -> None:
        self._record = record
        self.overruns = 0
        self.socket = context.socket(zmq.XPUB)
        self.socket.setsockopt(zmq.XPUB_VERBOSE, 1)
        self.socket.setsockopt(zmq.XPUB_NODROP, 1)
        self._last_values: LastValues | None = None

    def guarded_by(self, guard: ConnectionGuard) -> LastValues:
        """The last values, whose `serve` answers subscriptions. Call this once the socket is bound."""
        self._last_values = LastValues(TOPICS, Inbox(self.socket, guard), guard, self._send)
        return self._last_values

    def publish(self, topic: str, message: Event) -> None:
        """Publish a message, and keep it for later subscribers."""
        payload = encode(message)
        assert self._last_values is not None, "the socket is bound"
        self._last_values.keep(topic.encode(), payload)
        if self._record is not None:
            self._record(topic, payload)
        self._send(topic.encode(), payload)

    async def publish_every(self, period_s: float, topic: str, message: Callable[[], Event]) -> None:
        """Publish a new message from `message` in every period, until cancelled."""
        while True:
            self.publish(topic, message())
            await asyncio.sleep(period_s)

    def event(self, event: Event) -> None:
        """Publish an event of a command, and log it."""
        self.publish("v1/event", event)
        event_log.info("%s", _line(event))

    def _send(self, topic: bytes, payload: bytes) -> None:
        self.overruns += not publish_now(self.socket, [topic, payload])


def _line(event: Event) -> str:
    """An event as one log line, without the fields that every event has and without empty fields."""
    skip = ("v", "seq", "t_mono", "id")
    fields = msgspec.structs.asdict(event).items()
    text = " ".join(f"{k}={v!r}" for k, v in fields if k not in skip and v not in (None, "", [], {}))
    return f"{event.__struct_config__.tag} {event.id[:8]} {text}"
