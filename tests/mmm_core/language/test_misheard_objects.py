"""A last word that is spelt right and not meant."""

from __future__ import annotations

import pytest

from mmm_core.language.misheard_objects import with_meant_object
from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("put both hands on your hops", "put both hands on your hips"),
        ("pretend to play the violet", "pretend to play the violin"),
        ("put your finger to your lisp", "put your finger to your lips"),
    ],
)
def test_a_word_that_makes_the_command_a_phrase_of_the_corpus_is_taken(said: str, meant: str) -> None:
    assert with_meant_object(said) == meant


@pytest.mark.parametrize(
    "said",
    [
        "wave to the mouse",  # anything can be waved at
        "point to the floor",
        "put your right hand on your cheek",
        "circle your wrists",
        "look down to your shoes",
        "play the harp",
        "cover your mouth",
    ],
)
def test_a_word_that_may_be_meant_stays(said: str) -> None:
    assert with_meant_object(said) == said


def test_a_sentence_is_read_with_it() -> None:
    assert [c.text for step in read("cover your mouse with your right hand, then nod").steps for c in step] == [
        "cover your mouth with your right hand",
        "nod",
    ]
