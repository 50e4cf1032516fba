"""A Model Context Protocol server over stdio: a language model moves and stops the robot, within the daemon's own limits.

The server speaks JSON-RPC 2.0, one message a line (MCP revision 2025-06-18, tools only). Each line is answered when its call is
done, so that `stop`, `estop` and `status` do not wait for a motion; motions with `wait` are played one after the other, and a stop
ends those that have not begun. No tool can bypass the daemon: a tool is a request like any other, refused with
the daemon's words. Arming after a fault or e-stop stays with people: there is no tool.
"""

from __future__ import annotations

import asyncio
import contextlib
import importlib.metadata
import logging
import threading
from collections.abc import Awaitable, Callable
from typing import IO, Any, cast

from daemon.client.async_client import AsyncClient
from daemon.client.errors import CancelledByError, Said
from daemon.client.event_text import repeatable
from daemon.client.json_rpc import (
    BAD_PARAMETERS,
    INTERNAL,
    NO_METHOD,
    AnswerWriter,
    Call,
    RpcError,
    RpcId,
    decode_call,
    failure,
    lines,
    result,
)
from daemon.errors import DaemonError
from daemon.wire.codec import MOST_NAMED
from daemon.wire.requests import (
    LEAST_AMPLITUDE,
    LEAST_TEMPO,
    LONGEST_S,
    MOST_AMPLITUDE,
    MOST_SCENES,
    MOST_TEMPO,
    SHORTEST_S,
)
from daemon.wire.showing import in_words, shortened, shown
from mmm_core.language.stop_words import means_stop

log = logging.getLogger(__name__)

PROTOCOL_REVISIONS = ("2025-06-18", "2025-03-26", "2024-11-05")
MOST_WAITING = 64
"""Number of motions that wait for their turn at most; another is refused."""
END_S = 2.0
"""Seconds that the peer has to read the last answers."""
INSTRUCTIONS = (
    "A humanoid upper body: head, arms and torso. Say short English commands, one motion each, or several with `story`. "
    "'again', 'slower', 'with the other hand', 'three more', 'keep going' refer to what you said last. "
    "'Keep waving' or 'wave until I say stop' goes on until something else is said. "
    "It cannot walk, squat or move its legs, has no fingers to grasp, point with or count on, holds no objects, shows no face, "
    "does not speak, sees nothing, and knows no other language. Where it refuses a text it says why: tell that to the person or "
    "choose a gesture of `gestures`. Results say what was understood and what was seen on the robot: repeat these, not what was "
    "asked for. "
    "After an e-stop or a fault a person has to arm the robot; no tool does."
)
_OPTIONS: dict[str, Any] = {
    "tempo": {"type": "number", "minimum": LEAST_TEMPO, "maximum": MOST_TEMPO},
    "amplitude": {"type": "number", "minimum": LEAST_AMPLITUDE, "maximum": MOST_AMPLITUDE},
    "repeat": {"type": "integer", "minimum": 1, "maximum": 20},
    "wait": {"type": "boolean", "description": "answer when the motion has ended (default), else once it is accepted"},
}
_STORY_OPTIONS = {key: _OPTIONS[key] for key in ("tempo", "amplitude", "wait")}
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
        ("story", "Several things one after the other in one motion, e.g. ['wave', 'clap twice', 'bow']; for a long performance.",
         {"texts": {"type": "array", "items": {"type": "string"}, "minItems": 1, "maxItems": MOST_SCENES}, **_STORY_OPTIONS},
         ["texts"]),
        ("cancel", "End what is being played, and all that waits; the robot brakes and holds, and takes the next command.", {}, []),
        ("gestures", "List the named gestures.", {}, []),
        ("look", "Turn the head: degrees to the left and down. Without angles the head is free again.",
         {"yaw_deg": _ANGLE, "pitch_deg": _ANGLE}, []),
        ("stop", "Brake within the limits and hold. Always allowed.", {}, []),
        ("estop", "Emergency: cut the torque at once (or hold, as the daemon is set). Only a person can undo it.", {}, []),
        ("status", "What the robot is doing.", {}, []),
    )
]  # fmt: skip


