"""The web server: the page, and the daemon's messages over HTTP and WebSocket. One event loop that only passes bytes on.

`POST /v1/cmd` and `/v1/ctl` take one request (JSON, or plain text as on the ZeroMQ sockets) and answer with its first event; a
WebSocket at the same address takes any number of requests and receives all events. `/v1/pub` and `/v1/stream` are WebSockets only.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application
from tornado.web import RequestHandler as TornadoHandler

from daemon.network.web_access import Access
from daemon.settings.config import Endpoints, config_error
from daemon.view.handlers import (
    FILE_TYPES,
    FileHandler,
    OpenApiHandler,
    RobotHandler,
    RunHandler,
    UnknownAddressHandler,
)
from daemon.view.web_sockets import PublishedHandler, RequestHandler, TargetHandler
from daemon.view.web_state import MOST_BYTES, WebState

PAGE = Path(__file__).parent / "page"
MOST_READ_BYTES = 1024 * 1024
"""Bytes of a request that are read at most, so that one of more than `MOST_BYTES` is told why it is refused."""


class WebServer:
    """Serves one daemon to the web.

    Args:
        access: address, port and token.
        endpoints: endpoints of the daemon.
        shapes: shapes of a robot by its name, as `robot_shapes` returns them.
        page: whether the page is served, or the messages alone.
        run: a recorded run as `recorded_run` returns it, shown instead of a daemon; None for none.
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
        self._state = WebState(access, endpoints, shapes, run)
        files = (
            [(f"/{f.name}", FileHandler, {"file": f}) for f in sorted(PAGE.iterdir()) if f.suffix in FILE_TYPES]
            if page
            else []
        )
        both: list[Any] = [
            *files,
            *([("/", FileHandler, {"file": PAGE / "index.html"})] if page else []),
            ("/v1/openapi.json", OpenApiHandler),
            ("/v1/robot/(.+)", RobotHandler),
            ("/v1/run", RunHandler),
            ("/v1/(cmd|ctl)", RequestHandler),
            ("/v1/pub", PublishedHandler),
            ("/v1/stream", TargetHandler),
        ]
        self._server = HTTPServer(
            Application(
                both, server=self._state, default_handler_class=UnknownAddressHandler, default_handler_args={"page": page},
                websocket_max_message_size=MOST_BYTES, websocket_ping_interval=10, log_function=_unlogged
            ),
            max_body_size=MOST_READ_BYTES, max_header_size=16 * 1024, idle_connection_timeout=60, body_timeout=5,
        )  # fmt: skip

    @property
    def access(self) -> Access:
        """Address, port and token; after `bind` the port that was bound."""
        return self._state.access

    def bind(self) -> None:
        """Bind the port.

        Raises:
            ConfigError: another program has the port, or the address is not this machine's.
        """
        try:
            sockets = bind_sockets(self.access.port, self.access.host)
        except OSError as error:
            found = f"{self.access.host}:{self.access.port}: {error.strerror}"
            raise config_error("http", found, "a free port of this machine", "choose another") from error
        self._server.add_sockets(sockets)
        port = sockets[0].getsockname()[1]
        self._state.access = Access(self.access.host, port, self.access.token)

    async def serve(self) -> None:
        """Serve until cancelled."""
        try:
            await self._state.feed.follow()
        finally:
            self._server.stop()
            self._state.relay.close()


def _unlogged(_: TornadoHandler) -> None:
    """Log no request: addresses may contain the token."""
