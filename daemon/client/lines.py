"""One socket of the asyncio client, over which several requests run at once."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import AsyncGenerator

import zmq
import zmq.asyncio

from daemon.client.connection import LONGEST_POLL_S
from daemon.client.errors import ConnectionLostError, NoAnswerError, stamp
from daemon.wire.codec import decode_event, encode
from daemon.wire.events import AnyEvent, Refusal
from daemon.wire.requests import Request, tag_of

LONGEST_WAIT_S = 1e9


class Line:
    """A DEALER socket that hands each event to the waiter for its id."""

    def __init__(self, socket: zmq.asyncio.Socket, endpoint: str) -> None:
        self._socket, self.endpoint = socket, endpoint
        self._waiting: dict[str, asyncio.Queue[AnyEvent]] = {}
        self._reader: asyncio.Task[None] | None = None

    @contextlib.asynccontextmanager
    async def asked(self, request: Request, timeout_s: float) -> AsyncGenerator[asyncio.Queue[AnyEvent]]:
        """Send a request; yields the queue of its events.

        Raises:
            NoAnswerError: no daemon was connected in time; the request is not sent later.
        """
        if self._reader is None:
            self._reader = asyncio.create_task(self._read())
        heard: asyncio.Queue[AnyEvent] = asyncio.Queue()
        self._waiting[request.id] = heard
        stamp(request)
        try:
            try:
                async with asyncio.timeout(timeout_s if timeout_s < LONGEST_WAIT_S else None):
                    await self._socket.send(encode(request))
            except TimeoutError:
                raise NoAnswerError(self.endpoint, tag_of(request), timeout_s) from None
            yield heard
        finally:
            self._waiting.pop(request.id, None)

    async def next_event(self, heard: asyncio.Queue[AnyEvent], timeout_s: float, asked: str) -> AnyEvent:
        """The next event of a queue that `asked` gave.

        Raises:
            NoAnswerError: no event in time, or the connection broke meanwhile.
        """
        began_s = time.monotonic()
        while True:
            left_s = began_s + timeout_s - time.monotonic()
            with contextlib.suppress(TimeoutError):
                return await asyncio.wait_for(heard.get(), min(LONGEST_POLL_S, max(0.0, left_s)))
            waited_s = time.monotonic() - began_s
            if waited_s >= timeout_s:
                raise NoAnswerError(self.endpoint, asked, timeout_s)
            connected = await self._socket.poll(0, zmq.POLLOUT)  # type: ignore[call-arg]  # as in `Connection._receive`
            if not connected and heard.empty():
                raise ConnectionLostError(self.endpoint, asked, waited_s)

    async def close(self) -> None:
        """Stop receiving events and close the socket."""
        if self._reader is not None:
            self._reader.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._reader
        self._socket.close(200)

    async def _read(self) -> None:
        while True:
            event = decode_event(await self._socket.recv())
            if event.id in self._waiting:
                self._waiting[event.id].put_nowait(event)
            elif isinstance(event, Refusal) and not event.id:  # the refused frame had no id
                for heard in self._waiting.values():
                    heard.put_nowait(event)
