"""Slips of the finger and of the pen: a word that is not spelt right, or stands where it hardly can, and the word that was meant.

A word that is spelt right stays: every word of the corpus, and the 40,000 commonest of English. A slip is mended to the
nearest corpus word by optimal string alignment, a Damerau-Levenshtein distance (rapidfuzz, MIT); of equally near words to the
one that the corpus says most.
"""

from __future__ import annotations

import math
import re
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray
from rapidfuzz import process
from rapidfuzz.distance import OSA

from mmm_core.language.clause_patterns import BEGINS_WITH_A_VERB
from mmm_core.language.slips_in_context import mended_in_context
from mmm_core.language.word_tables import REMEMBERED, lines

MOST_SLIPS = {3: 1, 4: 1, 5: 2}
"""Letters of a word: greatest distance to the word that was meant; longer words 2."""
SURE_ENOUGH = 1.2
"""Greatest weighted distance where no word at all is spelt right, as in texts of other languages."""
ONE_SLIP = 1.5
"""Greatest weighted distance between two words that are both spelt right, of which one is a slip of the other."""
NEAR_ENOUGH = 1.7
"""Greatest weighted distance of a slip to its word."""
_WORD = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)*")
_FIRST_LETTER, _EXCHANGED, _OTHER_KEY = 0.35, 0.25, 0.35
"""Weights: another first letter; two letters that change places, which costs less than one lost or added; one letter for another
that is neither a neighbour on the keyboard nor a vowel for a vowel."""
_LETTERS = frozenset("abcdefghijklmnopqrstuvwxyz")
_ENDINGS = re.compile(r"(?:ing|ed|er|es|s|ly)$")
_DOUBLED = re.compile(r"[aeiou]([bdgklmnprt])\1$")
_ROWS = ("qwertyuiop", "asdfghjkl", "zxcvbnm")
_NEIGHBOURS = {
    key: "".join(other[max(0, i - 1) : i + 2] for other in _ROWS[max(0, r - 1) : r + 2])
    for r, row in enumerate(_ROWS)
    for i, key in enumerate(row)
}
"""Keys beside, above and below each key."""
_GLUES = frozenset(
    (
        "your the both with left right forward back over out me hand hands arm arms head and then to me up down please twice times slowly fast"
    ).split()
)
"""Words that are typed together with the next or the one before."""
COMMONEST = 6000
"""Words of English that stay in the place of a limb or a verb, "conduct your band"."""
NOT_RARE, _SELDOM = 20_000, 0.95
"""Words of English that are not very rare, and how rare a word of the corpus is that may be taken for a slip all the same."""
_LIMB_PLACE = re.compile(r"(\b(?:your|both) (?:left |right |both )?|\b(?:left|right) (?=\w+$))([a-z]{3,})\b")
_LIMBS = ("hands", "hand", "arms", "arm", "head", "shoulders", "eyes", "ears", "hips", "chest", "heart", "fist", "face")
_VERBS = tuple(
    (
        "wave nod bow clap shrug raise lift lower point look lean turn twist tilt shake cross salute punch beckon hug stretch cover rub "
        "throw blow wipe scratch knock stir play drink flap put hold bend swing push pull touch dance cheer"
    ).split()
)
_SHORT = frozenset("a i an the to of in on at by it is as or and up my me we us so no do go he be if am".split())
_COMMON = 0.72
"""How rare the words may be of a command in which every word is a slip: among the commonest 540 of the corpus."""
MEANT_AS_WELL, _OTHER_RARE = 4000, 1.3
"""Commonest words of English that a slip is mended to where no word of the corpus is nearer, and how rare they are taken to be."""
_RARE = 0.35
"""Weight of how rare a word is in the corpus, from 0, the commonest, to 1."""


def without_slips(said: str) -> str:
    """A text in lower case with its slips mended.

    >>> without_slips("shurg yourleft sholder"), without_slips("move it for ward")
    ('shrug your left shoulder', 'move it forward')
    """
    if _is_foreign(said):
        return said
    said = mended_in_context(_joined(said), _is_right, _is_rare, _candidates)
    said = _in_their_place(said)
    return _WORD.sub(lambda found: mended_word(found[0]), said)


