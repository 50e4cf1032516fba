"""Requests to the daemon, one struct for each. No I/O.

`say`, `gesture`, `story`, `inbetween`, `edit` and `replay` share the options of `Play` (`request_base.py`); a new way to get
a motion is one more such struct.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from daemon.wire.compositions import (
    MOST_POSES,
    MOST_SCENES,
    SHORTEST_GAP_S,
    Edit,
    Inbetween,
    KeyPoseOf,
    Replay,
    SceneOf,
    Story,
)
from daemon.wire.ctl_requests import Arm, Estop, Park, Reset, Stop, Torque
from daemon.wire.lease_requests import LONGEST_SILENCE_S, SHORTEST_SILENCE_S, Lease, Release, Target
from daemon.wire.request_base import (
    IDLE_STYLES,
    LEAST_AMPLITUDE,
    LEAST_TEMPO,
    LONGEST_PREFIX_S,
    LONGEST_S,
    MAX_ID_CHARS,
    MAX_SEED,
    MAX_TEXT_CHARS,
    MOST_AMPLITUDE,
    MOST_REPEATS,
    MOST_TEMPO,
    PROTOCOL_VERSION,
    SHORTEST_PREFIX_S,
    SHORTEST_S,
    Command,
    Id,
    Name,
    Play,
    PlayOptions,
    Request,
    Text,
    TimelyRequest,
    tag_of,
)

__all__ = [
    "CMD_TYPES",
    "CTL_TYPES",
    "IDLE_STYLES",
    "LEAST_AMPLITUDE",
    "LEAST_TEMPO",
    "LONGEST_PREFIX_S",
    "LONGEST_S",
    "LONGEST_SILENCE_S",
    "MAX_ID_CHARS",
    "MAX_SEED",
    "MAX_TEXT_CHARS",
    "MOST_AMPLITUDE",
    "MOST_POSES",
    "MOST_REPEATS",
    "MOST_SCENES",
    "MOST_TEMPO",
    "PROTOCOL_VERSION",
    "REQUESTS",
    "SHORTEST_GAP_S",
    "SHORTEST_PREFIX_S",
    "SHORTEST_S",
    "SHORTEST_SILENCE_S",
    "STREAM_TYPES",
    "Arm",
    "Cancel",
    "Capabilities",
    "CmdRequest",
    "Command",
    "CtlRequest",
    "Edit",
    "Estop",
    "Gesture",
    "Id",
    "Idle",
    "Inbetween",
    "KeyPoseOf",
    "Lease",
    "Look",
    "Name",
    "Park",
    "Play",
    "PlayOptions",
    "Record",
    "Release",
    "Replay",
    "Request",
    "Reset",
    "Say",
    "SceneOf",
    "Status",
    "Stop",
    "Story",
    "Target",
    "Text",
    "TimelyRequest",
    "Torque",
    "tag_of",
]


class Say(Play, tag="say", kw_only=True):
    """Move as the text says.

    Attributes:
        text: what to do, in English.
        seed: the same text, seed and seconds give the same motion.
        seconds: length of the motion; None lets the model choose.
        prefix_s: seconds of the running motion that the new one continues from, 0.2 to 1.6; 0 for none. The longer the prefix,
            the smoother the transition, and the less of the text shows.
        context: whether the text may refer to the last command of the same connection ("again", "with the other hand"); off, it
            is read by itself.
    """

    text: Text
    seed: Annotated[int, Meta(ge=0, le=MAX_SEED)] = 0
    seconds: Annotated[float, Meta(ge=SHORTEST_S, le=LONGEST_S)] | None = None
    prefix_s: Annotated[float, Meta(ge=0, le=LONGEST_PREFIX_S)] = 0.0
    context: bool = True

    def __post_init__(self) -> None:
        """Refuse a prefix for a motion whose start is not known yet.

        Raises:
            ValueError: which becomes one `error` event.
        """
        super().__post_init__()
        if self.prefix_s and self.when != "now":
            raise ValueError('`prefix_s` is of what is played now: it goes with `when` "now" only')
        if 0 < self.prefix_s < SHORTEST_PREFIX_S:
            raise ValueError(f"`prefix_s` is 0 or {SHORTEST_PREFIX_S} to {LONGEST_PREFIX_S}")

    @property
    def words(self) -> str:
        """The text."""
        return self.text

    @property
    def texts(self) -> tuple[str, ...]:
        """The text."""
        return (self.text,)


class Gesture(Play, tag="gesture", kw_only=True):
    """Play a named clip of the library; needs no generator.

    Attributes:
        name: name of the clip; `capabilities` lists all.
    """

    name: Name

    @property
    def words(self) -> str:
        """The clip's name."""
        return self.name


class Record(Request, tag="record", kw_only=True):
    """Keep the motion of a command as a gesture of one's own.

    Attributes:
        name: of the gesture.
        command: id of the command whose motion to keep; empty means the newest.
        replace: whether to overwrite a gesture with that name, which is refused otherwise.
    """

    name: Name
    command: Id = ""
    replace: bool = False


class Look(TimelyRequest, tag="look"):
    """Turn the head during any motion; without angles the head follows the motion again.

    Attributes:
        yaw_deg: degrees to the left.
        pitch_deg: degrees down.
    """

    yaw_deg: Annotated[float, Meta(ge=-120, le=120)] | None = None
    pitch_deg: Annotated[float, Meta(ge=-80, le=80)] | None = None


class Idle(TimelyRequest, tag="idle"):
    """Play small movements of breath and gaze while no command is played.

    Attributes:
        on: whether the movements are played.
        style: amplitude of the movements.
    """

    on: bool = True
    style: Literal["calm", "lively"] = "calm"


class Capabilities(Request, tag="capabilities"):
    """Request a `capabilities` event: the abilities of this robot and this daemon."""


class Cancel(Request, tag="cancel"):
    """End a command: the robot decelerates within its limits and holds.

    Attributes:
        command: id of the command; empty means all that run or wait.
    """

    command: Id = ""


class Status(Request, tag="status"):
    """Request a `state` event."""


CmdRequest = (
    Say | Story | Inbetween | Edit | Replay | Gesture | Lease | Release | Record | Look | Idle | Cancel | Status
    | Capabilities
)  # fmt: skip
CtlRequest = Stop | Estop | Reset | Arm | Park | Torque | Status
CMD_TYPES: tuple[type[Request], ...] = (
    Say, Story, Inbetween, Edit, Replay, Gesture, Lease, Release, Record, Look, Idle, Cancel, Status, Capabilities,
)  # fmt: skip
CTL_TYPES: tuple[type[Request], ...] = (Stop, Estop, Reset, Arm, Park, Torque, Status)
STREAM_TYPES: tuple[type[Request], ...] = (Target,)
REQUESTS: tuple[type[Request], ...] = (*CMD_TYPES, *CTL_TYPES[:-1], *STREAM_TYPES)
