"""Candidates for a misspelled word, by weighted distance: words of the gesture corpus and the commonest words of English."""

from __future__ import annotations

import math
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray
from rapidfuzz import process
from rapidfuzz.distance import OSA

from mmm_core.language.word_tables import REMEMBERED, lines

MOST_SLIPS = {3: 1, 4: 1, 5: 2}
"""Largest distance to the intended word, by number of letters; 2 for longer words."""
_FIRST_LETTER, _EXCHANGED, _OTHER_KEY = 0.35, 0.25, 0.35
"""Weights: another first letter; two letters that change places, which costs less than one lost or added; one letter for another
that is neither a neighbour on the keyboard nor a vowel for a vowel."""
_LETTERS = frozenset("abcdefghijklmnopqrstuvwxyz")
_ROWS = ("qwertyuiop", "asdfghjkl", "zxcvbnm")
_NEIGHBOURS = {
    key: "".join(other[max(0, i - 1) : i + 2] for other in _ROWS[max(0, r - 1) : r + 2])
    for r, row in enumerate(_ROWS)
    for i, key in enumerate(row)
}
"""Keys beside, above and below each key."""
MEANT_AS_WELL, _OTHER_RARE = 4000, 1.3
"""Number of common English words that a misspelling may be corrected to if no corpus word is nearer, and their rarity."""
_RARE = 0.35
"""Weight of a word's rarity in the corpus, which runs from 0, the commonest, to 1."""


def nearest(word: str) -> tuple[float, str]:
    """The weighted distance to the word nearest to a misspelling, and the word; infinity where none is near."""
    return near(word)[0] if near(word) else (math.inf, word)


@lru_cache(maxsize=REMEMBERED)
def near(word: str) -> tuple[tuple[float, str], ...]:
    """Candidates for a misspelling, the nearest first, each with its weighted distance."""
    most = MOST_SLIPS.get(len(word), 2)
    words, letters = _as_long(len(word), most)
    alike = np.flatnonzero(np.bitwise_count(letters ^ _letters_in(word)) <= 2 * most)
    chosen = [words[i] for i in alike.tolist()]
    found = process.extract(word, chosen, scorer=OSA.distance, score_cutoff=most, limit=None)
    return tuple(sorted((_cost(word, str(meant), int(d)), str(meant)) for meant, d, _ in found))


@cache
def rarity() -> dict[str, float]:
    """Rarity of each candidate: for corpus words 0 to 1, by the logarithm of the rank; for other words 1.3."""
    words = lines("corpus_words")
    other = dict.fromkeys(lines("english_words")[:MEANT_AS_WELL], _OTHER_RARE)
    return other | {word: math.log(i + 1) / math.log(len(words)) for i, word in enumerate(words)}


@cache
def _by_length() -> dict[int, list[str]]:
    found: dict[int, list[str]] = {}
    for word in rarity():
        found.setdefault(len(word), []).append(word)
    return found


@cache
def _as_long(n: int, most: int) -> tuple[list[str], NDArray[np.uint32]]:
    """Words that a slip of `n` letters may be mended to, at most `most` letters longer or shorter, and the letters of each.

    Words some slips apart differ by at most two letters for each slip, which rules out most words before they are compared.
    """
    lengths = range(n - most, n + most + 1)
    words = [word for length in lengths for word in _by_length().get(length, ())]
    return words, np.concatenate([_letters_by_length(length) for length in lengths])


@cache
def _letters_by_length(n: int) -> NDArray[np.uint32]:
    """(N,) letters in each word of `n` letters."""
    return np.array([_letters_in(word) for word in _by_length().get(n, ())], np.uint32)


def _letters_in(word: str) -> int:
    """One bit for each letter from a to z that a word has."""
    bits = 0
    for letter in set(word) & _LETTERS:
        bits |= 1 << (ord(letter) - ord("a"))
    return bits


def loaded(longest: int) -> None:
    """Load the tables for misspellings of up to `longest` letters."""
    for n in range(3, longest + 1):
        _as_long(n, MOST_SLIPS.get(n, 2))


def _cost(word: str, meant: str, distance: int) -> float:
    cost = float(distance) + _RARE * rarity()[meant]
    if sorted(word) == sorted(meant):
        return cost - _EXCHANGED
    if word[0] != meant[0]:
        cost += _FIRST_LETTER
    if len(word) == len(meant):
        cost += sum(_OTHER_KEY for a, b in zip(word, meant, strict=True) if a != b and not _mixed_up(a, b))
    return cost


def _mixed_up(a: str, b: str) -> bool:
    """Whether one letter is often typed for the other."""
    return {a, b} <= set("aeiouy") or b in _NEIGHBOURS.get(a, "")
