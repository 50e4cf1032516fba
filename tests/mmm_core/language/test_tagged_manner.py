"""Tempo and size in words that the rules do not know, given the manner of each word."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.marked_sentences import read_manner
from mmm_core.language.reading import read
from mmm_core.language.tagged_manner import (
    LIKELY_OF_PART,
    LIKELY_OF_WHOLE,
    MannerPhrase,
    manner_phrases,
    with_left_manner,
    with_likely_manner,
    with_plain_manner,
)
from mmm_core.language.tagged_words import MANNERS, words_of


def _tagged(marked: str) -> tuple[str, np.ndarray]:
    """A sentence, and log-probabilities that are sure of its marks."""
    sentence, manners = read_manner(marked)
    sure = np.full((len(manners), len(MANNERS)), 0.001)
    sure[np.arange(len(manners)), [MANNERS.index(manner) for manner in manners]] = 0.996
    return sentence, np.log(sure)


def _plain(marked: str) -> str:
    sentence, log_probability = _tagged(marked)
    return with_plain_manner(sentence, manner_phrases(sentence, log_probability))


@pytest.mark.parametrize(
    ("marked", "plain"),
    [
        ("Bow {slow: as if you waded through treacle}, then nod.", "Bow slowly, then nod."),
        ("{fast: Quick as a wink}, point up at the ceiling!", "quickly point up at the ceiling!"),
        ("Stir the porridge for me. Och, {slow: easy now}, {slow: it's not a race}.", "Stir the porridge for me slowly."),
        ("give me {small: the merest suggestion of} a bow", "give me slightly a bow"),
        ("clap {fast: like a startled hare} and lean {large: like a falling tree}", "clap quickly and lean hugely"),
        ("Nod. {fast: Super fast}!", "Nod quickly."),
        ("Nod {slow: slowly}", "Nod slowly"),
        ("Nod {slow: very slowly}, then bow {slow: at the pace of a glacier}", "Nod very slowly, then bow slowly"),
        ("wave at the tiny people", "wave at the tiny people"), ("jumping jacks {fast: x6 lets go}", "jumping jacks x6 lets go"),
    ],
)  # fmt: skip
def test_an_adverb_takes_the_place_of_unknown_words_of_manner(marked: str, plain: str) -> None:
    assert _plain(marked) == plain


@pytest.mark.parametrize(
    ("marked", "commands"),
    [
        ("Bow {slow: as if you waded through treacle}, then nod.", [("bow", 0.62, 1.0), ("nod", 1.0, 1.0)]),
        ("Stir the porridge for me. Och, {slow: easy now}, {slow: it's not a race}.", [("stir the porridge", 0.62, 1.0)]),
        ("give me {small: the merest suggestion of} a bow", [("give me a bow", 1.0, 0.6)]),
        ("Nod {large: till your chin bumps your chest}", [("nod", 1.0, 1.4)]),
    ],
)  # fmt: skip
def test_the_rules_read_what_comes_out(marked: str, commands: list[tuple[str, float, float]]) -> None:
    found = [(c.text, c.manner.tempo, c.manner.size) for step in read(_plain(marked)).steps for c in step]
    assert found == commands


def test_one_phrase_has_one_manner_and_a_doubtful_phrase_has_none() -> None:
    sentence, log_probability = "nod um eh uh", np.log(np.full((4, 5), 1e-3))  # words that say no manner by themselves
    log_probability[0, 0] = 0.0
    log_probability[1:, 1] = np.log([0.9, 0.9, 0.6])
    log_probability[3, 2] = np.log(0.3)
    assert manner_phrases(sentence, log_probability) == [MannerPhrase(4, 12, "slow")]
    log_probability[1:, :2] = np.log([0.45, 0.5])
    assert manner_phrases(sentence, log_probability) == []


@given(st.text(alphabet="ab ,.!-'", max_size=40), st.data())
def test_of_any_text_the_words_outside_its_phrases_stay_in_order(text: str, data: st.DataObject) -> None:
    text = text.replace(".", ",").replace("!", ";")  # a sentence that says little beside its manner is dropped
    spans = words_of(text)
    manners = data.draw(st.lists(st.sampled_from(range(5)), min_size=len(spans), max_size=len(spans)))
    phrases = manner_phrases(text, np.log(np.eye(5)[manners].reshape(-1, 5) * 0.95 + 0.01))
    assert all(a.end <= b.start for a, b in pairwise(phrases))
    outside = [text[a:b] for (a, b), m in zip(spans, manners, strict=True) if not m and text[a].isalnum()]
    said = iter(words_of(changed := with_plain_manner(text, phrases)))
    assert all(any(changed[a:b] == word for a, b in said) for word in outside)


@pytest.mark.parametrize(
    ("marked", "read_as"),
    [
        ("pump those arms {fast: like you're sprinting}", "pump those arms like you are sprinting (1.6 times as fast)"),
        ("brush your teeth, {slow: and don't you dare rush it}", "brush your teeth (0.62 times as fast)"),
        ("draw a circle in the air, {large: the most humongous one you can manage}",
         "draw a circle in the air (1.4 times as large)"),
        ("Nod {slow: very slowly}", "nod (0.55 times as fast)"),
        ("finger on your lips, and {small: less of the drumming}", "finger on your lips"),
        ("nod, {large: make it count}, then bow", "nod, make it count; bow"),
        ("wave at the tiny people", "wave"),
    ],
)  # fmt: skip
def test_the_only_command_takes_a_manner_that_its_reading_lacks(marked: str, read_as: str) -> None:
    sentence, log_probability = _tagged(marked)
    found = with_left_manner(read(sentence), sentence, manner_phrases(sentence, log_probability))
    assert "; ".join(found.sentences) == read_as


def test_a_denial_that_is_nothing_but_a_manner_denies_nothing() -> None:
    sentence, log_probability = _tagged("brush your teeth, {slow: and don't you dare rush it}")
    assert with_left_manner(read(sentence), sentence, manner_phrases(sentence, log_probability)).denied == ()


def test_the_only_command_takes_the_likely_manner_of_the_sentence() -> None:
    found = read("nod like a sleepy cow")
    slow = with_likely_manner(found, {"slow": LIKELY_OF_WHOLE, "large": LIKELY_OF_WHOLE - 0.01})
    assert [command.manner for step in slow.steps for command in step] == [read("nod slowly").steps[0][0].manner]
    assert with_likely_manner(found, {"slow": LIKELY_OF_WHOLE - 0.01}) == found


def test_a_manner_that_is_said_stays() -> None:
    found = read("nod very fast")
    assert with_likely_manner(found, {"slow": 0.99}) == found


def test_of_several_commands_each_takes_its_own_manner() -> None:
    found = read("nod, then bow")
    slow = with_likely_manner(
        found, {"fast": 0.99}, {"bow": {"slow": LIKELY_OF_PART}, "nod": {"fast": LIKELY_OF_PART - 0.01}}
    )
    assert [step[0].manner.tempo for step in slow.steps] == [1.0, read("bow slowly").steps[0][0].manner.tempo]
