"""A lease's life as one transition table, and the clock that moves it. Sans-I/O: told the time, never asks for it.

Silence decelerates to a hold, lasting silence ends the lease (the robot then parks and goes limp).
"""

from __future__ import annotations

from enum import Enum


class LeaseState(Enum):
    """What a lease that has begun is doing."""

    WAITING = "waiting"  # no target has come yet
    STREAMING = "streaming"
    SILENT = "silent"  # braking, or standing, until a target comes
    RELEASED = "released"  # its holder gave it back: on the way to the last target
    OVER = "over"  # silent for too long


class LeaseEvent(Enum):
    """What moves it."""

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
    """One lease in time.

    Args:
        silence_s: without a target for so long it is silent.
        park_s: for so long it is over.

    Attributes:
        state: what it is doing.
        last_s: when the last target came; before the first one, when the lease began.
    """

    def __init__(self, silence_s: float, park_s: float) -> None:
        self.silence_s, self.park_s = silence_s, max(park_s, silence_s)
        self.state = LeaseState.WAITING
        self.last_s = float("inf")

    def begin(self, now_s: float) -> None:
        """The robot is ready: silence counts from here."""
        self.last_s = now_s

    def target(self, now_s: float) -> bool:
        """A target came; false when the lease takes none any more."""
        self.look(now_s)
        self._move(LeaseEvent.TARGET)
        if self.state is LeaseState.STREAMING:
            self.last_s = now_s
        return self.state is LeaseState.STREAMING

    def release(self) -> None:
        """Its holder gives it back."""
        self._move(LeaseEvent.RELEASE)

    def look(self, now_s: float) -> LeaseState:
        """The state at a time."""
        silent_s = now_s - self.last_s
        if silent_s >= self.park_s:
            self._move(LeaseEvent.LONG_SILENCE)
        elif silent_s >= self.silence_s:
            self._move(LeaseEvent.SILENCE)
        return self.state

    def _move(self, event: LeaseEvent) -> None:
        self.state = TRANSITIONS[self.state][event]
