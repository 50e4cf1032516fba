"""Finds the gesture families that a text may name, by its words; a motion is then searched for the signs of these families.

`family_words.txt` lists the words of each family, each with a digit for the share of the family's phrases that contain the word:
9 for all phrases, one less for each halving. `mmm_core.corpus.family_words` makes the file from the corpus. `sentences.txt`
describes for each family the performance of its gesture.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from functools import cache
from importlib.resources import files

_FOLDER = files("mmm_core.recognition")
WORDS_FILE = _FOLDER.joinpath("family_words.txt")
HIGHEST_LEVEL = 9
"""Digit of a word that stands in all phrases of a family."""
UNSEEN_SHARE = 0.001
"""Share of a family's phrases that is assumed to contain a word when none of them does."""
_STOP_WORDS = frozenset(
    "an the your you of in to with and at it is as hand hands arm arms left right both for me my this that do make should "
    "be by from out on one two three once twice times please can could would".split()
)
"""Words that name no gesture."""


def families_named(text: str, most: int = 4) -> list[str]:
    """Gesture families that a text may name, the likeliest first, by naive Bayes over their words; at most `most`."""
    scores: defaultdict[str, float] = defaultdict(float)
    for word in sorted(content_words(text)):
        for family, score in _families_of_words().get(word, ()):
            scores[family] += score
    return [family for family, _ in sorted(scores.items(), key=lambda item: (-item[1], item[0]))[:most]]


def content_words(text: str) -> set[str]:
    """The words of a text that may name a gesture, in lower case."""
    return set(re.findall(r"[a-z]+", text.lower())) - _STOP_WORDS


@cache
def sentences() -> dict[str, str]:
    """Descriptions of the performance of each family ("wave"), or of a family in a direction ("look up")."""
    return dict(_lines("sentences.txt"))


@cache
def _families_of_words() -> dict[str, tuple[tuple[str, float], ...]]:
    """For each word the families that it may name, with the log ratio of its share of their phrases to `UNSEEN_SHARE`."""
    found: dict[str, list[tuple[str, float]]] = {}
    for family, words in _lines("family_words.txt"):
        for word in words.split():
            share = 2.0 ** (int(word[-1]) - HIGHEST_LEVEL)
            found.setdefault(word[:-1], []).append((family, math.log((share + UNSEEN_SHARE) / UNSEEN_SHARE)))
    return {word: tuple(families) for word, families in found.items()}


def _lines(name: str) -> list[tuple[str, str]]:
    lines = _FOLDER.joinpath(name).read_text(encoding="utf-8").splitlines()
    return [(head, rest.strip()) for head, _, rest in (line.partition(":") for line in lines)]
