"""Errors of a client, the events that it received for a command, and the time stamp of its requests."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import msgspec

from daemon.errors import CommandError, DaemonError
from daemon.host.clock import clock_id
from daemon.wire.event_base import Event
from daemon.wire.events import AnyEvent, Done, ErrorEvent, Refusal
from daemon.wire.requests import Request, tag_of
from daemon.wire.showing import in_words
from daemon.wire.status import StateEvent

_BAD_NAMES = ("unknown_gesture", "unknown_motion", "bad_file")
"""Codes of refusals of requests that name an unknown gesture, motion or file."""
ARMING_ENDS = ("idle", "moving", "holding", "fault", "estop")
"""States in which arming has ended; arming that was broken off may end in limp as well."""
_START_OR_NAME = (
    "is `mmmd run` running there? Start it, or name its port with --cmd, --ctl, --pub or MMMD_CMD, MMMD_CTL, MMMD_PUB"
)


class NoAnswerError(DaemonError, TimeoutError):
    """The daemon did not answer."""

    def __init__(self, endpoint: str, asked: str, timeout_s: float) -> None:
        self.endpoint, self.asked, self.timeout_s = endpoint, asked, timeout_s
        super().__init__(self._message())

    def _message(self) -> str:
        do = _START_OR_NAME
        if self.endpoint.startswith("tcp://"):
            do += "; a daemon with keys answers nobody without an allowed one (--keys, `mmmd keys --help`)"
        return f"{self.asked}: no answer from {self.endpoint} in {self.timeout_s:g} s; {do}"


class NobodyListensError(NoAnswerError):
    """Nothing takes connections at the endpoint."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(endpoint, "connect", 0.0)

    def _message(self) -> str:
        return f"{self.asked}: nothing listens at {self.endpoint}; {_START_OR_NAME}"


class ConnectionLostError(NoAnswerError):
    """The connection broke while an answer was awaited, so that none can come; `timeout_s` is how long it was awaited."""

    def _message(self) -> str:
        return (
            f"{self.asked}: {self.endpoint} was lost after {self.timeout_s:.1f} s: the daemon ended, or a network in between; what "
            f"it was doing is unknown: look at the robot, start `mmmd run` again, and say it again"
        )


class RefusedError(DaemonError):
    """The daemon rejected a request, or could not carry it out; `event` says why."""

    def __init__(self, event: Refusal) -> None:
        self.event = event
        self.code = event.code
        self.exit_status = exit_status(event)
        super().__init__(event.message)


def exit_status(event: Refusal) -> int:
    """The exit status of a refused command: 3 for a robot in a fault or e-stop, 2 for a bad request or name, else 1."""
    if event.code == "fault" or (event.code == "wrong_state" and "reset" in event.allowed):
        return 3
    return 2 if isinstance(event, ErrorEvent) or event.code in _BAD_NAMES else 1


class CancelledByError(DaemonError):
    """The command ended before its motion did."""

    def __init__(self, by: str) -> None:
        self.by = by
        super().__init__(f"the command was cancelled by {by}")


@dataclass(frozen=True)
class Said:
    """A command and the events received for it.

    Attributes:
        id: id of the command.
        events: its events so far; the last is terminal once it has ended.
    """

    id: str
    events: tuple[AnyEvent, ...]

    @property
    def done(self) -> Done | None:
        """The `done` event with the figures of the motion; None when it was not played to its end."""
        last = self.events[-1] if self.events else None
        return last if isinstance(last, Done) else None


def stamp(request: Request) -> None:
    """Write into a request the time of sending, and the clock that it is read from.

    Raises:
        CommandError: a number of the request is not finite; JSON would have none in its place.
    """
    for name, value in msgspec.structs.asdict(request).items():
        if isinstance(value, float) and not math.isfinite(value):
            raise CommandError(
                f"'{tag_of(request)}' request: found {name} {value}; allowed: a finite number; correct it"
            )
    request.t_mono, request.clock = time.monotonic(), clock_id() or None


def waited_in_vain(endpoint: str, states: tuple[str, ...], status: StateEvent, timeout_s: float) -> NoAnswerError:
    """The error of a wait in which the robot reached none of `states`."""
    why = f": {status.reason}" if status.reason else ""
    return NoAnswerError(
        endpoint, f"wait for {' or '.join(states)} (the robot is {in_words(status.state)}{why})", timeout_s
    )


def unexpected(event: Event, asked: str) -> DaemonError:
    """The error of an answer that does not fit the request."""
    if isinstance(event, Refusal):
        return RefusedError(event)
    return DaemonError(f"{asked}: the daemon answered '{tag_of(event)}'; is it of another version?")
