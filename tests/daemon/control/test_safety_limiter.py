import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.control.safety_limiter import SafetyLimiter
from tests.support.robots import packaged
from tests.support.sizes import examples

ROBOT = packaged("reference")
LOW, HIGH = SafetyLimiter(ROBOT).limits.position_min_rad, SafetyLimiter(ROBOT).limits.position_max_rad
PERIOD_S = ROBOT.bus.period_s

anything = st.floats(allow_nan=True, allow_infinity=True) | st.floats(-10, 10) | st.sampled_from([0.0, 1e300, -1e-300])
targets = st.lists(
    st.tuples(st.integers(0, 2**32 - 1), anything, st.sampled_from(["all", "one", "noise", "brake"])), max_size=60
)


def assert_within(goals: np.ndarray, start: np.ndarray) -> None:
    """Position, velocity and acceleration as finite differences, from rest at `start`."""
    path = np.vstack([start, start, goals])
    slack = 1e-9
    assert (goals >= LOW - slack).all() and (goals <= HIGH + slack).all()
    assert (np.abs(np.diff(path, axis=0)) <= ROBOT.velocity_limit_rad_s * PERIOD_S * (1 + 1e-6) + slack).all()
    bend = np.abs(np.diff(path, 2, axis=0))
    assert (bend <= ROBOT.acceleration_limit_rad_s2 * PERIOD_S**2 * (1 + 1e-6) + slack).all()


@settings(max_examples=examples(150), deadline=None)
@given(targets, st.integers(0, 2**32 - 1))
def test_no_input_breaks_a_limit(commands, seed):
    """NaN, infinities, teleports, noise, brakes in any order: every goal is finite and inside every bound."""
    gate, random = SafetyLimiter(ROBOT), np.random.default_rng(seed)
    start = random.uniform(LOW, HIGH)
    gate.reset(start)
    goals = []
    for value_seed, value, kind in commands:
        draw = np.random.default_rng(value_seed)
        target = gate.position_rad.copy()
        if kind == "all":
            target[:] = value
        elif kind == "one":
            target[draw.integers(len(target))] = value
        else:
            target = draw.uniform(2 * LOW, 2 * HIGH)
        goals.append(gate.brake() if kind == "brake" else gate.step(target))
        assert np.isfinite(goals[-1]).all()
    if goals:
        assert_within(np.array(goals), start)


@settings(max_examples=examples(50), deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.05, 1.0))
def test_what_keeps_the_limits_passes_bit_for_bit(seed, share):
    """The gate's own output, fed to a second gate, comes back unchanged and is not called clipped."""
    random = np.random.default_rng(seed)
    first, second = SafetyLimiter(ROBOT), SafetyLimiter(ROBOT)
    start = random.uniform(LOW, HIGH)
    first.reset(start)
    second.reset(start)
    for k in range(80):
        if k % 20 == 0:
            target = random.uniform(LOW, HIGH)
        goal = first.step(first.position_rad + share * (target - first.position_rad))
        again = second.step(goal)
        assert again.tobytes() == goal.tobytes()
        assert not second.clipped.any()


def test_an_input_that_is_not_finite_brakes_and_is_counted():
    gate = SafetyLimiter(ROBOT)
    gate.reset(ROBOT.rest_rad)
    far = np.clip(ROBOT.rest_rad + 0.5, LOW, HIGH)
    for _ in range(5):
        gate.step(far)
    speed = np.abs(gate.velocity_rad_s)
    bad = far.copy()
    bad[3] = np.nan
    gate.step(bad)
    assert gate.refused == 1 and gate.clipped.all()
    assert (np.abs(gate.velocity_rad_s) <= speed).all() and (np.abs(gate.velocity_rad_s) < speed).any()


def test_braking_comes_to_rest_and_stays():
    gate = SafetyLimiter(ROBOT)
    gate.reset(ROBOT.rest_rad)
    for _ in range(30):
        gate.step(HIGH)
    cycles = 0
    while not gate.at_rest:
        gate.brake()
        cycles += 1
    slowest = (ROBOT.velocity_limit_rad_s / ROBOT.acceleration_limit_rad_s2).max()
    assert cycles <= slowest / PERIOD_S + 2
    held = gate.position_rad.tobytes()
    assert gate.brake().tobytes() == held


def test_a_target_is_reached_and_held_exactly():
    gate = SafetyLimiter(ROBOT)
    gate.reset(ROBOT.park_rad)
    for _ in range(600):
        gate.step(ROBOT.rest_rad)
    assert gate.position_rad.tobytes() == ROBOT.rest_rad.tobytes()
    assert gate.at_rest and not gate.clipped.any()


@pytest.mark.parametrize("asked_rad", [HIGH[0] + 1.0, HIGH[0] + 0.1, HIGH[0] - 0.1, LOW[0]])
def test_a_joint_outside_its_range_never_goes_further_out(asked_rad):
    gate = SafetyLimiter(ROBOT)
    start, target = ROBOT.rest_rad.copy(), ROBOT.rest_rad.copy()
    start[0], target[0] = HIGH[0] + 0.2, asked_rad
    gate.reset(start)
    path = np.array([gate.step(target)[0] for _ in range(300)])
    before = np.concatenate([start[:1], path[:-1]])
    assert (path <= np.maximum(before, HIGH[0]) + 1e-12).all()
    if asked_rad <= HIGH[0]:
        assert path[-1] == asked_rad


def test_a_start_that_is_not_finite_is_refused():
    with pytest.raises(ValueError, match="not finite"):
        SafetyLimiter(ROBOT).reset(np.full(ROBOT.n_joints, np.nan))
