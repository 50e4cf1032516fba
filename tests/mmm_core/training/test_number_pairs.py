"""Which number of a sentence counts which of its gestures, as its label says."""

from __future__ import annotations

import pytest

from mmm_core.corpus.labelled_sentences import read_labelled
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.model.sentence_parser import TOKENS_OF_GESTURE
from mmm_core.training.number_pairs import number_pairs


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        ("clap twice before the three of you bow => clap x2; bow", {("twice", 0)}),
        ("two nods and two claps => nod x2; clap x2", {("two", 0), ("two", 1)}),
        ("shrug, nod, four of each => shrug x4; nod x4", {("four", 0), ("four", 1)}),
        ("give table six a bow => bow", set()),
        ("bow => bow", set()),
    ],
)
def test_a_number_is_paired_with_the_gestures_that_it_counts(line: str, meant: set[tuple[str, int]]) -> None:
    encoder, one = load_text_encoder(), read_labelled(line)
    pairs = number_pairs(encoder, [read_labelled("bow => bow"), one])
    tokens = encoder.word_pieces.encode(one.text).tokens
    found = {(tokens[pair.piece], pair.token // TOKENS_OF_GESTURE - 1) for pair in pairs if pair.is_meant}
    assert found == meant and all(pair.sentence == 1 for pair in pairs)


def test_unknown_counts_and_words_beyond_the_longest_text_are_left_out() -> None:
    encoder, one = load_text_encoder(), read_labelled("clap twice => clap x2")
    longer = one._replace(text="please " * 80 + one.text)
    assert number_pairs(encoder, [one._replace(counts=None), longer]) == []
