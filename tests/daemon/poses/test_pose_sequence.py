"""Postures: the motion they come from, mirrors, tempo, size, and going over from one to another."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.poses.aliveness import Aliveness
from daemon.poses.pose_sequence import (
    at_tempo,
    distance_deg,
    faded_in,
    joined,
    mirrored,
    mixed,
    posture_of,
    scaled,
    standing,
)
from mmm_core.motion.skeleton import matrix_from_quat, rotation_y
from retarget.human.human import read_human
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from tests.support.kinematic import motion_of, raised_arm
from tests.support.sizes import examples

RIGHT = raised_arm("right", 1.5, 1.3, "right")
P = posture_of(RIGHT)


def test_a_posture_says_what_its_motion_says_wherever_the_person_stands():
    turn = rotation_y(np.array(0.9))
    joints = RIGHT.joints_m @ turn.T + np.array([3.0, 0.2, -1.0])
    turned = posture_of(motion_of(joints.astype(np.float64), "turned"))
    a, b = read_human(RIGHT), read_human(P.motion(RIGHT))
    assert np.allclose(a.upper, b.upper, atol=1e-5) and np.allclose(a.fore, b.fore, atol=1e-5)
    assert np.allclose(turned.bones, P.bones, atol=1e-5)
    again = P.motion(RIGHT)
    assert (again.text, again.seed, again.status) == (RIGHT.text, RIGHT.seed, RIGHT.status)


def test_mirroring_twice_changes_nothing_and_once_moves_the_other_arm():
    twice = mirrored(mirrored(P))
    assert np.array_equal(twice.bones, P.bones) and np.array_equal(twice.head_quat_wxyz, P.head_quat_wxyz)
    other = posture_of(raised_arm("left", 1.5, 1.3, "left"))
    assert distance_deg(mirrored(P), other).max() < 0.01


def test_a_mirrored_head_looks_to_the_other_side():
    from daemon.poses.idle import head_wxyz

    yaw, pitch = np.deg2rad([30.0]), np.deg2rad([10.0])
    from dataclasses import replace

    p = replace(standing(), head_quat_wxyz=head_wxyz(yaw, pitch), forearm_twist_rad=np.array([[0.2, -0.5]]))
    m = mirrored(p)
    assert np.allclose(m.head_quat_wxyz, head_wxyz(-yaw, pitch))
    assert np.allclose(m.forearm_twist_rad, [[0.5, -0.2]])
    forward = matrix_from_quat(p.head_quat_wxyz)[0] @ [0, 0, 1]
    assert forward[0] > 0.4 and forward[1] < -0.1  # left and down


@pytest.mark.parametrize("tempo", [0.5, 0.8, 1.0, 1.7, 2.0])
def test_tempo_keeps_the_poses_and_changes_the_length(tempo):
    p = at_tempo(P, tempo)
    assert len(p) == pytest.approx(len(P) / tempo, abs=1.5)
    assert distance_deg(p[:1], P[:1])[0] < 1e-4 and distance_deg(p[-1:], P[-1:])[0] < 1e-4
    assert np.linalg.norm(p.bones[:, 1:], axis=-1) == pytest.approx(1.0)


@given(st.floats(0.3, 1.2))
@settings(max_examples=examples(20), deadline=None)
def test_amplitude_scales_how_far_the_arm_leaves_standing(amplitude):
    up = int(np.argmin(P.bones[:, 19, 1] * -1))
    before = distance_deg(standing(), P[up : up + 1])[0]
    after = distance_deg(standing(), scaled(P, amplitude)[up : up + 1])[0]
    assert after == pytest.approx(amplitude * before, rel=0.02)


@given(st.integers(0, 25), st.floats(0, 1))
@settings(max_examples=examples(30), deadline=None)
def test_mixing_stays_on_the_sphere_and_meets_both_ends(frame, weight):
    a, b = P[frame : frame + 1], mirrored(P)[frame : frame + 1]
    m = mixed(a, b, np.array([weight]))
    assert np.linalg.norm(m.bones[:, 1:], axis=-1) == pytest.approx(1.0)
    assert np.linalg.norm(m.head_quat_wxyz, axis=-1) == pytest.approx(1.0)
    assert distance_deg(mixed(a, b, np.zeros(1)), a)[0] < 1e-3 and distance_deg(mixed(a, b, np.ones(1)), b)[0] < 1e-3


def test_fading_in_grows_out_of_what_was_before_and_then_is_the_motion():
    before = mirrored(P)[10:12]
    p = faded_in(P, before, 8)
    assert distance_deg(p[:1], before[:1])[0] < 0.1 * distance_deg(P[:1], before[:1])[0] + 0.5
    assert np.array_equal(p.bones[8:], P.bones[8:])
    assert np.allclose(
        faded_in(P[:3], before, 8).bones[-1], P.bones[2], atol=1e-6
    )  # shorter than the fade: over in time


def test_joined_and_cut_again():
    both = joined([P, P])
    assert len(both) == 2 * len(P) and np.array_equal(both[len(P) :].bones, P.bones)


@pytest.mark.parametrize("name", ["reference", "op3"])
def test_the_standing_person_is_near_the_rest_of_the_robots_and_clear(name):
    robot = load_robot(name)
    path = Retargeter(robot).retarget(standing().at(np.zeros(20, np.intp)).motion())
    assert path.report.interventions == 0


def test_a_generated_motion_is_alive_unless_it_is_switched_off() -> None:
    """The mirror image of a text gives the mirrored poses; without the setting the poses are the motion's."""
    right = raised_arm("raise your right arm", 2.0, 1.3, "right")
    left = raised_arm("raise your left arm", 2.0, 1.3, "left")
    plain, on = Aliveness(on=False).posture_of(right), Aliveness(on=True).posture_of(right)
    assert np.array_equal(plain.bones, posture_of(right).bones)
    assert 0.5 < float(distance_deg(plain, on).max()) < 30.0
    image = mirrored(Aliveness(on=True).posture_of(left))
    assert float(distance_deg(image, on).max()) < 1e-3
    assert not np.array_equal(on.bones, Aliveness(on=True).posture_of(right, piece=1).bones), "scenes sway alike"
