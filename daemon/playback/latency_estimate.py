"""How far ahead of the bus a path is handed over: as long as it lately took to make the first piece of one, and some more."""

from __future__ import annotations

_NEWEST = 0.3
"""Weight of the newest path."""
_SPREADS = 0.7
"""Mean deviations beyond the mean: a hand-over that is missed costs a whole attempt more."""


class LatencyEstimate:
    """Seconds, learnt from each path.

    Attributes:
        mean_s: it takes lately.
        spread_s: its mean deviation.
    """

    def __init__(self, first_s: float) -> None:
        self.mean_s, self.spread_s = first_s, first_s / 4

    @property
    def seconds(self) -> float:
        """Seconds to allow for the next one."""
        return self.mean_s + _SPREADS * self.spread_s

    def took(self, seconds: float) -> None:
        """Learn from the newest measurement."""
        off_s = seconds - self.mean_s
        self.mean_s += _NEWEST * off_s
        self.spread_s += _NEWEST * (abs(off_s) - self.spread_s)
