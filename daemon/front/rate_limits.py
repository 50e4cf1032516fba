"""Request limits: a token bucket for each client and for each peer. No I/O."""

from __future__ import annotations

from collections import OrderedDict

RATE_HZ = 400.0
BURST = 4000
PEER_RATE_HZ, PEER_BURST = 2000.0, 20_000
"""Requests a second, and at once, of all clients of one peer together: of one key, else of one address. The limit is needed
because a client that connects again gets a new name."""
KEPT = 1024
"""Clients that are remembered; the one with the oldest request is forgotten first."""


class Rates:
    """Limits the requests of each client.

    Attributes:
        refused: number of requests that were dropped.
    """

    def __init__(self, rate_hz: float = RATE_HZ, burst: int = BURST) -> None:
        self._rate_hz, self._burst = rate_hz, burst
        self._left: OrderedDict[bytes, tuple[float, float]] = OrderedDict()
        self.refused = 0

    def allows(self, client: bytes, now_s: float, cost: float = 1.0) -> bool:
        """Whether a client may send a request that counts as `cost` requests now; counts the request."""
        left, at_s = self._left.pop(client, (float(self._burst), now_s))
        left = min(float(self._burst), left + (now_s - at_s) * self._rate_hz)
        allowed = left >= cost
        self._left[client] = (left - cost if allowed else left, now_s)
        while len(self._left) > KEPT:
            self._left.popitem(last=False)
        self.refused += not allowed
        return allowed


class RequestLimits:
    """Limits the requests of each client, and of all clients of each peer together."""

    def __init__(self) -> None:
        self._clients, self._peers = Rates(), Rates(PEER_RATE_HZ, PEER_BURST)

    @property
    def refused(self) -> int:
        """Number of requests that were dropped."""
        return self._clients.refused + self._peers.refused

    def allows(self, client: bytes, peer: str, now_s: float) -> bool:
        """Whether a client of a peer may send a request now; counts the request."""
        return self._clients.allows(client, now_s) and self._peers.allows(peer.encode(), now_s)
