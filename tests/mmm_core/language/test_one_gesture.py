"""Sentences of one gesture that look like two commands, and sentences of two commands that look like these."""

from __future__ import annotations

import zlib

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.grammar import caption
from mmm_core.corpus.synthesis import draw_gesture
from mmm_core.language.one_gesture import TABLE
from mmm_core.language.reading import read
from mmm_core.language.word_tables import lines
from tests.support.sizes import few_and_long

PARTED_AT_MOST = 0.01
"""Share of captions of one gesture that may be read as several commands: they say two directions or sides in turn."""


def said(text: str) -> str:
    return "; ".join(read(text).sentences)


@pytest.mark.parametrize("seed", few_and_long([11], [11, 12]))
def test_captions_of_one_gesture_are_one_command(seed: int) -> None:
    """Before the table, the reader took 79 of 2,368 captions for several commands or for a denial."""
    captions: list[str] = []
    for name in FAMILIES:
        rng = np.random.default_rng((seed, zlib.crc32(name.encode())))
        captions += [caption([draw_gesture(rng, (name,))], False, rng) for _ in range(2)]
    parted = [text for text in captions if [len(step) for step in read(text).steps] != [1]]
    assert len(parted) <= PARTED_AT_MOST * len(captions), parted


@pytest.mark.parametrize("every", few_and_long([8], [1]))
def test_each_phrase_of_the_table_needs_it_to_be_one_command(every: int) -> None:
    for phrase in lines(TABLE)[::every]:
        known, by_rules = read(phrase), read(phrase, by_rules_alone=True)
        assert [len(step) for step in known.steps] == [1] and not known.denied, phrase
        assert [len(step) for step in by_rules.steps] != [1] or by_rules.denied, f"the table does not need {phrase!r}"


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        # a pose that is kept, said as a denial
        ("request silence and do not move for two seconds", "request silence (for 2 s)"),
        ("cup your left ear and don't move for 3 seconds", "cup your left ear (for 3 s)"),
        ("raise your right arm without moving for four seconds", "raise your right arm (for 4 s)"),
        ("raise your right arm, not moving for 2 seconds", "raise your right arm (for 2 s)"),
        # a part of the arm that was named, and what an arm got ready for
        ("left elbow out, hand on the hip", "left elbow out, hand on the hip"),
        ("flex your right elbow and lay the hand on your nape", "flex your right elbow and lay the hand on your nape"),
        ("stretch out your left hand and catch the ball", "stretch out your left hand and catch the ball"),
        ("reach out and catch a ball with your left hand", "reach out and catch a ball with your left hand"),
        ("clap with your hands above you", "clap with your hands above you"),
        # a thing that is taken, and the way back
        ("take your hat in your left hand and lift it", "take your hat in your left hand and lift it"),
        ("bow and straighten up again", "bow and straighten up"),
        ("flex and extend your elbow", "flex and extend your elbow"),
        # directions between two, and there and back several times
        ("point diagonally left and upwards", "point diagonally up to the left"),
        ("look down and to the left", "look down to the left"),
        ("bend your body left and then right three times", "bend your body left and right three times"),
        ("lean to one side and then the other five times", "lean from side to side five times"),
        # words that look like words of order or of denial
        ("a disco move with your left arm", "a disco move with your left arm"),
        ("point at the far left end with your left hand", "point at the far left end with your left hand"),
        ("wait with your hands together", "wait with your hands together"),
        ("tell me not to make a sound", "tell me not to make a sound"),
        ("with your whole left arm, wave overhead", "wave overhead with your whole left arm"),
        # phrases that only the corpus shows to be one
        ("reach up and clap", "reach up and clap"), ("robot, bend down, box up", "bend down, box up"),
        ("she points her left arm up to the side and buries her face in the other elbow",
         "she points her left arm up to the side and buries her face in the other elbow"),
        ("say I should not have said that and cover your mouth", "say I should not have said that and cover your mouth"),
        ("reach up and clap, then nod", "reach up and clap; nod"),
        # and what looks like these
        ("do not move", ""), ("wave, but do not nod", "wave"), ("look left and right", "look to the left; look to the right"),
        ("look left and then up", "look to the left; look up"),
        ("lean to one side and then the other", "lean to the left; lean to the right"),
        ("put your left hand on your hip and wave", "put your left hand on your hip + wave with your right hand"),
        ("rub your belly and pat your head at the same time", "rub your belly + pat your head"),
        ("raise your left arm and lower it", "raise your left arm; lower your left arm"),
        ("nod and clap together", "nod + clap"), ("nod, end with a bow", "nod; a bow"),
        ("lean forward with your hands on your hips", "lean forward + put your hands on your hips"),
        ("stretch your arms up, then clap and bow", "stretch your arms up; clap; bow"),
    ],
)  # fmt: skip
def test_one_gesture_and_two(text: str, read_as: str) -> None:
    assert said(text) == read_as
