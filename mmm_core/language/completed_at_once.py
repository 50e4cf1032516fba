"""Commands at the same time, each completed with what it takes from the other: verb, free arm, direction.

"Point left with your left arm and right with the right": the second command takes the verb of the first.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache, lru_cache, partial

from mmm_core.language.limbs import ARMS, SOME_ARM, limbs_of
from mmm_core.language.word_tables import REMEMBERED, any_of, lines

_any = partial(any_of, "at_once")
_FILLER = re.compile(_any("filler"))
_FRONTED = re.compile(
    r"^(?:(?:and|with|using) )+(?:your |the )?(left|right|other)(?: hand| arm| one)?,? (?:you (?:are |will )?)?(?:be )?"
    rf"(?!{_any('place')}\b)(\w.+)$"
)
_GERUND = re.compile(r"^\w+(?:ing|ed)\b")
_IS = re.compile(
    r"^(?P<limb>(?:your |the |both )?(?:left |right )?(?:hands?|arms?|fists?|palms?|head)) "
    rf"{_any('is')}(?: being| held)? (?P<rest>.+)$"
)
ACTS = re.compile(
    r"^(?:(?:let|have|get|make|keep) )?(?:your |the )?(?:(?P<side>left|right) (?:hand|arm|fist)|(?P<head>head)) "
    rf"(?:(?P<ing>{_any('acting')})|(?P<verb>{_any('act')})(?:e?s)?)\b(?P<rest>.*)$"
)
"""'Your left hand waves', 'have your head nod'."""
_SIDE_FIRST = re.compile(r"^(left|right) (?=(?:on|behind|over|at|up|down|out) )")
_LEFT_OUT = re.compile(rf"{_any('left out')}\b")
OTHER_HAND = re.compile(r"\bother (?:hand|arm|one)\b")


def beside_each_other(commands: Sequence[str]) -> list[str]:
    """Commands that are known to be done at the same time, each with the verb, arm and direction that it takes from the others.

    >>> beside_each_other(["point left with your left arm", "nodding"])
    ['point left with your left arm', 'nod']
    """
    first, *others = (imperative(command) for command in commands)
    complete = [first, *(there(with_verb(other, first), first) for other in others)]
    named = [limbs_of(command) for command in complete]
    return [
        freed(command, frozenset[str]().union(*(limbs for k, limbs in enumerate(named) if k != i)))
        for i, command in enumerate(complete)
    ]


def with_verb(second: str, first: str) -> str:
    """The second part with the verb of the first: "right with the right arm" beside "point left with the left arm"."""
    verb = _LEFT_OUT.match(first)
    one = re.match(
        r"(?:with |using )(?:your |the )?(?P<side>left|right|other)(?: hand| arm| one)? (?=to\b|up\b|down\b|forward|ahead|back)",
        second,
    )
    way = re.match(r"(?:to the )?(?:left|right|up|down|forward|ahead|straight ahead|back) (?=with\b|using\b)", second)
    if verb is None or (one is None and way is None):
        return second
    if one is None:
        return f"{verb[0]} {second}"
    named = re.search(r"\b(left|right) (?:hand|arm)\b", first)
    side = one["side"] if one["side"] != "other" else ("right" if named and named[1] == "left" else "left")
    return f"{verb[0]} {second[one.end() :]} with your {side} hand"


def imperative(part: str) -> str:
    """A part as a command: "nodding" -> "nod", "your left arm is stretched forward" -> "left arm stretched forward"."""
    part = _FRONTED.sub(r"\2 with your \1 hand", part.strip(" ,."))
    while (shorter := _FILLER.sub("", part)) != part:
        part = shorter
    part = _SIDE_FIRST.sub(r"\1 hand ", part)
    if acts := ACTS.match(part):
        verb = base_of(acts["ing"]) if acts["ing"] else acts["verb"]
        if acts["head"]:
            return f"{verb}{acts['rest']}" if verb in ("nod", "look") else f"{verb} your head{acts['rest']}"
        return f"{verb}{acts['rest']} with your {acts['side']} hand"
    if stays := _IS.match(part):
        part = f"{stays['limb']} {stays['rest']}"
    if m := _GERUND.match(part):
        part = base_of(m[0]) + part[m.end() :]
    return part


@lru_cache(maxsize=REMEMBERED)
def base_of(inflected: str) -> str:
    """The verb of a gerund or a past form: "waving" -> "wave", "clapped" -> "clap"; the word itself where there is none.

    >>> base_of("waving"), base_of("nodding"), base_of("clapped"), base_of("king")
    ('wave', 'nod', 'clap', 'king')
    """
    words = _words()
    stem = inflected.removesuffix("ing").removesuffix("ed")
    doubled = stem[:-1] if len(stem) > 2 and stem[-1] == stem[-2] else ""
    ranked = [word for word in (stem, f"{stem}e", doubled) if word in words and len(word) > 1]
    return min(ranked, key=lambda word: words[word]) if ranked and stem != inflected else inflected


@cache
def _words() -> dict[str, int]:
    return {word: i for i, word in enumerate(lines("corpus_words"))}


def freed(clause: str, other: frozenset[str]) -> str:
    """A clause of some arm with the side that the other command leaves free."""
    if limbs_of(clause) != SOME_ARM or not other & ARMS or other >= ARMS:
        return clause
    return sided(clause, "left" if "right_arm" in other else "right")


def there(clause: str, first: str) -> str:
    """A clause with "there" replaced by the direction of `first`: "look there" beside "point to the left" -> "look to the left"."""
    way = re.search(r"\b(?:to (?:the |your )?(?:left|right)|up|down|left|right)\b(?! (?:hand|arm))", first)
    found = re.match(
        r"(look|point)(?: (?:there|that way|over there|in that direction)(?: too)?| (?=with\b)|$)(?P<rest>.*)", clause
    )
    if way is None or found is None or (found[1] == "point" and found[0] == "point"):
        return clause
    return f"{found[1]} {way[0]}{found['rest']}"


def sided(clause: str, side: str) -> str:
    """A clause of one arm with a side named."""
    if re.search(r"\b(?:left|right) (?:hand|arm)\b", clause):
        return clause
    if OTHER_HAND.search(clause):
        other = re.sub(r"\b(?:(?:your|the) )?other (hand|arm|one)\b", rf"your {side} \1", clause, count=1)
        return other.replace(f"your {side} one", f"your {side} hand")
    named, n = re.subn(r"(?:^|\b(?:your|one|a|the) )(hand|arm|fist)\b", rf"your {side} \1", clause, count=1)
    return named if n else f"{clause} with your {side} hand"
