"""Letters without which a pattern is found in no text, so that most patterns of a table need not be tried.

A pattern that says `(?:clap|wave) hands` is found only where "clap" or "wave" stands. Of each alternative the three neighbouring
characters are kept that the fewest sentences have, and a text is turned into the set of its trigrams; where the two sets share
nothing the pattern cannot be found (Cox, "Regular Expression Matching with a Trigram Index", 2012).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from re import _compiler, _parser  # type: ignore[attr-defined]  # they have no public names since Python 3.11
from re import _constants as ops  # type: ignore[attr-defined]
from typing import Any

MOST_ALTERNATIVES = 400
"""Largest number of alternatives of a pattern; a pattern with more is always tried."""
_SHARES = (
    (45, " th|the|he |you| yo|our|ur "), (30, "and|igh|ght| le|lef|eft|rig|nd | ha|th |han| ri"),
    (20, " wi|wit|ith|ht |ft | a |arm|ing| ar|t a| to|t h"),
    (15, "ng | an|to | ti|er |ime|tim|e l|e r| he|mes|hea|es |ead|ve |e t|e a"),
    (10, " fo|o t| on|at |for|r h| no|r l|r r|t t|ke |h t| bo| in|h y|rm |ave|ou |e w|on |nds|r t| wa|in |an | up|ow |ad |e y|e s"),
    (7, "n t|d t|her|ly |st |en | do| sh|rms|wav|lea|oth"),
)  # fmt: skip
_SHARE = {letters: share for share, several in _SHARES for letters in several.split("|")}
"""Per cent of sentences that have three letters, of 600 captions and 1,200 other sentences; of any letters not listed fewer."""
_OTHER_SHARE = 3
_SHORTEST = 3


@lru_cache(maxsize=64)
def letters_of(text: str) -> frozenset[str]:
    """The trigrams of a text: all threes of neighbouring characters."""
    return frozenset(map("".join, zip(text, text[1:], text[2:], strict=False)))


def compiled(pattern: str, flags: int = 0) -> tuple[re.Pattern[str], frozenset[str]]:
    """A compiled pattern and its trigrams; the pattern is parsed once for both, since parsing takes longest.

    Args:
        pattern: a regular expression.
        flags: of `re`.

    Returns:
        the compiled pattern, which does not know its text; and trigrams of which every text that matches has at least one, empty
        where the pattern requires none.

    >>> sorted(compiled("(?:clap|wave) your hands?")[1])
    ['cla', 'wav']
    """
    parsed = _parser.parse(pattern, flags)
    found = _compiler.compile(parsed, flags)
    if found.flags & re.IGNORECASE:
        return found, frozenset()
    return found, frozenset(map(_rarest, _best(list(_needed(parsed)))))


def _needed(parts: Iterable[Any]) -> Iterator[frozenset[str]]:
    """For each part of a pattern that has to be found: texts of which one is found there."""
    literal = ""
    for op, value in parts:
        if op is ops.LITERAL:
            literal += chr(value)
            continue
        if op in (ops.AT, ops.ASSERT_NOT):
            continue  # of no width, so that the letters around it are neighbours
        yield frozenset({literal})
        literal = ""
        if op is ops.SUBPATTERN and not value[1]:  # a group with flags of its own may be of any case
            yield from _needed(value[3])
        elif op is ops.BRANCH:
            each = [_best(list(_needed(branch))) for branch in value[1]]
            yield frozenset().union(*each) if all(each) else frozenset()
        elif op in (ops.MAX_REPEAT, ops.MIN_REPEAT, ops.POSSESSIVE_REPEAT) and value[0] > 0:
            yield from _needed(value[2])
        elif op is ops.ATOMIC_GROUP:
            yield from _needed(value)
        elif op is ops.ASSERT:
            yield from _needed(value[1])
    yield frozenset({literal})


def _best(found: list[frozenset[str]]) -> frozenset[str]:
    """The set of alternatives that excludes most texts, from several sets that a match all requires."""
    usable = [
        each for each in found if 0 < len(each) <= MOST_ALTERNATIVES and all(len(text) >= _SHORTEST for text in each)
    ]
    return min(usable, key=lambda each: sum(_share(_rarest(text)) for text in each), default=frozenset())


@cache
def _rarest(text: str) -> str:
    """The three neighbouring letters of a text that the fewest sentences contain."""
    return min((text[i : i + 3] for i in range(len(text) - 2)), key=_share)


def _share(letters: str) -> int:
    return _SHARE.get(letters, _OTHER_SHARE)
