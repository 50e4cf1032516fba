from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.control.ptp_trajectory import ACCELERATION_RAD_S2, SPEED_RAD_S, PtpTrajectory
from daemon.control.safety_limiter import SafetyLimiter
from retarget.path.limits import JointLimits
from retarget.robot.loading import list_robots, load_robot
from tests.support.robots import packaged
from tests.support.sizes import examples

ROBOT = packaged("reference")
LIMITS = JointLimits.of(ROBOT)
PERIOD_S = ROBOT.bus.period_s


def path(way: PtpTrajectory) -> np.ndarray:
    return np.array([way.at(k * PERIOD_S) for k in range(int(way.duration_s / PERIOD_S) + 3)])


@settings(max_examples=examples(60), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_it_is_slow_and_passes_the_gate_unchanged(seed):
    random = np.random.default_rng(seed)
    start, goal = random.uniform(LIMITS.position_min_rad, LIMITS.position_max_rad, (2, ROBOT.n_joints))
    q = path(PtpTrajectory([start, goal], LIMITS))
    assert (np.abs(np.diff(q, axis=0)) <= SPEED_RAD_S * PERIOD_S * (1 + 1e-6)).all()
    assert (np.abs(np.diff(q, 2, axis=0)) <= ACCELERATION_RAD_S2 * PERIOD_S**2 * (1 + 1e-6) + 1e-9).all()
    gate = SafetyLimiter(ROBOT)
    gate.reset(start)
    for target in q:
        goal_rad = gate.step(target)
        assert np.abs(goal_rad - target).max() < 1e-9


def test_it_begins_and_ends_where_it_should():
    way = PtpTrajectory([ROBOT.park_rad, ROBOT.rest_rad], LIMITS)
    assert way.at(0.0) == pytest.approx(ROBOT.park_rad, abs=1e-12)
    assert way.at(way.duration_s) == pytest.approx(ROBOT.rest_rad, abs=1e-9)
    assert way.at(way.duration_s + 100) == pytest.approx(ROBOT.rest_rad, abs=1e-9)


@pytest.mark.parametrize("name", list_robots())
def test_the_longest_way_ends_in_bounded_time(name):
    """The bound within which every robot is armed or parked, wherever it stands."""
    robot = load_robot(name)
    limits = JointLimits.of(robot)
    way = PtpTrajectory([limits.position_min_rad, limits.position_max_rad], limits)
    widest = (limits.position_max_rad - limits.position_min_rad).max()
    assert way.duration_s < widest / min(SPEED_RAD_S, 0.5 * limits.velocity_rad_s.min()) + 2.0


def test_a_way_of_no_length_is_over_at_once():
    way = PtpTrajectory([ROBOT.rest_rad, ROBOT.rest_rad], LIMITS)
    assert way.duration_s < PERIOD_S
    assert way.at(0.0) == pytest.approx(ROBOT.rest_rad)


def test_from_outside_its_range_a_joint_only_comes_back():
    start = ROBOT.rest_rad.copy()
    start[2] = LIMITS.position_max_rad[2] + 0.3
    q = path(PtpTrajectory([start, ROBOT.rest_rad], LIMITS))[:, 2]
    assert (np.diff(q) <= 1e-9).all()


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 5))
def test_it_goes_through_every_pose_of_a_way_on_straight_lines(seed, n):
    """What was proved free on lines between the poses is what the robot does; it stands at each corner."""
    random = np.random.default_rng(seed)
    way = list(random.uniform(LIMITS.position_min_rad, LIMITS.position_max_rad, (n, ROBOT.n_joints)))
    approach = PtpTrajectory(way, LIMITS)
    q = path(approach)
    assert q[0] == pytest.approx(way[0]) and q[-1] == pytest.approx(way[-1])
    off = np.full(len(q), np.inf)
    for a, b in pairwise(way):
        u = np.clip((q - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        off = np.minimum(off, np.abs(q - (a + u[:, None] * (b - a))).max(1))
    assert off.max() < 1e-6
    gate = SafetyLimiter(ROBOT)
    gate.reset(way[0])
    assert max(np.abs(gate.step(target) - target).max() for target in q) < 1e-9
