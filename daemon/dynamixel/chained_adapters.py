"""Whether a chained read is used: one in which a servo's silence silences those behind it.

Fast sync read and the bulk read of protocol 1.0 are such; they are the quicker ones. A reply that breaks off now and then
costs the answers of that cycle. One that breaks off again and again is no accident (a servo is gone, or the firmware does
not keep to the order), and then every servo answers for itself for a while: so only the silent one is quarantined.
"""

from __future__ import annotations

from daemon.dynamixel.health import QUARANTINE_AFTER

_BREAK_POINTS, _MOST_POINTS = 4, 12
"""Points that a cycle costs whose reply broke off, and points at which chained reads are left; a whole reply takes one point away.
They are left after three broken replies in a row, or one in five for long: well before the servos behind a dead one would be
taken for dead."""
_PAUSE_CYCLES, _LONGEST_PAUSE_CYCLES = 25, 3200
"""Cycles in which each servo answers for itself, first and at most; twice as many each time that it helps for a moment only."""
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
        """Whether a cycle in which all is well changes nothing here."""
        return self.used and not self._points and self._held >= _HELD_CYCLES

    def after_cycle(self, broke_at: int | None) -> bool:
        """Judge a cycle; True when `used` has changed.

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
        """Who broke it off is left out now: try again at once."""
        self.used, self._points, self._last_row = True, 0, None
