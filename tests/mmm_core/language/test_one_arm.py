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
    assert said("raise your hand and hold it up for two seconds") == "raise your right hand (for 2 s)"


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("wipe your brow, left hand", "wipe your brow with your left hand"),
        ("wave! Use the left one, please", "wave with your left hand"),
        ("salute, only with your right", "salute with your right hand"),
        ("stir the soup, left arm, 20 seconds", "stir the soup with your left hand (for 20 s)"),
        ("reach forward, dear, with your right hand", "reach forward with your right hand"),
        # and what names another command or is no arm's
        ("wave, then the left hand", "wave > wave with your left hand"),
        ("punch, left, right", "punch with your left hand > punch with your right hand"),
        ("wave, left hand up", "wave with your right hand + raise your left hand"),
        ("look up, left hand on your hip", "look up + put your left hand on your hip"),
        ("hand over your heart, that's right", "hand over your heart, that is right"),
    ],
)  # fmt: skip
def test_a_hand_named_after_a_command_is_the_hand_of_it(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("nod. Slowly.", "nod (0.62 times as fast)"), ("wave. Very slowly, please. Then bow", "wave (0.55 times as fast) > bow"),
        ("wave slowly, then quickly", "wave (0.62 times as fast) > wave (1.6 times as fast)"),
        ("wave. Again, but slower", "wave > wave (0.62 times as fast)"),
    ],
)  # fmt: skip
def test_words_of_manner_alone_are_those_of_the_command_before(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("wave with your right hand, then the other hand does the same",
         "wave with your right hand > wave with your left hand"),
        ("jab with the left, then the other one but slower",
         "jab with your left hand > jab with your right hand (0.62 times as fast)"),
        ("clap twice, then give me four more", "clap twice > clap four times"),
        ("look right, then over your left shoulder", "look to the right > look back over your left shoulder"),
        ("play a bit of guitar", "play a bit of guitar"), ("a bit of a nod, please", "a nod (0.6 times as large)"),
    ],
)  # fmt: skip
def test_what_a_command_leaves_out_is_that_of_the_one_before(text: str, read_as: str) -> None:
    assert said(text) == read_as
