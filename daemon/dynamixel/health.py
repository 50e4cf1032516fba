"""Health of each servo: ok, late, missing, faulted or quarantined, and what was counted on the way there."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.codec.packet import ALERT_BIT

QUARANTINE_AFTER = 10
"""Cycles in a row without an answer after which a servo is asked no more but once a second: at 100 Hz a tenth of a second."""
PROBE_EVERY_S = 1.0
BROWN_OUT_AFTER = 3
"""Cycles in a row without an answer of many, before power is suspected: one may be a spoilt group read."""
WITHHELD_S, _WITHHELD_CYCLES = 0.15, 3
"""Seconds and cycles of silence after which a servo whose torque a goal switches on gets no goal any more: it
may have lost its power, started again (which takes longer) and hang limp wherever it fell."""


class Health(IntEnum):
    """What can be said of a servo."""

    OK = 0
    LATE = 1
    """Its last answer came after its deadline."""
    MISSING = 2
    """The servo did not answer in the last cycle."""
    FAULTED = 3
    """The servo answers, and reports a hardware error or came back without its torque or settings."""
    QUARANTINED = 4
    """The servo has been missing for long and is left out of the cycle; it is asked once a second."""


COUNTERS = ("timeouts", "crc", "late", "retries", "alerts")
HEALTH = np.dtype([("state", "u1"), ("_", "V1"), ("temperature_c", "i2"), *((name, "u4") for name in COUNTERS)])
"""A servo as the bus process shows it to others."""


@dataclass
class Counters:
    """(S,) events of each servo since the start."""

    timeouts: NDArray[np.int64]
    crc: NDArray[np.int64]
    late: NDArray[np.int64]
    retries: NDArray[np.int64]
    alerts: NDArray[np.int64]


class HealthTracker:
    """Health of the servos of a bus, kept from what each cycle brought.

    Args:
        n: servos.
        woken_by_goal: (S,) those that switch their torque on when they get a goal: all of protocol 1.0; none when None.
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
        """(S,) servos that came back changed; cleared by `cleared`."""
        self.withheld = np.zeros(n, bool)
        """(S,) servos that get no goals until all was verified anew; cleared by `cleared`."""
        self._woken_by_goal = np.zeros(n, bool) if woken_by_goal is None else woken_by_goal

    def all_well(self, error: NDArray[np.uint8]) -> bool:
        """Whether nothing was wrong with any servo before, and these error bytes say nothing new."""
        return self._well and not error.any() and not self.faulted.any()

    def after_cycle(self, valid: NDArray[np.bool_], error: NDArray[np.uint8], now_s: float) -> bool:
        """Judge a cycle: who answered with which error byte. True when somebody was just quarantined."""
        missing = self.asked & ~valid
        alert = valid & ((error & ALERT_BIT) != 0)
        self._well = False
        self._missed[valid] = 0
        self._missed[missing] += 1
        self.counters.timeouts += missing
        self.counters.alerts += alert & ~self._alerted
        self._alerted[valid] = alert[valid]
        self.withheld |= self._woken_by_goal & alert  # a goal could give it its torque back
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
        """(S,) servos that take part and have long been silent, when they are many; else none."""
        silent = self.asked & (self._missed >= BROWN_OUT_AFTER)
        return silent if self._are_many(silent) else np.zeros_like(silent)

    def _are_many(self, silent: NDArray[np.bool_]) -> bool:
        """Whether these are a matter of power or of a cable: half of those asked. One alone never is, as others answer."""
        n = int(silent.sum())
        return n > 1 and 2 * n >= int(self.asked.sum())

    def port_lost(self) -> None:
        """Nobody can answer, and nobody is to blame: nothing is counted."""
        self.state[self.asked] = Health.MISSING
        self._well = False

    def show(self, table: NDArray[np.void], rows: NDArray[np.intp] | slice = slice(None)) -> None:
        """Copy state and counters into the `rows` of a table of `HEALTH`."""
        table["state"][rows] = self.state
        for name in COUNTERS:
            table[name][rows] = getattr(self.counters, name)

    def withhold(self, read_s: NDArray[np.float64], now_s: float) -> NDArray[np.bool_]:
        """(S,) servos that get no goals now, by when each answered last."""
        if self._missed.any():
            silent = (self._missed >= _WITHHELD_CYCLES) & (now_s - read_s > WITHHELD_S)
            self.withheld |= self._woken_by_goal & silent
        return self.withheld

    def withhold_from(self, row: int) -> None:
        """This servo gets no goals until all was verified anew: it would refuse them, or worse."""
        self.withheld[row] = True

    def withhold_all(self) -> None:
        """The port is gone: when it is back the servos have stopped by themselves, and get no goals until armed anew."""
        self.withheld[:] = True

    def came_late(self, row: int) -> None:
        """An answer of this servo arrived after its deadline."""
        self.counters.late[row] += 1
        if self.state[row] == Health.MISSING:
            self.state[row] = Health.LATE
            self._missed[row] = 0

    def probe_due(self, now_s: float) -> int | None:
        """A quarantined servo that should be asked again now."""
        if self.asked.all():
            return None
        rows = np.flatnonzero(~self.asked)
        row = int(rows[np.argmin(self._probe_due_s[rows])])
        return row if now_s >= self._probe_due_s[row] else None

    def probed(self, row: int, *, answered: bool, now_s: float) -> None:
        """A quarantined servo was asked; one that answered takes part again."""
        if answered:
            self.asked[row], self._missed[row] = True, 0
            self.state[row] = Health.FAULTED if self.faulted[row] else Health.OK
        self._probe_due_s[row] = now_s + PROBE_EVERY_S

    def cleared(self) -> None:
        """Everything was verified anew: no servo is taken for changed, all take part."""
        self.faulted[:], self.asked[:], self._missed[:], self._alerted[:] = False, True, 0, False
        self.withheld[:] = False
        self.state[:] = Health.OK
