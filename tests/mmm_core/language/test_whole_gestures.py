"""Gestures without strokes are said in plain words with their number, so that they can be repeated as a whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.plain_gestures import Meant, family_of, gestures
from mmm_core.language.whole_gestures import is_whole, once, with_plain_repetitions


def test_the_table_has_the_families_of_the_corpus_that_have_no_strokes() -> None:
    assert {family_of(name) for name in gestures() if is_whole(name)} == {
        name for name, family in FAMILIES.items() if not family.counts
    }


@pytest.mark.parametrize(
    ("command", "bare"),
    [
        ("salute 3 times", "salute"), ("salute once", "salute"), ("look to the left 2 times", "look to the left"),
        ("give me five with your left hand 2 times", "give me five with your left hand"),
        ("salute", ""), ("clap 3 times", ""), ("nod your head once", ""), ("salute the captain 3 times", ""),
    ],
)  # fmt: skip
def test_the_number_of_a_whole_gesture_is_taken_off(command: str, bare: str) -> None:
    assert once(command) == bare


def _read(command: str, gesture: str, probability: float) -> tuple[list[str], list[str]]:
    """The commands of a reading of one command, and those whose gesture was asked for."""
    asked: list[str] = []

    def classes(commands: Sequence[str]) -> Mapping[str, Meant]:
        asked.extend(commands)
        return {text: Meant(gesture, probability) for text in commands}

    found = with_plain_repetitions(Reading(command, ((PlainCommand(command),),)), classes)
    return [c.text for step in found.steps for c in step], asked


@pytest.mark.parametrize(
    ("command", "gesture", "said"),
    [
        ("salute the captain three times", "salute", "salute 3 times"),
        ("take two sips with your left hand", "drink", "drink from a glass with your left hand 2 times"),
        ("pour the tea twice", "pour", "pour water from a jug 2 times"),
        ("do the dab three times", "dab", "dab 3 times"),
        ("tip your hat twice", "pull_hat", "tip your hat twice"),
        ("tip your head sideways to the right twice", "tilt_head/right", "tilt your head to the right 2 times"),
    ],
)
def test_a_whole_gesture_is_said_in_plain_words_with_its_number(command: str, gesture: str, said: str) -> None:
    assert _read(command, gesture, 0.9)[0] == [said]


def test_a_gesture_that_is_not_sure_is_left_as_it_was_said() -> None:
    assert _read("salute the captain three times", "salute", 0.5)[0] == ["salute the captain three times"]


@pytest.mark.parametrize(
    "command", ["salute the captain", "salute once", "clap three times", "wave twice with your left hand"]
)
def test_no_network_is_asked_without_a_number_or_about_a_verb_of_strokes(command: str) -> None:
    assert _read(command, "salute", 0.9) == ([command], [])
