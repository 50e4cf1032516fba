"""Events of a command, one struct for each; and the union of all events. No I/O."""

from __future__ import annotations

from typing import ClassVar

from daemon.wire.event_base import Event
from daemon.wire.status import CapabilitiesEvent, HealthEvent, LogEvent, StateEvent


class Accepted(Event, tag="accepted"):
    """The text was understood and the motion will be played.

    Attributes:
        plan_id: number of the plan in the log.
        text: the text.
        status: accepted, or degraded when only part of the text can be done.
        understood: content of the motion made for the text, in one sentence; of a lease, the targets that it takes.
        nearest: the known command that lies nearest to the text, and its score; empty where no text was read.
        lacks: what this robot lacks to show the motion; empty for nothing.
        commands: what was read in the text, one entry for each command in turn; commands at once are joined by " + ", tempo, size
            and hold stand in brackets. Empty where no text was read.
        denied: what the text says not to do.
        refers_to: id of the earlier command that the text refers to ("again", "slower"); empty where it stands by itself.
        reason: why the text is degraded, else empty.
        scope_score: how near the text lies to what the model can do.
        duration_s: length of the generated motion, of one whose strokes are counted (`say` with a number) as first drafted; 0
            for a story, of which only the first part is known.
        generate_ms: time the generator took until there was something to play.
        silence_s: of a lease: without a target for so long it brakes and holds; None for a motion.
        goes_on: whether the motion goes round until another command, a stop or a cancel ends it (`loop`, "keep waving").
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
    nearest: str = ""
    lacks: str = ""
    commands: tuple[str, ...] = ()
    denied: tuple[str, ...] = ()
    refers_to: str = ""
    goes_on: bool = False


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
        understood: what the motion shows that was made for the part, in one sentence.
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
        peak_speed_rad_s: speed of that joint.
        peak_speed_limit_rad_s: limit of that joint.
        clipped_frames: frames in which a position limit changed the model's motion.
        gate_clipped_frames: frames that the last limiter before the bus changed.
        underruns: cycles in which the plan had no frame ready.
        direction_error_deg: mean angle between the human's and the robot's arm bones.
        interventions: times the path was led round a self-collision.
        log_dropped: cycles that are missing from these figures.
        shown: whether the goals that the robot was given show what the motion shows: "shown", "in part" or "not shown"; empty
            where it is not judged (a story, a lease, a motion of more than 15 s).
        seen: content of the motion, in one sentence.
        missing: content that was not seen on the robot; empty for none.
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
    shown: str = ""
    seen: str = ""
    missing: str = ""


class Cancelled(Event, tag="cancelled"):
    """The command ended before its motion did.

    Attributes:
        plan_id: number of the plan, 0 when it had none yet.
        by: cause of the end: stop, estop, park, reset, cancel, shutdown, or `say ID`.
    """

    terminal: ClassVar[bool] = True
    plan_id: int
    by: str


class Refusal(Event):
    """A refusal: what was requested, found and allowed, and what to do next."""

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
    """A well-formed command that is not accepted now (state of the robot) or at all (out of the model's scope).

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
    """A `ctl` verb was passed to the bus, or a request without a motion was carried out, such as a text that means to stop.

    Attributes:
        verb: the verb.
        state: the robot's state when the verb was passed on.
        note: change made to the request, else empty.
        carried_out: of a `stop` or an `estop` on `ctl`: whether a bus cycle has carried it out; where none has yet (the bus process
            is dead, frozen or starting, its port is lost) the request stays pending, and `carried_out` follows. Else None.
    """

    terminal: ClassVar[bool] = True
    verb: str
    state: str
    note: str = ""
    carried_out: bool | None = None


class CarriedOut(Event, tag="carried_out"):
    """A bus cycle has carried out a `stop` or an `estop` that was not carried out yet when it was acknowledged.

    Attributes:
        verb: the verb.
        after_s: seconds since the request.
    """

    terminal: ClassVar[bool] = True
    verb: str
    after_s: float


AnyEvent = (
    Accepted | Progress | Done | Cancelled | Rejected | ErrorEvent | Failed | Ack | CarriedOut | StateEvent | HealthEvent
    | LogEvent | CapabilitiesEvent
)  # fmt: skip
EVENTS: tuple[type[Event], ...] = (
    Accepted, Progress, Done, Cancelled, Rejected, ErrorEvent, Failed, Ack, CarriedOut, StateEvent, HealthEvent,
    LogEvent, CapabilitiesEvent,
)  # fmt: skip
