"""Messages of the daemon: bytes to requests, events to bytes. Sans-I/O.

A request is one frame: JSON of a known type, or plain text, which is the text of `say`. Every message has `v`, `id`,
`type`, `seq` and `t_mono`. A frame that is wrong raises one `WireError`, which holds what was asked, found and allowed
and what to do, so that it becomes exactly one `error` event. An accepted command ends in exactly one of `done`,
`cancelled`, `failed`; `rejected` and `error` mean that it was never accepted.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, cast

import msgspec
from msgspec import Meta

from daemon.errors import DaemonError

PROTOCOL_VERSION = 1
MAX_FRAME_BYTES = 64 * 1024
MAX_TEXT_CHARS = 2000
MAX_ID_CHARS = 128
MAX_SEED = 2**31 - 1
SHORTEST_S, LONGEST_S = 0.2, 9.8
"""Lengths of motion that may be asked for: one token and a whole window of the model."""

Id = Annotated[str, Meta(max_length=MAX_ID_CHARS, description="chosen by the sender; the same id twice is one command")]
Text = Annotated[str, Meta(min_length=1, max_length=MAX_TEXT_CHARS)]


class WireError(DaemonError, ValueError):
    """A frame that cannot be taken; says what was asked, found and allowed, and what to do."""

    def __init__(self, code: str, asked: str, found: str, allowed: str, do: str, request_id: str = "") -> None:
        self.code, self.asked, self.found, self.allowed, self.do = code, asked, found, allowed, do
        self.request_id = request_id
        super().__init__(f"{asked}: found {found}; allowed: {allowed}; {do}")


class Request(msgspec.Struct, tag_field="type", forbid_unknown_fields=True, kw_only=True):
    """What every request may carry.

    Attributes:
        v: version of the protocol.
        id: chosen by the sender, returned in every event; empty lets the daemon choose.
        seq: the sender's count of messages; kept in the log.
        t_mono: the sender's monotonic clock in seconds; kept in the log.
    """

    v: int = PROTOCOL_VERSION
    id: Id = ""
    seq: int | None = None
    t_mono: float | None = None


class Say(Request, tag="say"):
    """Move as the text says.

    Attributes:
        text: what to do, in English.
        seed: the same text, seed and seconds give the same motion.
        seconds: length of the motion; None lets the model choose.
    """

    text: Text
    seed: Annotated[int, Meta(ge=0, le=MAX_SEED)] = 0
    seconds: Annotated[float, Meta(ge=SHORTEST_S, le=LONGEST_S)] | None = None


class Cancel(Request, tag="cancel"):
    """End a command: the robot decelerates within its limits and holds.

    Attributes:
        command: id of the command; empty means whatever is running.
    """

    command: Id = ""


class Status(Request, tag="status"):
    """Ask for a `state` event."""


class Stop(Request, tag="stop"):
    """Decelerate within the limits, hold, drop what was planned."""


class Estop(Request, tag="estop"):
    """Cut torque at once; latched until `reset`."""


class Reset(Request, tag="reset"):
    """Leave e-stop or fault: the robot is limp afterwards and must be armed."""


class Arm(Request, tag="arm"):
    """Torque on over a goal pinned to the measured pose, then a slow move to the rest pose."""


class Park(Request, tag="park"):
    """Move to the park pose, then torque off."""


CmdRequest = Say | Cancel | Status
CtlRequest = Stop | Estop | Reset | Arm | Park | Status
REQUESTS: tuple[type[Request], ...] = (Say, Cancel, Status, Stop, Estop, Reset, Arm, Park)
CMD_TYPES: tuple[type[Request], ...] = (Say, Cancel, Status)
CTL_TYPES: tuple[type[Request], ...] = (Stop, Estop, Reset, Arm, Park, Status)


class Event(msgspec.Struct, tag_field="type", kw_only=True):
    """What every event carries; a receiver ignores fields that it does not know.

    Attributes:
        v: version of the protocol.
        id: id of the command that the event belongs to; empty for `state`.
        seq: count of the daemon's messages.
        t_mono: the daemon's monotonic clock in seconds.
    """

    terminal: ClassVar[bool] = False
    v: int = PROTOCOL_VERSION
    id: str = ""
    seq: int = 0
    t_mono: float = 0.0


class Accepted(Event, tag="accepted"):
    """The text was understood and the motion will be played.

    Attributes:
        plan_id: number of the plan in the log.
        text: the text.
        status: accepted, or degraded when only part of the text can be done.
        understood: nearest known command and its score.
        reason: why it is degraded, else empty.
        scope_score: how near the text lies to what the model can do.
        duration_s: length of the generated motion.
        generate_ms: time the generator took.
    """

    plan_id: int
    text: str
    status: str
    understood: str
    reason: str
    scope_score: float
    duration_s: float
    generate_ms: float


class Progress(Event, tag="progress"):
    """A stage was reached: `arming` (waiting for torque and rest pose) or `moving` (the first servo moves).

    Attributes:
        plan_id: number of the plan, 0 before there is one.
        stage: the stage.
        first_motion_ms: text to first changed servo goal, once `moving`.
    """

    plan_id: int
    stage: str
    first_motion_ms: float | None = None


class Done(Event, tag="done"):
    """The motion was played to its end.

    Attributes:
        plan_id: number of the plan in the log.
        first_motion_ms: from the text's arrival to the first cycle in which a servo's goal changed; None when none did.
        duration_s: from the first to the last frame at the bus.
        frames: frames played.
        peak_speed_share: largest joint speed as a share of that joint's limit.
        peak_speed_joint: the joint that had it.
        peak_speed_rad_s: its speed.
        peak_speed_limit_rad_s: its limit.
        clipped_frames: frames in which a position limit changed the model's motion.
        gate_clipped_frames: frames that the last limiter before the bus changed.
        underruns: cycles in which the plan had no frame ready.
        direction_error_deg: mean angle between the human's and the robot's arm bones.
        interventions: times the path was led round a self-collision.
        log_dropped: cycles that are missing from these figures.
    """

    terminal: ClassVar[bool] = True
    plan_id: int
    first_motion_ms: float | None
    duration_s: float
    frames: int
    peak_speed_share: float
    peak_speed_joint: str
    peak_speed_rad_s: float
    peak_speed_limit_rad_s: float
    clipped_frames: int
    gate_clipped_frames: int
    underruns: int
    direction_error_deg: float
    interventions: int = 0
    log_dropped: int = 0


class Cancelled(Event, tag="cancelled"):
    """The command ended before its motion did.

    Attributes:
        plan_id: number of the plan, 0 when it had none yet.
        by: what ended it: stop, estop, park, reset, cancel, shutdown, or `say ID`.
    """

    terminal: ClassVar[bool] = True
    plan_id: int
    by: str


class Refusal(Event):
    """What was asked, found and allowed, and what to do next."""

    terminal: ClassVar[bool] = True
    code: str
    asked: str
    found: str
    allowed: str
    do: str

    @property
    def message(self) -> str:
        """One line for people."""
        return f"{self.asked}: {self.found}; allowed: {self.allowed}; {self.do}"


class Rejected(Refusal, tag="rejected"):
    """A well-formed command that is not taken now (state of the robot) or at all (out of the model's scope).

    Attributes:
        understood: nearest known command, when the scope was the reason.
        scope_score: how near the text lies to what the model can do.
    """

    understood: str = ""
    scope_score: float | None = None


class ErrorEvent(Refusal, tag="error"):
    """A frame that is not a request."""


class Failed(Refusal, tag="failed"):
    """A command that could not be carried out: generator, retargeting or bus.

    Attributes:
        plan_id: number of the plan, 0 when it had none yet.
    """

    plan_id: int = 0


class Ack(Event, tag="ack"):
    """A ctl verb was handed to the bus, or a cancel to the planner.

    Attributes:
        verb: the verb.
        state: the robot's state when it was handed over.
    """

    verb: str
    state: str


class CurrentCommand(msgspec.Struct):
    """The command that is being played."""

    id: str
    plan_id: int
    text: str
    frames: int
    frames_pushed: int


class StateEvent(Event, tag="state"):
    """The robot and the daemon, 20 times a second on `v1/state` and in answer to `status`.

    Attributes:
        robot: name of the robot.
        bus: URL of the bus.
        state: limp, arming, idle, moving, holding, parking, fault or estop.
        must_arm: an explicit `arm` is needed before the next text.
        reason: why the robot is in fault, else empty.
        command: what is being played, None when nothing is.
        generator: ready, starting or down, with the reason.
        joint_names: J names.
        goal_rad: (J,) what the servos were last told.
        present_rad: (J,) what they last measured.
        queued_ms: setpoints that the bus process has in hand.
        bus_info: counters of the bus process.
        recording: path of the log, empty when there is none.
        uptime_s: since the start of the daemon.
    """

    robot: str
    bus: str
    state: str
    must_arm: bool
    reason: str
    command: CurrentCommand | None
    generator: str
    joint_names: list[str]
    goal_rad: list[float]
    present_rad: list[float]
    queued_ms: float
    bus_info: dict[str, Any]
    recording: str
    uptime_s: float


AnyEvent = (
    Accepted | Progress | Done | Cancelled | Rejected | ErrorEvent | Failed | Ack | StateEvent
)  # fmt: skip
EVENTS: tuple[type[Event], ...] = (Accepted, Progress, Done, Cancelled, Rejected, ErrorEvent, Failed, Ack, StateEvent)

_ENCODER = msgspec.json.Encoder()
_EVENT_DECODER = msgspec.json.Decoder(AnyEvent)


def encode(message: Request | Event) -> bytes:
    """JSON of a request or event."""
    return _ENCODER.encode(message)


def decode_event(frame: bytes) -> AnyEvent:
    """The event in a frame.

    Raises:
        WireError: it is none.
    """
    try:
        return _EVENT_DECODER.decode(frame)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise WireError("not_an_event", "read an event", str(error), _names(EVENTS), "is this mmmd's port?") from error


def decode_cmd(frame: bytes) -> CmdRequest:
    """The request in a frame of the `cmd` socket; a frame that is not JSON is the text of `say`.

    Raises:
        WireError: the frame cannot be taken.
    """
    text = _checked_text(frame)
    if text.lstrip()[:1] in ("{", "["):
        return _decode_json(text, CMD_TYPES, CmdRequest, "cmd")
    check_text(text)
    return Say(text=text.strip())


def decode_ctl(frame: bytes) -> CtlRequest:
    """The request in a frame of the `ctl` socket: JSON, or the bare verb.

    Raises:
        WireError: the frame cannot be taken.
    """
    text = _checked_text(frame).strip()
    if text[:1] not in ("{", "["):
        text = _ENCODER.encode({"type": text}).decode()
    return _decode_json(text, CTL_TYPES, CtlRequest, "ctl")


def error_event(error: WireError) -> ErrorEvent:
    """The one event that answers a bad frame."""
    return ErrorEvent(
        id=error.request_id, code=error.code, asked=error.asked, found=error.found, allowed=error.allowed, do=error.do
    )


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
        found = "too deeply nested" if isinstance(error, RecursionError) else str(error)
        do = "close every brace, or send plain text that does not begin with { or ["
        raise WireError("bad_json", "read a JSON request", found, "one JSON object", do) from None
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
            found = f"unknown field {', '.join(map(repr, unknown))}"
            allowed, do = f"fields {', '.join(known)}", "remove it; see docs/wire"
            raise WireError("unknown_field", f"'{name}' request", found, allowed, do, request_id) from None
        allowed = f"what docs/wire/{name}.schema.json says"
        raise WireError("bad_value", f"'{name}' request", str(error), allowed, "correct it", request_id) from None


def _check_version(raw: dict[str, Any], request_id: str) -> None:
    version = raw.get("v", PROTOCOL_VERSION)
    if type(version) is not int or version != PROTOCOL_VERSION:
        found, allowed = f"version {version!r} of the protocol", f"version {PROTOCOL_VERSION}, which this daemon speaks"
        raise WireError("version", "read a request", found, allowed, "use a client of the same version", request_id)


def _check_type(raw: dict[str, Any], types: tuple[type[Request], ...], socket: str, request_id: str) -> type[Request]:
    by_name: dict[object, type[Request]] = {str(t.__struct_config__.tag): t for t in types}
    name = raw.get("type")
    if isinstance(name, str) and name in by_name:
        return by_name[name]
    found = "no 'type'" if name is None else f"type {name!r}"
    do = "name one of these types"
    if isinstance(name, str) and name in {str(t.__struct_config__.tag) for t in REQUESTS}:
        do = f"send it to the {'ctl' if socket == 'cmd' else 'cmd'} socket"
    allowed = f"on {socket}: {_names(types)}"
    raise WireError("unknown_type", "read a request", found, allowed, do, request_id)


def check_text(text: str, request_id: str = "") -> None:
    """Refuse a text that is empty or too long.

    Raises:
        WireError: it is.
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
    return ", ".join(str(t.__struct_config__.tag) for t in types)
