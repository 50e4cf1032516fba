"""Estimates how far ahead of the bus new frames must begin: mean plus 0.7 deviations of the time that recent ones took."""

from __future__ import annotations

_NEWEST = 0.3
"""Weight of the newest measurement in the running mean and deviation."""
_SPREADS = 0.7
"""Number of mean deviations added to the mean: a splice that is missed costs a whole further attempt."""


class LatencyEstimate:
    """A duration in seconds, learnt from measurements.

    Attributes:
        mean_s: running mean, seconds.
        spread_s: running mean of the absolute deviation, seconds.
    """

    def __init__(self, first_s: float) -> None:
        self.mean_s, self.spread_s = first_s, first_s / 4

    @property
    def seconds(self) -> float:
        """Seconds to allow for the next time."""
        return self.mean_s + _SPREADS * self.spread_s

    def took(self, seconds: float) -> None:
        """Learn from the newest measurement."""
        off_s = seconds - self.mean_s
        self.mean_s += _NEWEST * off_s
        self.spread_s += _NEWEST * (abs(off_s) - self.spread_s)
