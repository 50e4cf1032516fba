"""A Model Context Protocol server over stdio: a language model says, stops and looks, with the daemon's own limits.

JSON-RPC 2.0, one message a line (MCP revision 2025-06-18, tools only). Nothing here can go round the daemon: a tool is a
request like any other, refused with the same words. Arming after a fault or e-stop stays with people: there is no tool.
"""

from __future__ import annotations

import importlib.metadata
import json
import logging
from collections.abc import Callable
from typing import IO, Any, cast

from daemon.client import CancelledByError, Client
from daemon.errors import DaemonError
from daemon.requests import LEAST_AMPLITUDE, LEAST_TEMPO, LONGEST_S, MOST_AMPLITUDE, MOST_TEMPO, SHORTEST_S

log = logging.getLogger(__name__)

PROTOCOL_REVISIONS = ("2025-06-18", "2025-03-26", "2024-11-05")
_PARSE_ERROR, _BAD_REQUEST, _NO_METHOD, _BAD_PARAMETERS = -32700, -32600, -32601, -32602
_OPTIONS: dict[str, Any] = {
    "tempo": {"type": "number", "minimum": LEAST_TEMPO, "maximum": MOST_TEMPO},
    "amplitude": {"type": "number", "minimum": LEAST_AMPLITUDE, "maximum": MOST_AMPLITUDE},
    "repeat": {"type": "integer", "minimum": 1, "maximum": 20},
    "wait": {"type": "boolean", "description": "answer when the motion has ended (default), else once it is accepted"},
}
_SECONDS = {"type": "number", "minimum": SHORTEST_S, "maximum": LONGEST_S}
_ANGLE = {"type": "number", "minimum": -120, "maximum": 120}
TOOLS: list[dict[str, Any]] = [
    {
        "name": name,
        "description": description,
        "inputSchema": {
            "type": "object", "properties": properties, "required": required, "additionalProperties": False
        },
    }
    for name, description, properties, required in (
        ("say", "Move the robot's head, arms and torso as a short English text says, e.g. 'wave with your right hand'.",
         {"text": {"type": "string"}, "seconds": _SECONDS, **_OPTIONS}, ["text"]),
        ("gesture", "Play a named gesture; `gestures` lists them.", {"name": {"type": "string"}, **_OPTIONS}, ["name"]),
        ("gestures", "List the named gestures.", {}, []),
        ("look", "Turn the head: degrees to the left and down. Without angles the head is free again.",
         {"yaw_deg": _ANGLE, "pitch_deg": _ANGLE}, []),
        ("stop", "Brake within the limits and hold. Always allowed.", {}, []),
        ("estop", "Emergency: cut the torque at once. Only a person can undo it.", {}, []),
        ("status", "What the robot is doing.", {}, []),
    )
]  # fmt: skip


