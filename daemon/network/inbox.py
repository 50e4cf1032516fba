"""Receives whole messages of few parts from an asyncio socket; further parts of a message are discarded as they come."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import NamedTuple, cast

import zmq
import zmq.asyncio

from daemon.network.connections import ConnectionGuard, connection_of

MOST_PARTS = 8
"""Parts of a message that are kept: an address, an empty delimiter, and more parts than any request has."""
DISCARDED_AT_ONCE = 256
"""Parts discarded before the event loop continues with other tasks."""
MOST_DISCARDED = 1000
"""Discarded parts of a message after which its sender is cut off."""


class Message(NamedTuple):
    """One message.

    Attributes:
        parts: its parts, at most `MOST_PARTS`; the first ones of a longer message.
        fd: descriptor of its connection; -1 for a message that ZeroMQ made itself, as at the end of a subscriber.
        frame: the first part, with what ZeroMQ knows about the sender.
    """

    parts: list[bytes]
    fd: int
    frame: zmq.Frame

    @property
    def peer(self) -> str:
        """The sender: the name of its key, else its address, else empty."""
        for name in ("User-Id", "Peer-Address"):
            try:
                if found := self.frame.get(name):
                    return str(found)
            except zmq.ZMQError:
                continue
        return ""


class Inbox:
    """The receiving side of one socket.

    ZeroMQ hands over a message as a whole, however many parts it has; a list of a million parts would hold up the event
    loop. Several tasks may receive from one `Inbox`: each gets messages of its own.

    Args:
        socket: socket from which nothing else receives.
        guard: guard of its connections.
    """

    def __init__(self, socket: zmq.asyncio.Socket, guard: ConnectionGuard) -> None:
        self._socket, self._guard = socket, guard
        # Receives with DONTWAIT, as the asyncio socket itself does, but without a future.
        self._at_once: zmq.Socket[bytes] = zmq.Socket(shadow=socket)
        self._discarding = False
        self._discarded = 0

    async def receive(self) -> Message:
        """The next message."""
        while (message := await self.waiting()) is None:
            # Not `recv`: another task could take the second part before this one has gone on with the first.
            await cast("asyncio.Future[int]", self._socket.poll())
        return message

    async def waiting(self) -> Message | None:
        """The next message that has arrived already; None without one."""
        while True:
            await self._discard()
            frame = self._next()
            if frame is None:
                return None
            if (message := self._message(frame)) is not None:
                return message

    async def arrived(self, most: int) -> AsyncIterator[Message]:
        """The next message, and those after it that have arrived already, at most `most` in all; none is lost between two calls."""
        message = await self.receive()
        for n in range(1, most + 1):
            yield message
            following = await self.waiting() if n < most else None
            if following is None:
                return
            message = following

    def _message(self, frame: zmq.Frame) -> Message | None:
        """The message that begins with a frame; None for a frame of a message that is being discarded."""
        if self._discarding:
            self._discard_one(frame)
            return None
        parts = [frame]
        while parts[-1].more and len(parts) < MOST_PARTS:
            following = self._next()
            assert following is not None, "the parts of a message come together"
            parts.append(following)
        self._discarding, self._discarded = parts[-1].more, 0
        fd = connection_of(frame)
        self._guard.received(fd)
        return Message([part.bytes for part in parts], fd, frame)

    async def _discard(self) -> None:
        """Discard the remaining parts of a message that is too long."""
        while self._discarding:
            for _ in range(DISCARDED_AT_ONCE):
                frame = self._next()
                if frame is None:
                    self._discarding = False
                else:
                    self._discard_one(frame)
                if not self._discarding:
                    return
            await asyncio.sleep(0)

    def _discard_one(self, frame: zmq.Frame) -> None:
        self._discarding = frame.more
        self._discarded += 1
        if self._discarded == MOST_DISCARDED:
            self._guard.shut_down(connection_of(frame), "a message of too many parts", f"more than {MOST_DISCARDED}")

    def _next(self) -> zmq.Frame | None:
        """The next frame that has arrived; None without one."""
        try:
            return self._at_once.recv(zmq.DONTWAIT, copy=False)
        except zmq.Again:
            return None