def _in_their_place(said: str) -> str:
    """A text with slips mended by their place, where few words can stand: a limb after "your", a verb before words spelt right."""
    said = _LIMB_PLACE.sub(lambda found: found[1] + _one_slip_from(found[2], _LIMBS), said)
    first = re.match(r"((?:please |now )?)([a-z]{3,})\b(?= )", said)
    if first is None or not all(map(_is_right, _WORD.findall(said[first.end() :]))):
        return said
    if _is_right(first[2]) and BEGINS_WITH_A_VERB.match(said[first.end() + 1 :]):
        return said  # a name: "leah wave to us"
    return f"{first[1]}{_one_slip_from(first[2], _VERBS)}{said[first.end() :]}"


@lru_cache(maxsize=REMEMBERED)
def _one_slip_from(word: str, meant: tuple[str, ...]) -> str:
    """The only one of some words that a rare word is one slip from; the word itself where it is common or none is near.

    >>> _one_slip_from("lein", ("lean", "lower")), _one_slip_from("leap", ("lean", "lower"))
    ('lean', 'leap')
    """
    if word in _meant() or word in _common() or word in _stays():
        return word
    near = [w for w in meant if OSA.distance(word, w, score_cutoff=1) <= 1]
    return (
        min(near, key=lambda w: (sorted(w) != sorted(word), not set(word) <= set(w), _meant().get(w, 1.0)))
        if near
        else word
    )


@cache
def _common() -> frozenset[str]:
    """The commonest words of English, which stay wherever they stand."""
    return frozenset(lines("english_words")[:COMMONEST])


@cache
def _stays() -> frozenset[str]:
    """Right words of English that look like slips of the verbs or limbs of gestures: "leap", "wand"."""
    return frozenset(lines("stays"))


@lru_cache(maxsize=REMEMBERED)
def _is_rare(word: str) -> bool:
    """Whether a word that is spelt right is very rare, in English and in the corpus."""
    return word in _very_rare() and _meant().get(word, 1.0) > _SELDOM


@cache
def _very_rare() -> frozenset[str]:
    return frozenset(lines("english_words")[NOT_RARE:])


def _joined(said: str) -> str:
    """A text in which a blank inside a word is taken out: "for ward" -> "forward", where one part is no common word of a command."""
    words = said.split(" ")
    whole: list[str] = []
    for word in words:
        before = whole[-1] if whole else ""
        if before and _is_parted_word(before, word.rstrip(".,!?")):
            whole[-1] = before + word
        else:
            whole.append(word)
    return " ".join(whole)


def _is_parted_word(a: str, b: str) -> bool:
    """Whether two words are one that is common in commands, and not both are words of commands by themselves."""
    if not (a + b).isalpha() or a in _SHORT or b in _SHORT or len(a + b) < 4 or _meant().get(a + b, 1.0) > _COMMON:
        return False
    return not all(len(part) > 2 and _meant().get(part, 1.0) < _COMMON for part in (a, b))


def _is_foreign(said: str) -> bool:
    """Whether most words of a text are unknown and one of them is near no word."""
    words = _WORD.findall(said)
    unknown = [word for word in words if not _is_right(word)]
    foreign = 2 * len(unknown) >= len(words) + bool(BEGINS_WITH_A_VERB.match(said)) and any(
        mended_word(word) == word for word in unknown
    )
    if len(unknown) == len(words) > 1 and not _is_command_of_common_words([mended_word(word) for word in unknown]):
        foreign |= any(_cost_of(word) > SURE_ENOUGH for word in unknown)
    return foreign


def _is_command_of_common_words(words: list[str]) -> bool:
    """Whether words, each of which was a slip, are a command: "lok dwon" is, a text in another language hardly ever."""
    is_common = all(_meant().get(word, 1.0) < _COMMON for word in words)
    return is_common and any(BEGINS_WITH_A_VERB.match(word) for word in words)


@cache
def _right() -> frozenset[str]:
    return frozenset(lines("english_words") + lines("corpus_words") + lines("also_right"))


