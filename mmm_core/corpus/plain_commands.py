"""Lists every phrase of the grammar in its plainest form, for the scope index, the word tables and the benches."""

from __future__ import annotations

import functools
import re

from mmm_core.corpus.families import FAMILIES, MIMED, Gesture
from mmm_core.corpus.forms import (
    AT_ONCE_TERSE,
    FAST,
    HOLDS,
    IN_TURNS,
    LARGE,
    PRETEND,
    PRETENDING,
    REQUESTS,
    SLOW,
    SMALL,
    THEN,
    WITH_BOTH,
    WITH_HAND,
)
from mmm_core.corpus.grammar import is_terse, words_of
from mmm_core.corpus.withheld import is_withheld
from mmm_core.language.inflection import expand, plain


def plain_phrases(family: str, direction: str = "") -> list[tuple[str, str]]:
    """(row, phrase) for every phrase of a family and direction, with open slots; the row says which arms the phrase names.

    Bare phrases of a family with sides also come with words that name a hand.
    """
    g = Gesture(family, direction=direction)
    words, sides = words_of(g), FAMILIES[family].sides
    rows: list[tuple[str, tuple[str, ...], tuple[str, ...]]] = [
        ("one", words.one, ("",)), ("any", words.any, ("",)), ("both", words.both, ("",)), ("alternating", words.alternating, ("",)),
    ]  # fmt: skip
    if "right" in sides:
        rows += [("any", words.bare, ("",)), ("one", words.bare, WITH_HAND[:1])]
        rows += [("both", words.bare, WITH_BOTH[:1])] if "both" in sides else []
    else:
        rows += [("both" if sides else "none", words.bare, ("",))]
    if "alternating" in sides:
        verbs = tuple(p for p in (*words.bare, *words.both) if not is_terse(p))
        rows += [("alternating", verbs, IN_TURNS[:1])]
    said = [(row, f"{p}{end}") for row, patterns, ends in rows for q in patterns for p in expand(q) for end in ends]
    if family in MIMED:
        said += [
            (row, PRETEND[0].replace("{v}", p))
            for row, p in said
            if row != "one" and not is_terse(p) and p.split()[0] not in PRETENDING
        ]
    return [(row, plain(p)) for row, p in said]


@functools.cache
def known_commands(most_of_a_row: int = 12) -> frozenset[str]:
    """Plain commands of every family, with each side and direction, and without a count or with three.

    From each row of phrases come the shortest one and about `most_of_a_row` others: half of them are the first phrases of the
    row, which are the most common, the other half are spread over the rest.
    """
    found: set[str] = set()
    for name, family in FAMILIES.items():
        for direction in family.directions or ("",):
            rows: dict[str, list[str]] = {}
            for row, phrase in plain_phrases(name, direction):
                rows.setdefault(row, []).append(phrase)
            for row, phrases in rows.items():
                first = -(-most_of_a_row // 2)
                rest = phrases[first:]
                spread = rest[:: max(1, -(-len(rest) // max(1, most_of_a_row - first)))]
                shortest = min(phrases, key=lambda p: len(p.replace("{n}", "").split()))
                for phrase in dict.fromkeys((shortest, *phrases[:first], *spread)):
                    for side in ("left", "right") if row == "one" or "{S}" in phrase else ("",):
                        for often, number in (("", "three"), ("three times", "3")) if "{" in phrase else (("", ""),):
                            text = phrase.replace("{S}", side).replace("{D}", direction)
                            found.add(" ".join(text.replace("{n}", often).replace("{N}", number).split()))
    return frozenset(text for text in found if not is_withheld(text))


def manner_phrases() -> tuple[str, ...]:
    """Words of manner, order, requests and pretence that stand around the phrases in sentences."""
    forms = (*SLOW, *FAST, *LARGE, *SMALL, *HOLDS, *THEN, *AT_ONCE_TERSE, *REQUESTS, *PRETEND, *IN_TURNS)
    return tuple(re.sub(r"\{.\}|\^", " ", form) for form in forms)
