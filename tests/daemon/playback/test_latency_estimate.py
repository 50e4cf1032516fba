"""How far ahead a path is handed over: near what it takes, beyond it where that varies."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from daemon.playback.latency_estimate import LatencyEstimate


@given(st.floats(0.001, 0.5))
def test_what_takes_always_the_same_is_allowed_that(seconds: float) -> None:
    lead = LatencyEstimate(0.03)
    for _ in range(60):
        lead.took(seconds)
    np.testing.assert_allclose(lead.seconds, seconds, rtol=0.01)


@given(st.integers(0, 99))
def test_what_varies_is_allowed_more_so_that_most_are_in_time(seed: int) -> None:
    took = np.random.default_rng(seed).gamma(9.0, 0.003, 400)
    lead, in_time = LatencyEstimate(0.03), 0
    for seconds in took:
        in_time += seconds <= lead.seconds
        lead.took(float(seconds))
    assert in_time > 0.6 * len(took)
    assert lead.seconds < 2 * np.quantile(took, 0.9)
