"""How much one client may ask: a bucket of requests that fills at a rate. Sans-I/O."""

from __future__ import annotations

from collections import OrderedDict

RATE_HZ = 400.0
BURST = 4000
KEPT = 1024
"""Clients that are remembered; the one that asked least recently is forgotten first."""


class Rates:
    """Requests of each client.

    Attributes:
        refused: requests that were dropped.
    """

    def __init__(self, rate_hz: float = RATE_HZ, burst: int = BURST) -> None:
        self._rate_hz, self._burst = rate_hz, burst
        self._left: OrderedDict[bytes, tuple[float, float]] = OrderedDict()
        self.refused = 0

    def allows(self, client: bytes, now_s: float, cost: float = 1.0) -> bool:
        """Whether a client may ask now for what counts as `cost` requests; counts it."""
        left, at_s = self._left.pop(client, (float(self._burst), now_s))
        left = min(float(self._burst), left + (now_s - at_s) * self._rate_hz)
        allowed = left >= cost
        self._left[client] = (left - cost if allowed else left, now_s)
        while len(self._left) > KEPT:
            self._left.popitem(last=False)
        self.refused += not allowed
        return allowed
