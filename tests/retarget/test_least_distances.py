"""Bounds of distances carried to poses nearby: never above the true distance, and the same verdicts as measuring all of it."""

from __future__ import annotations

import numpy as np
import pytest

from retarget.path.collision import SelfContact
from retarget.path.least_distances import LeastDistances
from retarget.robot.loading import list_robots, load_robot
from tests.retarget.test_collision import measured_m
from tests.support.robots import ByName, packaged
from tests.support.sizes import few_and_long

CONTACTS = ByName(list_robots(), lambda name: SelfContact(packaged(name)))


def wandering(name: str, n: int, step_rad: float, seed: int = 5) -> np.ndarray:
    """(n, J) poses from rest on, in steps of `step_rad` a joint at most, within the range of each joint."""
    robot, rng = load_robot(name), np.random.default_rng(seed)
    toward = np.repeat(
        rng.uniform(robot.position_min_rad, robot.position_max_rad, (n // 10 + 1, robot.n_joints)), 10, 0
    )
    q = [robot.rest_rad]
    for aim in toward[: n - 1]:
        q.append(q[-1] + np.clip(aim - q[-1], -step_rad, step_rad))
    return np.array(q)


@pytest.mark.parametrize("name", few_and_long(["reference", "op2"], list(CONTACTS)))
def test_no_bound_is_above_the_true_distance(name: str) -> None:
    contact = CONTACTS[name]
    q = wandering(name, 60, 0.15)
    near = q[3:40] + np.random.default_rng(1).uniform(-0.1, 0.1, (37, q.shape[1]))
    for poses, least_m in ((q, contact.least(q).least_m), (near, contact.least(q).at(near, 3))):
        true_m = np.minimum(measured_m(contact, poses), 3.0)
        assert ((least_m <= true_m + 1e-6) | ((least_m < 0) & (true_m < 0))).all()
    assert (contact.touching(contact.least(q)) == contact.frames(q, 1.0)).all()


@pytest.mark.parametrize("name", few_and_long(["reference", "op2"], list(CONTACTS)))
def test_a_path_is_found_free_where_it_is_without_bounds(name: str) -> None:
    """With bounds from its own frames, from frames nearby, and without, the same segments touch."""
    contact, free, hits = CONTACTS[name], 0, 0
    for seed in range(6):
        control = wandering(name, 40, 0.1, seed)
        frames = (control[1:-1] + control[2:]) / 2
        plain = contact.along(control)
        nothing = LeastDistances(frames, np.full((len(frames), len(contact._pairs)), -np.inf), contact._sweep_m)
        for least in (nothing, contact.least(frames), contact.least(frames + 0.05)):
            assert (contact.along_near(control, None, least)[0] == plain).all()
        free, hits = free + int((~plain).sum()), hits + int(plain.sum())
    assert free
    assert hits or name in {"poppy_torso", "reachy_2021"}, (
        "no such path touches: only these two never meet themselves on one"
    )
