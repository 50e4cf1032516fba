"""The corpus's own phrases are in scope, and no other text gets into scope by them."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.corpus.family_words import known_phrases
from mmm_core.corpus.outside import OUTSIDE, outside_texts
from mmm_core.corpus.scope_prompts import SCOPE_TEST
from mmm_core.generate.engine import Engine
from mmm_core.language.known_phrases import is_known_phrase, key_of
from mmm_core.language.word_tables import KNOWN_PHRASES_FILE


@pytest.mark.parametrize(
    "text",
    [
        "do star jumps",
        "do a star jump",
        "do five star jumps",
        "water the plants",
        "write an email",
        "hit the heavy bag",
        "this person shifts from one foot to the other",
    ],
)
def test_a_phrase_of_the_corpus_is_accepted(engine: Engine, text: str) -> None:
    """The shipped classifier refused these or doubted them."""
    assert engine.understand(text)[1].status == "accepted"


@pytest.mark.parametrize(
    ("text", "status"),
    [
        ("jump", "rejected"),
        ("do a somersault", "rejected"),
        ("walk to the window", "rejected"),
        ("the plants", "rejected"),
        ("what time is it now", "rejected"),
    ],
)
def test_others_are_judged_as_before(engine: Engine, text: str, status: str) -> None:
    assert not is_known_phrase(text)
    assert engine.understand(text)[1].status == status


def test_no_text_outside_is_known() -> None:
    assert not [text for text in OUTSIDE if is_known_phrase(text)]
    assert not [text for texts in SCOPE_TEST.out_of_scope.values() for text in texts if is_known_phrase(text)]
    made = outside_texts(3000, np.random.default_rng(9))
    assert sum(map(is_known_phrase, made)) < 0.01 * len(made)


def test_words_that_say_nothing_make_no_other_phrase() -> None:
    assert key_of("Please do three star jumps now.") == key_of("star jump") != key_of("star map")
    assert key_of("nod") is None


def test_the_file_is_that_of_the_corpus() -> None:
    """When this fails after phrases were changed: `python -m mmm_core.corpus.family_words`."""
    assert KNOWN_PHRASES_FILE.read_bytes() == known_phrases()
