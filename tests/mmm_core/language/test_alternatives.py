"""A denied act is replaced by another greeting, the opposite, the other hand or the rest of the body."""

from __future__ import annotations

import pytest

from mmm_core.language.context import InContext, conversation
from tests.support.readings import said


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("greet us, but no waving", "bow politely | not: waving"),
        ("say goodbye without waving or bowing", "nod your head | not: waving or bowing"),
        ("say yes without nodding", "give a thumbs up with your right hand | not: nodding"),
        ("show me any greeting except a bow", "wave your right hand | not: a bow"),
        ("do anything but wave", "clap your hands | not: wave"),
        ("do anything but wave or clap", "nod your head | not: wave or clap"),
        ("do anything but wave, clap or nod", "bow politely | not: wave or clap or nod"),
        ("show me any move other than the dab", "wave your right hand | not: the dab"),
        ("don't wave, do something else", "clap your hands | not: wave"),
        ("no hugging, something else please", "wave your right hand | not: hugging"),
        ("I don't want to see anything but a proper salute", "a salute"), ("nobody wants anything but a hug", "a hug"),
        ("not left, the other way", "right | not: left"), ("lean, but not forward, the opposite", "lean back | not: forward"),
        ("not a nod, the opposite", "shake your head | not: a nod"),
        ("take your right hand instead of your left to point up", "point up with your right hand | not: the left"),
        ("keep your arms completely still and nod", "nod"), ("turn your head left, but keep your hips facing forward",
         "turn your head left"),
        ("nod, your shoulders should not move", "nod"),
        ("greet me without using your hands", "bow politely | not: your hands"), ("point, but not at me", "point | not: at me"),
        ("don't cross your arms, put them on your hips", "put your hands on your hips | not: cross your arms"),
        ("not the left shoulder, shrug the right one", "shrug the right shoulder | not: the left shoulder"),
        ("look anywhere but up", "look down"),
        ("raise your arms, but not above your shoulders", "raise your arms to shoulder height"),
        ("turn your head, your body stays where it is", "turn your head"),
        ("say thank you but don't bow", "put your right hand on your heart | not: bow"),
        ("refuse, but without using your head", "wag your right index finger | not: using your head"),
        ("whatever you do, don't nod, just clap", "clap | not: nod"),
        ("look at me, not at the floor", "look straight ahead | not: at the floor"),
        ("don't point with your finger, use your whole hand", "point with your whole hand | not: with your finger"),
        ("forget the salute and clap", "clap | not: the salute"), ("lift neither arm, just nod", "nod | not: lift your arms"),
        ("leave your arms hanging and shrug", "shrug"), ("left hand only: wave", "wave with your left hand"),
        # and what looks like it
        ("drop your chin and turn it to the left", "drop your chin and turn it to the left"),
        ("forget the salute and the bow", " | not: the salute and the bow"),
        ("wave your right hand, but do not wave your left", "wave your right hand | not: wave your left hand"),
        ("say hello without bowing", "wave your right hand | not: bowing"),
        ("keep your right hand on your heart and nod", "put your right hand on your heart + nod"),
        ("hold your left arm straight up and nod", "hold your left arm straight up + nod"),
        ("move your hands, then wave", "move your hands; wave"), ("turn the other way", "turn the other way"),
        ("greet me without using your left hand", "greet me with your right hand | not: your left hand"),
        ("turn your head and stay there", "turn your head and stay there"),
        ("use your left hand to wave", "wave with your left hand"),
    ],
)  # fmt: skip
def test_what_is_read(text: str, read_as: str) -> None:
    assert said(text) == read_as


def test_the_opposite_turns_the_last_command() -> None:
    meant = conversation(["give a thumbs up", "no, the opposite"])[-1]
    assert isinstance(meant, InContext) and meant.reading.sentences == ("give a thumbs down",)
