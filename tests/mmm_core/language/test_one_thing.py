"""A thing or a part of the body that commands in turn speak of as "it", and manner beside it; and what looks like it."""

from __future__ import annotations

import pytest

from mmm_core.language.context import InContext, conversation
from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        # the thing of the first command, with the hand that takes it
        ("take a cup with your left, drink from it, put it down",
         "take a cup with your left hand; drink from the cup with your left hand; put the cup down with your left hand"),
        ("catch a ball, look at it, then throw it back", "catch a ball; look at the ball; throw the ball back"),
        ("pick up the phone, hold it to your ear, then put it down",
         "pick up the phone; hold the phone to your ear; put the phone down"),
        # that arm, the hand that leaves, the arm that snaps back
        ("kiss your left fingertips, then stretch that arm forward", "kiss your left fingertips; stretch your left arm forward"),
        ("hand on your heart, then take it off", "put your right hand on your heart; lower your right arm"),
        ("take your left hand off your heart", "lower your left hand"),
        ("lift your right hand to your brow, keep it there for two seconds, snap it back to your side",
         "lift your right hand to your brow (for 2 s); lower your right hand (1.6 times as fast)"),
        ("with the left: knock, then wave", "knock with your left hand; wave with your left hand"),
        # how strongly and how fast
        ("knock softly on the door", "knock on the door (0.6 times as large)"), ("bow softly", "bow (0.62 times as fast)"),
        ("nod as fast as the motors allow", "nod (1.8 times as fast)"), ("shake your head violently",
         "shake your head (1.6 times as fast)"),
        ("wave as fast as your arm can", "wave (1.8 times as fast)"),
        ("bow down as low as you can go", "bow politely (1.4 times as large)"), ("raise your arm just an inch",
         "raise your right hand (0.56 times as large)"),
        ("lower your head over five seconds", "look down (0.5 times as fast)"),
        # and what looks like these
        ("take your hat and lift it", "take your hat and lift it"), ("take your hat off", "take your hat off"),
        ("form two rings with your hands and look through them", "form two rings with your hands and look through them"),
        ("raise your right hand, hold it, and lower it", "raise your right hand; lower your right hand"),
        ("nod as your arm waves", "nod + your arm waves"), ("snap your fingers", "snap your fingers"),
        ("wave both arms wildly", "wave both arms wildly"),
        ("raise your left hand, then put the hand down", "raise your left hand, then put the hand down"),
    ],
)  # fmt: skip
def test_what_is_read(text: str, read_as: str) -> None:
    assert "; ".join(read(text).sentences) == read_as


def test_a_hand_leaves_where_the_last_command_put_it() -> None:
    meant = conversation(["put your left hand on your heart", "take it off"])[-1]
    assert isinstance(meant, InContext) and meant.reading.sentences == ("lower your left hand",)
