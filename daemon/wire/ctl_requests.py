"""Requests on `ctl`: the stops, and the verbs that switch torque or lead the robot on. No I/O."""

from __future__ import annotations

from typing import Annotated, Any

from msgspec import UNSET, Meta

from daemon.wire.request_base import Request, TimelyRequest

Unread = Annotated[Any, Meta(description="accepted with any value and never read: nothing delays a stop")]


class HaltRequest(Request, kw_only=True):
    """A stop. It may carry the field of `TimelyRequest`, with any value, and is carried out all the same.

    Attributes:
        state_t_mono: never read.
    """

    state_t_mono: Unread = UNSET

    def __post_init__(self) -> None:
        """Drop the value, which may be nested too deeply for those who read requests."""
        self.state_t_mono = UNSET


class Stop(HaltRequest, tag="stop"):
    """Decelerate within the limits, hold, drop what was planned."""


class Estop(HaltRequest, tag="estop"):
    """Cut torque at once, or brake and hold where the daemon is set so (`estop = "hold"`); latched until `reset`.

    Where it holds already a second one cuts.
    """


class Reset(TimelyRequest, tag="reset"):
    """Leave e-stop or fault: the robot is limp afterwards and must be armed."""


class Arm(TimelyRequest, tag="arm"):
    """Torque on over a goal pinned to the measured pose, then a slow move to the rest pose."""


class Park(TimelyRequest, tag="park"):
    """Move to the park pose, then torque off."""


class Torque(TimelyRequest, tag="torque", kw_only=True):
    """Torque on as by `arm`; or off: brake within the limits, then limp where it stands, until an explicit `arm`.

    Attributes:
        on: whether torque goes on.
    """

    on: bool