def _is_right(word: str) -> bool:
    """Whether a word or what it is inflected from is spelt right, or too short or strange to be judged."""
    if len(word) < 3 or "'" in word or not word.isascii() or word in _right():
        return True
    ending = _ENDINGS.search(word)
    stem = word[: ending.start()] if ending else ""
    if ending is not None and ending[0] in ("s", "es") and stem[-1:] == "s":
        return False
    if (
        ending is not None
        and ending[0] == "es"
        and not re.search(r"(?:[sxzo]|[cs]h)$", stem)
        and f"{stem}e" not in _right()
    ):
        return False
    if ending is None or len(stem) < 3:
        return False
    doubled = ending[0] in ("ing", "ed", "er") and bool(_DOUBLED.search(stem)) and stem[:-1] in _right()
    return stem in _right() or (ending[0] != "s" and f"{stem}e" in _right()) or doubled


@cache
def _meant() -> dict[str, float]:
    """Words that a slip is mended to, with how rare each is in the corpus, from 0 to 1, by the logarithm of its rank; others 1.3."""
    words = lines("corpus_words")
    other = dict.fromkeys(lines("english_words")[:MEANT_AS_WELL], _OTHER_RARE)
    return other | {word: math.log(i + 1) / math.log(len(words)) for i, word in enumerate(words)}


@cache
def _by_length() -> dict[int, list[str]]:
    found: dict[int, list[str]] = {}
    for word in _meant():
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
    """Loads what slips of up to `longest` letters are looked up in."""
    _is_rare("")
    for n in range(3, longest + 1):
        _as_long(n, MOST_SLIPS.get(n, 2))


@lru_cache(maxsize=REMEMBERED)
def mended_word(word: str) -> str:
    """The word, or the corpus word that it is a slip of.

    >>> mended_word("shurg"), mended_word("hnads"), mended_word("Grandma"), mended_word("tango")
    ('shrug', 'hands', 'Grandma', 'tango')
    """
    if _is_right(word.lower()):
        return word
    if glued := _parted(word.lower()):
        return glued
    cost, meant = _nearest(word.lower())
    return meant if cost <= NEAR_ENOUGH else word


def _parted(word: str) -> str:
    """The words of a command that were typed without a blank: "yourleft" -> "your left"; "" where it is none.

    One of two words is among those that glue to others, the other one is common in the corpus.
    """
    for i in range(2, len(word) - 1):
        a, b = word[:i], word[i:]
        if (a in _GLUES and _is_of_commands(b)) or (b in _GLUES and _is_of_commands(a)):
            return f"{a} {b}"
    return ""


def _is_of_commands(word: str) -> bool:
    """Whether a word is common in commands, or begins one."""
    return word in _VERBS or _meant().get(word, 1.0) < _COMMON


def _cost_of(word: str) -> float:
    """Weighted distance of a slip to the word that it is mended to."""
    return _nearest(word)[0]


def _nearest(word: str) -> tuple[float, str]:
    """The corpus word nearest to a slip, with its weighted distance; infinity where none is near."""
    return _near(word)[0] if _near(word) else (math.inf, word)


@lru_cache(maxsize=REMEMBERED)
def _near(word: str) -> list[tuple[float, str]]:
    """Corpus words that may be meant by a slip, the nearest first, each with its weighted distance."""
    most = MOST_SLIPS.get(len(word), 2)
    words, letters = _as_long(len(word), most)
    alike = np.flatnonzero(np.bitwise_count(letters ^ _letters_in(word)) <= 2 * most)
    chosen = [words[i] for i in alike.tolist()]
    found = process.extract(word, chosen, scorer=OSA.distance, score_cutoff=most, limit=None)
    return sorted((_cost(word, str(meant), int(d)), str(meant)) for meant, d, _ in found)


def _candidates(word: str) -> list[tuple[float, str]]:
    """Words that may be meant by a word that its neighbours make unlikely; one slip away where it is spelt right."""
    most = ONE_SLIP if _is_right(word) else NEAR_ENOUGH
    return [(cost, meant) for cost, meant in _near(word) if cost <= most and meant != word]


def _cost(word: str, meant: str, distance: int) -> float:
    cost = float(distance) + _RARE * _meant()[meant]
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
