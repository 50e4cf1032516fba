"""JSON-RPC 2.0, one message a line: each line of any bytes becomes one call or one error."""

from __future__ import annotations

import json
import queue
import threading
from collections.abc import Iterator
from typing import IO, Any, cast

import msgspec

from daemon.errors import DaemonError
from daemon.wire.showing import shortened, shown

PARSE_ERROR, BAD_REQUEST, NO_METHOD, BAD_PARAMETERS, INTERNAL = -32700, -32600, -32601, -32602, -32603
MOST_LINE_BYTES = 1 << 20
"""Bytes of a line at most; a longer line is one error."""
MOST_ID_CHARS = 256
MOST_UNWRITTEN = 1000
"""Number of answers that wait for a peer that does not read at most; further answers are dropped."""

RpcId = str | int | float | None


class RpcError(DaemonError):
    """A call that cannot be carried out, as JSON-RPC names it.

    Attributes:
        code: error code of JSON-RPC 2.0, section 5.1.
        id: id of the call; None when it is unknown.
    """

    def __init__(self, code: int, message: str, call_id: RpcId = None) -> None:
        self.code, self.id = code, call_id
        super().__init__(message)


class Call(msgspec.Struct):
    """A call, or without an id a notification."""

    method: str
    params: dict[str, Any] = {}
    id: RpcId = None


def decode_call(line: bytes) -> Call:
    """The call in a line.

    Raises:
        RpcError: the line holds no call.
    """
    if len(line) > MOST_LINE_BYTES:
        raise RpcError(PARSE_ERROR, f"a line of more than {MOST_LINE_BYTES} bytes; send less in one message")
    try:
        raw = msgspec.json.decode(line)
    except Exception as error:  # RecursionError and MemoryError among them
        raise RpcError(PARSE_ERROR, f"no JSON: {shortened(error)}") from None
    if not isinstance(raw, dict):
        raise RpcError(BAD_REQUEST, f"{shown(raw)}; allowed: one JSON object a line")
    asked = cast("dict[str, Any]", raw)
    call_id = asked.get("id")
    if not _is_id(call_id):
        raise RpcError(BAD_REQUEST, f"id {shown(call_id)}; allowed: a number, or at most {MOST_ID_CHARS} characters")
    try:
        return msgspec.convert(asked, Call)
    except msgspec.ValidationError as error:
        raise RpcError(BAD_REQUEST, shortened(error), call_id) from None


def result(call_id: RpcId, value: dict[str, Any]) -> dict[str, Any]:
    """The answer to a call."""
    return {"jsonrpc": "2.0", "id": call_id, "result": value}


def failure(error: RpcError) -> dict[str, Any]:
    """The answer to a call in error."""
    return {"jsonrpc": "2.0", "id": error.id, "error": {"code": error.code, "message": str(error)}}


def lines(source: IO[bytes]) -> Iterator[bytes]:
    """The lines of a stream; a line that is too long is cut just above the bound."""
    while line := source.readline(MOST_LINE_BYTES + 1):
        end = line
        while end and not end.endswith(b"\n") and len(line) > MOST_LINE_BYTES:
            end = source.readline(MOST_LINE_BYTES)
        yield line


class AnswerWriter:
    """Writes answers from a thread of its own, because a peer that does not read them must not delay a stop."""

    def __init__(self, out: IO[str]) -> None:
        self._out = out
        self._answers: queue.Queue[dict[str, Any] | None] = queue.Queue(MOST_UNWRITTEN)
        self._thread = threading.Thread(target=self._run, name="answers", daemon=True)
        self._thread.start()

    def write(self, answer: dict[str, Any]) -> None:
        """Write an answer as soon as the peer reads it; dropped when too many wait."""
        if not self._answers.full():
            self._answers.put_nowait(answer)

    def close(self, timeout_s: float) -> None:
        """Wait until all answers are written, `timeout_s` at most."""
        if not self._answers.full():
            self._answers.put_nowait(None)
        self._thread.join(timeout_s)

    def _run(self) -> None:
        while (answer := self._answers.get()) is not None:
            try:
                self._out.write(json.dumps(answer) + "\n")
                self._out.flush()
            except (OSError, ValueError):  # the peer has closed it
                return


def _is_id(value: object) -> bool:
    if isinstance(value, str):
        return len(value) <= MOST_ID_CHARS
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 2**63)
