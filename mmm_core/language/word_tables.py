"""The word tables of `mmm_core/language/words`, read once on first use."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from mmm_core.language.needed_letters import compiled, letters_of

_FOLDER = files("mmm_core.language").joinpath("words")
CORPUS_WORDS_FILE = _FOLDER.joinpath("corpus_words.txt")
KNOWN_PHRASES_FILE = _FOLDER.joinpath("known_phrases.bin")
HARD_PHRASES_FILE = _FOLDER.joinpath("hard_phrases.txt")
LIMB_WORDS_FILE = _FOLDER.joinpath("limb_words.txt")
PHRASE_GESTURES_FILE = _FOLDER.joinpath("phrase_gestures.bin")
ONE_GESTURE_FILE = _FOLDER.joinpath("one_gesture.txt")
WORD_PAIRS_FILE = _FOLDER.joinpath("word_pairs.txt")

REMEMBERED = 2048
"""Largest number of words or sentences in a cache of readings; the least recently used one is dropped."""
WAY = "left|right|up|down|forwards?|backwards?|back"
"""Directions, for patterns of tables."""
LIMB = r"(?:hands?|arms?|fists?|palms?|fingers?|elbows?|forearms?|biceps|thumbs?)"
"""A hand, an arm or a part of them, for patterns of tables."""


@cache
def lines(name: str) -> tuple[str, ...]:
    """The lines of a table without comments and empty ones."""
    text = _FOLDER.joinpath(f"{name}.txt").read_text(encoding="utf-8")
    return tuple(line for line in text.splitlines() if line.strip() and not line.startswith("#"))


@cache
def pairs(name: str) -> tuple[tuple[str, str], ...]:
    """The two sides of each line `left => right`."""
    return tuple((left.rstrip(), right.strip()) for left, _, right in (line.partition("=>") for line in lines(name)))


@cache
def phrases(name: str, kind: str) -> tuple[str, ...]:
    """The phrases of a kind in a table of lines `kind => phrase`; @LIMB stands for a hand, an arm or a part of them.

    Raises:
        KeyError: the table has no such kind.
    """
    found = tuple(phrase.replace("@LIMB", LIMB) for of, phrase in pairs(name) if of == kind)
    if not found:
        raise KeyError(f"{name}.txt has no line '{kind} => ...'")
    return found


def any_of(name: str, kind: str) -> str:
    """A pattern for any phrase of a kind."""
    return f"(?:{'|'.join(phrases(name, kind))})"


class Rule(NamedTuple):
    r"""A compiled pattern, in lower case, and the words that take its place, where `\1` stands for the first group."""

    pattern: re.Pattern[str]
    words: str = ""


class RuleTable:
    """Rules in order; only rules whose required letters occur in a text are tried (`needed_letters.py`).

    Args:
        patterns: pattern and words of each rule, in the order in which they are tried.
    """

    def __init__(self, patterns: Iterable[tuple[str, str]]) -> None:
        rules: list[Rule] = []
        self._always: list[int] = []
        by_letters: defaultdict[str, list[int]] = defaultdict(list)
        for number, (text, words) in enumerate(patterns):
            pattern, needed = compiled(text)
            rules.append(Rule(pattern, words))
            if not needed:
                self._always.append(number)
            for letters in needed:
                by_letters[letters].append(number)
        self.rules = tuple(rules)
        self._by_letters, self._letters = dict(by_letters), frozenset(by_letters)
        self._last: tuple[str, list[int]] = "", self._found("")

    def possible(self, text: str, after: int = -1) -> list[int]:
        """Ascending indices of the rules beyond index `after` that may match a text."""
        last, found = self._last  # one tuple, so that threads never see the text of one and the numbers of another
        if last != text:
            self._last = text, (found := self._found(text))
        return found if after < 0 else found[bisect_right(found, after) :]

    def _found(self, text: str) -> list[int]:
        found = set(self._always)
        found.update(*map(self._by_letters.__getitem__, self._letters & letters_of(text)))
        return sorted(found)


@cache
def substitutions(name: str) -> RuleTable:
    """The lines `pattern => words` of a table, compiled."""
    return RuleTable(pairs(name))


def replaced(text: str, table: RuleTable) -> str:
    """A text in which each rule in turn replaces its pattern by its words.

    A plain `sub` would parse the words of a rule on every call, even where the pattern does not match.
    """
    numbers = iter(table.possible(text))
    while (number := next(numbers, None)) is not None:
        pattern, words = table.rules[number]
        if pattern.search(text) is not None:
            text = pattern.sub(words, text)
            numbers = iter(table.possible(text, number))
    return text
