"""Expectations of sentences that a body can meet: a robot that cannot bow meets no order that contains a bow."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mmm_core.corpus.heldout import Command, Sentence
from mmm_core.evaluation.sentence_capability import showable_expectations
from mmm_core.motion.motion import Motion

BOW, NOD, WAVE = Command("bow", "trunk"), Command("nod", "head"), Command("wave", "arm", side="right")
SENTENCES = (
    Sentence("bow", "everyday", ((BOW,),)),
    Sentence("wave, then nod", "in_turn", ((WAVE,), (NOD,))),
    Sentence("wave, then bow", "in_turn", ((WAVE,), (BOW,))),
    Sentence("wave and nod", "at_once", ((WAVE, NOD),)),
    Sentence("do not clap, wave", "denial", ((WAVE,),), denied=("clap",)),
    Sentence("do not clap", "denial", (), denied=("clap",), nothing=True),
    Sentence(
        "touch your forehead, then salute", "in_turn", ((Command("forehead", "arm"),), (Command("salute", "arm"),))
    ),
    Sentence(
        "hold both", "in_turn", ((Command("raise", "arm", hold_s=5.0),), (Command("hands_up", "arm", hold_s=5.0),))
    ),
    Sentence("do not wave me off, beckon", "denial", ((Command("beckon", "arm"),),), denied=("go_away",)),
)


def _without_trunk(motion: Motion) -> Motion:
    """The motion of somebody who does not bend: where the trunk bends, nothing moves."""
    bends = (motion.joints_m[:, 12, 1] < motion.joints_m[0, 12, 1] - 0.05).any()
    if not bends:
        return motion
    first = [
        array[:1].repeat(len(array), 0) for array in (motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    ]
    return replace(motion, joints_m=first[0], head_quat_wxyz=first[1], forearm_twist_rad=first[2])


@pytest.fixture(scope="module")
def of_a_person() -> dict[str, frozenset[str]]:
    return showable_expectations(SENTENCES)


def test_a_person_can_show_all_of_them(of_a_person: dict[str, frozenset[str]]) -> None:
    assert {"limb", "pose", "denial", "tempo", "size"} <= of_a_person["bow"]
    assert all("order" in of_a_person[text] for text in ("wave, then nod", "wave, then bow"))
    assert "at_once" in of_a_person["wave and nod"]
    assert "denial" in of_a_person["do not clap"] and "limb" not in of_a_person["do not clap"]


def test_a_sentence_with_one_command_that_cannot_be_seen_expects_no_order() -> None:
    found = showable_expectations(SENTENCES, _without_trunk)
    assert "pose" not in found["bow"] and "denial" not in found["bow"]
    assert "order" in found["wave, then nod"] and "order" not in found["wave, then bow"]
    assert {"side", "denial"} <= found["do not clap, wave"]


def test_a_sign_of_what_is_denied_expects_no_denial(of_a_person: dict[str, frozenset[str]]) -> None:
    assert "denial" in of_a_person["do not clap, wave"]
    assert "denial" not in of_a_person["do not wave me off, beckon"]


def test_gestures_that_show_the_sign_of_each_other_expect_no_order(of_a_person: dict[str, frozenset[str]]) -> None:
    assert "order" not in of_a_person["touch your forehead, then salute"]


def test_what_is_too_long_for_one_clip_may_be_in_order(of_a_person: dict[str, frozenset[str]]) -> None:
    assert "order" in of_a_person["hold both"]
