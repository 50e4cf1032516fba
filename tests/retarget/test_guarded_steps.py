"""Steps towards any targets: every limit kept, nothing touched, by measures of their own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from retarget.path.collision import SelfContact
from retarget.path.limits import brake
from retarget.path.safety_filter import SafetyFilter
from retarget.robot.robot import RobotModel
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

ROBOTS = ByName(("reference", "toddlerbot", "op2"), packaged)
GUARDS = ByName(ROBOTS, lambda name: SafetyFilter(packaged(name)))
BODIES = ByName(ROBOTS, lambda name: SelfContact(packaged(name), margin_m=0.0))
"""Without a margin: what it calls contact is contact."""

jumps = st.lists(
    st.tuples(st.integers(0, 2**32 - 1), st.integers(1, 40), st.sampled_from(["pose", "far", "one", "into", "brake"])),
    min_size=1, max_size=25,
)  # fmt: skip


def begun(name: str) -> tuple[RobotModel, SafetyFilter]:
    robot, guard = ROBOTS[name], GUARDS[name]
    guard.reset(robot.rest_rad, np.zeros(robot.n_joints))
    guard.holds = 0
    return robot, guard


def assert_kept(robot: RobotModel, guard: SafetyFilter, path: np.ndarray) -> None:
    period, limits = robot.bus.period_s, guard.limits
    whole = np.vstack([robot.rest_rad, robot.rest_rad, path])
    assert (path >= limits.position_min_rad - 1e-9).all() and (path <= limits.position_max_rad + 1e-9).all()
    assert (np.abs(np.diff(whole, axis=0)) <= limits.velocity_rad_s * period * (1 + 1e-6) + 1e-9).all()
    assert (np.abs(np.diff(whole, 2, axis=0)) <= limits.acceleration_rad_s2 * period**2 * (1 + 1e-6) + 1e-9).all()
    between = np.concatenate([path, *(path[:-1] + u * np.diff(path, axis=0) for u in (0.25, 0.5, 0.75))])
    assert BODIES[robot.name].clearance_m(between).min() > 0.0


@settings(max_examples=examples(30), deadline=None)
@given(name=st.sampled_from(sorted(ROBOTS)), commands=jumps)
def test_no_targets_break_a_limit_or_touch(name, commands):
    """Random poses, jumps beyond every limit, single joints, targets that alternate within few steps, sudden ends."""
    robot, guard = begun(name)
    low, high = guard.limits.position_min_rad, guard.limits.position_max_rad
    path = []
    target = robot.rest_rad.copy()
    for seed, n, kind in commands:
        draw = np.random.default_rng(seed)
        if kind == "pose":
            target = draw.uniform(low, high)
        elif kind == "far":
            target = np.where(draw.random(robot.n_joints) < 0.5, -1e6, 1e6)
        elif kind == "one":
            target = target.copy()
            target[draw.integers(robot.n_joints)] = draw.uniform(2 * low.min(), 2 * high.max())
        elif kind == "into":
            target = np.where(
                draw.random(robot.n_joints) < 0.7, draw.choice([0, 1], robot.n_joints) * (high - low) + low, 0
            )
        path += [guard.brake() if kind == "brake" else guard.step(target) for _ in range(n)]
    while not guard.at_rest:
        path.append(guard.brake())
    assert_kept(robot, guard, np.array(path))


def touching_target(robot: RobotModel, seed: int = 0) -> np.ndarray:
    """A pose in which the robot is in itself."""
    draw, body = np.random.default_rng(seed), BODIES[robot.name]
    poses = draw.uniform(robot.position_min_rad, robot.position_max_rad, (3000, robot.n_joints))
    return poses[body.clearance_m(poses).argmin()]


@pytest.mark.parametrize("name", few_and_long(["reference"], sorted(ROBOTS)))
def test_it_holds_before_it_touches_and_goes_on_when_the_target_lets_it(name):
    robot, guard = begun(name)
    inside = touching_target(robot)
    path = [guard.step(inside) for _ in range(400)]
    assert guard.held and guard.at_rest and guard.holds == 1
    assert guard.touching(inside)
    assert not np.array_equal(path[-1], robot.rest_rad), "it went as far as it could"
    path += [guard.step(robot.rest_rad) for _ in range(600)]
    assert not guard.held and np.array_equal(path[-1], robot.rest_rad)
    assert_kept(robot, guard, np.array(path))


def test_a_held_robot_does_not_creep():
    robot, guard = begun("reference")
    inside = touching_target(robot)
    for _ in range(400):
        guard.step(inside)
    held = guard.position_rad.copy()
    for _ in range(300):
        guard.step(inside)
    assert np.array_equal(guard.position_rad, held)


def test_what_ends_the_steps_brakes_on_the_way_that_was_proved():
    """The bus process brakes by `limits.brake` when frames end: from every step that way is clear."""
    _, guard = begun("toddlerbot")
    draw = np.random.default_rng(5)
    for _ in range(12):
        target = draw.uniform(guard.limits.position_min_rad, guard.limits.position_max_rad)
        for _ in range(25):
            guard.step(target)
            position, velocity, way = guard.position_rad, guard.velocity_rad_s, [guard.position_rad]
            while velocity.any():
                goal = brake(position, velocity, guard.limits, guard.period_s)
                position, velocity = goal, (goal - position) / guard.period_s
                way.append(goal)
            assert BODIES["toddlerbot"].clearance_m(np.array(way)).min() > 0.0


def test_a_target_within_reach_is_met_and_one_outside_counts_as_clipped():
    robot, guard = begun("reference")
    near = robot.rest_rad + np.clip(0.2, None, (robot.position_max_rad - robot.rest_rad) / 2)
    for _ in range(200):
        guard.step(near)
    assert np.array_equal(guard.position_rad, near) and not guard.clipped and not guard.held
    guard.step(np.full(robot.n_joints, 9.0))
    assert guard.clipped


def test_a_robot_within_the_margin_may_leave_it_but_not_go_deeper():
    """It may have been led there by hand while it was limp."""
    robot = ROBOTS["op2"]
    guard = GUARDS["op2"]
    kept = SelfContact(robot)
    draw = np.random.default_rng(2)
    poses = draw.uniform(guard.limits.position_min_rad, guard.limits.position_max_rad, (4000, robot.n_joints))
    clear = BODIES["op2"].clearance_m(poses)
    near = poses[(clear > 0.001) & (clear < 0.004)][0]
    before = kept.slack_m(near)
    assert (before < 0).any()
    guard.reset(near, np.zeros(robot.n_joints))
    target = touching_target(robot)
    for _ in range(300):
        guard.step(target)
        assert (kept.slack_m(guard.position_rad) >= np.minimum(before, 0.0) - 1e-5).all()
