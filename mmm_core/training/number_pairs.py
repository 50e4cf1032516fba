"""Pairs each number of a sentence with each of its gestures: what the parser's number pointer learns from."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

from mmm_core.corpus.labelled_sentences import LabelledSentence
from mmm_core.language.number_words import NumberWord, number_words
from mmm_core.language.tagged_words import words_of
from mmm_core.model.sentence_parser import TOKENS_OF_GESTURE
from mmm_core.model.text import MiniLm


class NumberPair(NamedTuple):
    """A number word and a gesture of one sentence of a batch.

    Attributes:
        sentence: index of the sentence.
        piece: index of the word's first piece.
        token: index of the gesture among the sentence's tokens.
        is_meant: whether the number says how often the gesture is to be done.
    """

    sentence: int
    piece: int
    token: int
    is_meant: bool


def number_pairs(encoder: MiniLm, batch: Sequence[LabelledSentence]) -> list[NumberPair]:
    """All pairs of the sentences of a batch whose counts are known."""
    found: list[NumberPair] = []
    for sentence, one in enumerate(batch):
        places = words_of(one.text)
        numbers = number_words([one.text[start:end] for start, end in places])
        if not numbers or not one.counts:
            continue
        of_text = encoder.word_pieces.encode(one.text)
        meant = _meant(numbers, one.counts)
        for number in numbers:
            piece = of_text.char_to_token(places[number.place][0])
            if piece is None:  # beyond the longest text
                continue
            for k in range(len(one.counts)):
                token = (k + 1) * TOKENS_OF_GESTURE
                found.append(NumberPair(sentence, piece, token, (number.place, k) in meant))
    return found


def _meant(numbers: Sequence[NumberWord], counts: Sequence[int | None]) -> set[tuple[int, int]]:
    """The places of numbers and the indices of the gestures that they count.

    Of equal numbers for as many gestures each counts one, in their order; else each counts all of these gestures.
    """
    found: set[tuple[int, int]] = set()
    for value in {one.value for one in numbers}:
        places = [one.place for one in numbers if one.value == value]
        counted = [k for k, count in enumerate(counts) if count == value]
        pairs = zip(places, counted, strict=True) if len(places) == len(counted) else product(places, counted)
        found.update(pairs)
    return found
