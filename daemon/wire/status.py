"""Events about the daemon and the robot: state, health, log, capabilities; one struct for each. No I/O."""

from __future__ import annotations

from typing import Any

import msgspec

from daemon.wire.event_base import Event


class GestureInfo(msgspec.Struct):
    """A clip of the library.

    Attributes:
        name: for `gesture`.
        text: what it shows.
        seconds: its length.
        loop: whether a part of it can loop; otherwise the whole is repeated.
        hold_s: seconds from its start to the hold pose.
        mirror: name of the clip that is its mirror image, empty when it is symmetric.
        own: recorded, taught or added by the user.
        side: arms that it was taught with, left, right or both; else empty.
    """

    name: str
    text: str
    seconds: float
    loop: bool
    hold_s: float
    mirror: str
    own: bool = False
    side: str = ""


class JointInfo(msgspec.Struct):
    """A joint and its limits."""

    name: str
    role: str
    position_min_rad: float
    position_max_rad: float
    velocity_limit_rad_s: float
    acceleration_limit_rad_s2: float


class CapabilitiesEvent(Event, tag="capabilities"):
    """The abilities of this robot and this daemon.

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
        lease: times of a lease in seconds: silence_s (brake and hold), park_s, limp_s.
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
    """The lease that is held now.

    Attributes:
        id: of its command, which every target names.
        holder: name that the requesting program gave itself.
        state: accepted (not begun yet), waiting (for the first target), streaming, silent or released.
        held_by: cause that keeps the robot from its target: self-collision, silence, or empty.
        silence_s: seconds without a target after which the robot brakes and holds.
        silent_s: seconds since the last target.
        targets: number of accepted messages.
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
        lease: the lease that may send to it now; None for none.
        bad: number of messages refused since the start, by code.
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
    """State of a servo, and its counters since its port was opened.

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
        temperature_c: of the motor; None before it was read.
        effort: its current, or the load of a servo that measures no current.
        effort_unit: mA, or %.
    """

    id: int
    joint: str
    state: str
    timeouts: int = 0
    crc: int = 0
    late: int = 0
    retries: int = 0
    alerts: int = 0
    temperature_c: int | None = None
    effort: float = 0.0
    effort_unit: str = ""


class HealthEvent(Event, tag="health"):
    """Every servo, once a second on `v1/health`.

    Attributes:
        robot: name of the robot.
        servos: in the order of the robot file; none before the first bus cycle.
        silent_ms: milliseconds since the newest bus cycle, which is the age of these data.
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
        command: the running command, None when there is none.
        waiting: ids of the commands that wait for their turn or their time.
        idle: style of the idle movements, `off` when there are none.
        gaze_deg: requested direction of the head (left, down), None when it follows the motion.
        stream: the socket for joint targets, and its lease.
        generator: ready, starting or down, with the reason.
        joint_names: J names.
        goal_rad: (J,) last goals of the joints.
        present_rad: (J,) last measured positions of the joints.
        queued_ms: milliseconds of setpoints queued in the bus process.
        bus_info: counters of the bus process.
        person_m: (66,) the person that the robot shows: x, y, z of each of the 22 joints in metres, x left, y up, z forward.
        person_faces: (3,) unit vector to where the person's head faces, in the same axes.
        effort: (S,) of each servo, in the order and unit of `v1/health`.
        servos_not_ok: those whose state is not ok; all are on `v1/health`.
        recording: path of the log, empty when there is none; says so when recording has stopped.
        uptime_s: seconds since the start of the daemon.
        torque: whether the servos have torque, which an e-stop with `--estop hold` and a fault may leave on; None where the bus
            process does not say.
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
    person_m: list[float] = msgspec.field(default_factory=list[float])
    person_faces: list[float] = msgspec.field(default_factory=list[float])
    effort: list[float] = msgspec.field(default_factory=list[float])
    torque: bool | None = None

    @property
    def with_torque(self) -> str:
        """Whether a halted robot has torque, in words for a person who wants to reach in; empty in other states."""
        if self.state not in ("fault", "estop"):
            return ""
        if self.torque is None:
            return "perhaps with torque: keep your hands out"
        return "with torque on: keep your hands out" if self.torque else "without torque"
