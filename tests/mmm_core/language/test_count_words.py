"""The number of strokes that a text names is read, and another one said in its place."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.heldout import PROBES
from mmm_core.language.count_words import MOST, count_asked, with_count


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("clap three times", 3), ("Clap 3 times.", 3), ("wave twice", 2), ("nod once", 1), ("bow thrice", 3), ("clap 3x", 3),
        ("two quick nods", 2), ("do four waves using the right hand", 4), ("left fist forward, three hits", 3),
        ("just one clap", 1), ("a single nod", 1), ("tug at the rope four times with one hand", 4), ("clap ten times", 10),
        ("clap twice more", 2), ("three deep breaths", 3), ("draw two more circles", 2), ("one quick dab", 1),
        ("press the barbell fifteen times", 15), ("twenty swings", 20), ("clap 25 times", 25), ("thirty nods", 30),
    ],
)  # fmt: skip
def test_a_number_of_strokes_is_read(text: str, count: int) -> None:
    assert count_asked(text) == count


@pytest.mark.parametrize(
    "text",
    [
        "", "wave", "raise two arms", "hold both hands up for three seconds", "give me five", "at once, wave", "turn 90 degrees",
        "once you are done, bow", "bow once more", "wave twice and nod three times", "clap 100 times", "point at the two cars",
        "chew thirty-two times", "as if five hundred people watched", "disco at 0.5x", "the other one draws a circle",
        "point at 3 o'clock", "raise one hand", "wave to two people", "show two fingers", "raise your left arm for four beats",
        "stretch like you're six years old", "hold your arms up for three breaths", "cross your arms for five heartbeats",
        "do the one two punches", "drum as if you were on six espressos", "nod like somebody who has had three coffees",
        "give twenty kids a wave", "nod twenty five times", "clap 31 times", "salute sixteen guests",
    ],
)  # fmt: skip
def test_what_is_no_number_of_strokes_is_not(text: str) -> None:
    assert count_asked(text) is None


def test_the_probes_numbers_are_read_and_hardly_any_others() -> None:
    wrong = [p.text for p in PROBES if p.then is None and p.count is not None and count_asked(p.text) != p.count]
    more = [p.text for p in PROBES if p.then is None and p.count is None and count_asked(p.text) is not None]
    assert wrong == [] and more == ["three cheers for the winner, arms up"]


@given(st.text(max_size=80))
def test_any_text_has_a_number_or_none(text: str) -> None:
    assert count_asked(text) in (None, *range(1, MOST + 1))


@pytest.mark.parametrize(
    ("text", "two"),
    [
        ("wave six times in a row", "wave two times in a row"), ("clap 5x, please", "clap 2x, please"),
        ("Four smooches off the left palm", "two smooches off the left palm"), ("give 8 nods speedily", "give 2 nods speedily"),
        ("four waves, all four times with the left hand", None), ("wave", None), ("hold both hands up for four seconds", None),
    ],
)  # fmt: skip
def test_another_number_is_said_in_its_place(text: str, two: str | None) -> None:
    found = with_count(text, 2)
    assert found == two if two is not None else found is None or count_asked(found) == 2


@given(count=st.integers(4, 12), other=st.integers(2, 12), digits=st.booleans())
def test_a_number_said_anew_is_read(count: int, other: int, digits: bool) -> None:
    text = f"knock {count if digits else with_count('knock 4 times', count)} times"
    text = text if digits else with_count("knock four times", count) or ""
    assert count_asked(text) == count
    said = with_count(text, other)
    assert said is not None and count_asked(said) == other and with_count(said, count) == text
