"""Phrases that the model performs badly are said in the plain command of their gesture, and no other sentence changes."""

from __future__ import annotations

import pytest

from docs.tools.hard_phrases import phrases_of
from mmm_core.corpus.family_words import as_read
from mmm_core.language.commands import Reading
from mmm_core.language.hard_phrases import said_of, without_hard_phrases
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.plain_gestures import gestures, plain_command
from mmm_core.language.reading import read
from mmm_core.language.word_tables import pairs
from tests.support.sizes import few_and_long

TABLE = pairs("hard_phrases")


def as_done(text: str) -> Reading:
    return without_hard_phrases(text, read(text))


def said(text: str) -> list[list[str]]:
    return [[command.sentence for command in step] for step in as_done(text).steps]


@pytest.mark.parametrize("every", few_and_long([25], [1]))
def test_each_hard_phrase_is_of_its_gesture_and_has_a_plain_command(every: int) -> None:
    """The default suite checks the phrases of every 25th gesture, the long one checks all."""
    assert len(TABLE) > 100
    assert {gesture for gesture, _ in TABLE} <= {*gestures()}
    for gesture in sorted({gesture for gesture, _ in TABLE})[::every]:
        ours = {phrase for of, phrase in TABLE if of == gesture}
        assert not ours - {as_read(one.text) for one in phrases_of(gesture)}
        assert all(plain_command(gesture, phrase) for phrase in ours)
    assert len({said_of(phrase) for _, phrase in TABLE}) == len(TABLE), "no two phrases read alike"


@pytest.mark.parametrize(("gesture", "phrase"), TABLE[:: max(1, len(TABLE) // 40)])
def test_a_hard_phrase_is_said_in_plain_words_by_either_hand(gesture: str, phrase: str) -> None:
    reading = as_done(phrase)
    assert reading.words == plain_command(gesture, phrase)
    assert as_done(mirror_words(phrase)).words == mirror_words(reading.words)


def test_number_hand_and_manner_stay() -> None:
    assert said("be a bat") == [["flap your arms"]]
    assert said("play the spinet four times very slowly, then nod") == [
        ["play the piano 4 times (0.55 times as fast)"],
        ["nod"],
    ]
    assert said("field the ball with your right hand") == [["catch a ball with your right hand"]]


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("look at me", "stand still"), ("give me a thumbs up", "stick your fist out for a bump"),
        ("thumbs up with your left hand", "hold out your left fist for a bump"),
        ("touch your nose with your left hand", "put your left finger to your lips"),
    ],
)  # fmt: skip
def test_what_the_corpus_lacks_is_said_as_the_nearest_gesture(text: str, command: str) -> None:
    assert as_done(text).words == command


@pytest.mark.parametrize("text", ["wave with your right hand", "exactly: be a bat", "be a battery", "the spinet", ""])
def test_other_texts_stay_as_they_are(text: str) -> None:
    assert as_done(text) == read(text)
