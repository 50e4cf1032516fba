"""State shared by the addresses of the web server: access, the daemon behind it, limits on requests and connections."""

from __future__ import annotations

import asyncio
import time

import msgspec
from tornado.httputil import HTTPServerRequest

from daemon.front.rate_limits import Rates
from daemon.front.stop_texts import stops
from daemon.network.web_access import Access
from daemon.settings.config import Endpoints
from daemon.view.relay import Feed, Relay

MOST_BYTES = 64 * 1024
"""Bytes of a request at most, as on the ZeroMQ sockets."""
MOST_SOCKETS = 64
"""Number of WebSockets open at a time, at most; a page has three."""
MOST_POSTS = 32
"""Number of POST requests under way at a time."""
RATE_HZ, BURST = 50.0, 200
"""Requests per second, and requests at once, of all web clients of one address; stops are not counted."""


class WebState:
    """State of one web server.

    Attributes:
        relay: sockets to the daemon.
        feed: the daemon's published messages.
        posts: semaphore for POST requests.
        sockets: the open WebSockets.

    Args:
        access: address, port and token.
        endpoints: endpoints of the daemon.
        shapes: shapes of a robot by its name.
        run: a recorded run that is shown instead of a daemon; None for none.
    """

    def __init__(self, access: Access, endpoints: Endpoints, shapes: dict[str, bytes], run: bytes | None) -> None:
        self.access, self.shapes, self.run = access, shapes, run
        self.relay = Relay(endpoints)
        self.feed = Feed(self.relay)
        self.posts = asyncio.Semaphore(MOST_POSTS)
        self.sockets = 0
        self._rates = Rates(RATE_HZ, BURST)

    def allows(self, request: HTTPServerRequest, frame: bytes) -> bool:
        """Whether a request may be sent to the daemon now; a stop always may."""
        return self._rates.allows((request.remote_ip or "").encode(), time.monotonic()) or is_stop(frame)


class _Typed(msgspec.Struct):
    type: str = ""


def type_of(event: bytes) -> str:
    """The `type` of a message."""
    return msgspec.json.decode(event, type=_Typed).type


def is_stop(frame: bytes) -> bool:
    """Whether a frame is a `stop`, an `estop` or a text that means to stop: these are sent on regardless of the rate limit."""
    if frame.strip() == b"estop" or stops([frame]):
        return True
    try:
        return msgspec.json.decode(frame, type=_Typed).type in ("stop", "estop")
    except (
        msgspec.MsgspecError,
        UnicodeDecodeError,
        RecursionError,
    ):  # the daemon's answer says what is wrong with the frame
        return False
