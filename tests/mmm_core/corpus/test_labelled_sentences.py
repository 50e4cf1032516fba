"""Sentences with the gestures that they ask for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mmm_core.corpus.heldout import read_sentences
from mmm_core.corpus.labelled_sentences import LABELLED_SENTENCES, load_labelled_sentences, read_labelled
from mmm_core.errors import TrainingDataError
from mmm_core.language.gesture_steps import ANY_ARM, IN_TURN, LEFT, ArmGesture
from mmm_core.language.plain_gestures import OUTSIDE, gestures

LEARNT = ("words_seen", *(f"words_test_{n}" for n in range(1, 6)))
"""Sets that were looked at, which the parser learns from now (`looked_at_sets.txt`)."""
SETS = sorted({path.stem for path in LABELLED_SENTENCES.parent.glob("words_*.jsonl")} - set(LEARNT))


@pytest.mark.parametrize(
    ("line", "steps"),
    [
        ("bow, then look up => bow; look/up", (("any", "bow"), ("any", "look/up"))),
        ("five hooks, slowly => turns hook x5 slow", ((IN_TURN, "hook"),)),
        ("a => b => left raise 2.5s | not bow, nod", ((LEFT, "raise"),)),
        ("please do not wave => | not wave", ()),
        ("do nothing =>", ()),
        ("sing => left outside", ((ANY_ARM, OUTSIDE),)),
    ],
)
def test_a_line_is_a_sentence_and_its_steps(line: str, steps: tuple[tuple[str, str], ...]) -> None:
    found = read_labelled(line)
    assert found.text == line.rpartition(" =>")[0].strip()
    assert [one for step in found.steps for one in step] == [ArmGesture(*one) for one in steps]


def test_tempo_and_size_of_a_label_are_its_manners() -> None:
    assert read_labelled("a => clap slow x2; left raise large | not bow fast").manners == {"slow", "large"}


def test_commands_at_once_are_one_step() -> None:
    assert [len(step) for step in read_labelled("a => left heart + nod; bow").steps] == [2, 1]


@pytest.mark.parametrize("line", ["no label", "a => frobnicate", "a => left", "=> wave", "a => wave;"])
def test_a_line_that_cannot_be_read_is_refused(line: str) -> None:
    with pytest.raises(TrainingDataError, match=re.escape(repr(line))):
        read_labelled(line, Path("some.txt"))


def test_all_that_ship_are_read_and_none_is_of_an_evaluation() -> None:
    given = load_labelled_sentences()
    assert len(given) == 54_857
    named = {one.gesture for sentence in given for step in sentence.steps for one in step}
    assert named == {*gestures(), OUTSIDE}
    assert len(SETS) == 11
    judged = {_letters(one.text) for name in SETS for one in read_sentences(name)}
    assert not judged & {_letters(one.text) for one in given}


def _letters(text: str) -> str:
    return re.sub(r"\W+", " ", text.lower()).strip()
