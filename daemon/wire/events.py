"""What the daemon says: one struct for each event. Sans-I/O."""

from __future__ import annotations

from typing import Any, ClassVar

import msgspec

from daemon.wire.requests import PROTOCOL_VERSION


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
        duration_s: length of the generated motion; 0 for a story, of which only the first part is known.
        generate_ms: time the generator took.
        silence_s: of a lease: without a target for so long it brakes and holds; None for a motion.
    """

    plan_id: int
    text: str
    status: str
    understood: str
    reason: str
    scope_score: float
    duration_s: float
    generate_ms: float
    silence_s: float | None = None


class Progress(Event, tag="progress"):
    """A stage was reached.

    `arming`: waiting for torque and rest pose; `moving`: the first servo moves; `scene`: a part of a story is played next,
    or was left out. Of a lease: `leased`: targets move the robot from now on; `held` before a self-contact; `silent`: braking,
    as no target came; `streaming` again; `bad_target`: messages that were refused. `reason` says more.

    Attributes:
        plan_id: number of the plan, 0 before there is one.
        stage: the stage.
        first_motion_ms: text (of a lease: first target) to first changed servo goal, once `moving`.
        target_t_mono: of a lease, once `moving`: when its first target came, on the daemon's clock.
        scene: number of the part, from 1 in each round.
        text: of the part.
        status: accepted, degraded, or rejected when the part was left out.
        reason: why it is not accepted.
        understood: nearest known command and its score.
        scope_score: how near the part lies to what the model can do.
    """

    plan_id: int
    stage: str
    first_motion_ms: float | None = None
    target_t_mono: float | None = None
    scene: int | None = None
    text: str = ""
    status: str = ""
    reason: str = ""
    understood: str = ""
    scope_score: float | None = None


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
    """A ctl verb was handed to the bus; or a request that is no motion was carried out.

    Attributes:
        verb: the verb.
        state: the robot's state when it was handed over.
        note: what was changed about it, else empty.
    """

    verb: str
    state: str
    note: str = ""


class GestureInfo(msgspec.Struct):
    """A clip of the library.

    Attributes:
        name: for `gesture`.
        text: what it shows.
        seconds: its length.
        loop: whether a part of it goes round; else the whole is done again.
        hold_s: when it is held, with `hold`.
        mirror: the clip that shows the same on the other side, empty when it is symmetric.
        own: recorded or added by the user.
    """

    name: str
    text: str
    seconds: float
    loop: bool
    hold_s: float
    mirror: str
    own: bool = False


class JointInfo(msgspec.Struct):
    """A joint and what bounds it."""

    name: str
    role: str
    position_min_rad: float
    position_max_rad: float
    velocity_limit_rad_s: float
    acceleration_limit_rad_s2: float


class CapabilitiesEvent(Event, tag="capabilities"):
    """What this robot and this daemon can do.

    Attributes:
        version: of mmmd.
        robot: name of the robot.
        rate_hz: of the bus.
        joints: the joints.
        generator: ready, starting or down; with the checkpoint's hash.
        checkpoint_hash: of the weights in use, empty while there are none.
        requests: types that `cmd` and `ctl` take; each has a schema in docs/wire.
        topics: what `pub` publishes; subscribe to a topic, or to a beginning of it.
        options: bounds of the options of `say` and `gesture`.
        gestures: the library.
        idle_styles: for `idle`.
        stream: endpoint of the `stream` socket.
        lease: its times in seconds: silence_s (brake and hold), park_s, limp_s.
    """

    version: str
    robot: str
    rate_hz: float
    joints: list[JointInfo]
    generator: str
    checkpoint_hash: str
    requests: dict[str, list[str]]
    topics: dict[str, str]
    options: dict[str, list[float]]
    gestures: list[GestureInfo]
    idle_styles: list[str]
    stream: str = ""
    lease: dict[str, float] = msgspec.field(default_factory=dict[str, float])


class LeaseInfo(msgspec.Struct):
    """The lease that is held.

    Attributes:
        id: of its command, which every target names.
        holder: who asked for it, in its own words.
        state: accepted (not begun yet), waiting (for the first target), streaming, silent or released.
        held_by: what keeps the robot from its target: self-collision, silence, or nothing.
        silence_s: without a target for so long it brakes and holds.
        silent_s: since the last target.
        targets: messages taken.
        clipped: frames whose target lay outside a position limit.
    """

    id: str
    holder: str
    state: str
    held_by: str = ""
    silence_s: float = 0.0
    silent_s: float = 0.0
    targets: int = 0
    clipped: int = 0


class StreamInfo(msgspec.Struct):
    """The `stream` socket.

    Attributes:
        endpoint: where it is.
        lease: who may send to it now; None for nobody.
        bad: messages refused since the start, by code.
    """

    endpoint: str
    lease: LeaseInfo | None = None
    bad: dict[str, int] = msgspec.field(default_factory=dict[str, int])


class CurrentCommand(msgspec.Struct):
    """The command that is being played."""

    id: str
    plan_id: int
    text: str
    frames: int
    frames_pushed: int


class ServoHealth(msgspec.Struct):
    """What can be said of a servo, and what was counted since its port was opened.

    Attributes:
        id: of the servo.
        joint: name of the servo in the robot file.
        state: ok, late (its last answer came after the deadline), missing (none in the last cycle), faulted (reports a
            hardware error, or came back without torque or settings) or quarantined (long silent, asked once a second).
        timeouts: cycles without its answer.
        crc: of those, with bytes that were no answer.
        late: answers after the deadline.
        retries: questions outside the cycle that were asked again.
        alerts: hardware alerts that began.
    """

    id: int
    joint: str
    state: str
    timeouts: int = 0
    crc: int = 0
    late: int = 0
    retries: int = 0
    alerts: int = 0


class HealthEvent(Event, tag="health"):
    """Every servo, once a second on `v1/health`.

    Attributes:
        robot: name of the robot.
        servos: in the order of the robot file; none before the first bus cycle.
        silent_ms: since the newest bus cycle: what is said of the servos is as old.
    """

    robot: str
    servos: list[ServoHealth]
    silent_ms: float


class LogEvent(Event, tag="log"):
    """A line of the daemon's log, on `v1/log`; `t_mono` is when it was written.

    Attributes:
        level: info, warning or error.
        process: front, bus, generator or recorder.
        module: the logger's name.
        text: the line.
    """

    level: str
    process: str
    module: str
    text: str


class StateEvent(Event, tag="state"):
    """The robot and the daemon, 20 times a second on `v1/state` and in answer to `status`.

    Attributes:
        robot: name of the robot.
        bus: URL of the bus.
        state: limp, arming, idle, moving, holding, parking, fault or estop.
        must_arm: an explicit `arm` is needed before the next text.
        reason: why the robot is in fault, else empty.
        command: what is being played, None when nothing is.
        waiting: ids of the commands that wait for their turn or their time.
        idle: style of the idle movements, `off` when there are none.
        gaze_deg: where the head was told to look (left, down), None when it is free.
        stream: the socket for joint targets, and who holds its lease.
        generator: ready, starting or down, with the reason.
        joint_names: J names.
        goal_rad: (J,) what the servos were last told.
        present_rad: (J,) what they last measured.
        queued_ms: setpoints that the bus process has in hand.
        bus_info: counters of the bus process.
        servos_not_ok: those whose state is not ok; all are on `v1/health`.
        recording: path of the log, empty when there is none; says so when recording has stopped.
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
    waiting: list[str] = msgspec.field(default_factory=list[str])
    idle: str = "off"
    gaze_deg: tuple[float, float] | None = None
    stream: StreamInfo | None = None
    servos_not_ok: list[ServoHealth] = msgspec.field(default_factory=list[ServoHealth])


AnyEvent = (
    Accepted | Progress | Done | Cancelled | Rejected | ErrorEvent | Failed | Ack | StateEvent | HealthEvent
    | LogEvent | CapabilitiesEvent
)  # fmt: skip
EVENTS: tuple[type[Event], ...] = (
    Accepted, Progress, Done, Cancelled, Rejected, ErrorEvent, Failed, Ack, StateEvent, HealthEvent,
    LogEvent, CapabilitiesEvent,
)  # fmt: skip
