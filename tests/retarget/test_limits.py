"""Laws of the limiter: nothing it returns passes a bound, and what keeps the bounds passes through it untouched."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from retarget.path.limit_path import limit_path
from retarget.path.limits import JointLimits, brake, keeps, limit_step
from tests.support.robots import packaged
from tests.support.sizes import examples

LIMITS = JointLimits.of(packaged("reference"))
J = len(LIMITS.position_min_rad)
seeds = st.integers(0, 2**32 - 1)


def check_bounds(path, position, velocity, period_s):
    """All differences of a path that starts from a state inside its limits."""
    whole = np.concatenate([position[None], path])
    speed = np.diff(whole, axis=0) / period_s
    bend = np.diff(np.concatenate([velocity[None], speed]), axis=0) / period_s
    assert (path >= LIMITS.position_min_rad).all() and (path <= LIMITS.position_max_rad).all()
    assert (np.abs(speed) <= LIMITS.velocity_rad_s * (1 + 1e-9)).all()
    assert (np.abs(bend) <= LIMITS.acceleration_rad_s2 * (1 + 1e-6)).all()


def wild(rng, T, kind):
    """Targets of any kind, many outside the range."""
    if kind == "noise":
        return rng.normal(scale=3, size=(T, J))
    if kind == "teleport":
        return rng.normal(scale=3, size=(T // 8 + 1, J))[np.arange(T) // 8]
    return np.cumsum(rng.normal(scale=0.1, size=(T, J)), axis=0)


def follow(targets, position, velocity, period_s):
    """The limiter's answer to one target after another."""
    path = []
    for target in targets:
        following = limit_step(target, position, velocity, LIMITS, period_s)
        velocity, position = (following - position) / period_s, following
        path.append(following)
    return np.array(path)


@settings(max_examples=examples(40), deadline=None)
@given(seeds, st.sampled_from(["noise", "teleport", "drift"]), st.sampled_from([0.05, 0.01, 0.008, 0.005]))
def test_no_target_passes_a_bound(seed, kind, period_s):
    rng = np.random.default_rng(seed)
    position = rng.uniform(LIMITS.position_min_rad, LIMITS.position_max_rad)
    still = np.zeros(J)
    path = follow(wild(rng, 150, kind), position, still, period_s)
    check_bounds(path, position, still, period_s)
    again = follow(path, position, still, period_s)
    np.testing.assert_array_equal(again, path, "what keeps the bounds must pass through bit for bit")


@settings(max_examples=examples(25), deadline=None)
@given(seeds, st.sampled_from(["noise", "teleport", "drift"]), st.integers(1, 130))
def test_a_path_with_look_ahead_keeps_the_bounds(seed, kind, T):
    rng = np.random.default_rng(seed)
    position = rng.uniform(LIMITS.position_min_rad, LIMITS.position_max_rad)
    path = limit_path(wild(rng, T, kind), position, np.zeros(J), LIMITS, 0.05)
    check_bounds(path, position, np.zeros(J), 0.05)


@settings(max_examples=examples(30), deadline=None)
@given(seeds, st.sampled_from([0.05, 0.01]))
def test_what_keeps_the_limits_is_what_a_step_would_follow(seed, period_s):
    rng = np.random.default_rng(seed)
    position = rng.uniform(LIMITS.position_min_rad, LIMITS.position_max_rad, (200, J))
    velocity, ahead = rng.uniform(-1.1, 1.1, (2, 200, J)) * LIMITS.velocity_rad_s
    near = velocity + rng.uniform(-1.2, 1.2, (200, J)) * LIMITS.acceleration_rad_s2 * period_s
    target = position + period_s * np.where(rng.random((200, J)) < 0.8, near, velocity)
    ahead = np.where(rng.random((200, J)) < 0.5, ahead, near)
    followed = limit_step(target, position, velocity, LIMITS, period_s, ahead) == target
    kept = keeps(target, position, velocity, LIMITS, period_s, ahead)
    assert 0.1 < kept.mean() < 0.9
    np.testing.assert_array_equal(kept, followed)


def test_a_reference_inside_the_bounds_is_followed_exactly():
    t = np.arange(100)[:, None] / 20
    middle = (LIMITS.position_min_rad + LIMITS.position_max_rad) / 2
    reference = middle + 0.2 * (1 - np.cos(t * np.linspace(0.5, 3, J)))
    path = limit_path(reference, reference[0], np.zeros(J), LIMITS, 0.05)
    np.testing.assert_array_equal(path, reference)


def test_look_ahead_is_nearer_than_a_causal_clamp():
    """A clamp that does not know the future lags behind each jump; half of its error is the least to be saved."""
    reference = np.zeros((60, J)) + LIMITS.position_min_rad * 0.2
    reference[30:] += 0.8 * (LIMITS.position_max_rad - LIMITS.position_min_rad) * 0.5
    start = reference[0]
    ahead = limit_path(reference, start, np.zeros(J), LIMITS, 0.05)
    causal = follow(reference, start, np.zeros(J), 0.05)
    assert np.abs(ahead - reference).sum() < 0.75 * np.abs(causal - reference).sum()


@settings(max_examples=examples(30), deadline=None)
@given(seeds)
def test_a_start_outside_returns_inside_and_never_speeds_outwards(seed):
    rng = np.random.default_rng(seed)
    side = rng.choice([-1.0, 1.0], J)
    edge = np.where(side > 0, LIMITS.position_max_rad, LIMITS.position_min_rad)
    position, velocity = edge + side * rng.uniform(0, 0.5, J), side * rng.uniform(-1, 1, J)
    path = follow(np.repeat((edge + side)[None], 400, 0), position, velocity, 0.01)
    inside = (path[-1] >= LIMITS.position_min_rad) & (path[-1] <= LIMITS.position_max_rad)
    assert inside.all()
    speed = np.diff(np.concatenate([position[None], path]), axis=0) / 0.01
    bend = np.diff(np.concatenate([velocity[None], speed]), axis=0) / 0.01
    assert (np.abs(bend) <= LIMITS.acceleration_rad_s2 * (1 + 1e-6)).all()


def test_braking_stops_within_the_bounds_and_stays():
    position, velocity = LIMITS.position_min_rad + 0.4, LIMITS.velocity_rad_s * 0.5
    for _ in range(60):
        following = brake(position, velocity, LIMITS, 0.01)
        velocity, position = (following - position) / 0.01, following
    np.testing.assert_array_equal(brake(position, velocity, LIMITS, 0.01), position)
    assert velocity == pytest.approx(np.zeros(J), abs=1e-9)
