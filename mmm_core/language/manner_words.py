"""How strongly words ask for a tempo or a size: a sum of weights of their words, neighbouring words and endings.

A logistic regression for each manner, learnt from sentences and expressions of writers (`mmmd train manner`). It tells "at a brisk
rate" from "at a snail's pace" by the very words, where the states of the text encoder hardly differ: to an encoder trained on the
meaning of sentences "quickly" and "slowly" are nearly the same. `words/manner_words.txt` has a line for each piece of text,
`piece => weights of slow, fast, small and large`; `words/manner_choice.txt` has what these weigh beside classifier and tagger.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import cache, lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mmm_core.language.mirroring import canonical
from mmm_core.language.tagged_words import FAST, LARGE, SLOW, SMALL
from mmm_core.language.word_tables import REMEMBERED, pairs

ASKED = (SLOW, FAST, SMALL, LARGE)
"""The manners that words ask for, in the order of the weights."""
EVIDENCE = ("words", "whole", "tags")
"""Kinds of evidence for a manner: by the words alone, by the classifier for the whole text, by the tagger for its words."""
START = "(none)"
"""The piece that every text has."""
_WORD = re.compile(r"[a-z0-9']+")
_DRAWN_OUT = re.compile(r"(.)\1{2,}")
_MOST, _LEAST = 6.0, 1e-3
"""Largest logarithm of odds by words that counts, and the least probability of what is said or not said otherwise."""
_LONG = 5
"""Letters of a word from which its first four and five and its last four letters are pieces, too."""


def pieces_of(text: str) -> set[str]:
    """The pieces of a text: its words, two and three neighbouring ones, and the beginnings and endings of long ones.

    A text and its mirror image have the same pieces, so that they ask for the same.

    >>> sorted(pieces_of("slooowly now"))
    ['^sloo', '^sloow', 'now', 'owly$', 'sloowly', 'sloowly now']
    """
    words = [_DRAWN_OUT.sub(r"\1\1", word) for word in _WORD.findall(canonical(text)[0].lower().replace("\u2019", "'"))]
    found = set(words)
    found.update(" ".join(some) for some in pairwise(words))
    found.update(" ".join(some) for some in zip(words, words[1:], words[2:], strict=False))
    for word in words:
        if len(word) >= _LONG:
            found |= {f"^{word[:4]}", f"^{word[:5]}", f"{word[-4:]}$"}
    return found


@lru_cache(REMEMBERED)
def asked_manners(text: str) -> tuple[float, float, float, float]:
    """Logarithms of the odds that a text asks for each of `ASKED`, by its words alone."""
    weights = _weights()
    some = [
        weights[piece] for piece in sorted(pieces_of(text)) if piece in weights
    ]  # sorted: the same sum in every process
    slow, fast, small, large = np.sum([weights[START], *some], axis=0).tolist()
    return slow, fast, small, large


def likely_manners(text: str, of_whole: Mapping[str, float], of_tags: Mapping[str, float]) -> dict[str, float]:
    """The probability of each of `ASKED` for a text that asks for one of them at most, and in which no rule finds any.

    Args:
        text: the text.
        of_whole: the probability of each by what the text means as a whole.
        of_tags: the greatest probability that a word of it has of each.
    """
    weights = _evidence_weights()
    start = np.array([weights[manner] for manner in ASKED])
    odds = np.exp(start + evidence(text, of_whole, of_tags) @ np.array([weights[kind] for kind in EVIDENCE]))
    return dict(zip(ASKED, (odds / (1 + odds.sum())).tolist(), strict=True))


def evidence(text: str, of_whole: Mapping[str, float], of_tags: Mapping[str, float]) -> NDArray[np.float64]:
    """(4, 3) what each kind of evidence says for each of `ASKED`: logarithms of odds; arguments as in `likely_manners`."""
    return np.array(
        [
            (min(max(words, -_MOST), _MOST), _odds(of_whole.get(manner, 0.0)), _odds(of_tags.get(manner, 0.0)))
            for manner, words in zip(ASKED, asked_manners(text), strict=True)
        ]
    )


def _odds(probability: float) -> float:
    return math.log(max(probability, _LEAST) / max(1 - probability, _LEAST))


@cache
def _evidence_weights() -> dict[str, float]:
    return {name: float(weight) for name, weight in pairs("manner_choice")}


@cache
def _weights() -> dict[str, NDArray[np.float32]]:
    return {piece: np.array(row.split(), np.float32) for piece, row in pairs("manner_words")}
