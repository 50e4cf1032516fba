"""Corrects misspelled words, and words that are unlikely in their place, to the intended words.

Correctly spelled words stay: every word of the corpus, and the 40,000 commonest of English. A misspelling becomes the nearest corpus
word by optimal string alignment, a Damerau-Levenshtein distance (rapidfuzz, MIT); among equally near words the most frequent one.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache

from rapidfuzz.distance import OSA

from mmm_core.language.clause_patterns import BEGINS_WITH_A_VERB
from mmm_core.language.nearest_words import near, nearest, rarity
from mmm_core.language.slips_in_context import mended_in_context
from mmm_core.language.word_tables import REMEMBERED, lines

SURE_ENOUGH = 1.2
"""Largest weighted distance of a correction in a text without any correctly spelled word, as in texts of other languages."""
ONE_SLIP = 1.5
"""Largest weighted distance between two correctly spelled words of which one may be a misspelling of the other."""
NEAR_ENOUGH = 1.7
"""Largest weighted distance from a misspelling to its correction."""
_WORD = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)*")
_ENDINGS = re.compile(r"(?:ing|ed|er|es|s|ly)$")
_DOUBLED = re.compile(r"[aeiou]([bdgklmnprt])\1$")
_GLUES = frozenset(
    (
        "your the both with left right forward back over out me hand hands arm arms head and then to me up down please twice times slowly fast"
    ).split()
)
"""Words that are often typed without the blank before or after them."""
COMMONEST = 6000
"""Number of commonest English words that stay in the place of a limb or a verb: "conduct your band"."""
NOT_RARE, _SELDOM = 20_000, 0.95
"""Number of English words that count as not very rare, and the rarity from which a corpus word may still be a misspelling."""
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
"""Largest rarity of the words in a command whose words are all misspelled: the commonest 540 words of the corpus."""


def without_slips(said: str) -> str:
    """A text in lower case with its misspellings corrected.

    >>> without_slips("shurg yourleft shoulder"), without_slips("move it for ward")
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
    """The only candidate in `meant` one slip from a rare word; the word itself where it is common or no candidate is near.

    >>> _one_slip_from("lein", ("lean", "lower")), _one_slip_from("leap", ("lean", "lower"))
    ('lean', 'leap')
    """
    if word in rarity() or word in _common() or word in _stays():
        return word
    near = [w for w in meant if OSA.distance(word, w, score_cutoff=1) <= 1]
    return (
        min(near, key=lambda w: (sorted(w) != sorted(word), not set(word) <= set(w), rarity().get(w, 1.0)))
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
    """Whether a correctly spelled word is very rare, in English and in the corpus."""
    return word in _very_rare() and rarity().get(word, 1.0) > _SELDOM


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
    if not (a + b).isalpha() or a in _SHORT or b in _SHORT or len(a + b) < 4 or rarity().get(a + b, 1.0) > _COMMON:
        return False
    return not all(len(part) > 2 and rarity().get(part, 1.0) < _COMMON for part in (a, b))


def _is_foreign(said: str) -> bool:
    """Whether most words of a text are unknown and one of them is near no word."""
    words = _WORD.findall(said)
    unknown = [word for word in words if not _is_right(word)]
    foreign = 2 * len(unknown) >= len(words) + bool(BEGINS_WITH_A_VERB.match(said)) and any(
        mended_word(word) == word for word in unknown
    )
    if len(unknown) == len(words) > 1 and not _is_command_of_common_words([mended_word(word) for word in unknown]):
        foreign |= any(nearest(word)[0] > SURE_ENOUGH for word in unknown)
    return foreign


def _is_command_of_common_words(words: list[str]) -> bool:
    """Whether words, each of which was a slip, are a command: "lok dwon" is, a text in another language hardly ever."""
    is_common = all(rarity().get(word, 1.0) < _COMMON for word in words)
    return is_common and any(BEGINS_WITH_A_VERB.match(word) for word in words)


@cache
def _right() -> frozenset[str]:
    return frozenset(lines("english_words") + lines("corpus_words") + lines("also_right"))


def _is_right(word: str) -> bool:
    """Whether a word or what it is inflected from is spelt right, or too short or strange to be judged."""
    if len(word) < 3 or "'" in word or not word.isascii() or word in _right():
        return True
    if re.search("i(?:es|ed|er|ly)$", word) and f"{word[: word.rindex('i')]}y" in _right():
        return True  # "buries"
    ending = _ENDINGS.search(word)
    stem = word[: ending.start()] if ending else ""
    if ending is not None and ending[0] in ("s", "es") and stem[-1:] == "s":
        return ending[0] == "es" and f"{stem}e" in _right()  # "looses"
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


@lru_cache(maxsize=REMEMBERED)
def mended_word(word: str) -> str:
    """The word, or the corpus word that it is a misspelling of.

    >>> mended_word("shurg"), mended_word("hnads"), mended_word("Grandma"), mended_word("tango")
    ('shrug', 'hands', 'Grandma', 'tango')
    """
    if _is_right(word.lower()):
        return word
    if glued := _parted(word.lower()):
        return glued
    cost, meant = nearest(word.lower())
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
    return word in _VERBS or rarity().get(word, 1.0) < _COMMON


def _candidates(word: str) -> list[tuple[float, str]]:
    """Words that may be meant by a word that its neighbours make unlikely; one slip away where it is spelt right."""
    most = ONE_SLIP if _is_right(word) else NEAR_ENOUGH
    return [(cost, meant) for cost, meant in near(word) if cost <= most and meant != word]
