"""The web server: the page, and the daemon's messages over HTTP and WebSocket. One event loop that only hands bytes on.

`POST /v1/cmd` and `/v1/ctl` take one request (JSON, or plain text as on the ZeroMQ sockets) and answer with its first event; a
WebSocket at the same address takes any number and gets all events. `/v1/pub` and `/v1/stream` are WebSockets alone.
"""

from __future__ import annotations

# pyright: reportUnknownMemberType=false
# Tornado's `finish` and `write` take a `dict` without saying of what.
import asyncio
import contextlib
import logging
import time
from pathlib import Path
from typing import Any

import msgspec
import zmq.asyncio
from tornado.httpserver import HTTPServer
from tornado.httputil import HTTPServerRequest
from tornado.netutil import bind_sockets
from tornado.web import Application, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from daemon.client.compositions import FIRST_REPLY_TIMEOUT_S, MOTION_TIMEOUT_S
from daemon.front.rate_limits import Rates
from daemon.front.stop_texts import stops
from daemon.network.web_access import Access
from daemon.settings.config import Endpoints, config_error
from daemon.view.openapi import openapi
from daemon.view.relay import Feed, Reader, Relay, send, unreached

log = logging.getLogger(__name__)

PAGE = Path(__file__).parent / "page"
MOST_BYTES = 64 * 1024
"""Length of a request, as on the ZeroMQ sockets."""
MOST_SOCKETS = 64
"""WebSockets open at a time: a page has three."""
MOST_POSTS = 32
"""Requests by POST under way at a time."""
RATE_HZ, BURST = 50.0, 200
"""Requests a second, and at once, of all web clients of one address; stops are never counted."""
STREAM_RATE_HZ, STREAM_BURST = 500.0, 500
"""Targets a second, and at once, of one connection to `stream`; more are dropped, as only the newest counts."""
CTL_TIMEOUT_S = 5.0
_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
_STATUS = {"error": 400, "rejected": 409, "failed": 409}
_POLICY = "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"


class WebServer:
    """Serves one daemon to the web.

    Args:
        access: address, port and token.
        endpoints: where the daemon is.
        shapes: of the robot by its name, as `robot_shapes` gives them.
        page: whether the page is served, or the messages alone.
        run: a recorded run as `recorded_run` gives it, shown instead of a daemon; None for none.
    """

    def __init__(
        self,
        access: Access,
        endpoints: Endpoints,
        shapes: dict[str, bytes],
        *,
        page: bool = True,
        run: bytes | None = None,
    ) -> None:
        self.access, self.shapes, self.run = access, shapes, run
        self.relay = Relay(endpoints)
        self.feed = Feed(self.relay)
        self.posts = asyncio.Semaphore(MOST_POSTS)
        self.sockets = 0
        self._rates = Rates(RATE_HZ, BURST)
        files = (
            [(f"/{f.name}", _File, {"file": f}) for f in sorted(PAGE.iterdir()) if f.suffix in _TYPES] if page else []
        )
        both: list[Any] = [
            *files,
            *([("/", _File, {"file": PAGE / "index.html"})] if page else []),
            ("/v1/openapi.json", _OpenApi),
            ("/v1/robot/(.+)", _Robot),
            ("/v1/run", _Run),
            ("/v1/(cmd|ctl)", _Requests),
            ("/v1/pub", _Published),
            ("/v1/stream", _Targets),
        ]
        self._server = HTTPServer(
            Application(
                both, server=self, websocket_max_message_size=MOST_BYTES, websocket_ping_interval=10, log_function=_unlogged
            ),
            max_body_size=MOST_BYTES, max_header_size=16 * 1024, idle_connection_timeout=60, body_timeout=5,
        )  # fmt: skip

    def bind(self) -> None:
        """Take the port.

        Raises:
            ConfigError: somebody else has it, or the address is not this machine's.
        """
        try:
            sockets = bind_sockets(self.access.port, self.access.host)
        except OSError as error:
            found = f"{self.access.host}:{self.access.port}: {error.strerror}"
            raise config_error("http", found, "a free port of this machine", "choose another") from error
        self._server.add_sockets(sockets)
        port = sockets[0].getsockname()[1]
        self.access = Access(self.access.host, port, self.access.token)

    async def serve(self) -> None:
        """Serve until cancelled."""
        try:
            await self.feed.follow()
        finally:
            self._server.stop()
            self.relay.close()

    def allows(self, request: HTTPServerRequest, frame: bytes) -> bool:
        """Whether a request may go on to the daemon now; a stop always may."""
        return self._rates.allows((request.remote_ip or "").encode(), time.monotonic()) or _is_stop(frame)


class _Handler(RequestHandler):
    """What all addresses have in common: who may use them, and nothing of it kept or framed by other sites."""

    @property
    def server(self) -> WebServer:
        return self.settings["server"]

    def set_default_headers(self) -> None:
        self.clear_header("Server")
        for name, value in (
            ("Content-Security-Policy", _POLICY), ("X-Content-Type-Options", "nosniff"), ("Referrer-Policy", "no-referrer"),
            ("Cache-Control", "no-cache"), ("Cross-Origin-Resource-Policy", "same-origin"),
        ):  # fmt: skip
            self.set_header(name, value)

    def prepare(self) -> None:
        if refused := self.server.access.refusal(self.request.headers, self.get_query_argument("token", "")):
            self._refuse(*refused)

    def write_error(self, status_code: int, **_: Any) -> None:
        self.finish({"type": "error", "code": "http", "found": self._reason, "asked": self.request.path})

    def _refuse(self, status: int, why: str, code: str = "forbidden") -> None:
        self.set_status(status)
        if status == 401:
            self.set_header("WWW-Authenticate", "Bearer")
        self.finish({"type": "error", "code": code, "asked": self.request.path, "found": why})