class McpServer:
    """Answers one client over a pair of streams."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._tools: dict[str, Callable[[dict[str, Any]], str]] = {
            "say": self._say,
            "gesture": self._gesture,
            "gestures": lambda _: "\n".join(f"{g.name}: {g.text}" for g in client.capabilities().gestures),
            "look": self._look,
            "stop": lambda _: f"stopped; the robot is in {client.stop().state}",
            "estop": lambda _: f"torque is cut; before, the robot was in {client.estop().state}",
            "status": lambda _: self._status(),
        }

    def serve(self, source: IO[str], out: IO[str]) -> None:
        """Answer line by line until the source ends."""
        for line in source:
            if not line.strip():
                continue
            answer = self.answer(line)
            if answer is not None:
                out.write(json.dumps(answer) + "\n")
                out.flush()

    def answer(self, line: str) -> dict[str, Any] | None:
        """The reply to one message; None for a notification."""
        try:
            message = json.loads(line)
        except (json.JSONDecodeError, RecursionError) as error:
            return _error(None, _PARSE_ERROR, f"no JSON: {error}")
        if not isinstance(message, dict):
            return _error(None, _BAD_REQUEST, "one JSON object a line")
        asked = cast("dict[str, Any]", message)
        request_id, method, parameters = asked.get("id"), asked.get("method"), asked.get("params", {})
        if not isinstance(method, str) or not isinstance(parameters, dict):
            return _error(request_id, _BAD_REQUEST, "`method` is a string and `params` an object")
        if request_id is None:
            return None
        if method == "initialize":
            return _result(request_id, self._initialize(cast("dict[str, Any]", parameters)))
        if method == "ping":
            return _result(request_id, {})
        if method == "tools/list":
            return _result(request_id, {"tools": TOOLS})
        if method == "tools/call":
            return self._call(request_id, cast("dict[str, Any]", parameters))
        return _error(request_id, _NO_METHOD, f"method {method!r}; known: initialize, ping, tools/list, tools/call")

    def _initialize(self, parameters: dict[str, Any]) -> dict[str, Any]:
        asked = parameters.get("protocolVersion")
        return {
            "protocolVersion": asked if asked in PROTOCOL_REVISIONS else PROTOCOL_REVISIONS[0],
            "capabilities": {"tools": {}},
            "serverInfo": {"name": "mmmd", "version": importlib.metadata.version("mmmd")},
            "instructions": "A humanoid upper body. Short commands, one motion each; a new one takes over from the old.",
        }

    def _call(self, request_id: Any, parameters: dict[str, Any]) -> dict[str, Any]:
        name, arguments = parameters.get("name"), parameters.get("arguments", {})
        tool = self._tools.get(name) if isinstance(name, str) else None
        if tool is None or not isinstance(arguments, dict):
            return _error(request_id, _BAD_PARAMETERS, f"tool {name!r}; known: {', '.join(self._tools)}")
        given = cast("dict[str, Any]", arguments)
        schema = next(t["inputSchema"] for t in TOOLS if t["name"] == name)
        unknown = given.keys() - schema["properties"].keys()
        missing = set(schema["required"]) - given.keys()
        if unknown or missing:
            text = f"unknown: {', '.join(sorted(unknown)) or 'none'}; missing: {', '.join(sorted(missing)) or 'none'}"
            return _error(request_id, _BAD_PARAMETERS, f"{name}: {text}; allowed: {', '.join(schema['properties'])}")
        try:
            return _result(request_id, _text(tool(given)))
        except CancelledByError as error:
            return _result(request_id, _text(str(error)))
        except (DaemonError, ValueError, TypeError) as error:
            return _result(request_id, _text(str(error), failed=True))

    def _say(self, arguments: dict[str, Any]) -> str:
        text, wait = str(arguments.pop("text")), bool(arguments.pop("wait", True))
        said = self._client.say(text, wait=wait, **arguments)
        return _told(said.events)

    def _gesture(self, arguments: dict[str, Any]) -> str:
        name, wait = str(arguments.pop("name")), bool(arguments.pop("wait", True))
        return _told(self._client.gesture(name, wait=wait, **arguments).events)

    def _look(self, arguments: dict[str, Any]) -> str:
        note = self._client.look(arguments.get("yaw_deg"), arguments.get("pitch_deg")).note
        return "looking there" + (f" as far as it goes: {note}" if note else "")

    def _status(self) -> str:
        s = self._client.status()
        doing = f"playing {s.command.text!r}" if s.command else "playing nothing"
        needs = "; a person has to arm it first" if s.must_arm else ""
        return (
            f"{s.robot} is in {s.state}{': ' + s.reason if s.reason else ''}, {doing}{needs}; generator {s.generator}"
        )


def _told(events: tuple[Any, ...]) -> str:
    from daemon.commands.playing import describe

    return "\n".join(describe(e) for e in events)


def _text(text: str, *, failed: bool = False) -> dict[str, Any]:
    return {"content": [{"type": "text", "text": text}], "isError": failed}


def _result(request_id: Any, result: dict[str, Any]) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "id": request_id, "result": result}


def _error(request_id: Any, code: int, message: str) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "id": request_id, "error": {"code": code, "message": message}}
