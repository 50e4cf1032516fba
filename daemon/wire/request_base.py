"""Fields that requests have in common, and the options of playing a motion. No I/O.

A field that may be unset is not encoded then, so that a daemon of before this field reads the request of a newer client.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypedDict

import msgspec
from msgspec import UNSET, Meta, UnsetType

PROTOCOL_VERSION = 1
MAX_TEXT_CHARS = 2000
MAX_ID_CHARS = 128
MAX_CLOCK_CHARS = 64
MAX_SEED = 2**31 - 1
SHORTEST_S, LONGEST_S = 0.2, 9.8
"""Seconds of motion that may be requested: one token to a whole window of the model, which a test compares with the model."""
SHORTEST_PREFIX_S, LONGEST_PREFIX_S = 0.2, 1.6
"""Seconds of a prefix: one token, to the longest prefix that the model takes (`mmm_core.generate.continuation`)."""
LEAST_TEMPO, MOST_TEMPO = 0.5, 2.0
LEAST_AMPLITUDE, MOST_AMPLITUDE = 0.3, 1.2
MOST_REPEATS = 1000
IDLE_STYLES = ("calm", "lively")

Id = Annotated[str, Meta(max_length=MAX_ID_CHARS, description="chosen by the sender; the same id twice is one command")]
Text = Annotated[str, Meta(min_length=1, max_length=MAX_TEXT_CHARS)]
ShownState = Annotated[
    float, Meta(description="`t_mono` of the newest state that the sender has shown; too old: refused")
]
Name = Annotated[str, Meta(pattern=r"^[a-z0-9][a-z0-9_]{0,63}$", description="lower case letters, digits and _")]


class Request(msgspec.Struct, tag_field="type", forbid_unknown_fields=True, kw_only=True):
    """Fields that every request may have.

    Attributes:
        v: version of the protocol.
        id: chosen by the sender, returned in every event; empty lets the daemon choose.
        seq: the sender's count of messages; kept in the log.
        t_mono: the sender's monotonic clock in seconds; kept in the log.
        clock: name of that clock by `daemon.host.clock.clock_id`; only times of the same clock are compared.
    """

    v: int = PROTOCOL_VERSION
    id: Id = ""
    seq: int | None = None
    t_mono: float | None = None
    clock: Annotated[str, Meta(max_length=MAX_CLOCK_CHARS)] | None = None


class TimelyRequest(Request, kw_only=True):
    """A request that is meant for the robot as its sender sees it, and dangerous once nobody expects it any more.

    Attributes:
        state_t_mono: `t_mono` of the newest `state` event that the sender has shown; when the request arrives with a state that
            is too old, it is refused (`daemon.front.late_requests`). Unset or None: the request is not checked.
    """

    state_t_mono: ShownState | UnsetType | None = UNSET


class Command(TimelyRequest, kw_only=True):
    """Fields of every request that moves the robot: the time of its turn.

    Attributes:
        when: now (takes over from what is played), after (what is played and what waits already), or at `at_s`.
        at_s: when to take over, on the daemon's clock as in `t_mono` of its events.
        deadline_s: a motion that cannot begin so many seconds after its request came is not played.
    """

    when: Literal["now", "after", "at"] = "now"
    at_s: float | None = None
    deadline_s: Annotated[float, Meta(ge=0, le=3600)] | None = None

    def __post_init__(self) -> None:
        """Refuse options that contradict each other.

        Raises:
            ValueError: which becomes one `error` event.
        """
        if (self.at_s is not None) != (self.when == "at"):
            raise ValueError('`when` "at" and `at_s` belong together: give both or none')

    @property
    def words(self) -> str:
        """The command in a word or a sentence."""
        raise NotImplementedError

    @property
    def texts(self) -> tuple[str, ...]:
        """Texts of a person in the request; empty for a request that names a stored motion."""
        return ()


class Play(Command, kw_only=True):
    """Options of playing a motion from any source.

    Attributes:
        tempo: factor of the motion's speed, as far as the servos can follow.
        amplitude: factor of every deviation from standing.
        mirror: whether left and right are exchanged.
        repeat: number of times that the whole motion is played.
        loop: whether the part of the motion that can loop, else the whole, repeats until a stop or another command.
        hold: whether the motion stops in its most telling pose and stays there.
    """

    tempo: Annotated[float, Meta(ge=LEAST_TEMPO, le=MOST_TEMPO)] = 1.0
    amplitude: Annotated[float, Meta(ge=LEAST_AMPLITUDE, le=MOST_AMPLITUDE)] = 1.0
    mirror: bool = False
    repeat: Annotated[int, Meta(ge=1, le=MOST_REPEATS)] = 1
    loop: bool = False
    hold: bool = False

    def __post_init__(self) -> None:
        """Refuse options that contradict each other.

        Raises:
            ValueError: which becomes one `error` event.
        """
        super().__post_init__()
        if self.loop and (self.repeat > 1 or self.hold):
            raise ValueError("`loop` goes round until it is ended: leave out `repeat` and `hold`")


class PlayOptions(TypedDict, total=False):
    """The options of `Play`, for keyword arguments."""

    tempo: float
    amplitude: float
    mirror: bool
    repeat: int
    loop: bool
    hold: bool
    when: Literal["now", "after", "at"]
    at_s: float | None
    deadline_s: float | None


def tag_of(kind: type[msgspec.Struct] | msgspec.Struct) -> str:
    """The `type` of a message."""
    return str(kind.__struct_config__.tag)
