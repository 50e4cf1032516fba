"""Clauses that say their place among the others."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.positions import in_said_order
from mmm_core.language.reading import read

ACTS = ("clap", "wave", "salute", "nod your head", "bow", "shrug your shoulders", "lean forward")


@pytest.mark.parametrize(
    ("sentence", "ordered"),
    [
        ("finish on a flex; open with jumping jacks and put two punches in the middle",
         "jumping jacks, then put two punches, then a flex"),
        ("the violin comes second; you open with the flute", "the flute, then the violin"),
        ("your bow closes the show, dear, and blowing a kiss opens it", "blowing a kiss, then your bow, dear"),
        ("lower both arms as the last thing; lean forward as the first", "lean forward, then lower both arms"),
        ("last of all you will take a deep breath, but you have star jumps to do beforehand",
         "star jumps, then take a deep breath"),
        ("throw the ball, but warm up with arm circles before that", "arm circles, then throw the ball"),
        ("to finish off, bow, but first of all, wave", "wave, then bow"),
    ],
)  # fmt: skip
def test_clauses_stand_in_the_order_that_their_words_say(sentence: str, ordered: str) -> None:
    assert in_said_order(sentence) == ordered


@pytest.mark.parametrize(
    "sentence",
    [
        "first clap, then bow",
        "start with a nod, end with a bow",
        "look up for one second, nod",
        "open your arms, then close them",
        "do not wave first, bow",
        "salute, left hand first and your right after it",
        "twist your trunk: left first, right second",
        "look around the room, first to one side and then to the other",
        "wave to the last row and bow",
        "point at the end of the street, then nod",
    ],
)
def test_clauses_in_order_and_words_that_say_no_place_stay(sentence: str) -> None:
    assert in_said_order(sentence) == sentence


@given(st.lists(st.sampled_from(ACTS), min_size=2, max_size=4, unique=True), st.data())
def test_the_first_is_done_first_wherever_it_is_said_later(acts: list[str], data: st.DataObject) -> None:
    first, *others = acts
    others.insert(data.draw(st.integers(1, len(others))), f"{first} as the very first thing")
    assert read(", ".join(others)).sentences[0] == read(first).sentences[0]


@given(st.text(max_size=60))
def test_any_text_is_ordered_once_for_all(text: str) -> None:
    ordered = in_said_order(text)
    assert in_said_order(ordered) == ordered or len(ordered) < len(text)