class _File(_Handler):
    """A file of the page; without a token, as it holds nothing of the robot."""

    def initialize(self, file: Path) -> None:
        self._file = file

    def prepare(self) -> None:
        if not self.server.access.token:
            super().prepare()

    def get(self) -> None:
        self.set_header("Content-Type", f"{_TYPES[self._file.suffix]}; charset=utf-8")
        self.finish(self._file.read_bytes())


class _OpenApi(_Handler):
    def get(self) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(openapi())


class _Robot(_Handler):
    """Shapes of a robot, by its name."""

    def get(self, name: str) -> None:
        shapes = self.server.shapes.get(name)
        if shapes is None:
            self._refuse(404, f"the shapes of {name!r} are not known here; start `mmmd view` with --robot")
            return
        self.set_header("Content-Type", "application/octet-stream")
        self.finish(shapes)


class _Run(_Handler):
    """A recorded run; 204 where a daemon is shown."""

    def get(self) -> None:
        if self.server.run is None:
            self.set_status(204)
            self.finish()
            return
        self.set_header("Content-Type", "application/octet-stream")
        self.finish(self.server.run)


class _Socket(WebSocketHandler, _Handler):
    """A WebSocket whose frames go to the daemon and back."""

    def prepare(self) -> None:
        super().prepare()
        if self._finished or self.request.headers.get("Upgrade", "").lower() != "websocket":
            return
        if self.server.sockets >= MOST_SOCKETS:
            self._refuse(503, f"{MOST_SOCKETS} connections are open; close a page")

    async def get(self, *args: str, **kwargs: str) -> None:
        if self.request.headers.get("Upgrade", "").lower() == "websocket":
            await super().get(*args, **kwargs)
            return
        self.set_header("Upgrade", "websocket")
        self.set_header("Connection", "Upgrade")
        at = f"{self.request.host}{self.request.path}"
        example = {"/v1/cmd": "bow", "/v1/ctl": "stop"}.get(self.request.path)
        post = f", or send one request by POST: curl -d {example} http://{at}" if example else ""
        self._refuse(426, f"a GET that asks for no WebSocket; connect to ws://{at}{post}", "upgrade_required")

    def check_origin(self, origin: str) -> bool:
        return True  # `prepare` has judged it

    def open(self, *_: str, **__: str) -> None:
        self.server.sockets += 1
        self.set_nodelay(True)

    def on_close(self) -> None:
        self.server.sockets -= 1


class _Requests(_Socket):
    """`cmd` or `ctl`: one request by POST, any number by WebSocket."""

    _daemon: zmq.asyncio.Socket | None = None
    _back: asyncio.Task[None] | None = None

    async def post(self, kind: str) -> None:
        frame, server = self.request.body, self.server
        if not server.allows(self.request, frame):
            self._refuse(429, f"more than {RATE_HZ:g} requests a second")
            return
        async with contextlib.AsyncExitStack() as stack:
            if not _is_stop(frame):
                if server.posts.locked():
                    self._refuse(429, f"{MOST_POSTS} requests are under way")
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
            self.set_status(_STATUS.get(_type_of(first), 200))
            if self.get_query_argument("until", "") != "end":
                await self._answer(first)
                return
            self.set_header("Content-Type", "application/x-ndjson")
            event: bytes | None = first
            while event is not None:
                self.write(event + b"\n")
                await self.flush()
                if _type_of(event) not in ("accepted", "progress"):
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


class _Published(_Socket):
    """`pub`: state, health, events and log lines, each as one JSON message."""

    _reader: Reader | None = None
    _task: asyncio.Task[None] | None = None

    def open(self, *args: str, **_: str) -> None:
        super().open()
        self._reader = self.server.feed.join()
        self._task = asyncio.create_task(self._hand_on(self._reader))

    def on_message(self, message: str | bytes) -> None:
        """Nothing is asked here."""

    def on_close(self) -> None:
        super().on_close()
        if self._reader is not None:
            self.server.feed.leave(self._reader)
        if self._task is not None:
            self._task.cancel()

    async def _hand_on(self, reader: Reader) -> None:
        with contextlib.suppress(WebSocketClosedError):
            while True:
                await self.write_message(await reader.take())  # bytes go as text, as they are


class _Targets(_Socket):
    """`stream`: joint targets under a lease, which `cmd` gives."""

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


class _Typed(msgspec.Struct):
    type: str = ""


def _type_of(event: bytes) -> str:
    return msgspec.json.decode(event, type=_Typed).type


def _is_stop(frame: bytes) -> bool:
    """Whether a frame is a `stop`, an `estop` or a text that means to stop: handed on however many requests came before it."""
    if frame.strip() == b"estop" or stops([frame]):
        return True
    try:
        return msgspec.json.decode(frame, type=_Typed).type in ("stop", "estop")
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):  # the daemon names what is wrong with it
        return False


def _too_fast() -> bytes:
    event = {
        "type": "error", "code": "too_fast", "id": "", "asked": "read a request", "found": "more than that for a while",
        "allowed": f"{RATE_HZ:g} requests a second", "do": "ask less often",
    }  # fmt: skip
    return msgspec.json.encode(event)


def _unlogged(_: RequestHandler) -> None:
    """Requests are not logged: their addresses may hold the token."""
