"""Which texts mean to stop: the table in the documentation, the corpus, and laws."""

from __future__ import annotations

import dataclasses
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.families.phrases import read_phrases
from mmm_core.language.reading import read
from mmm_core.language.stop_words import means_stop
from tests.support.stop_words_page import listed

STOPS, COMMANDS = listed("These stop"), listed("These do not")


def test_the_page_lists_both_kinds() -> None:
    assert len(STOPS) >= 40 and len(COMMANDS) >= 25


@pytest.mark.parametrize("text", STOPS)
def test_a_text_that_means_to_stop(text: str) -> None:
    assert means_stop(text)


@pytest.mark.parametrize("text", COMMANDS)
def test_a_text_that_is_a_command(text: str) -> None:
    assert not means_stop(text)


@pytest.mark.parametrize(
    "text",
    ["", " ", "...", "please", "you", "robot, now", "no", "\0", "🙂", "the", "left hand", "stop " * 500, "x" * 10_000],
)
def test_what_stops_nothing(text: str) -> None:
    assert not means_stop(text)


@given(
    st.sampled_from(STOPS),
    st.sampled_from(["please {}", "{} please", "{}!", "  {}  ", "robot, {}", "{} now", "{}... {}"]),
)
def test_courtesy_and_signs_change_nothing(text: str, frame: str) -> None:
    assert means_stop(frame.replace("{}", text)) or len(frame.replace("{}", text).split()) > 14
    assert means_stop(text.upper()) and means_stop(text.title())


@given(st.text(max_size=200))
def test_any_text_is_judged(text: str) -> None:
    assert means_stop(text) in (True, False)


def test_the_corpus_says_none_but_to_stand_still() -> None:
    """What a caption says must reach the model; only the family that stands still may as well be braked."""
    found = set[str]()
    for family in FAMILIES:
        words, directed = read_phrases(family)
        for kind in (words, *directed.values()):
            for phrase in (p for field in dataclasses.fields(kind) for p in getattr(kind, field.name)):
                said = re.sub(r"\{[^}]*\}|[~^]", "", re.sub(r"\(([^)|]*)\|[^)]*\)", r"\1", phrase))
                found |= {family} if means_stop(said) else set()
    assert found <= {"stand", "stop"}  # of the stop sign: "whoa", called out without a hand


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("stop and look left", "look to the left"), ("Stop! Now wave with your left hand.", "wave with your left hand"),
        ("stop then bow", "bow"), ("pause and look left", "look to the left"), ("wait a second and then wave", "wave"),
        ("stop right there and salute", "salute"), ("stop waving and clap", "clap"), ("stop the traffic", "stop the traffic"),
        ("stop and stay", "stop and stay"),
    ],
)  # fmt: skip
def test_a_command_after_a_stop_is_read(text: str, command: str) -> None:
    """The first of these was refused: "it only says not to do 'and look left'"."""
    assert read(text).words == command


@pytest.mark.parametrize(
    "text", ["nod three times, after that stop", "nod three times and stop after that", "nod three times. Then stop!"]
)
def test_a_stop_at_the_end_is_no_gesture(text: str) -> None:
    """The first of these ended in a stop sign."""
    assert read(text).words == "nod three times"
