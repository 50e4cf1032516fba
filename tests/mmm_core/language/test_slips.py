"""Slips that the words beside them give away, and words that look like slips and stay."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest

from mmm_core.corpus.synthesis import draw_spec, words_for
from mmm_core.language.slips import mended_word
from mmm_core.language.slips_in_context import is_beside
from mmm_core.language.spelling import mended
from mmm_core.language.word_tables import lines


@pytest.mark.parametrize(
    ("slip", "meant"),
    [
        ("lean eft and nod", "lean left and nod"),
        ("look up and then don", "look up and then down"),
        ("nod fat", "nod fast"),
        ("put gour right hand on your heart", "put your right hand on your heart"),
        ("shake yoir head", "shake your head"),
        ("raise the right arm at the same tie", "raise the right arm at the same time"),
        ("lrft hand on your heart", "left hand on your heart"),
        ("lean bacl a smidge", "lean back a smidge"),
        ("when you are fnished, nod", "when you are finished, nod"),
        ("lean foorward, actually no, backwards", "lean backwards"),
        ("look over your left shouldder", "look over your left shoulder"),
        ("bow twics", "bow twice"),
        ("keep wavin' wi' thi left hand", "keep waving with your left hand"),
        ("hold the basin", "hold the basin"),
    ],
)
def test_a_slip_is_mended_by_the_words_beside_it(slip: str, meant: str) -> None:
    assert mended(slip) == meant


@pytest.mark.parametrize(
    "text",
    [
        "jump with both feet", "kick the ball with your left foot", "come down the stairs", "print the page", "sell the book",
        "recite a poem", "stomp your feet", "pack the horse", "wave at the band", "point at your land",
        "wave when the music starts", "i hate to bother you", "the person sings", "order pizzas", "walk like a crab",
        "nod if you can hear me", "leap in the air", "leap to the left", "tip your hat twice", "tip your hat to the left",
        "mow the lawn", "shave the sheep", "mend the chair", "wave your wand", "wipe your tears",
        "leah wave to us", "hugo clap your hands", "boo the referee",
        "take the heat", "do the eft tap", "lever le bras gauche",
    ],
)  # fmt: skip
def test_a_word_that_is_right_stays(text: str) -> None:
    assert mended(text) == text


@pytest.mark.parametrize("word", ["waves", "clapping", "bigger", "twices", "shrugged", "wider", "nodded", "pizzas"])
def test_inflected_words_are_right(word: str) -> None:
    assert mended_word(word) == word


def test_words_of_captions_stand_beside_each_other() -> None:
    """When this fails after phrases were changed: `python -m mmm_core.corpus.family_words`."""
    rng, known = np.random.default_rng(99), {*lines("corpus_words")[:300]}
    captions = [text for _ in range(60) for text in words_for(draw_spec(rng), rng)]
    found = [re.findall(r"[a-z]+", text.lower()) for text in captions]
    pairs = [(a, b) for words in found for a, b in pairwise(words) if {a, b} <= known]
    assert len(pairs) > 300
    assert np.mean([is_beside(a, b) for a, b in pairs]) > 0.9
