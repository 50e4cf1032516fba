"""Second-order bounds of distances between poses: never above the true distance, and near enough to spare halvings."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest

from retarget.path.collision import SelfContact
from retarget.path.continuous_bounds import Sections
from retarget.robot.loading import list_robots, load_robot
from tests.retarget.test_collision import place as put
from tests.support.robots import ByName, packaged
from tests.support.sizes import few_and_long

mujoco: Any = importlib.import_module("mujoco")
CONTACTS = ByName(list_robots(), lambda name: SelfContact(packaged(name)))


def splines(name: str, n: int, step_rad: float) -> np.ndarray:
    """(n, 3, J) control points of segments: poses anywhere in the range, steps of up to `step_rad` to and from them."""
    robot, rng = load_robot(name), np.random.default_rng(7)
    middle = rng.uniform(robot.position_min_rad, robot.position_max_rad, (n, robot.n_joints))
    steps = rng.uniform(-step_rad, step_rad, (2, n, robot.n_joints))
    return np.stack([middle - steps[0], middle, middle + steps[1]], 1)


def bounds_m(contact: SelfContact, control: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, P) second-order and first-order bounds of each segment's distances, and the least of 21 samples.

    Of pairs of capsules the samples are exact; of others each is MuJoCo's where a bound is near it or above it.
    """
    n, pairs = len(control), contact._every
    ends = (control[:, :-1] + control[:, 1:]) / 2
    placed = contact._placed(ends.reshape(2 * n, -1), with_joints=False)
    known = contact._of_all(placed, pairs)
    step, bend = np.abs(np.diff(control, axis=1)), np.abs(np.diff(control, n=2, axis=1))[:, 0]
    moved = np.maximum(*(step[:, i] @ contact._sweep_m.T for i in (0, 1)))
    bent = np.stack([contact._spans.bends_m(step[i], bend[i : i + 1], moved[i : i + 1])[0] for i in range(n)])
    row, pair = (i.ravel() for i in np.meshgrid(np.arange(n), pairs, indexing="ij"))
    rows, distance_m = np.stack([2 * row, 2 * row + 1]), known.distance_m.reshape(n, 2, -1)
    ways = known.way.reshape(n, 2, len(pairs), 3).transpose(1, 0, 2, 3).reshape(2, -1, 3)
    ends_m = distance_m.transpose(1, 0, 2).reshape(2, -1)
    u = np.repeat([[0.0], [1.0]], len(pair), 1)
    sections = Sections(row, pair, u, rows, ends_m, ways, moved.ravel(), bent.ravel())
    second_order = contact._spans.least_m(sections, placed.centre, placed.turn).reshape(n, -1)
    u = np.linspace(0, 1, 21)[None, :, None]
    c0, c1, c2 = (control[:, i, None] for i in range(3))
    place = (c0 + c1) / 2 + (c1 - c0) * u + (c2 - 2 * c1 + c0) * (u * u / 2)
    samples = contact.distances_m(place.reshape(-1, place.shape[2])).reshape(n, 21, -1)
    for i, k, p in zip(*np.nonzero((samples < second_order[:, None] + 1e-3) & ~contact._exact), strict=True):
        put(contact, place[i, k])
        samples[i, k, p] = mujoco.mj_geomDistance(contact._model, contact._data, *contact._pair_list[p], 3.0, None)
    true = samples.min(1)
    first_order = (distance_m.sum(1) - moved) / 2
    return second_order, first_order, true


@pytest.mark.parametrize("name", few_and_long(["reference"], CONTACTS))
@pytest.mark.parametrize("step_rad", [0.03, 0.15, 0.5])
def test_a_bound_between_poses_is_not_above_any_distance_there(name: str, step_rad: float) -> None:
    contact = CONTACTS[name]
    second, _, true = bounds_m(contact, splines(name, 60, step_rad))
    some = contact._bounded
    assert some.all()
    # How deep boxes are in each other MuJoCo knows to some millimetres only, so there the sign has to be right.
    assert ((second <= true + 1e-6) | ((second <= 0) & (true <= 0)))[:, some].all()


@pytest.mark.parametrize("name", few_and_long(["poppy_torso"], ["reference", "poppy_torso"]))
def test_at_the_speeds_of_gestures_it_tells_far_more_than_movement_alone(name: str) -> None:
    """Pairs 2 to 6 cm apart, joints at up to 1 rad/s: what is lost of the true distance falls to less than half."""
    contact = CONTACTS[name]
    assert contact._bounded.all()
    second, first, true = bounds_m(contact, splines(name, 400, 0.05))
    near = (true > 0.02) & (true < 0.06)
    assert near.sum() > 50
    assert (true - second)[near].mean() < 0.5 * (true - first)[near].mean()
