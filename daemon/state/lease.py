"""A lease's life as one transition table, and the clock that moves it. No I/O: each call is given the time.

Silence brakes the robot to a hold; lasting silence ends the lease (the robot then parks and goes limp).
"""

from __future__ import annotations

from enum import Enum


class LeaseState(Enum):
    """States of a lease that has begun."""

    WAITING = "waiting"  # no target has come yet
    STREAMING = "streaming"
    SILENT = "silent"  # the robot brakes, or stands, until a target comes
    RELEASED = "released"  # given back by its holder: the robot moves to the last target
    OVER = "over"  # silent for too long


class LeaseEvent(Enum):
    """Events that change a lease's state."""

    TARGET = "target"
    SILENCE = "silence"
    LONG_SILENCE = "long silence"
    RELEASE = "release"


_S, _E = LeaseState, LeaseEvent
_LIVE = {_E.TARGET: _S.STREAMING, _E.SILENCE: _S.SILENT, _E.LONG_SILENCE: _S.OVER, _E.RELEASE: _S.RELEASED}
TRANSITIONS: dict[LeaseState, dict[LeaseEvent, LeaseState]] = {
    _S.WAITING: _LIVE,
    _S.STREAMING: _LIVE,
    _S.SILENT: _LIVE,
    _S.RELEASED: dict.fromkeys(LeaseEvent, _S.RELEASED),
    _S.OVER: dict.fromkeys(LeaseEvent, _S.OVER),
}


class LeaseClock:
    """Follows one lease through time.

    Args:
        silence_s: seconds without a target after which the lease is silent.
        park_s: seconds without a target after which the lease is over.

    Attributes:
        state: state of the lease.
        last_s: time of the last target, seconds; before the first target, the beginning of the lease.
    """

    def __init__(self, silence_s: float, park_s: float) -> None:
        self.silence_s, self.park_s = silence_s, max(park_s, silence_s)
        self.state = LeaseState.WAITING
        self.last_s = float("inf")

    def begin(self, now_s: float) -> None:
        """Count silence from now on, because the robot is ready."""
        self.last_s = now_s

    def target(self, now_s: float) -> bool:
        """Note a target; returns whether the lease still takes targets."""
        self.look(now_s)
        self._move(LeaseEvent.TARGET)
        if self.state is LeaseState.STREAMING:
            self.last_s = now_s
        return self.state is LeaseState.STREAMING

    def release(self) -> None:
        """Release the lease for its holder."""
        self._move(LeaseEvent.RELEASE)

    def look(self, now_s: float) -> LeaseState:
        """Update and return the state at a time."""
        silent_s = now_s - self.last_s
        if silent_s >= self.park_s:
            self._move(LeaseEvent.LONG_SILENCE)
        elif silent_s >= self.silence_s:
            self._move(LeaseEvent.SILENCE)
        return self.state

    def _move(self, event: LeaseEvent) -> None:
        self.state = TRANSITIONS[self.state][event]
