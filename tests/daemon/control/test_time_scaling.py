"""How fast setpoints are played: never off their path, never faster, to the very end, and waiting comes to an end."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from daemon.control.derating import LEAST_SHARE
from daemon.control.time_scaling import WAIT_S, ScaledSetpoints, TimeScaling
from daemon.shared_memory.bus_link import Setpoint

PERIOD_S = 0.01


class Ring:
    """Setpoints in a list."""

    def __init__(self, q: np.ndarray) -> None:
        self.left = [Setpoint(1, i, i == len(q) - 1, row) for i, row in enumerate(q)]

    def take_setpoint(self) -> Setpoint | None:
        return self.left.pop(0) if self.left else None


@given(st.lists(st.floats(LEAST_SHARE, 1.0), min_size=1, max_size=200), st.integers(2, 60))
@example([1.0, np.nextafter(1.0, 0.0)], 2)  # their sum rounds to 2: the last setpoint was left out
def test_slowed_setpoints_keep_to_the_path_and_come_to_its_end(shares, n):
    """On a straight ramp the value tells the place: it never goes back, never faster than the share, to the very end."""
    q = np.linspace(0, n - 1, n)[:, None]
    slowed, places = ScaledSetpoints(Ring(q)), []
    for i in range(10 * n):
        setpoint = slowed.take(shares[i % len(shares)])
        if setpoint is None:
            break
        places.append(float(setpoint.q_rad[0]))
    assert places[0] == 0 and places[-1] == n - 1 and setpoint is None
    steps = np.diff(places)
    assert steps.min() >= -1e-12 and steps.max() <= 1 + 1e-9


def test_at_full_speed_every_setpoint_passes_as_it_is():
    q = np.random.default_rng(0).normal(size=(50, 3))
    slowed = ScaledSetpoints(Ring(q))
    given_out = [slowed.take(1.0) for _ in range(50)]
    assert all(np.array_equal(s.q_rad, row) for s, row in zip(given_out, q, strict=True))
    assert [s.last for s in given_out] == [False] * 49 + [True]


@given(st.lists(st.sampled_from([0.0, 0.02, 0.5, 1.0]), min_size=1, max_size=200).filter(any), st.integers(2, 40))
def test_a_share_of_nothing_gives_the_same_place_again(shares, n):
    q = np.linspace(0, n - 1, n)[:, None]
    slowed, place = ScaledSetpoints(Ring(q)), None
    for i in range(3000 * n):
        setpoint = slowed.take(shares[i % len(shares)])
        if setpoint is None:
            break
        assert place is None or shares[i % len(shares)] or setpoint.q_rad[0] == place
        place = setpoint.q_rad[0]
    assert place == n - 1 and setpoint is None


@given(st.lists(st.booleans(), min_size=1, max_size=3000))
def test_a_motion_waits_while_it_is_held_but_not_for_ever(held):
    pace = TimeScaling(PERIOD_S)
    shares = [pace.update(held=h) for h in held] + [pace.update(held=False) for _ in range(100)]
    assert all(0 <= s <= 1 for s in shares) and shares[-1] == 1.0
    assert max(np.diff([1.0, *shares])) < 0.0201  # it comes back slowly
    always = [pace.update(held=True) for _ in range(400)]
    assert always[0] == 0.0 and always[-1] == 1.0 and always.count(0.0) <= WAIT_S / PERIOD_S + 1


def test_one_that_is_never_held_is_played_as_it_comes():
    pace = TimeScaling(PERIOD_S)
    assert [pace.update(held=False) for _ in range(50)] == [1.0] * 50
