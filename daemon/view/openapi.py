"""The OpenAPI description of the web server, generated from the structs that decode the messages."""

from __future__ import annotations

import functools
import importlib.metadata
from typing import Any

import msgspec

from daemon.wire.events import EVENTS
from daemon.wire.requests import CMD_TYPES, CTL_TYPES

_PLAIN = {
    "cmd": "Plain text is the text of `say`.",
    "ctl": "Plain text is the bare verb: stop, estop, reset, arm, park or status.",
}


@functools.cache
def openapi() -> bytes:
    """The description as JSON."""
    (events, *requests), schemas = msgspec.json.schema_components(
        [_union(EVENTS), _union(CMD_TYPES), _union(CTL_TYPES)], ref_template="#/components/schemas/{name}"
    )
    paths = {
        f"/v1/{kind}": {"post": _post(kind, schema, events)} for kind, schema in zip(_PLAIN, requests, strict=True)
    }
    paths["/v1/pub"] = {"get": _socket("State 20 times a second, health, events and log lines, each a JSON message.")}
    paths["/v1/stream"] = {"get": _socket("Joint targets under a lease that `/v1/cmd` gives, each a JSON message.")}
    document: dict[str, Any] = {
        "openapi": "3.1.0",
        "info": {
            "title": "mmmd",
            "version": importlib.metadata.version("mmmd"),
            "description": "The messages of docs/wire over HTTP and WebSocket. `/v1/cmd` and `/v1/ctl` take WebSockets too, "
            "which get every event of their requests.",
        },
        "paths": paths,
        "components": {"schemas": schemas, "securitySchemes": {"token": {"type": "http", "scheme": "bearer"}}},
        "security": [{}, {"token": []}],
    }
    return msgspec.json.encode(document)


def _union(types: tuple[type[Any], ...]) -> Any:
    return functools.reduce(lambda a, b: a | b, types)


def _post(kind: str, request: dict[str, Any], events: dict[str, Any]) -> dict[str, Any]:
    answer = {"content": {"application/json": {"schema": events}}}
    return {
        "summary": f"One request of the socket `{kind}`, answered by its first event",
        "description": f"{_PLAIN[kind]} With `?until=end` all events are sent, one a line, to the one that ends the command.",
        "parameters": [{"name": "until", "in": "query", "schema": {"enum": ["end"]}}],
        "requestBody": {
            "required": True,
            "content": {"application/json": {"schema": request}, "text/plain": {"schema": {"type": "string"}}},
        },
        "responses": {
            "200": {"description": "taken", **answer},
            "400": {"description": "no request", **answer},
            "401": {"description": "the token is missing or wrong"},
            "403": {"description": "a page of another site"},
            "409": {"description": "rejected or failed, with the reason", **answer},
            "413": {"description": "more than 64 KiB"},
            "429": {"description": "too many requests"},
            "503": {"description": "no daemon is reached", **answer},
            "504": {"description": "the daemon does not answer", **answer},
        },
    }


def _socket(summary: str) -> dict[str, Any]:
    return {
        "summary": f"WebSocket: {summary}",
        "responses": {
            "101": {"description": "the connection is a WebSocket"},
            "426": {"description": "a GET that asks for no WebSocket; the body says how to connect"},
        },
    }
