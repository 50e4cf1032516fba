"""The sockets of the asyncio client: opened on first use; every wait for a reply has a time-out."""

from __future__ import annotations

from types import TracebackType
from typing import Self

import zmq
import zmq.asyncio

from daemon.client.compositions import REPLY_TIMEOUT_S
from daemon.client.errors import unexpected
from daemon.client.lines import Line
from daemon.network.keys import KeyFolder, connect_curve
from daemon.settings.config import Endpoints
from daemon.wire.events import Ack, AnyEvent
from daemon.wire.requests import Request, tag_of


class AsyncConnection:
    """Sends requests and receives events over `cmd` and `ctl`, from one event loop.

    Args:
        endpoints: the daemon's endpoints; those that the environment names (`MMMD_CMD`, ...) when they are not given.
        timeout_s: seconds to wait for a reply at most.
    """

    def __init__(self, endpoints: Endpoints | None = None, timeout_s: float = REPLY_TIMEOUT_S) -> None:
        self.endpoints = endpoints or Endpoints.of_environment()
        self._timeout_s = timeout_s
        self._context = zmq.asyncio.Context()
        self._lines: dict[str, Line] = {}

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the sockets; unsent requests have 200 ms."""
        for line in self._lines.values():
            await line.close()
        self._context.destroy(linger=200)

    async def _command(self, request: Request) -> Ack:
        return await self._acknowledged(request, self.endpoints.cmd)

    async def _control(self, request: Request) -> Ack:
        return await self._acknowledged(request, self.endpoints.ctl)

    async def _acknowledged(self, request: Request, endpoint: str) -> Ack:
        event = await self._ask(request, endpoint)
        if not isinstance(event, Ack):
            raise unexpected(event, tag_of(request))
        return event

    async def _ask(self, request: Request, endpoint: str) -> AnyEvent:
        line = self._line(endpoint)
        async with line.asked(request, self._timeout_s) as heard:
            return await line.next_event(heard, self._timeout_s, tag_of(request))

    def _line(self, endpoint: str) -> Line:
        if endpoint not in self._lines:
            socket = self._context.socket(zmq.DEALER)
            socket.setsockopt(zmq.IMMEDIATE, 1)
            self._secure(socket, endpoint)
            socket.connect(endpoint)
            self._lines[endpoint] = Line(socket, endpoint)
        return self._lines[endpoint]

    def _secure(self, socket: zmq.asyncio.Socket, endpoint: str) -> None:
        if self.endpoints.keys is not None and endpoint.startswith("tcp://"):
            connect_curve(socket, KeyFolder(self.endpoints.keys), "daemon")
