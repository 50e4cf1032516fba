"""Commands are given any number, lose theirs, and keep their manner."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import MOST, count_asked, with_times, without_times
from mmm_core.language.manner import Manner
from mmm_core.language.number_words import NumberWord, number_words
from mmm_core.language.plain_gestures import gesture_of, gestures, plain_command
from mmm_core.language.stroke_numbers import with_numbers

_GESTURES = (
    "clap", "shrug", "wave your left hand", "nod your head", "bow politely", "knock five times", "clap twice", "clap one time",
    "nod your head thrice", "two claps", "do a quadruple fist pump", "knock on the door twice with your left hand",
)  # fmt: skip
_PLAIN = {
    "two claps": "clap 2 times",
    "do a quadruple fist pump": "pump your fist in triumph",
    "knock on the door twice with your left hand": "knock on the door with your left hand 2 times",
}


@given(st.sampled_from(_GESTURES), st.integers(1, MOST))
def test_a_command_takes_any_number_and_keeps_its_manner(gesture: str, number: int) -> None:
    command = PlainCommand(gesture, Manner(tempo=0.6))
    read = with_numbers(Reading(gesture, ((command,),)), [number], _PLAIN)
    assert count_asked(read.steps[0][0].text) == number
    assert read.steps[0][0].manner == command.manner


@given(st.sampled_from(_GESTURES))
def test_a_number_is_taken_off(gesture: str) -> None:
    read = with_numbers(Reading(gesture, ((PlainCommand(gesture),),)), [None], _PLAIN).steps[0][0].text
    assert count_asked(read) is None and read


def test_no_plain_command_ends_in_a_word_that_is_taken_for_its_number() -> None:
    for name in gestures():
        for arm in ("", "left hand", "both hands", "alternating hands"):
            if command := plain_command(name, arm):
                assert (
                    without_times(command) == command
                    and gesture_of(with_times(command, 3)) == gesture_of(command) == name
                )


def test_each_command_has_its_own_number() -> None:
    reading = Reading("", tuple((PlainCommand(text),) for text in ("clap", "nod your head", "bow politely")))
    read = with_numbers(reading, [3, None, 1])
    assert [step[0].text for step in read.steps] == ["clap 3 times", "nod your head", "bow politely once"]


@pytest.mark.parametrize("number", [3, None])
def test_a_command_that_is_no_phrase_stays(number: int | None) -> None:
    reading = Reading("", ((PlainCommand("put your hand on that opposite thing"),),))
    assert with_numbers(reading, [number]) is reading


@pytest.mark.parametrize(
    ("sentence", "found"),
    [
        ("knock twice , then half a dozen claps", [(1, 2), (6, 6)]),
        ("nod x3 and clap 4x", [(1, 3), (4, 4)]),
        ("a double nod , a single clap", [(1, 2), (5, 1)]),
        ("wave with both hands", []),
        ("with one hand , the two arms", []),
        ("chew thirty-two times", []),
        ("clap twenty five times", [(2, 25)]),
        ("two dozen claps", [(1, 24)]),
        ("nod at 5 : 30 and wave twice", [(7, 2)]),
        ("two hand taps", [(0, 2)]),
        ("row three times at table six", [(1, 3)]),
    ],
)
def test_words_that_are_numbers_are_found(sentence: str, found: list[tuple[int, int]]) -> None:
    assert number_words(sentence.split()) == [NumberWord(*one) for one in found]
