""" "Left" and "right" that name no side, beside the sentences in which they do."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read
from mmm_core.language.spelling import mended


def said(text: str) -> str:
    return " > ".join(read(text).sentences)


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("crane your neck to see what is left", "crane your neck to see what remains"),
        ("wave until there's no time left", "wave until there is no time"),
        ("nod if you have any energy left", "nod"),
        ("wave with what strength you have left", "wave with what strength you have"),
        ("there is nothing left to do but shrug", "shrug"),
        # somebody left
        ("everyone has left, wave goodbye", "wave goodbye"),
        ("she just left, wave goodbye", "wave goodbye"),
        ("he's left, wave goodbye", "wave goodbye"),
        ("he left the room so wave goodbye", "wave goodbye"),
        ("the guests left so wave goodbye", "wave goodbye"),
        ("I left my keys at home, shrug", "shrug"),
        # correct
        ("you're right, nod", "nod"),
        ("if that's right give a thumbs up", "give a thumbs up"),
        ("get it right this time, bow", "bow"),
        ("right so wave", "wave"),
        ("right after that, bow", "bow"),
        # straight, all the way
        ("point right at me", "point at me"),
        ("look right into the camera", "look into the camera"),
        ("raise your hand right up", "raise your hand up"),
        ("lift your arms right over your head", "lift your arms over your head"),
        ("lean right back", "lean back"),
        ("look right up", "look up"),
    ],
)
def test_no_side_is_read_where_none_is_named(text: str, read_as: str) -> None:
    """ "Look right into the camera" was done as a look to the right, "I left my keys at home" went to the model with a side."""
    assert said(text) == read_as


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("look right", "look to the right"),
        ("look right down left up", "look to the right > look down > look to the left > look up"),
        ("look to the top left", "look to the top left"),
        ("turn right then left", "turn right > turn left"),
        ("turn right up to the wall", "turn right up to the wall"),
        ("left arm up right arm up", "raise your left hand + raise your right hand"),
        ("raise your left", "raise your left hand"),
        ("what is on your left", "look to the left"),
        ("look right and point right at the same time", "look to the right + point right"),
        ("raise your left arm but not your right", "raise your left arm"),
        ("punch with your left, then your right", "punch with your left hand > punch with your right hand"),
    ],
)
def test_sides_stay(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    "text",
    [
        "have the left hand wave", "the person left of you", "both of us left and right of you", "get that right paw up in the air",
        "your right, then your left", "who is left of you",
    ],
)  # fmt: skip
def test_words_that_look_like_other_senses_stay(text: str) -> None:
    assert mended(text) == text
