"""Addresses that the web server answers by itself: files of the page, OpenAPI, shapes of the robot, a recorded run."""

from __future__ import annotations

# pyright: reportUnknownMemberType=false
# Tornado's `finish` and `write` take a `dict` of unknown element types.
from pathlib import Path
from typing import Any

from tornado.web import RequestHandler

from daemon.view.openapi import openapi
from daemon.view.web_state import WebState

FILE_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
_SERVED = (
    "POST or WebSocket /v1/cmd", "POST or WebSocket /v1/ctl", "WebSocket /v1/pub", "WebSocket /v1/stream", "GET /v1/openapi.json",
)  # fmt: skip
"""Addresses for programs, as a 404 answer lists them; the page uses others besides."""
_PAGE = "GET / (the page)"
_POLICY = "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"


class BaseHandler(RequestHandler):
    """Base of all addresses: checks access, and forbids browsers to cache answers and other sites to frame them."""

    @property
    def server(self) -> WebState:
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
            self.refuse(*refused)

    def write_error(self, status_code: int, **_: Any) -> None:
        found = self._reason
        if status_code == 405:
            served = [
                m for m in ("GET", "POST") if getattr(type(self), m.lower()) is not getattr(RequestHandler, m.lower())
            ]
            found = f"{self.request.method}, which this address does not serve; allowed: {', '.join(served)}"
            self.set_header("Allow", ", ".join(served))
        self.finish({"type": "error", "code": "http", "found": found, "asked": self.request.path})

    def refuse(self, status: int, why: str, code: str = "forbidden") -> None:
        self.set_status(status)
        if status == 401:
            self.set_header("WWW-Authenticate", "Bearer")
        self.finish({"type": "error", "code": code, "asked": self.request.path, "found": why})


class FileHandler(BaseHandler):
    """A file of the page; served without a token, as it contains no data of the robot."""

    def initialize(self, file: Path) -> None:
        self._file = file

    def prepare(self) -> None:
        if not self.server.access.token:
            super().prepare()

    def get(self) -> None:
        self.set_header("Content-Type", f"{FILE_TYPES[self._file.suffix]}; charset=utf-8")
        self.finish(self._file.read_bytes())


class OpenApiHandler(BaseHandler):
    """The description of the HTTP addresses."""

    def get(self) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(openapi())


class RobotHandler(BaseHandler):
    """Shapes of a robot, by the robot's name."""

    def get(self, name: str) -> None:
        shapes = self.server.shapes.get(name)
        if shapes is None:
            self.refuse(404, f"the shapes of {name!r} are not known here; start `mmmd view` with --robot")
            return
        self.set_header("Content-Type", "application/octet-stream")
        self.finish(shapes)


class RunHandler(BaseHandler):
    """The recorded run; 204 when a daemon is shown."""

    def get(self) -> None:
        if self.server.run is None:
            self.set_status(204)
            self.finish()
            return
        self.set_header("Content-Type", "application/octet-stream")
        self.finish(self.server.run)


class UnknownAddressHandler(BaseHandler):
    """Answers 404 for an unknown address, with a list of the known ones."""

    def initialize(self, page: bool) -> None:
        self._page = page

    def prepare(self) -> None:
        super().prepare()
        if self._finished:
            return
        served = (_PAGE, *_SERVED) if self._page else _SERVED
        elsewhere = "" if self._page else "; `mmmd run --view` and `mmmd view` serve the page"
        self.refuse(404, f"nothing at this address; served are: {', '.join(served)}{elsewhere}", "unknown_address")
