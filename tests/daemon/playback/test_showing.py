"""What is told of a motion before and after it: what it shows, what the robot lacks for it, whether the robot has shown it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from daemon.gestures.clips import load_clips
from daemon.gestures.library import SHIPPED
from daemon.playback.sources.showing import Showing, Verdict
from daemon.poses.cycles import find_hold
from daemon.poses.pose_sequence import PoseSequence, at_tempo, faded_in, joined, standing
from mmm_core.motion.motion import FPS
from mmm_core.motion.posture_features import PostureFeatures, posture_features
from mmm_core.recognition.seen import Scene
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot


@cache
def showing(robot: str) -> Showing:
    return Showing(load_robot(robot))


def clip(name: str) -> PoseSequence:
    return load_clips(SHIPPED)[name].posture


def scenes(posture: PoseSequence, words: str) -> list[Scene]:
    return [Scene(len(posture) / posture.fps, words)]


def posture_features_of(posture: PoseSequence) -> PostureFeatures:
    motion = posture.motion()
    return posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)


def verdict(robot: str, posture: PoseSequence, words: str) -> Verdict:
    path = Retargeter(load_robot(robot)).retarget(posture.motion())
    goals_rad = path.at_rate(FPS)
    return showing(robot).verdict(posture, scenes(posture, words), goals_rad, FPS)


def test_a_robot_that_has_the_joints_lacks_nothing():
    for name, words in (("bow", "bow"), ("clap", "clap"), ("wave_right", "wave with your right hand")):
        told = showing("reference").of(clip(name), scenes(clip(name), words))
        assert told.lacks == "" and told.sentence, name


@pytest.mark.parametrize(
    ("robot", "name", "lacks"),
    [
        ("op3", "bow", "it has no waist that bends forward: its head does instead"),
        ("op3", "twist_left", "it has no waist"),
        ("op3", "tilt_head_left", "it has no head joint that tilts sideways"),
        ("reachy_2021", "nod", "it has no neck"),
    ],
)
def test_what_a_robot_lacks_is_told_before_it_moves(robot: str, name: str, lacks: str):
    """OP3 took "bow" with `accepted ... (1.00)` and nodded."""
    assert showing(robot).of(clip(name), scenes(clip(name), name.replace("_", " "))).lacks == lacks


@pytest.mark.parametrize(("robot", "meets"), [("reference", True), ("poppy_torso", True), ("op2", False)])
def test_a_clap_whose_hands_stay_apart_is_not_called_shown(robot: str, meets: bool):
    """OP2's hands stay ten centimetres apart, though its forearms point as a clapping person's do."""
    told = verdict(robot, clip("clap"), "clap")
    assert ("cm apart" in told.missing) == (not meets), told
    assert (told.shown == "shown") == meets, told


def test_arms_of_three_joints_say_how_far_they_are_off():
    lacks = showing("op3").of(clip("clap"), scenes(clip("clap"), "clap")).lacks
    assert "its left arm of 3 joints is about" in lacks and "its right arm of 3 joints is about" in lacks


def test_a_bow_is_shown_with_a_waist_and_in_part_with_a_head():
    whole = verdict("reference", clip("bow"), "bow")
    assert (whole.shown, whole.missing) == ("shown", "") and whole.seen.startswith("bows")
    head = verdict("op3", clip("bow"), "bow")
    assert head.shown == "in part" and head.missing == "the upper body hardly moved, the head bent instead"


@pytest.mark.parametrize("words", ["bow", "bow twice"])
def test_a_bow_that_begins_bent_is_shown(words: str):
    """A robot that was stopped in a bow and bowed again was told that it had not."""
    once = clip("bow")
    posture = joined([once] * (2 if "twice" in words else 1))
    bent = once[int(posture_features_of(once).trunk_pitch_deg.argmax()) :][:1]
    played = faded_in(posture, bent, round(0.6 * FPS))
    goals_rad = Retargeter(load_robot("reference")).retarget(played.motion()).at_rate(FPS)
    told = showing("reference").verdict(posture, scenes(posture, words), goals_rad, FPS)
    assert (told.shown, told.missing) == ("shown", ""), told


def test_what_a_robot_cannot_show_at_all_is_not_shown():
    assert verdict("op3", clip("twist_left"), "twist to the left").shown == "not shown"


def test_a_motion_in_which_nothing_moves_is_never_done_without_a_word():
    """ "yes" ended in `done` while nothing had moved; standing still is shown only where that was asked for."""
    still = standing().at(np.zeros(40, np.intp))
    told = verdict("reference", still, "yes\nyes sir (1.00)")
    assert (told.shown, told.missing) == ("not shown", "nothing moves")
    assert verdict("reference", still, "stand still").shown == "shown"


def test_strokes_of_a_draft_are_not_counted():
    """A draft that clapped once was reported so, while its motion clapped twice."""
    told = showing("reference").of(clip("clap_three_times"), scenes(clip("clap_three_times"), "clap"), draft=True)
    assert told.sentence == "claps"


def test_scenes_that_are_still_being_made_are_told_by_their_words():
    bow = clip("bow")
    both = [*scenes(bow, "bow"), Scene(9.0, "nod\nnod twice (1.00)")]
    assert showing("reference").of(bow, both, draft=True).sentence == "bows, then what 'nod' asks"


def test_a_pose_that_is_held_is_shown_though_its_motion_is_short():
    """A hand raised in 1.3 s and held was told not to be raised."""
    posture = at_tempo(clip("raise_left"), len(clip("raise_left")) / (2 * FPS))
    goals_rad = Retargeter(load_robot("reference")).retarget(posture.motion()).at_rate(FPS)
    up = goals_rad[: find_hold(posture) + 1]
    told = showing("reference").verdict(posture, scenes(posture, "raise your left hand"), up, FPS, held=True)
    assert (told.shown, told.missing) == ("shown", ""), told
