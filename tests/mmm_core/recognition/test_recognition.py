"""What somebody who watches would say that a motion shows: by its signs, whatever the text was taken for."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.family_words import family_phrases
from mmm_core.corpus.heldout import PROBES, Probe
from mmm_core.evaluation.reconstruction import performed
from mmm_core.evaluation.robot_capability import as_motion
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.named import families_named, sentences
from mmm_core.recognition.seen import NOTHING_MOVES, Act, Scene, lost, scenes_seen, seen, sentence

EVERY_PHRASE = 23
"""Of the phrases of a family one in so many is tried."""


def motion_of(text: str, family: str, limb: str, **what) -> Motion:
    return as_motion(performed(Probe(text, family, limb, **what), seed=0), text)


def said_of(motion: Motion, words: str) -> str:
    return sentence(scenes_seen(motion, [Scene(motion.duration_s, words)]))


def test_every_family_has_a_sentence_and_words_that_name_it():
    """When this fails after phrases were changed: `python -m mmm_core.corpus.family_words`."""
    assert set(sentences()) >= set(FAMILIES)
    named = [
        family in families_named(phrase)
        for family, phrases in family_phrases().items()
        for phrase in phrases[::EVERY_PHRASE]
    ]
    assert np.mean(named) > 0.98


def test_a_description_follows_the_motion_and_not_the_text():
    """ "no" shook the head and was reported as "yes sir (1.00)"; a head that turned as one that tilts."""
    shaken = motion_of("no", "shake_head", "head", count=2)
    assert said_of(shaken, "no\nyes sir (1.00)").startswith("shakes the head")
    turned = motion_of("turn your head to the left", "look", "head", direction="left")
    assert said_of(turned, "turn your head to the left\ntilt your head to the left") == "turns the head to the left"
    waved = motion_of("wave", "wave", "arm", side="left", count=3)
    assert said_of(waved, "bow\nnod") == "waves with the left hand 3 times"


@pytest.mark.long
def test_of_most_gestures_the_family_is_said():
    probes = [p for p in PROBES if p.then is None][::3]
    right = 0
    for probe in probes:
        motion = as_motion(performed(probe, 0), probe.text)
        acts = seen(posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad), probe.text)
        right += any(act.family == probe.family for act in acts)
        if probe.side in ("left", "right"):
            assert acts[0].side == probe.side, (probe.text, acts)
    assert right > 0.88 * len(probes)


def test_a_motion_in_which_nothing_moves_says_so():
    """ "yes" was reported as "yes sir (1.00)" while the robot stood still."""
    still = motion_of("yes", "stand", "")
    assert said_of(still, "yes\nyes sir (1.00)") == NOTHING_MOVES


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (Act("arm", "both", "clap", count=2), "claps twice"),
        (Act("arm", "left", "point", "up right"), "points up and to the right with the left hand"),
        (Act("arm", "right", "point", "self", 1), "points to the chest with the right hand once"),
        (Act("head", "", "look", "up"), "looks up"),
        (Act("trunk", "", "lean", "back"), "leans backward"),
        (Act("arm", "both", place="above the head"), "moves both hands above the head"),
        (Act("trunk"), "moves the upper body"),
        (Act(""), NOTHING_MOVES),
    ],
)
def test_sentences(act: Act, words: str):
    assert act.sentence == words


def test_scenes_are_told_in_turn():
    bow, nod = motion_of("bow", "bow", "trunk", count=1), motion_of("nod", "nod", "head", count=2)
    scenes = [Scene(bow.duration_s, "bow"), Scene(bow.duration_s + nod.duration_s, "nod twice")]
    both = as_motion(np.concatenate([bow.features, nod.features]))
    assert sentence(scenes_seen(both, scenes)) == "bows once, then nods twice"


def test_what_another_motion_does_not_show_is_told():
    bow, nod = motion_of("bow", "bow", "trunk", count=1), motion_of("nod", "nod", "head", count=1)
    scenes = [Scene(bow.duration_s, "bow")]
    wanted = scenes_seen(bow, scenes)
    assert lost(bow, scenes, wanted) == []
    assert [what for _, what in lost(nod, scenes, wanted)] == ["the upper body hardly moved"]
    five, three = (motion_of("clap", "clap", "arm", side="both", count=n) for n in (5, 3))
    scenes = [Scene(five.duration_s, "clap")]
    assert [what for _, what in lost(three, scenes, scenes_seen(five, scenes))] == ["3 of 5 strokes"]
