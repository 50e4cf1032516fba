"""Teaching by hand: what is smoothed, cut and slowed, and that whatever a hand did, the gesture is one that the robot may show."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.errors import ClipError
from daemon.gestures.limpness import limpness_of
from daemon.gestures.teaching import (
    KEPT_STILL_FRAMES,
    MOVED_RAD,
    STILL_RAD,
    Taught,
    arm_joints,
    arms_alone,
    even,
    inside_positions,
    on_a_person,
    sides_led,
    slowed,
    smoothed,
    still_ends_cut,
    taught_gesture,
    taught_pose,
)
from mmm_core.motion.motion import FPS
from retarget.pipeline import Retargeter
from retarget.robot.loading import list_robots, load_robot
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples

RETARGETERS = ByName(("reference", "op3", "poppy_torso"), lambda name: Retargeter(packaged(name)))
ROBOT = packaged("reference")
TICK_RAD = 2 * np.pi / 4096
seeds = st.integers(0, 2**32 - 1)
names = st.sampled_from(sorted(RETARGETERS))


def led(retargeter: Retargeter, seed: int, speed: float = 1.0, sides: str = "both") -> tuple[list[float], np.ndarray]:
    """Times and positions of arms that a hand led from rest to random places and back, a little beyond their ranges too."""
    rng, robot = np.random.default_rng(seed), retargeter.robot
    knots = rng.integers(2, 6)
    places = np.repeat(robot.rest_rad[None], knots + 2, 0)
    span = robot.position_max_rad - robot.position_min_rad
    wild = robot.position_min_rad + span * rng.uniform(-0.05, 1.05, (knots, robot.n_joints))
    arms = arm_joints(robot, sides)
    places[1:-1, arms] = wild[:, arms]
    at_s = np.concatenate([[1.0], 1.0 + np.cumsum(rng.uniform(0.3, 1.5, knots + 1)) / speed])
    t = np.cumsum(rng.uniform(0.04, 0.06, round((at_s[-1] + 1.0) / 0.05)))
    q = np.stack([np.interp(t, at_s, column) for column in places.T], 1)
    return t.tolist(), q + rng.uniform(-TICK_RAD, TICK_RAD, q.shape)


def may_be_shown(retargeter: Retargeter, taught: Taught) -> None:
    path = retargeter.retarget(taught.posture.motion())
    limits = retargeter.limits
    assert path.report.peak_speed_share <= 1 + 1e-6 and path.report.peak_acceleration_share <= 1 + 1e-6
    assert (path.q_rad >= limits.position_min_rad - 1e-9).all() and (path.q_rad <= limits.position_max_rad + 1e-9).all()
    assert not retargeter.contact.along(path.control_rad).any()


@settings(max_examples=examples(12), deadline=None)
@given(names, seeds, st.floats(0.3, 8.0))
def test_whatever_a_hand_did_the_robot_may_show_it(name, seed, speed):
    """At any speed, through its own body and beyond its stops: within every limit, and clear of itself."""
    retargeter = RETARGETERS[name]
    taught = taught_gesture(retargeter, *led(retargeter, seed, speed))
    may_be_shown(retargeter, taught)


@settings(max_examples=examples(25), deadline=None)
@given(names, seeds)
def test_a_pose_may_be_shown_too(name, seed):
    retargeter = RETARGETERS[name]
    t, q = led(retargeter, seed)
    still = np.repeat(q[len(q) // 2][None], 20, 0)
    taught = taught_pose(retargeter, t[:20], still)
    assert len(taught.posture) == FPS and taught.sides == "both"
    may_be_shown(retargeter, taught)


@settings(max_examples=examples(50), deadline=None)
@given(seeds, st.floats(0.3, 10.0))
def test_slowing_keeps_the_way_and_the_speed_limit(seed, speed):
    _, q = led(RETARGETERS["reference"], seed, speed)
    limit = ROBOT.velocity_limit_rad_s
    slower, times = slowed(q, limit)
    assert (np.abs(np.diff(slower, axis=0)) * FPS <= limit * (1 + 1e-9)).all()
    assert len(slower) >= len(q) and np.allclose(slower[[0, -1]], q[[0, -1]])
    fastest = (np.abs(np.diff(q, axis=0)) * FPS / limit).max()
    assert times == pytest.approx(max(1.0, fastest))
    if fastest <= 1:
        assert np.allclose(slower, q)
    again, once = slowed(slower, limit)
    assert once <= 1 + 1e-9 and np.allclose(again, slower, atol=1e-6)
    low, high = q.min(0) - 1e-12, q.max(0) + 1e-12
    assert (slower >= low).all() and (slower <= high).all()


@settings(max_examples=examples(50), deadline=None)
@given(seeds, st.integers(0, 60), st.integers(0, 60))
def test_still_ends_are_cut_however_long_they_are(seed, before, after):
    """What is cut is as still as its end, what moves stays, and more of the still ends changes nothing."""
    _, q = led(RETARGETERS["reference"], seed)
    q = smoothed(q)
    cut = still_ends_cut(q)
    first = next(k for k in range(len(q)) if np.array_equal(q[k : k + len(cut)], cut))
    last = first + len(cut) - 1
    assert (np.abs(q[: first + KEPT_STILL_FRAMES] - q[0]) <= STILL_RAD).all()
    assert (np.abs(q[last - KEPT_STILL_FRAMES + 1 :] - q[-1]) <= STILL_RAD).all()
    longer = np.concatenate([np.repeat(q[:1], before, 0), q, np.repeat(q[-1:], after, 0)])
    assert np.array_equal(still_ends_cut(longer), cut)


@settings(max_examples=examples(50), deadline=None)
@given(seeds, st.integers(2, 80))
def test_smoothing_keeps_what_stands_and_takes_what_trembles(seed, frames):
    rng = np.random.default_rng(seed)
    stands = np.repeat(rng.uniform(-2, 2, (1, 3)), frames, 0)
    assert np.allclose(smoothed(stands), stands)
    slow = np.sin(2 * np.pi * 0.5 * np.arange(200) / FPS)[:, None]
    trembling = slow + np.deg2rad(1) * np.sin(2 * np.pi * 9 * np.arange(200) / FPS + rng.uniform(0, 6))[:, None]
    middle = slice(20, -20)
    assert np.abs(smoothed(slow) - slow)[middle].max() < np.deg2rad(0.2), "a slow movement stays, and is not delayed"
    assert np.abs(smoothed(trembling) - slow)[middle].max() < np.deg2rad(0.3)


@settings(max_examples=examples(25), deadline=None)
@given(names, seeds, st.sampled_from(["left", "right"]))
def test_one_arm_is_found_and_nothing_else_is_taught(name, seed, side):
    """The other arm, the trunk and a hanging head stay at rest, wherever they were measured."""
    retargeter = RETARGETERS[name]
    t, q = led(retargeter, seed, sides=side)
    robot = retargeter.robot
    others = [j for j in range(robot.n_joints) if j not in arm_joints(robot, side)]
    hanging = [j for j in others if not robot.joints[j].role.startswith(("left_", "right_"))]
    q[:, hanging] = robot.position_min_rad[hanging]
    assert sides_led(robot, q) == side
    assert np.array_equal(arms_alone(robot, q, side)[:, others], np.repeat(robot.rest_rad[None, others], len(q), 0))
    assert taught_gesture(retargeter, t, q).sides == side


@settings(max_examples=examples(20), deadline=None)
@given(names, seeds)
def test_an_arm_in_reach_comes_back_as_it_was_led(name, seed):
    """On a person and back on the robot: the arms point where they were led, where nothing is in the way."""
    retargeter = RETARGETERS[name]
    robot, rng = retargeter.robot, np.random.default_rng(seed)
    q = np.repeat(robot.rest_rad[None], 40, 0)
    for j in arm_joints(robot, "both"):
        room = min(robot.position_max_rad[j] - q[0, j], q[0, j] - robot.position_min_rad[j], 0.5)
        q[:, j] += room * rng.uniform(0, 0.8) * (1 - np.cos(np.linspace(0, 2 * np.pi, 40))) / 2
    if retargeter.contact.frames(q, 1.5).any():
        return
    path = retargeter.retarget(on_a_person(retargeter.kinematics, q).motion())
    assert path.report.direction_mean_deg < 1.5


def test_a_turned_forearm_is_kept():
    q = np.repeat(ROBOT.rest_rad[None], 40, 0)
    yaw = [ROBOT.joint_names.index(f"{side}_forearm_yaw") for side in ("left", "right")]
    q[:, yaw] += np.array([0.6, -0.4]) * np.linspace(0, 1, 40)[:, None]
    path = RETARGETERS["reference"].retarget(on_a_person(RETARGETERS["reference"].kinematics, q).motion())
    assert path.q_rad[39, yaw] == pytest.approx(q[-1, yaw], abs=0.02)


def test_measurements_with_a_pause_are_bridged_and_told():
    t = [0.0, 0.05, 0.1, 0.6, 0.65]
    q, notes = even(t, np.array(t)[:, None])
    assert np.allclose(q[:, 0], np.arange(len(q)) / FPS)
    assert len(notes) == 1 and "0.50 s at 0.1 s" in notes[0]


def test_what_was_beyond_a_limit_or_too_fast_is_told():
    t = (np.arange(60) / FPS).tolist()
    q = np.repeat(ROBOT.rest_rad[None], 60, 0)
    elbow = ROBOT.joint_names.index("right_elbow")
    q[20:40, elbow] = ROBOT.position_max_rad[elbow] + 0.1
    clipped, notes = inside_positions(q, RETARGETERS["reference"].limits, ROBOT.joint_names)
    assert clipped[:, elbow].max() <= ROBOT.position_max_rad[elbow] and "right_elbow was led 5.8 degrees" in notes[0]
    said = " ".join(taught_gesture(RETARGETERS["reference"], t, q).notes)
    assert "right_elbow was led" in said and "times as fast as a joint may be" in said


@pytest.mark.parametrize(
    ("moved_rad", "frames", "says"),
    [(0.0, 40, "no arm was moved"), (MOVED_RAD * 0.9, 40, "no arm was moved"), (1.0, 1, "1 positions")],
)
def test_a_recording_with_nothing_in_it_is_refused(moved_rad, frames, says):
    q = np.repeat(ROBOT.rest_rad[None], frames, 0)
    q[frames // 2 :, ROBOT.joint_names.index("right_elbow")] += moved_rad
    with pytest.raises(ClipError, match=says):
        taught_gesture(RETARGETERS["reference"], (np.arange(frames) / FPS).tolist(), q)


def test_a_pose_that_moved_is_refused():
    q = np.repeat(ROBOT.rest_rad[None], 40, 0)
    q[:, ROBOT.joint_names.index("right_elbow")] += np.linspace(0, 1, 40)
    with pytest.raises(ClipError, match="hold the arms still"):
        taught_pose(RETARGETERS["reference"], (np.arange(40) / FPS).tolist(), q)


@pytest.mark.parametrize(
    ("name", "falls", "sinks"),
    [
        ("reference", ("waist_pitch",), ("head_pitch",)), ("op3", (), ("head_tilt",)),
        ("poppy_torso", ("bust_y", "bust_x"), ("head_y",)), ("toddlerbot", ("waist_roll",), ("neck_pitch",)),
    ],
)  # fmt: skip
def test_what_falls_without_torque_is_read_off_the_robot(name, falls, sinks):
    limpness = limpness_of(Retargeter(load_robot(name)).kinematics)
    assert (limpness.falls, limpness.sinks) == (falls, sinks)
    assert any("FALLS" in line for line in limpness.in_words()) == bool(falls)


@pytest.mark.parametrize("name", list_robots())
def test_every_joint_is_said_to_hang_fall_sink_or_stay(name):
    robot = load_robot(name, blanks=True)
    limpness = limpness_of(Retargeter(robot).kinematics)
    said = [*limpness.arms, *limpness.falls, *limpness.sinks, *limpness.stays]
    assert sorted(said) == sorted(robot.joint_names)
