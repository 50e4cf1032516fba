"""Words that ask for a tempo or a size, told by the words themselves."""

from __future__ import annotations

import pytest

from mmm_core.corpus.heldout import read_sentences
from mmm_core.language.manner_words import ASKED, asked_manners, evidence, likely_manners, pieces_of
from mmm_core.language.mirroring import mirror_words
from mmm_core.training.manner_training import MANNER_EXPRESSIONS

NONE = dict.fromkeys(ASKED, 0.05)


@pytest.mark.parametrize(
    ("text", "manner"),
    [
        ("stir it at a brisk rate", "fast"),
        ("rub your hands, very rapid", "fast"),
        ("stir that pot like molasses in January", "slow"),
        ("clap at half speed", "slow"),
        ("the tiniest little nod", "small"),
        ("a nod that hardly anybody would notice", "small"),
        ("a gigantic wave", "large"),
        ("as wide as your arms will go", "large"),
    ],
)
def test_words_tell_manners_that_states_confuse(text: str, manner: str) -> None:
    odds = dict(zip(ASKED, asked_manners(text), strict=True))
    assert max(odds, key=lambda name: odds[name]) == manner
    assert max(likely := likely_manners(text, NONE, NONE), key=lambda name: likely[name]) == manner


@pytest.mark.parametrize("text", ["wave", "nod to the two people at the table", "raise your left arm", "", "\u2026"])
def test_words_without_manner_ask_for_none(text: str) -> None:
    assert max(asked_manners(text)) < 0
    assert sum(likely_manners(text, NONE, NONE).values()) < 0.5


def test_probabilities_of_all_sources_count() -> None:
    text = "conduct the choir"
    unsure = likely_manners(text, NONE, NONE)
    sure = likely_manners(text, NONE | {"fast": 0.9}, NONE | {"fast": 0.9})
    assert sure["fast"] > 0.5 > unsure["fast"]
    assert sure["slow"] < unsure["slow"]
    assert 0 <= min(sure.values()) <= sum(sure.values()) <= 1
    assert evidence(text, {}, {}).shape == (4, 3)


def test_a_drawn_out_word_is_the_same_however_long_it_is() -> None:
    assert pieces_of("sloooow") == pieces_of("SLOOOOOOOW") != pieces_of("slow")


def test_a_text_and_its_mirror_image_ask_for_the_same() -> None:
    text = "raise your left arm and look right, quick as a flash"
    assert asked_manners(text) == asked_manners(mirror_words(text))


def test_no_expression_is_a_sentence_that_measures() -> None:
    said = {line.partition("=>")[2].strip().lower() for line in MANNER_EXPRESSIONS.read_text("utf-8").splitlines()}
    for name in (
        "words_test",
        "words_test_singles",
        "words_test_denials",
        "words_test_denials_2",
        "words_test_4",
        "words_test_5",
        "words_test_3",
        "words_test_2",
        "words_test_1",
        "words_dev",
        "words_dev_2",
        "words_dev_3",
        "words_dev_4",
        "words_dev_5",
    ):
        assert not said & {sentence.text.lower() for sentence in read_sentences(name)}
