"""Requests a second: each client has its share, and the clients of one peer share one."""

from __future__ import annotations

from daemon.front.rate_limits import BURST, PEER_BURST, PEER_RATE_HZ, RATE_HZ, Rates, RequestLimits


def test_ever_new_clients_of_one_peer_share_its_limit():
    """The limit was that of each name, and a client that connects anew has a new one."""
    limits = RequestLimits()
    allowed = sum(limits.allows(b"%d" % n, "laptop", 0.0) for n in range(2 * PEER_BURST))
    assert allowed == PEER_BURST and limits.refused == PEER_BURST
    assert limits.allows(b"1", "another machine", 0.0)
    assert sum(limits.allows(b"new %d" % n, "laptop", 1.0) for n in range(5000)) == PEER_RATE_HZ


def test_rates_bound_each_client_apart():
    rates = Rates()
    assert sum(rates.allows(b"a", 0.0) for _ in range(2 * BURST)) == BURST
    assert rates.allows(b"b", 0.0) and rates.refused == BURST
    assert sum(rates.allows(b"a", 1.0) for _ in range(1000)) == RATE_HZ
