"""Finds the words of a sentence that are numbers: "two", "3", "x4", "twice", "half a dozen" -> 2, 3, 4, 2, 6."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import accumulate
from typing import NamedTuple

from mmm_core.language.count_words import ADVERBS, NUMBERS, OF_A_LIMB
from mmm_core.language.multiples import multiples_in
from mmm_core.language.word_tables import LIMB

_TENS = {"twenty": 20, "thirty": 30, "forty": 40, "fifty": 50, "sixty": 60, "seventy": 70, "eighty": 80, "ninety": 90}
_VALUES = (
    NUMBERS
    | ADVERBS
    | _TENS
    | {"single": 1, "double": 2, "couple": 2, "pair": 2, "triple": 3, "trio": 3, "quadruple": 4, "dozen": 12}
)
_FIGURE = re.compile(r"x?(\d{1,2})x?")
_LIMBS = re.compile(rf"(?:{LIMB}|sides?|eyes?|ears?|feet|foot|knees?|legs?|handed)")
"""Nouns after "one" and "two" that are used, not counted: "with one hand"."""
_OF_A_LIMB = frozenset(OF_A_LIMB.split("|"))
_NAMED = re.compile(
    r"(?:number|year|class|room|page|hole|level|day|bus|train|platform|table|aged?|ward|camera|finalist|aisle|bed|gate|"
    r"player|channel|seat|floor|court|lane|track|group|team|route|chapter|exhibit|stall|booth|contestant)"
)
"""Nouns before a number that is their name: "table six"."""
_LARGER = re.compile(r"hundred|thousand|million|percent|%|o['\u2019]clock|am|pm")
_IN_FIGURES = (":", ".")
"""Marks between the figures of a time of day and of a decimal number."""


class NumberWord(NamedTuple):
    """A word that is a number, by its place in the sentence, and its value."""

    place: int
    value: int


def number_words(words: Sequence[str]) -> list[NumberWord]:
    """The numbers among the words of a sentence, in their order, without those that surely count no strokes.

    Left out are "table six", "twice as fast" and "3.5".

    >>> number_words("knock twice , then half a dozen claps".split())
    [NumberWord(place=1, value=2), NumberWord(place=6, value=6)]
    """
    found: list[NumberWord] = []
    in_multiples = _in_multiples([word.lower() for word in words])
    for place, word in enumerate(map(str.lower, words)):
        figure = _FIGURE.fullmatch(word)
        value = int(figure[1]) if figure else _VALUES.get(word)
        if not value or place in in_multiples or _is_of_something_else(words, place):
            continue
        before = [one.lower() for one in words[max(place - 2, 0) : place]]
        if word == "dozen" and "half" in before:
            value = 6
        elif found and found[-1].place == place - 1 and (word == "dozen" or (before[-1] in _TENS and value < 10)):
            tens = found.pop().value  # "two dozen", "twenty five"
            value = tens * value if word == "dozen" else tens + value
        found.append(NumberWord(place, value))
    return found


def _in_multiples(words: Sequence[str]) -> set[int]:
    """Places of the words that name a multiple: "clap twice as fast"."""
    starts = list(accumulate((len(word) + 1 for word in words), initial=0))
    multiples = multiples_in(" ".join(words))
    return {place for place, start in enumerate(starts[:-1]) if any(m.start <= start < m.end for m in multiples)}


def _is_of_something_else(words: Sequence[str], place: int) -> bool:
    """Whether a number belongs to a name, a larger number, a time of day, a decimal or the limbs that are used."""
    before, number, after, then = (words[i].lower() if 0 <= i < len(words) else "" for i in range(place - 1, place + 3))
    names_strokes = not {then, f"{then}s", f"{then}es"}.isdisjoint(_OF_A_LIMB)
    names_limbs = number in ("one", "two", "1", "2") and _LIMBS.fullmatch(after) and not names_strokes
    is_in_figures = (after in _IN_FIGURES and then.isdigit()) or (
        before in _IN_FIGURES and number.isdigit() and place > 1 and words[place - 2].isdigit()
    )
    return bool(_NAMED.fullmatch(before) or _LARGER.fullmatch(after) or names_limbs or is_in_figures)
