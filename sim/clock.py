"""Virtual time: moves only when somebody waits."""

from __future__ import annotations


class VirtualClock:
    """A `Clock` that jumps to where it is told to sleep."""

    def __init__(self, start_s: float = 0.0) -> None:
        self._now_s = start_s

    def now_s(self) -> float:
        """Current virtual time."""
        return self._now_s

    def sleep_until(self, t_s: float) -> None:
        """Jump ahead to `t_s`."""
        self._now_s = max(self._now_s, t_s)
