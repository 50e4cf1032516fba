"""Numbers of strokes that stand anywhere in a sentence, and numbers that count something else, read with the shipped parser."""

from __future__ import annotations

import pytest

from mmm_core.generate.pointed_numbers import with_pointed_numbers
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.commands import Reading
from mmm_core.language.count_words import count_asked


@pytest.fixture(scope="module")
def reader() -> SentenceReader:
    return SentenceReader.load()


def _counts(reader: SentenceReader, sentence: str) -> list[int | None]:
    return [count_asked(command.text) for step in reader.read(sentence).steps for command in step]


@pytest.mark.parametrize(
    ("sentence", "counts"),
    [
        ("cherries, left hand, five of them", [5]),
        ("cherries, left hand, fvie of them \N{CHERRIES}", [5]),
        ("saw that log for me, a dozen strokes please", [12]),
        ("do a double fist pump", [2]),
        ("triple nod", [3]),
        ("shrug x3", [3]),
        ("right uppercut times six", [6]),
        ("karate chops with both hands taking turns, six in total", [6]),
        ("sway to and fro for six sways", [6]),
        ("head rolls, three, gently", [3]),
        ("chop, chop, chop: that's three with the right", [3]),
        ("please tip your cap twice", [2]),
        ("three claps, no, make that five, and quick about it", [5]),
        ("clap five times, no wait, six", [6]),
        ("clap twice, no, three times", [3]),
        ("two jabs with the left, three with the right, then a bow", [2, 3, None]),
        ("brush your teeth, up and down ten times, and have a drink from the glass", [10, None]),
    ],
)
def test_a_number_of_strokes_is_found_wherever_it_stands(
    reader: SentenceReader, sentence: str, counts: list[int | None]
) -> None:
    assert _counts(reader, sentence) == counts


def test_a_mirrored_sentence_has_the_same_numbers(reader: SentenceReader) -> None:
    for sides in (("left", "right"), ("right", "left")):
        assert _counts(reader, "two jabs with the {}, three with the {}, then a bow".format(*sides)) == [2, 3, None]


def test_what_is_read_exactly_keeps_its_numbers(reader: SentenceReader) -> None:
    assert _counts(reader, "exactly: nod 3 times; bow; clap; wave 2 times; salute 2 times") == [3, None, None, 2, 2]


def test_more_gestures_than_the_parser_knows_keep_their_numbers(reader: SentenceReader) -> None:
    sentence = "exactly: clap 2 times; nod; bow; clap 3 times; nod; bow; wave; shrug"
    steps = reader.read(sentence).steps
    many = Reading(f"clap twice, {'nod, ' * 8}with all three of us", (*steps, *steps))
    assert with_pointed_numbers(many, reader._models) is many


@pytest.mark.parametrize(
    "sentence",
    [
        "give me five",
        "wave to camera two",
        "raise your left hand, class 3",
        "hold the binoculars up for six seconds",
        "at 5 o'clock, nod",
        "nod to the two of you",
        "conduct as if there were five hundred singers",
        "give table six a bow, would you?",
        "I'm not saying it twice: arms down",
        "one arm up",
    ],
)
def test_a_number_of_something_else_is_none_of_strokes(reader: SentenceReader, sentence: str) -> None:
    assert not any(_counts(reader, sentence))
