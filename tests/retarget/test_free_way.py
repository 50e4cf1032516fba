"""Ways that keep off the robot, proved again by poses set close together."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from retarget.path import rrt_connect
from retarget.path.collision import KEPT, SelfContact
from retarget.path.limits import JointLimits
from retarget.path.rrt_connect import RrtConnect
from retarget.robot.loading import list_robots, load_robot
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

ROBOTS = ByName(("reference", "toddlerbot", "op2"), packaged)
CONTACTS = ByName(ROBOTS, lambda name: SelfContact(packaged(name)))
BODIES = ByName(ROBOTS, lambda name: SelfContact(packaged(name), margin_m=0.0))
names = st.sampled_from(sorted(ROBOTS))
seeds = st.integers(0, 2**32 - 1)


def drawn(name: str, seed: int) -> np.ndarray:
    """(J,) any pose inside the limits, often one in contact."""
    limits = JointLimits.of(ROBOTS[name])
    return np.random.default_rng(seed).uniform(limits.position_min_rad, limits.position_max_rad)


APART_M, DEEPER_M = 2e-4, 5e-4
"""Metres by which a pair may come into contact, and by which one in contact may be deeper than the shallowest it has been."""


def dense(way: list[np.ndarray], step_rad: float = 0.01) -> np.ndarray:
    """(N, J) poses along a way, no joint moving further than `step_rad` between two."""
    parts = [np.array(way[:1])]
    for a, b in pairwise(way):
        n = max(1, int(np.ceil(np.abs(b - a).max() / step_rad)))
        parts.append(a + np.linspace(0, 1, n + 1)[1:, None] * (b - a))
    return np.concatenate(parts)


def searched(name: str, start: np.ndarray, goal: np.ndarray) -> RrtConnect:
    search = RrtConnect(ROBOTS[name], CONTACTS[name], start, goal)
    while not search.work():
        pass
    return search


@pytest.mark.parametrize("name", few_and_long(["reference", "op2"], ROBOTS))
@settings(max_examples=examples(12), deadline=None)
@given(seed=seeds, parks=st.booleans())
@example(seed=204342947, parks=False)  # of toddlerbot
def test_on_no_way_to_park_or_rest_it_touches_itself(name, seed, parks):
    """From any pose; where it starts in contact, each pair in contact only parts, and none joins it.

    A search by chance may find none, rarely also from a clear pose: then the robot holds and says so. How often one is found is for
    the next test.
    """
    robot, start = ROBOTS[name], drawn(name, seed)
    goal = robot.park_rad if parks else robot.rest_rad
    search = searched(name, start, goal)
    if search.way is None:
        return
    assert np.array_equal(search.way[0], start) and np.array_equal(search.way[-1], goal)
    limits = JointLimits.of(robot)
    poses = dense(search.way)
    assert (poses >= limits.position_min_rad - 1e-12).all() and (poses <= limits.position_max_rad + 1e-12).all()
    depth_m = np.minimum(BODIES[name].distances_m(poses), 0.0)
    shallowest_m = np.maximum.accumulate(depth_m, axis=0)  # of shapes deep in one another the depth has kinks
    assert (depth_m >= shallowest_m - np.where(shallowest_m < 0.0, DEEPER_M, APART_M)).all()


@pytest.mark.parametrize("n_poses", [20, pytest.param(60, marks=pytest.mark.soak)])
@pytest.mark.parametrize("name", few_and_long(["reference"], ROBOTS))
def test_from_clear_poses_and_from_slight_contacts_a_way_is_found(name, n_poses):
    """Shapes are coarse: an arm that rests on the body may be some millimetres in it."""
    depths = {seed: -float(BODIES[name].clearance_m(drawn(name, seed)[None])[0]) for seed in range(n_poses)}
    for low_m, high_m, share in ((-np.inf, 0.0, 1.0), (0.0, 0.006, 0.6)):
        some = [seed for seed, depth in depths.items() if low_m <= depth < high_m]
        searches = [searched(name, drawn(name, seed), ROBOTS[name].park_rad) for seed in some]
        assert sum(s.way is not None for s in searches) >= share * len(some)
        assert max((s.pieces for s in searches), default=0) < 5000


@pytest.mark.parametrize("name", list_robots())
def test_a_way_with_margin_joins_rest_and_park_pose_of_every_robot(name):
    robot = load_robot(name)
    contact = SelfContact(robot)
    search = RrtConnect(robot, contact, robot.rest_rad, robot.park_rad)
    while not search.work():
        pass
    assert search.way is not None
    assert (contact.slacks_m(dense(search.way)) > 0).all()


def blocked(name: str) -> tuple[np.ndarray, np.ndarray]:
    """A clear start from which the straight line to the park pose goes through the robot."""
    for seed in range(1000):
        start = drawn(name, seed)
        line = dense([start, ROBOTS[name].park_rad])
        if (CONTACTS[name].slack_m(start) > 0).all() and (BODIES[name].distances_m(line) < -0.005).any():
            return start, ROBOTS[name].park_rad
    raise AssertionError("no such pose")


@pytest.mark.parametrize(
    "name", few_and_long(["reference"], ["toddlerbot"])
)  # op2's short arms find it free from everywhere
def test_where_a_straight_line_crosses_the_robot_the_way_goes_round(name):
    start, goal = blocked(name)
    way = searched(name, start, goal).way
    assert way is not None and len(way) > 2
    assert (BODIES[name].distances_m(dense(way)) > 0).all()


def test_without_a_way_it_says_so_and_the_same_search_gives_the_same_way(monkeypatch):
    start, goal = blocked("reference")
    first, second = searched("reference", start, goal), searched("reference", start, goal)
    assert first.way is not None and second.way is not None
    assert np.array(first.way).tobytes() == np.array(second.way).tobytes()
    monkeypatch.setattr(rrt_connect, "TRIES", 0)
    assert searched("reference", start, goal).way is None


def test_a_start_outside_the_limits_only_comes_back():
    robot = ROBOTS["reference"]
    start = robot.rest_rad.copy()
    start[2] = JointLimits.of(robot).position_max_rad[2] + 0.2
    way = searched("reference", start, robot.park_rad).way
    assert way is not None
    assert (np.diff(dense(way)[:, 2]) <= 1e-12).all()


@settings(max_examples=examples(80), deadline=None)
@given(names, seeds, st.integers(2, 6), st.floats(0.01, 1.0))
def test_a_line_that_is_called_clear_keeps_its_share_everywhere(name, seed, n, reach):
    draw = np.random.default_rng(seed)
    at = drawn(name, seed)
    way = at + np.cumsum(draw.uniform(-reach, reach, (n, len(at))), 0)
    contact = CONTACTS[name]
    least = contact.slacks_m(dense(list(way), 0.005)).min()
    clear = contact.clear_along(way)
    assert not clear or least > 0
    if least > 0.004:
        assert clear, "it gives up only where it is close"


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_at_rest_it_is_clear(name):
    rest = ROBOTS[name].rest_rad
    assert CONTACTS[name].clear_along(np.array([rest, rest]), KEPT)
