"""More than thirty times becomes thirty with a note; zero times asks for nothing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import count_asked
from mmm_core.language.impossible_counts import within_counts
from mmm_core.language.reading import read

NUMBERS = [
    "31", "45", "100", "1,000", "a hundred", "two hundred", "hundreds of", "one hundred and fifty", "a million", "forty",
    "thirty five", "thirty-five", "ninety nine",
]  # fmt: skip


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("command", ["wave your hand N times", "clap N times quickly", "nod N times and bow"])
def test_more_than_thirty_times_becomes_thirty(number: str, command: str) -> None:
    reading = within_counts(read(command.replace("N", number)))
    assert count_asked(reading.steps[0][0].text) == 30
    assert len(reading.notes) == 1 and reading.notes[0].startswith(f"'{number}")
    assert not reading.denied and not reading.plain


@pytest.mark.parametrize(
    ("text", "words"), [("wave x100", "wave 30 times"), ("wave 50x", "wave 30x"), ("do 60 nods", "do 30 nods")]
)
def test_other_ways_to_say_a_number(text: str, words: str) -> None:
    assert within_counts(Reading(text, ((PlainCommand(text),),))).words == words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("wave 3.5 times", "wave 3 times"),
        ("nod 0.5 times", "nod 1 times"),
        ("bow two and a half times", "bow two times"),
    ],
)
def test_strokes_are_whole(text: str, words: str) -> None:
    """`wave 3.5 times` was read as three waves at half tempo."""
    reading = within_counts(read(text))
    assert reading.words == words and "no whole number" in reading.notes[0]


@given(st.integers(1, 30), st.sampled_from(["wave N times", "clap N times, then bow", "do N nods", "nod Nx"]))
def test_possible_numbers_stay(count: int, command: str) -> None:
    reading = read(command.replace("N", str(count)))
    assert within_counts(reading) is reading


@pytest.mark.parametrize(
    "text",
    [
        "clap in 100 people's faces", "count to 100", "wave for 45 seconds", "turn your head by 90 degrees",
        "raise your hand 2.50 m", "conduct as if there were five hundred singers",
    ],
)  # fmt: skip
def test_numbers_that_count_no_strokes_stay(text: str) -> None:
    reading = Reading(text, ((PlainCommand(text),),), plain=True)
    assert within_counts(reading) is reading


@pytest.mark.parametrize("zero", ["zero times", "0 times", "no times", "0x", "x0"])
def test_zero_times_is_not_at_all(zero: str) -> None:
    alone = within_counts(Reading("", ((PlainCommand(f"nod your head {zero}"),),)))
    assert (alone.steps, alone.denied, alone.notes) == ((), ("nod your head",), ())
    beside = within_counts(Reading("", ((PlainCommand(f"nod {zero}"), PlainCommand("clap")), (PlainCommand("bow"),))))
    assert beside.sentences == ("clap", "bow") and beside.denied == ("nod",)


@pytest.mark.parametrize(
    ("text", "seconds"), [("wave for 100 seconds", 30), ("raise your hand for 2 minutes", 30), ("bow for 5 seconds", 5)]
)
def test_a_hold_has_thirty_seconds_at_most(text: str, seconds: float) -> None:
    reading = within_counts(read(text))
    assert reading.steps[0][0].manner.hold_s == seconds
    assert bool(reading.notes) == (seconds == 30)


@pytest.mark.parametrize("times", ["-3 times", "minus three times", "negative 2 times"])
def test_less_than_zero_times_is_not_at_all(times: str) -> None:
    """`wave -3 times` waved."""
    reading = within_counts(Reading("", ((PlainCommand(f"wave {times}"),),)))
    assert (reading.steps, reading.denied) == ((), ("wave",))
