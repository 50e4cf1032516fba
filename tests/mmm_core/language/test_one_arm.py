"""Commands in turn of one arm that is named once, and one arm after a pose of both."""

from __future__ import annotations

import pytest

from mmm_core.language.one_arm import of_one_arm
from mmm_core.language.reading import read


def said(text: str) -> str:
    return " > ".join(read(text).sentences)


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("raise your left hand, salute, and lower it again",
         "raise your left hand > salute with your left hand > lower your left hand"),
        ("lift your right arm, bend the elbow, and let it hang",
         "lift your right arm > bend your right elbow > lower your right arm"),
        ("put your hand on your heart, then hold it out to me",
         "put your hand on your heart > hold your hand out to me"),
        ("With your right hand swing a hammer, then turn a key",
         "swing a hammer with your right hand > turn a key with your right hand"),
        ("with your left hand make a fist and after that open it wide",
         "make a fist with your left hand > open your fist wide with your left hand"),
        # one of both arms takes another place
        ("put your hands up left hand on your heart", "raise both hands up > put your left hand on your heart"),
        ("arms wide, right hand on your head", "hold your arms out to the sides > put your right hand on your head"),
    ],
)  # fmt: skip
def test_the_arm_is_carried_along(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    "commands",
    [
        ["raise your right arm", "wave"],  # any arm
        ["raise your left hand", "nod", "lower your left hand"],
        ["raise your left hand", "clap", "lower your left hand"],
        ["raise your left hand", "salute", "lower your right hand"],
        ["look to the left", "wave", "lean to the left"],
        ["raise your left hand", "wave with one hand", "lower your left hand"],
        ["salute with your left hand"],
    ],
)
def test_other_commands_keep_their_words(commands: list[str]) -> None:
    assert of_one_arm(commands) == commands


def test_what_describes_a_pose_of_both_arms_stays_with_it() -> None:
    assert said("clap your hands, right hand on top") == "clap your hands, right hand on top"
    assert said("fold your arms, left arm on top") == "fold your arms, left arm on top"
    assert said("raise your hand and hold it up for two seconds") == "raise your right hand (held for 2 s)"
