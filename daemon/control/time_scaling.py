"""Rate at which setpoints are played: full, slower along their own path, or zero while the gate holds. No I/O.

Where the gate keeps the robot off itself the motion waits and then continues slowly. A path without self-contact needs this only
where hard braking at full speed would cause contact. By waiting, the robot stays on its path, and its own arms do not cut it off
from the rest of the path.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from daemon.shared_memory.bus_link import Setpoint

WAIT_S = 1.0
"""Seconds that a motion waits in all before it continues without the robot, so that a motion into the robot ends as well."""
REJOIN_PER_S = 2.0
"""Rise of the share of full speed per second, after the gate has held the robot."""
_REJOINED = 0.5


class TimeScaling:
    """The share of full speed at which setpoints are taken, updated once a cycle."""

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._share, self._waited_s = 1.0, 0.0

    def update(self, *, held: bool) -> float:
        """0 while the gate holds, then rising to 1."""
        if held and self._waited_s < WAIT_S:
            self._share, self._waited_s = 0.0, self._waited_s + self._period_s
        else:
            self._share = min(1.0, self._share + REJOIN_PER_S * self._period_s)
            if self._share > _REJOINED and not held:
                self._waited_s = 0.0
        return self._share


class Source(Protocol):
    """A source of setpoints."""

    def take_setpoint(self) -> Setpoint | None:
        """The next setpoint; None when there is none."""
        ...


class ScaledSetpoints:
    """Setpoints played at a share of their rate, interpolated where a cycle falls between two of them.

    At full speed they pass unchanged, so that a replay is equal bit for bit.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self._given: Setpoint | None = None
        self._following: Setpoint | None = None
        self._phase = 0.0

    def reset(self) -> None:
        """Begin a new motion."""
        self._given = self._following = None
        self._phase = 0.0

    def take(self, share: float) -> Setpoint | None:
        """The setpoint of this cycle, the previous one again at a share of 0; None when the next one has not arrived yet."""
        if self._given is None or (share >= 1.0 and self._following is None):
            self._given = self._source.take_setpoint()
            return self._given
        phase, arrives = self._phase + share, False
        while phase >= 1.0 or (phase > 0.0 and self._following is None):
            if self._following is not None:
                self._given, self._following, phase, arrives = self._following, None, phase - 1.0, True
            elif (following := self._source.take_setpoint()) is not None:
                self._following = following
            else:  # the end, or the front is late: the next setpoint is taken without interpolation
                self._phase = 0.0
                return self._given if arrives else None
        self._phase = phase
        a, b = self._given, self._following
        if b is None or phase == 0.0:
            return a
        with np.errstate(invalid="ignore", over="ignore"):  # the gate refuses values that are not finite
            q_rad = a.q_rad + phase * (b.q_rad - a.q_rad)
        return Setpoint(a.plan_id, a.frame, False, q_rad)
