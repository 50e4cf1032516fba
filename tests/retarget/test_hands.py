"""Hands that touch on the person touch on the robot."""

from __future__ import annotations

import numpy as np
import pytest
from gestures import gesture

from mmm_core.motion.motion import Motion
from retarget.human.hand_contacts import read_contacts
from retarget.path.paths import JointPath
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from tests.support.sizes import few_and_long

CLAPPING = ("reference", "toddlerbot", "poppy_torso", "op3")
"""Robots whose arms are long and fast enough for a person's tempo."""
SLOW = {"ffw_bg2": 0.02, "reachy_2021": 0.15}
"""Robots that come together and part as often, by the metres by which they part; more is not in the reach of the shoulders of AI
Worker, which turn at 2 rad/s. OP2's hands stay 0.1 m apart."""


@pytest.fixture(scope="module")
def retargeters():
    return {name: Retargeter(load_robot(name), keep_contacts=True) for name in (*CLAPPING, *SLOW)}


def test_contacts_are_seen_on_the_person() -> None:
    clap, hips, wave = (read_contacts(gesture(n)).share for n in ("clap", "hands_on_hips", "wave"))
    claps = np.diff((clap["left", "other hand"] >= 1).astype(int))
    assert (claps == 1).sum() == 3
    assert hips["left", "hip"].max() == 1 and hips["right", "hip"].max() == 1 and not hips["left", "other hand"].any()
    assert not any(s.max() >= 1 for s in wave.values())


@pytest.mark.parametrize("name", few_and_long(["op3"], CLAPPING))
def test_a_clap_claps_as_often_on_the_robot(name: str, retargeters: dict[str, Retargeter]) -> None:
    motion = gesture("clap", count=3)
    path = retargeters[name].retarget(motion)
    counts = path.report.contacts["left hand to other hand"]
    assert counts["robot"] >= 0.6 * counts["human"], counts
    closed_m, open_m = claps_m(retargeters[name], motion, path)
    assert len(closed_m) == 3
    assert max(closed_m) < 0.025 < min(open_m), "the hands part between two claps"


@pytest.mark.parametrize("name", few_and_long(["reachy_2021"], SLOW))
def test_a_slow_robot_comes_together_as_often(name: str, retargeters: dict[str, Retargeter]) -> None:
    motion = gesture("clap", count=3)
    closed_m, open_m = claps_m(retargeters[name], motion, retargeters[name].retarget(motion))
    assert len(closed_m) == 3
    assert max(closed_m) < 0.015 and min(open_m) > SLOW[name]


@pytest.mark.long
def test_every_clap_of_two_to_six_meets_on_a_slow_robot(retargeters: dict[str, Retargeter]) -> None:
    for count in (2, 4, 5, 6):
        motion = gesture("clap", count=count)
        closed_m, _ = claps_m(retargeters["ffw_bg2"], motion, retargeters["ffw_bg2"].retarget(motion))
        assert len(closed_m) == count
        assert max(closed_m) < 0.025, closed_m


def claps_m(retargeter: Retargeter, motion: Motion, path: JointPath) -> tuple[list[float], list[float]]:
    """How near the robot's hands come in each clap of the person, beyond the margin, and how far they part between two."""
    assert retargeter._hands is not None
    gap, _ = retargeter.contact.nearest(path.q_rad, retargeter._hands._pairs["left", "other hand"])
    share = read_contacts(motion).share["left", "other hand"]
    starts, ends = (np.flatnonzero(np.diff((share >= 1).astype(int), prepend=0) == s) for s in (1, -1))
    closed = [float(gap[start - 2 : end + 2].min()) for start, end in zip(starts, ends, strict=True)]
    return closed, [float(gap[end:start].max()) for end, start in zip(ends, starts[1:], strict=False)]


@pytest.mark.parametrize("what", ["pray", "hands_on_hips", "sternum_fist"])
def test_held_contacts_are_held_on_the_reference_robot(what: str, retargeters: dict[str, Retargeter]) -> None:
    report = retargeters["reference"].retarget(gesture(what)).report
    assert report.contacts
    for name, n in report.contacts.items():
        assert n["robot"] >= 0.9 * n["human"], (name, n)
    assert report.direction_mean_deg < 3


def test_without_contacts_nothing_changes(retargeters: dict[str, Retargeter]) -> None:
    motion = gesture("point")
    plain = Retargeter(load_robot("reference")).retarget(motion)
    np.testing.assert_array_equal(retargeters["reference"].retarget(motion).control_rad, plain.control_rad)
    assert plain.report.contacts == {}


@pytest.mark.long
def test_a_path_out_of_contact_does_not_stray_from_the_motion() -> None:
    """OP2's hands cannot meet; of the paths on which they do not touch, one with arms past each other is not taken."""
    errors_deg = [
        Retargeter(load_robot("op2"), keep_contacts=True).retarget(gesture("clap", count=n)).report.direction_mean_deg
        for n in (3, 5)
    ]
    assert errors_deg[0] < 14 and errors_deg[1] < 20, errors_deg


def test_a_contact_out_of_reach_is_not_gone_for() -> None:
    """OP2's hands cannot meet in front of it: drawing them together would only spoil the gesture."""
    robot = load_robot("op2")
    motion = gesture("pray")
    plain, kept = (Retargeter(robot, keep_contacts=k).retarget(motion).report for k in (False, True))
    assert kept.direction_mean_deg < plain.direction_mean_deg + 1


def test_hands_behind_the_head_are_led_round_it(retargeters: dict[str, Retargeter]) -> None:
    """The refined path costs more than the limiter's would without contact, and is still the nearer one."""
    report = retargeters["poppy_torso"].retarget(gesture("behind_head")).report
    assert report.direction_mean_deg < 9
