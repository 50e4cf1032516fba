"""Messages of the daemon: bytes to requests, events to bytes. Sans-I/O.

A request is one frame: JSON of a known type, or plain text, which is the text of `say`. Every message has `v`, `id`,
`type`, `seq` and `t_mono`. A frame that is wrong raises one `WireError`, which holds what was asked, found and allowed
and what to do, so that it becomes exactly one `error` event. An accepted command ends in exactly one of `done`,
`cancelled`, `failed`; `rejected` and `error` mean that it was never accepted.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import msgspec

from daemon.errors import DaemonError
from daemon.wire.allowed import refused_value
from daemon.wire.event_base import Event
from daemon.wire.events import EVENTS, AnyEvent, ErrorEvent
from daemon.wire.requests import (
    CMD_TYPES,
    CTL_TYPES,
    MAX_ID_CHARS,
    MAX_TEXT_CHARS,
    PROTOCOL_VERSION,
    STREAM_TYPES,
    CmdRequest,
    CtlRequest,
    Request,
    Say,
    Target,
    tag_of,
)
from daemon.wire.showing import shortened, shown

MAX_FRAME_BYTES = 64 * 1024
MOST_NAMED = 5
"""Number of unknown fields that an error names, at most."""


class WireError(DaemonError, ValueError):
    """A frame that cannot be decoded; the text says what was requested, found and allowed, and what to do."""

    def __init__(self, code: str, asked: str, found: str, allowed: str, do: str, request_id: str = "") -> None:
        self.code, self.asked, self.found, self.allowed, self.do = code, asked, found, allowed, do
        self.request_id = request_id
        super().__init__(f"{asked}: found {found}; allowed: {allowed}; {do}")


_ENCODER = msgspec.json.Encoder()
_EVENT_DECODER = msgspec.json.Decoder(AnyEvent)
_Decoded = TypeVar("_Decoded")
_PLAIN = "close every brace, or send plain text that does not begin with { or ["


def encode(message: Request | Event) -> bytes:
    """JSON of a request or event."""
    return _ENCODER.encode(message)


def decode_event(frame: bytes) -> AnyEvent:
    """The event in a frame.

    Raises:
        WireError: the frame is no event.
    """
    try:
        return _EVENT_DECODER.decode(frame)
    except Exception as error:  # RecursionError, MemoryError, ...: any error that a peer can provoke in a decoder
        raise WireError(
            "not_an_event", "read an event", shortened(error), _names(EVENTS), "is this mmmd's port?"
        ) from None


def decode_cmd(frame: bytes) -> CmdRequest:
    """The request in a frame of the `cmd` socket; a frame that is not JSON is the text of `say`.

    Raises:
        WireError: the frame cannot be taken.
    """
    return _or_refused(_read_cmd, frame)


def decode_ctl(frame: bytes) -> CtlRequest:
    """The request in a frame of the `ctl` socket: JSON, or the bare verb.

    Raises:
        WireError: the frame cannot be taken.
    """
    return _or_refused(_read_ctl, frame)


def decode_target(frame: bytes) -> Target:
    """The joint target in a frame of the `stream` socket.

    Raises:
        WireError: the frame cannot be taken.
    """
    return _or_refused(_read_target, frame)


def only_frame(parts: list[bytes]) -> bytes:
    """The only frame of a request.

    Raises:
        WireError: there is no frame, or more than one.
    """
    if len(parts) != 1:
        found, do = f"{len(parts)} frames", "send the request as one frame"
        raise WireError("frames", "read a request", found, "1 frame", do)
    return parts[0]


def error_event(error: WireError) -> ErrorEvent:
    """The `error` event that answers a bad frame."""
    return ErrorEvent(
        id=error.request_id, code=error.code, asked=error.asked, found=error.found, allowed=error.allowed, do=error.do
    )


def _or_refused(read: Callable[[bytes], _Decoded], frame: bytes) -> _Decoded:
    """Decode a frame with `read`.

    Raises:
        WireError: the frame cannot be taken. Nothing else leaves here, whatever the frame made a decoder raise: who reads a
            socket must outlive every frame, and the thread that stops the robot is one of them.
    """
    try:
        return read(frame)
    except WireError:
        raise
    except Exception as error:
        found = "too deeply nested" if isinstance(error, RecursionError) else shortened(error)
        raise WireError("bad_json", "read a request", found, "one JSON object", _PLAIN) from None


def _read_cmd(frame: bytes) -> CmdRequest:
    text = _checked_text(frame)
    if text.lstrip()[:1] in ("{", "["):
        return _decode_json(text, CMD_TYPES, CmdRequest, "cmd")
    check_text(text)
    return Say(text=text.strip())


def _read_ctl(frame: bytes) -> CtlRequest:
    text = _checked_text(frame).strip()
    if text[:1] not in ("{", "["):
        text = _ENCODER.encode({"type": text}).decode()
    return _decode_json(text, CTL_TYPES, CtlRequest, "ctl")


def _read_target(frame: bytes) -> Target:
    return _decode_json(_checked_text(frame), STREAM_TYPES, Target, "stream")


def _checked_text(frame: bytes) -> str:
    if len(frame) > MAX_FRAME_BYTES:
        raise WireError(
            "too_large", "read a request", f"{len(frame)} bytes", f"at most {MAX_FRAME_BYTES}", "send less in one frame"
        )
    try:
        return frame.decode("utf-8")
    except UnicodeDecodeError as error:
        found = f"byte 0x{frame[error.start]:02x} at position {error.start}, which is not UTF-8"
        raise WireError("not_utf8", "read a request", found, "UTF-8 text or JSON", "encode the text as UTF-8") from None


def _decode_json(text: str, types: tuple[type[Request], ...], union: Any, socket: str) -> Any:
    try:
        raw = msgspec.json.decode(text)
    except (msgspec.DecodeError, RecursionError) as error:
        found = "too deeply nested" if isinstance(error, RecursionError) else shortened(error)
        raise WireError("bad_json", "read a JSON request", found, "one JSON object", _PLAIN) from None
    if not isinstance(raw, dict):
        do = 'send {"type": "say", "text": "..."} or plain text'
        raise WireError("bad_json", "read a JSON request", f"a JSON {type(raw).__name__}", "one JSON object", do)
    asked = cast("dict[str, Any]", raw)  # JSON objects have no other keys
    request_id = asked.get("id", "")
    request_id = request_id if isinstance(request_id, str) and len(request_id) <= MAX_ID_CHARS else ""
    _check_version(asked, request_id)
    kind = _check_type(asked, types, socket, request_id)
    if kind is Say and isinstance(asked.get("text"), str):
        check_text(asked["text"], request_id)
    try:
        return msgspec.convert(asked, union)
    except msgspec.ValidationError as error:
        name, known = str(asked["type"]), ["type", *(f.name for f in msgspec.structs.fields(kind))]
        unknown = [key for key in asked if key not in known]
        if unknown:
            more = f" and {len(unknown) - MOST_NAMED} more" if len(unknown) > MOST_NAMED else ""
            found = f"unknown field {', '.join(map(shown, unknown[:MOST_NAMED]))}{more}"
            allowed, do = f"fields {', '.join(known)}", "remove it; see docs/wire"
            raise WireError("unknown_field", f"'{name}' request", found, allowed, do, request_id) from None
        raise _bad_value(error, asked, kind, request_id) from None


def _bad_value(error: msgspec.ValidationError, raw: dict[str, Any], kind: type[Request], request_id: str) -> WireError:
    """The error of a request whose fields are known but have values that are not allowed."""
    name = tag_of(kind)
    if (refused := refused_value(error, raw, kind)) is not None:
        place, value, allowed = refused
        return WireError("bad_value", f"'{name}' request", f"{place} {shown(value)}", allowed, "correct it", request_id)
    missing = [f.encode_name for f in msgspec.structs.fields(kind) if f.required and f.encode_name not in raw]
    if missing:
        found, do = f"no {', '.join(missing)}", "add it"
        return WireError(
            "bad_value", f"'{name}' request", found, f"a request with {', '.join(missing)}", do, request_id
        )
    found, allowed = shortened(error), "fields that go together"
    return WireError("bad_value", f"'{name}' request", found, allowed, "correct it", request_id)


def _check_version(raw: dict[str, Any], request_id: str) -> None:
    version = raw.get("v", PROTOCOL_VERSION)
    if type(version) is not int or version != PROTOCOL_VERSION:
        found, allowed = (
            f"version {shown(version)} of the protocol",
            f"version {PROTOCOL_VERSION}, which this daemon speaks",
        )
        raise WireError("version", "read a request", found, allowed, "use a client of the same version", request_id)


def _check_type(raw: dict[str, Any], types: tuple[type[Request], ...], socket: str, request_id: str) -> type[Request]:
    by_name: dict[object, type[Request]] = {tag_of(t): t for t in types}
    name = raw.get("type")
    if isinstance(name, str) and name in by_name:
        return by_name[name]
    found = "no 'type'" if name is None else f"type {shown(name)}"
    do = "name one of these types"
    for its_socket, its_types in (("cmd", CMD_TYPES), ("ctl", CTL_TYPES), ("stream", STREAM_TYPES)):
        if isinstance(name, str) and name in {tag_of(t) for t in its_types}:
            do = f"send it to the {its_socket} socket"
            break
    allowed = f"on {socket}: {_names(types)}"
    raise WireError("unknown_type", "read a request", found, allowed, do, request_id)


def check_request(request: Request) -> None:
    """Refuse a request that the daemon would refuse, before it is sent.

    Raises:
        WireError: a value is outside the schema's bounds.
    """
    decode_cmd(encode(request))


def check_text(text: str, request_id: str = "") -> None:
    """Refuse a text that is empty or too long.

    Raises:
        WireError: the text is empty or too long.
    """
    if not text.strip():
        raise WireError(
            "empty_text",
            "say",
            "an empty text",
            f"1 to {MAX_TEXT_CHARS} characters",
            "say what to do, in words",
            request_id,
        )
    if len(text) > MAX_TEXT_CHARS:
        found, do = f"{len(text)} characters", "say it in fewer words"
        raise WireError("text_too_long", "say", found, f"1 to {MAX_TEXT_CHARS} characters", do, request_id)


def _names(types: tuple[type[msgspec.Struct], ...]) -> str:
    return ", ".join(tag_of(t) for t in types)
