"""Passes frames between the web and the daemon's ZeroMQ sockets without parsing them: the daemon checks them as any client's.

Every web client has a connection of its own to the daemon, so that no client receives another's events. Messages that no client
reads are dropped here, before they cost the daemon anything.
"""

from __future__ import annotations

import asyncio
from collections import OrderedDict, deque
from typing import Any

import msgspec
import zmq
import zmq.asyncio

from daemon.network.keys import KeyFolder, connect_curve
from daemon.settings.config import Endpoints
from daemon.wire.codec import encode
from daemon.wire.events import ErrorEvent

SEND_TIMEOUT_S = 1.0
"""Seconds until a frame that the daemon does not accept is given up."""
MOST_KEPT = 256
"""Messages of `pub` kept for a slow client, besides the newest state and health."""
_REPLACED = (b"v1/state", b"v1/health")
"""Topics of which a slow client gets only the newest message."""
_QUEUE = 100


class Relay:
    """Connections to one daemon.

    Args:
        endpoints: endpoints of the daemon.
    """

    def __init__(self, endpoints: Endpoints) -> None:
        self.endpoints = endpoints
        self._context = zmq.asyncio.Context()

    def requests(self, kind: str) -> zmq.asyncio.Socket:
        """A new connection to `cmd` or `ctl`."""
        return self._connected(zmq.DEALER, getattr(self.endpoints, kind))

    def targets(self) -> zmq.asyncio.Socket:
        """A new connection to `stream`."""
        return self._connected(zmq.PUB, self.endpoints.stream)

    def published(self) -> zmq.asyncio.Socket:
        """A new connection to `pub`, with all topics."""
        socket = self._connected(zmq.SUB, self.endpoints.pub)
        socket.subscribe(b"v1/")
        return socket

    def close(self) -> None:
        """Close every connection."""
        self._context.destroy(linger=100)

    def _connected(self, kind: int, endpoint: str) -> zmq.asyncio.Socket:
        socket = self._context.socket(kind)
        socket.setsockopt(zmq.LINGER, 100)
        socket.setsockopt(zmq.SNDHWM, _QUEUE)
        socket.setsockopt(zmq.RECONNECT_IVL_MAX, 1000)
        if kind == zmq.DEALER:
            socket.setsockopt(zmq.IMMEDIATE, 1)  # a request is not kept for a daemon that comes back later
        if self.endpoints.keys is not None and endpoint.startswith("tcp://"):
            connect_curve(socket, KeyFolder(self.endpoints.keys), "daemon")
        socket.connect(endpoint)
        return socket


async def send(socket: zmq.asyncio.Socket, frame: bytes) -> bytes | None:
    """Send a frame to the daemon; return an `error` event when no daemon accepts it, else None."""
    try:
        await asyncio.wait_for(socket.send(frame), SEND_TIMEOUT_S)
    except TimeoutError:
        return unreached(frame)
    return None


def unreached(frame: bytes) -> bytes:
    """The `error` event for a frame that no daemon accepted."""
    do = "start it with `mmmd run`, and look whether the addresses are the same"
    event = ErrorEvent(
        code="no_daemon", asked="reach the daemon", found="no answer", allowed="a daemon that runs", do=do
    )
    event.id = _id_of(frame)
    return encode(event)


def _id_of(frame: bytes) -> str:
    """The id in a request; empty without one."""
    try:
        found: Any = msgspec.json.decode(frame)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return ""
    name = found.get("id") if isinstance(found, dict) else ""  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    return name if isinstance(name, str) else ""


class Reader:
    """Messages of `pub` that one client has not received yet: the newest state and health, and the newest `MOST_KEPT` others."""

    def __init__(self) -> None:
        self._newest: OrderedDict[bytes, bytes] = OrderedDict()
        self._others: deque[bytes] = deque(maxlen=MOST_KEPT)
        self._there = asyncio.Event()
        self.dropped = 0

    def give(self, topic: bytes, payload: bytes) -> None:
        """Add a message for the client; the oldest one is dropped when the client does not keep up."""
        if topic in _REPLACED:
            self._newest[topic] = payload
        else:
            self.dropped += len(self._others) == MOST_KEPT
            self._others.append(payload)
        self._there.set()

    async def take(self) -> bytes:
        """Wait for the next message and return it."""
        while not self._others and not self._newest:
            self._there.clear()
            await self._there.wait()
        return self._others.popleft() if self._others else self._newest.popitem(last=False)[1]


class Feed:
    """Distributes the daemon's published messages to all readers; keeps the last state and health for later readers."""

    def __init__(self, relay: Relay) -> None:
        self._relay = relay
        self._last: dict[bytes, bytes] = {}
        self._readers: set[Reader] = set()

    def join(self) -> Reader:
        """Add a reader, which begins with the last state and health."""
        reader = Reader()
        for topic, payload in self._last.items():
            reader.give(topic, payload)
        self._readers.add(reader)
        return reader

    def leave(self, reader: Reader) -> None:
        self._readers.discard(reader)

    async def follow(self) -> None:
        """Pass on published messages, for ever."""
        socket = self._relay.published()
        while True:
            topic, payload = await socket.recv_multipart()
            if topic in _REPLACED:
                if self._last.get(topic) == payload:  # sent again for a client that has just subscribed
                    continue
                self._last[topic] = payload
            for reader in self._readers:
                reader.give(topic, payload)
