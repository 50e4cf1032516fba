"""Addresses of the web server that lead to the daemon: `cmd`, `ctl`, `pub` and `stream`, as WebSockets and by POST."""

from __future__ import annotations

# pyright: reportUnknownMemberType=false
# Tornado's `finish` and `write` take a `dict` of unknown element types.
import asyncio
import contextlib
import time

import msgspec
import zmq.asyncio
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from daemon.client.compositions import FIRST_REPLY_TIMEOUT_S, MOTION_TIMEOUT_S
from daemon.front.rate_limits import Rates
from daemon.view.handlers import BaseHandler
from daemon.view.relay import Reader, send, unreached
from daemon.view.web_state import MOST_BYTES, MOST_POSTS, MOST_SOCKETS, RATE_HZ, is_stop, type_of

STREAM_RATE_HZ, STREAM_BURST = 500.0, 500
"""Targets per second, and targets at once, of one connection to `stream`; more are dropped, as only the newest counts."""
CTL_TIMEOUT_S = 5.0
_STATUS = {"error": 400, "rejected": 409, "failed": 409}


class _Socket(WebSocketHandler, BaseHandler):
    """A WebSocket whose frames are passed to the daemon and back."""

    def prepare(self) -> None:
        super().prepare()
        if self._finished or self.request.headers.get("Upgrade", "").lower() != "websocket":
            return
        if self.server.sockets >= MOST_SOCKETS:
            self.refuse(503, f"{MOST_SOCKETS} connections are open; close a page")

    async def get(self, *args: str, **kwargs: str) -> None:
        if self.request.headers.get("Upgrade", "").lower() == "websocket":
            await super().get(*args, **kwargs)
            return
        self.set_header("Upgrade", "websocket")
        self.set_header("Connection", "Upgrade")
        at = f"{self.request.host}{self.request.path}"
        example = {"/v1/cmd": "bow", "/v1/ctl": "stop"}.get(self.request.path)
        post = f", or send one request by POST: curl -d {example} http://{at}" if example else ""
        self.refuse(426, f"a GET that asks for no WebSocket; connect to ws://{at}{post}", "upgrade_required")

    def check_origin(self, origin: str) -> bool:
        return True  # `prepare` has checked the origin

    def open(self, *_: str, **__: str) -> None:
        self.server.sockets += 1
        self.set_nodelay(True)

    def on_close(self) -> None:
        self.server.sockets -= 1


class RequestHandler(_Socket):
    """`cmd` or `ctl`: one request by POST, any number by WebSocket."""

    _daemon: zmq.asyncio.Socket | None = None
    _back: asyncio.Task[None] | None = None

    async def post(self, kind: str) -> None:
        frame, server = self.request.body, self.server
        until = self.get_query_argument("until", "")
        if until not in ("", "end"):
            self.refuse(400, f"until={until[:20]!r}; allowed: end, or none")
            return
        if len(frame) > MOST_BYTES:
            self.refuse(413, f"a request of {len(frame):,} bytes; at most {MOST_BYTES:,} are taken", "too_large")
            return
        if not server.allows(self.request, frame):
            self.refuse(429, f"more than {RATE_HZ:g} requests a second")
            return
        async with contextlib.AsyncExitStack() as stack:
            if not is_stop(frame):
                if server.posts.locked():
                    self.refuse(429, f"{MOST_POSTS} requests are under way")
                    return
                await stack.enter_async_context(server.posts)
            daemon = server.relay.requests(kind)
            stack.callback(daemon.close)
            if (error := await send(daemon, frame)) is not None:
                self.set_status(503)
                await self._answer(error)
                return
            first = await _received(daemon, FIRST_REPLY_TIMEOUT_S if kind == "cmd" else CTL_TIMEOUT_S)
            if first is None:
                self.set_status(504)
                await self._answer(unreached(frame))
                return
            self.set_status(_STATUS.get(type_of(first), 200))
            if until != "end":
                await self._answer(first)
                return
            self.set_header("Content-Type", "application/x-ndjson")
            event: bytes | None = first
            while event is not None:
                self.write(event + b"\n")
                await self.flush()
                if type_of(event) not in ("accepted", "progress"):
                    break
                event = await _received(daemon, MOTION_TIMEOUT_S)

    async def _answer(self, event: bytes) -> None:
        self.set_header("Content-Type", "application/json")
        await self.finish(event + b"\n")

    def open(self, *args: str, **_: str) -> None:
        super().open()
        self._daemon = self.server.relay.requests(args[0])
        self._back = asyncio.create_task(self._hand_back(self._daemon))

    async def on_message(self, message: str | bytes) -> None:
        frame = message.encode() if isinstance(message, str) else message
        if self._daemon is None:
            return
        error = await send(self._daemon, frame) if self.server.allows(self.request, frame) else _too_fast()
        if error is not None:
            await self.write_message(error.decode())

    def on_close(self) -> None:
        super().on_close()
        if self._back is not None:
            self._back.cancel()
        if self._daemon is not None:
            self._daemon.close()
            self._daemon = None

    async def _hand_back(self, daemon: zmq.asyncio.Socket) -> None:
        with contextlib.suppress(WebSocketClosedError):
            while True:
                await self.write_message((await daemon.recv()).decode())


class PublishedHandler(_Socket):
    """`pub`: state, health, events and log lines, each as one JSON message."""

    _reader: Reader | None = None
    _task: asyncio.Task[None] | None = None

    def open(self, *args: str, **_: str) -> None:
        super().open()
        self._reader = self.server.feed.join()
        self._task = asyncio.create_task(self._hand_on(self._reader))

    def on_message(self, message: str | bytes) -> None:
        """Ignore the message: this address takes no requests."""

    def on_close(self) -> None:
        super().on_close()
        if self._reader is not None:
            self.server.feed.leave(self._reader)
        if self._task is not None:
            self._task.cancel()

    async def _hand_on(self, reader: Reader) -> None:
        with contextlib.suppress(WebSocketClosedError):
            while True:
                await self.write_message(await reader.take())  # bytes are sent unchanged as text


class TargetHandler(_Socket):
    """`stream`: joint targets under a lease obtained through `cmd`."""

    _daemon: zmq.asyncio.Socket | None = None

    def open(self, *args: str, **_: str) -> None:
        super().open()
        self._daemon = self.server.relay.targets()
        self._rates = Rates(STREAM_RATE_HZ, STREAM_BURST)

    async def on_message(self, message: str | bytes) -> None:
        if self._daemon is not None and self._rates.allows(b"", time.monotonic()):
            await self._daemon.send(message.encode() if isinstance(message, str) else message)

    def on_close(self) -> None:
        super().on_close()
        if self._daemon is not None:
            self._daemon.close()
            self._daemon = None


async def _received(daemon: zmq.asyncio.Socket, timeout_s: float) -> bytes | None:
    try:
        return await asyncio.wait_for(daemon.recv(), timeout_s)
    except TimeoutError:
        return None


def _too_fast() -> bytes:
    event = {
        "type": "error", "code": "too_fast", "id": "", "asked": "read a request", "found": "more than that for a while",
        "allowed": f"{RATE_HZ:g} requests a second", "do": "ask less often",
    }  # fmt: skip
    return msgspec.json.encode(event)
