"""Health of each servo: ok, late, missing, faulted or quarantined, with counters of the events that led there."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec.packet import ALERT_BIT

QUARANTINE_AFTER = 10
"""Cycles in a row without an answer after which a servo is read only once a second: at 100 Hz a tenth of a second."""
PROBE_EVERY_S = 1.0
BROWN_OUT_AFTER = 3
"""Cycles in a row without answers of many servos before the power is suspected: one cycle may be a corrupted group read."""
WITHHELD_S, _WITHHELD_CYCLES = 0.15, 3
"""Seconds and cycles of silence after which a servo whose torque a goal switches on gets no more goals: it may have lost power,
restarted (which takes longer) and hang limp in any pose.
"""


class Health(IntEnum):
    """State of a servo."""

    OK = 0
    LATE = 1
    """The servo's last answer came after its deadline."""
    MISSING = 2
    """The servo did not answer in the last cycle."""
    FAULTED = 3
    """The servo answers, and reports a hardware error or came back without its torque or settings."""
    QUARANTINED = 4
    """The servo has been missing for long and is left out of the cycle; it is read once a second."""


COUNTERS = ("timeouts", "crc", "late", "retries", "alerts")
HEALTH = np.dtype([("state", "u1"), ("_", "V1"), ("temperature_c", "i2"), *((name, "u4") for name in COUNTERS)])
"""Record of a servo's health, as the bus process publishes it."""


@dataclass
class Counters:
    """(S,) counts of each servo's events since the start."""

    timeouts: NDArray[np.int64]
    crc: NDArray[np.int64]
    late: NDArray[np.int64]
    retries: NDArray[np.int64]
    alerts: NDArray[np.int64]


class HealthTracker:
    """Health of the servos of a bus, updated from the answers of each cycle.

    Args:
        n: servos.
        woken_by_goal: (S,) servos whose torque a goal switches on: all of protocol 1.0; none when None.
    """

    def __init__(self, n: int, woken_by_goal: NDArray[np.bool_] | None = None) -> None:
        self.state = np.zeros(n, np.uint8)
        self.counters = Counters(*(np.zeros(n, np.int64) for _ in range(5)))
        self._missed = np.zeros(n, np.int32)
        self._alerted = np.zeros(n, bool)
        self._probe_due_s = np.zeros(n)
        self._well = True
        self.asked = np.ones(n, bool)
        """(S,) servos that take part in the cycle."""
        self.faulted = np.zeros(n, bool)
        """(S,) servos that came back changed; reset by `cleared`."""
        self.withheld = np.zeros(n, bool)
        """(S,) servos that get no goals until they are verified again; reset by `cleared`."""
        self._woken_by_goal = np.zeros(n, bool) if woken_by_goal is None else woken_by_goal

    def all_well(self, error: NDArray[np.uint8]) -> bool:
        """Whether every servo was well before, and these error bytes report nothing new."""
        return self._well and not error.any() and not self.faulted.any()

    def after_cycle(self, valid: NDArray[np.bool_], error: NDArray[np.uint8], now_s: float) -> bool:
        """Judge a cycle by the servos that answered and their error bytes; return whether a servo was just quarantined."""
        missing = self.asked & ~valid
        alert = valid & ((error & ALERT_BIT) != 0)
        self._well = False
        self._missed[valid] = 0
        self._missed[missing] += 1
        self.counters.timeouts += missing
        self.counters.alerts += alert & ~self._alerted
        self._alerted[valid] = alert[valid]
        self.withheld |= self._woken_by_goal & alert  # a goal could switch its torque on again
        self.state[valid] = np.where(alert[valid] | self.faulted[valid], Health.FAULTED, Health.OK)
        self.state[missing] = Health.MISSING
        self._well = not (self.state.any() or self._alerted.any() or self._missed.any() or self.faulted.any())
        gone = self.asked & (self._missed >= QUARANTINE_AFTER)
        if not gone.any() or self._are_many(missing):
            return False
        self.asked &= ~gone
        self.state[gone] = Health.QUARANTINED
        self._probe_due_s[gone] = now_s + PROBE_EVERY_S
        return True

    def silent_at_once(self) -> NDArray[np.bool_]:
        """(S,) servos that take part and have been silent together for long, if they are many; else none."""
        silent = self.asked & (self._missed >= BROWN_OUT_AFTER)
        return silent if self._are_many(silent) else np.zeros_like(silent)

    def _are_many(self, silent: NDArray[np.bool_]) -> bool:
        """Whether so many servos are silent that power or a cable is the cause: half of those read, and never one alone."""
        n = int(silent.sum())
        return n > 1 and 2 * n >= int(self.asked.sum())

    def port_lost(self) -> None:
        """Count nothing: no servo can answer while the port is lost."""
        self.state[self.asked] = Health.MISSING
        self._well = False

    def show(self, table: NDArray[np.void], rows: NDArray[np.intp] | slice = slice(None)) -> None:
        """Copy state and counters into the `rows` of a table of `HEALTH`."""
        table["state"][rows] = self.state
        for name in COUNTERS:
            table[name][rows] = getattr(self.counters, name)

    def withhold(self, read_s: NDArray[np.float64], now_s: float) -> NDArray[np.bool_]:
        """(S,) servos that get no goals now, by the time of each one's last answer."""
        if self._missed.any():
            silent = (self._missed >= _WITHHELD_CYCLES) & (now_s - read_s > WITHHELD_S)
            self.withheld |= self._woken_by_goal & silent
        return self.withheld

    def withhold_from(self, row: int) -> None:
        """Send a servo no goals until it is verified again: it would refuse them, or a goal could switch its torque on."""
        self.withheld[row] = True

    def withhold_all(self) -> None:
        """Send no servo a goal until the robot is armed again: after a loss of the port all have stopped by their watchdogs."""
        self.withheld[:] = True

    def came_late(self, row: int) -> None:
        """Count an answer of this servo that arrived after its deadline."""
        self.counters.late[row] += 1
        if self.state[row] == Health.MISSING:
            self.state[row] = Health.LATE
            self._missed[row] = 0

    def probe_due(self, now_s: float) -> int | None:
        """Row of a quarantined servo that is due to be read again, None for none."""
        if self.asked.all():
            return None
        rows = np.flatnonzero(~self.asked)
        row = int(rows[np.argmin(self._probe_due_s[rows])])
        return row if now_s >= self._probe_due_s[row] else None

    def probed(self, row: int, *, answered: bool, now_s: float) -> None:
        """Record the reading of a quarantined servo; one that answered takes part again."""
        if answered:
            self.asked[row], self._missed[row] = True, 0
            self.state[row] = Health.FAULTED if self.faulted[row] else Health.OK
        self._probe_due_s[row] = now_s + PROBE_EVERY_S

    def cleared(self) -> None:
        """Let all servos take part, none faulted or withheld: all were verified again."""
        self.faulted[:], self.asked[:], self._missed[:], self._alerted[:] = False, True, 0, False
        self.withheld[:] = False
        self.state[:] = Health.OK
