"""The word tables of `mmm_core/language/words`, read once when they are first needed."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from importlib.resources import files

_FOLDER = files("mmm_core.language").joinpath("words")
CORPUS_WORDS_FILE = _FOLDER.joinpath("corpus_words.txt")
LIMB_WORDS_FILE = _FOLDER.joinpath("limb_words.txt")
WORD_PAIRS_FILE = _FOLDER.joinpath("word_pairs.txt")

WAY = "left|right|up|down|forwards?|backwards?|back"
"""Directions, for patterns of tables."""


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
def substitutions(name: str) -> tuple[tuple[re.Pattern[str], str], ...]:
    """The lines `pattern => words` of a table, compiled."""
    return tuple((re.compile(pattern), words) for pattern, words in pairs(name))


def replaced(text: str, rules: Iterable[tuple[re.Pattern[str], str]]) -> str:
    """A text in which each rule in turn puts its words in place of its pattern.

    `sub` alone reads the words of a rule anew on every call, also where the pattern is not found.
    """
    for pattern, words in rules:
        if pattern.search(text) is not None:
            text = pattern.sub(words, text)
    return text
