"""Time as the daemon sees it: real here, virtual in the simulator."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """Monotonic seconds, and waiting for them."""

    def now_s(self) -> float:
        """Seconds since some start; never goes back."""
        ...

    def sleep_until(self, t_s: float) -> None:
        """Return at `t_s` or at once when that is past."""
        ...


class RealClock:
    """The machine's monotonic clock."""

    def now_s(self) -> float:
        """Seconds of CLOCK_MONOTONIC."""
        return time.monotonic()

    def sleep_until(self, t_s: float) -> None:
        """Sleep to an absolute time."""
        left = t_s - time.monotonic()
        if left > 0:
            time.sleep(left)
