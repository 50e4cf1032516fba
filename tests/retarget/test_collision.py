"""Distances of a robot to itself against MuJoCo's own, on robots of capsules, of boxes and of cylinders; paths found free are."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest

from retarget.path.collision import SelfContact
from retarget.robot.loading import list_robots, load_robot
from tests.support.robots import ByName, packaged
from tests.support.sizes import few_and_long

mujoco: Any = importlib.import_module("mujoco")
CONTACTS = ByName(list_robots(), lambda name: SelfContact(packaged(name)))


def place(contact: SelfContact, q_rad: np.ndarray) -> None:
    """Put the shapes of MuJoCo's data where they are in a pose (J,)."""
    contact._data.qpos[contact._address] = q_rad
    mujoco.mj_kinematics(contact._model, contact._data)


def measured_m(contact: SelfContact, q_rad: np.ndarray) -> np.ndarray:
    """(T, P) distances by MuJoCo, one pair and pose after another."""
    found = np.empty((len(q_rad), len(contact._pairs)))
    for i, q in enumerate(q_rad):
        place(contact, q)
        for p, (a, b) in enumerate(contact._pair_list):
            found[i, p] = mujoco.mj_geomDistance(contact._model, contact._data, a, b, 3.0, None)
    return found


def random_poses(name: str, n: int) -> np.ndarray:
    robot = load_robot(name)
    return np.random.default_rng(3).uniform(robot.position_min_rad, robot.position_max_rad, (n, robot.n_joints))


@pytest.mark.parametrize("name", list(CONTACTS))
def test_distances_are_exact_where_small_and_never_too_large(name: str) -> None:
    contact, q = CONTACTS[name], random_poses(name, 150)
    ours, theirs = contact.distances_m(q), measured_m(contact, q)
    assert (ours <= theirs + 1e-6).all()
    small = (theirs > 0) & (theirs < contact._margin_m)
    assert small.any(), "no pose comes near itself: nothing was tested"
    np.testing.assert_allclose(ours[small], theirs[small], atol=1e-5)
    np.testing.assert_array_equal(ours < 0, theirs < 0)


@pytest.mark.parametrize("name", few_and_long(["reference"], CONTACTS))
def test_a_segment_found_free_is_free_at_every_instant(name: str) -> None:
    contact, q = CONTACTS[name], random_poses(name, 240)
    rest = load_robot(name).rest_rad
    control = np.array([rest + s * (pose - rest) for pose in q for s in (0.0, 0.3, 0.6, 1.0)])
    hit = contact.along(control)
    u = np.linspace(0, 1, 21)[None, :, None]
    c0, c1, c2 = (c[:, None] for c in (control[:-2], control[1:-1], control[2:]))
    place = (c0 + c1) / 2 + (c1 - c0) * u + (c2 - 2 * c1 + c0) * (u * u / 2)
    free = place[~hit].reshape(-1, q.shape[1])
    assert hit.any() and not hit.all()
    assert not contact.frames(free[::7]).any()
    assert (contact.clearance_m(free[::7]) > 0).all()
