"""Decides whether chained reads are used: reads in which a silent servo silences those behind it.

Fast sync read and the bulk read of protocol 1.0 are chained; they are the quicker reads. A reply that breaks off occasionally costs
the answers of that cycle. A reply that breaks off repeatedly has a cause (a servo is gone, or its firmware does not keep to the
order); then every servo answers for itself for a while, so that only the silent one is quarantined.
"""

from __future__ import annotations

from daemon.dynamixel.health import QUARANTINE_AFTER

_BREAK_POINTS, _MOST_POINTS = 4, 12
"""Points for a cycle whose reply broke off, and points at which chained reads are stopped; a complete reply takes one point off.
Three broken replies in a row, or one in five over a longer time, reach the limit: well before the servos behind a dead one would
be quarantined.
"""
_PAUSE_CYCLES, _LONGEST_PAUSE_CYCLES = 25, 3200
"""Cycles in which each servo answers for itself, at first and at most; the number doubles when chained reads break again soon."""
_HELD_CYCLES = 200
assert _MOST_POINTS <= _BREAK_POINTS * QUARANTINE_AFTER


class ChainedReads:
    """Decides between chained reads and reads in which every servo answers for itself.

    Attributes:
        used: whether chained reads are used now.
    """

    def __init__(self) -> None:
        self.used = True
        self._points = self._paused = 0
        self._pause = _PAUSE_CYCLES
        self._held = _HELD_CYCLES
        self._last_row: int | None = None

    @property
    def at_ease(self) -> bool:
        """Whether a cycle without errors changes nothing here."""
        return self.used and not self._points and self._held >= _HELD_CYCLES

    def after_cycle(self, broke_at: int | None) -> bool:
        """Judge a cycle; return whether `used` has changed.

        Args:
            broke_at: row of the servo at which a chained reply broke off; None when none did.
        """
        if not self.used:
            self._paused -= 1
            self.used = self._paused <= 0
            return self.used
        again, self._last_row = broke_at is not None and broke_at == self._last_row, broke_at
        self._held += 1
        if broke_at is None:
            self._points = max(0, self._points - 1)
            return False
        self._points += _BREAK_POINTS
        if not again and self._points < _MOST_POINTS:
            return False
        self._pause = _PAUSE_CYCLES if self._held > _HELD_CYCLES else min(2 * self._pause, _LONGEST_PAUSE_CYCLES)
        self.used, self._paused = False, self._pause
        self._points, self._held, self._last_row = 0, 0, None
        return True

    def resume(self) -> None:
        """Try chained reads again at once: the servo that broke them is excluded now."""
        self.used, self._points, self._last_row = True, 0, None
