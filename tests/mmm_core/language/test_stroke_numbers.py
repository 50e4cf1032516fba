"""Numbers of strokes that stand apart from their command, and numbers that count something else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import NUMBERS, count_asked
from mmm_core.language.manner import Manner
from mmm_core.language.stroke_numbers import strokes_said, with_said_number

_GESTURES = ("clap", "shrug", "wave your left hand", "nod your head")


@pytest.mark.parametrize(
    ("sentence", "number"),
    [
        ("cherries, left hand, five of them", 5),
        ("saw that log for me, a dozen strokes please", 12),
        ("do a quadruple fist pump", 4),
        ("triple nod", 3),
        ("shrug x3", 3),
        ("right uppercut times six", 6),
        ("reps: 8, exercise: curl, side: left", 8),
        ("karate chops with both hands taking turns, six in total", 6),
        ("sway to and fro for six sways", 6),
        ("head rolls, three, gently", 3),
        ("chop, chop, chop: that's three with the right", 3),
        ("please tip your cap twice", 2),
        ("you could shoot one arrow, go on", 1),
        ("knock with your right five times, oh go on, make it six", 6),
        ("don't do seven claps, do eight", 8),
        ("not two claps, three", 3),
        ("clap twice, no, three times", 3),
    ],
)
def test_a_number_of_strokes_is_found_wherever_it_stands(sentence: str, number: int) -> None:
    assert strokes_said(sentence) == number


@pytest.mark.parametrize(
    "sentence",
    [
        "give me five",
        "wave to camera two",
        "raise your left hand, class 3",
        "hold the binoculars up for six seconds",
        "at 5 o'clock, nod",
        "nod to the two of you",
        "two times speed, nod please",
        "chew thirty-two times as granny says",
        "conduct as if there were five hundred singers",
        "facepalm in three, two, one",
        "I'm not saying it twice: arms down",
        "look up once in a while",
        "disco at 0.5x",
        "the two arms taking turns",
        "wave with both hands",
        "one arm up",
        "nod twice or three times",
    ],
)
def test_a_number_of_something_else_is_none_of_strokes(sentence: str) -> None:
    assert strokes_said(sentence) is None


@given(st.sampled_from(_GESTURES), st.sampled_from([word for word, n in NUMBERS.items() if n > 1]))
def test_the_one_command_takes_any_number_and_keeps_its_manner(gesture: str, said: str) -> None:
    command = PlainCommand(gesture, Manner(tempo=0.6))
    read = with_said_number(Reading(f"{gesture}, slowly, {said} of those", ((command,),)))
    assert count_asked(read.steps[0][0].text) == NUMBERS[said]
    assert read.steps[0][0].manner == command.manner


@pytest.mark.parametrize(
    ("sentence", "commands"),
    [
        ("clap and nod, three of each", ["clap", "nod your head"]),
        ("put your hand on that opposite thing, five of them", ["put your hand on that opposite thing"]),
    ],
)
def test_several_commands_and_an_unknown_one_stay(sentence: str, commands: list[str]) -> None:
    reading = Reading(sentence, tuple((PlainCommand(text),) for text in commands))
    assert with_said_number(reading) is reading


def test_a_number_that_is_corrected_takes_the_place_of_the_first() -> None:
    reading = Reading("knock five times, oh go on, make it six", ((PlainCommand("knock five times"),),))
    assert with_said_number(reading).steps[0][0].text == "knock six times"