class McpServer:
    """Answers one client over a pair of streams."""

    def __init__(self, client: AsyncClient) -> None:
        self._client = client
        self._turn = asyncio.Lock()
        self._halts = self._waiting = 0
        self._halted_by = ""
        self._tools: dict[str, Callable[[dict[str, Any]], Awaitable[str]]] = {
            "say": self._say,
            "gesture": self._gesture,
            "story": self._story,
            "cancel": self._cancel,
            "gestures": self._gestures,
            "look": self._look,
            "stop": self._stop,
            "estop": self._estop,
            "status": self._status,
        }

    async def serve(self, source: IO[bytes], out: IO[str]) -> None:
        """Answer each line of `source`, read in a thread, until it ends and all lines are answered."""
        loop = asyncio.get_running_loop()
        unread: asyncio.Queue[bytes] = asyncio.Queue()
        answers = AnswerWriter(out)

        def read() -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended: nobody listens any more
                for line in lines(source):
                    loop.call_soon_threadsafe(unread.put_nowait, line)
                loop.call_soon_threadsafe(unread.put_nowait, b"")

        async def reply(line: bytes) -> None:
            answer = await self.answer(line)
            if answer is not None:
                answers.write(answer)

        threading.Thread(target=read, name="mcp", daemon=True).start()
        async with asyncio.TaskGroup() as replies:
            while line := await unread.get():
                if line.strip():
                    replies.create_task(reply(line))
        await asyncio.to_thread(answers.close, END_S)

    async def answer(self, line: bytes) -> dict[str, Any] | None:
        """The reply to one message of any content; None for a notification."""
        call_id: RpcId = None
        try:
            call = decode_call(line)
            call_id = call.id
            return None if call_id is None else result(call_id, await self._answer(call))
        except RpcError as error:
            error.id = call_id if error.id is None else error.id
            return failure(error)
        except Exception as error:  # one line must not end the server: the next one may be an e-stop
            log.exception("a call failed")
            return failure(RpcError(INTERNAL, shortened(error), call_id))

    async def _answer(self, call: Call) -> dict[str, Any]:
        if call.method == "initialize":
            return self._initialize(call.params)
        if call.method == "ping":
            return {}
        if call.method == "tools/list":
            return {"tools": TOOLS}
        if call.method == "tools/call":
            return await self._call(call.params)
        known = "initialize, ping, tools/list, tools/call"
        raise RpcError(NO_METHOD, f"method {shown(call.method)}; known: {known}")

    def _initialize(self, parameters: dict[str, Any]) -> dict[str, Any]:
        asked = parameters.get("protocolVersion")
        return {
            "protocolVersion": asked if asked in PROTOCOL_REVISIONS else PROTOCOL_REVISIONS[0],
            "capabilities": {"tools": {}},
            "serverInfo": {"name": "mmmd", "version": importlib.metadata.version("mmmd")},
            "instructions": INSTRUCTIONS,
        }

    async def _call(self, parameters: dict[str, Any]) -> dict[str, Any]:
        name, arguments = parameters.get("name"), parameters.get("arguments", {})
        tool = self._tools.get(name) if isinstance(name, str) else None
        if tool is None or not isinstance(arguments, dict):
            raise RpcError(BAD_PARAMETERS, f"tool {shown(name)}; known: {', '.join(self._tools)}")
        given = cast("dict[str, Any]", arguments)
        schema = next(t["inputSchema"] for t in TOOLS if t["name"] == name)
        unknown = sorted(map(shown, given.keys() - schema["properties"].keys()))[:MOST_NAMED]
        missing = sorted(set(schema["required"]) - given.keys())
        if unknown or missing:
            text = f"unknown: {', '.join(unknown) or 'none'}; missing: {', '.join(missing) or 'none'}"
            raise RpcError(BAD_PARAMETERS, f"{name}: {text}; allowed: {', '.join(schema['properties'])}")
        try:
            return _text(await tool(given))
        except CancelledByError as error:
            return _text(str(error))
        except (DaemonError, ValueError, TypeError, OverflowError) as error:
            return _text(shortened(error), failed=True)

    async def _say(self, arguments: dict[str, Any]) -> str:
        text, wait = _string(arguments.pop("text")), bool(arguments.pop("wait", True))
        if means_stop(text):  # a stop waits for no running motion
            return await self._stop({})
        return await self._play(lambda: self._client.say(text, wait=wait, **arguments))

    async def _gesture(self, arguments: dict[str, Any]) -> str:
        name, wait = _string(arguments.pop("name")), bool(arguments.pop("wait", True))
        return await self._play(lambda: self._client.gesture(name, wait=wait, **arguments))

    async def _story(self, arguments: dict[str, Any]) -> str:
        texts, wait = arguments.pop("texts"), bool(arguments.pop("wait", True))
        if not isinstance(texts, list):
            raise TypeError(f"found {shown(texts)}; allowed: a list of strings")
        scenes = [_string(text) for text in cast("list[object]", texts)]
        if any(map(means_stop, scenes)):
            return await self._stop({})
        return await self._play(lambda: self._client.story(scenes, wait=wait, **arguments))

    async def _cancel(self, _: dict[str, Any]) -> str:
        self._halts, self._halted_by = self._halts + 1, "cancel"
        note = (await self._client.cancel()).note
        return "ended; the robot brakes and holds" + (f": {note}" if note else "")

    async def _play(self, ask: Callable[[], Awaitable[Said]]) -> str:
        """Request a motion once the earlier ones have ended; a motion that a stop finds waiting is dropped."""
        halts = self._halts
        if self._waiting >= MOST_WAITING:
            raise ValueError(f"{self._waiting} motions wait already; wait for their answers, or call `stop`")
        self._waiting += 1
        try:
            async with self._turn:
                if halts != self._halts:
                    raise CancelledByError(self._halted_by)
                return repeatable((await ask()).events)
        finally:
            self._waiting -= 1

    async def _stop(self, _: dict[str, Any]) -> str:
        self._halts, self._halted_by = self._halts + 1, "stop"
        return f"stopped; before, the robot was {in_words((await self._client.stop()).state)}"

    async def _estop(self, _: dict[str, Any]) -> str:
        self._halts, self._halted_by = self._halts + 1, "estop"
        return f"e-stop is latched; before, the robot was {in_words((await self._client.estop()).state)}"

    async def _gestures(self, _: dict[str, Any]) -> str:
        return "\n".join(f"{g.name}: {g.text}" for g in (await self._client.capabilities()).gestures)

    async def _look(self, arguments: dict[str, Any]) -> str:
        note = (await self._client.look(arguments.get("yaw_deg"), arguments.get("pitch_deg"))).note
        return "looking there" + (f" as far as it goes: {note}" if note else "")

    async def _status(self, _: dict[str, Any]) -> str:
        s = await self._client.status()
        doing = f"playing {s.command.text!r}" if s.command else "playing nothing"
        needs = "; a person has to arm it first" if s.must_arm else ""
        return f"{s.robot} is {in_words(s.state)}{': ' + s.reason if s.reason else ''}, {doing}{needs}; generator {s.generator}"


def _text(text: str, *, failed: bool = False) -> dict[str, Any]:
    return {"content": [{"type": "text", "text": text}], "isError": failed}


def _string(value: object) -> str:
    """A text argument, unchanged.

    Raises:
        TypeError: the argument is no text.
    """
    if not isinstance(value, str):
        raise TypeError(f"found {shown(value)}; allowed: a string")
    return value
