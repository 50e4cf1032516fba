"""Tempo and size that a text names as a multiple: "twice as fast", "half as big", "at 50 % speed", "3x slower".

A number beside a comparison is a factor, no number of strokes: "wave twice as fast" asks for waves at double speed.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from mmm_core.language.count_words import ADVERBS, NUMBERS

_FRACTIONS = {"half": 1 / 2, "a third": 1 / 3, "one third": 1 / 3, "two thirds": 2 / 3}
_FRACTIONS |= {"a quarter": 1 / 4, "one quarter": 1 / 4, "three quarters": 3 / 4}
_MULTIPLES = {"double": 2.0, "triple": 3.0} | {word: float(n) for word, n in ADVERBS.items() if n > 1}
_FIGURE = rf"(?:\d+(?:\.\d+)?|\.\d+|{'|'.join(word for word in NUMBERS if word.isalpha())})"
_PART = rf"(?:{'|'.join(_FRACTIONS)}|\d+(?:\.\d+)? ?(?:%|percent\b|per cent\b))"
_TIMES = rf"(?:{_FIGURE}(?: and a half)? ?(?:times|x)\b)"
_MULTIPLE = "|".join(_MULTIPLES)
_SPEED = "speed|pace|tempo"
_FAST, _FASTER = "fast|quick|quickly|rapidly|swiftly", "faster|quicker|more quickly"
_SLOW, _SLOWER = "slow|slowly", "slower|more slowly"
_LARGE, _LARGER = (
    "big|large|wide|widely|deep|deeply|high|far|broad|broadly|hard",
    "bigger|larger|wider|deeper|higher|further|farther|broader",
)
_SMALL, _SMALLER = "small|little", "smaller"
_USUAL = (
    "before|usual|normal|now|that|this|last time|it was|the (?:last|first)(?: one| time)?|you did(?: before| it| that)?|"
    "you (?:normally|usually)(?: do| would)?"
)
"""What a multiple compares with: the command as it would be without it."""
_AS = re.compile(
    rf"\b(?P<number>{_PART}|{_TIMES}|{_MULTIPLE}) as (?P<of>{_FAST}|{_SLOW}|{_LARGE}|{_SMALL})\b(?: as (?:{_USUAL})\b)?(?! as\b)"
)
"""Not "three times as big as you can", which are three strokes."""
_COMPARED = re.compile(
    rf"(?:\bby )?(?<![\w.])(?P<number>{_PART}|{_TIMES}) (?P<of>{_FASTER}|{_SLOWER}|{_LARGER}|{_SMALLER})\b(?: than (?:{_USUAL})\b)?"
)
_ABOUT = r"(?:about|around|roughly|approximately|only|just) "
_OF_THE_USUAL = re.compile(
    rf"(?:\b(?:at|with|to) (?:{_ABOUT})?)?(?<![\w.])(?P<number>{_PART}|{_TIMES}|{_MULTIPLE}|\d*\.\d+)(?: of)?"
    rf"(?: (?:the|your|its|that|this))?(?: (?:normal|usual|regular|original))? (?P<of>{_SPEED}|size|amplitude)\b"
)
_AT = re.compile(
    rf"\bat (?:{_ABOUT})?(?P<number>(?:\d+(?:\.\d+)?|\.\d+) ?(?:times|x|%|percent|per cent))(?P<of>)(?!\w)(?! (?:of|on)\b)"
)
"""A multiple of the speed, as of a film: "at 2x", "at 50 percent"."""
_TEMPO = {"", *_FAST.split("|"), *_FASTER.split("|"), *_SLOW.split("|"), *_SLOWER.split("|"), *_SPEED.split("|")}
_LESS = {*_SLOW.split("|"), *_SLOWER.split("|"), *_SMALL.split("|"), *_SMALLER.split("|")}


class Multiple(NamedTuple):
    """Words that name a multiple, by their place in a text, and the factors of tempo and size."""

    start: int
    end: int
    tempo: float
    size: float


def multiple_in(text: str, start: int = 0) -> Multiple | None:
    """The first words of a text in lower case that name a multiple of its tempo or its size; None where none do.

    >>> multiple_in("wave half as slowly"), multiple_in("wave three times as big as you can")
    (Multiple(start=5, end=19, tempo=2.0, size=1.0), None)
    """
    for form in (_AS, _COMPARED, _OF_THE_USUAL, _AT):
        found = form.search(text, start)
        if found is not None and (factor := _factor(found)) > 0:
            return Multiple(*found.span(), *((factor, 1.0) if found["of"] in _TEMPO else (1.0, factor)))
    return None


def multiples_in(text: str) -> list[Multiple]:
    """All multiples that a text in lower case names, in their order."""
    found = list[Multiple]()
    while multiple := multiple_in(text):
        found.append(multiple)
        text = f"{text[: multiple.start]}{' ' * (multiple.end - multiple.start)}{text[multiple.end :]}"
    return sorted(found)


def _factor(found: re.Match[str]) -> float:
    """The factor that a comparison names; 0 or less where it names none: "100 percent slower"."""
    value, is_part = _value(found["number"])
    is_less = found["of"] in _LESS
    if is_part and found.re is _COMPARED:  # "20 percent slower" is 0.8 times as fast
        return 1 - value if is_less else 1 + value
    return (1 / value if is_less else value) if value else 0.0


def _value(number: str) -> tuple[float, bool]:
    """The value of a number in words or figures, and whether it is a fraction or percent."""
    if number in _FRACTIONS:
        return _FRACTIONS[number], True
    if number in _MULTIPLES:
        return _MULTIPLES[number], False
    figure = re.match(_FIGURE, number)
    assert figure is not None  # the patterns have no other numbers
    value = float(NUMBERS[figure[0]]) if figure[0].isalpha() else float(figure[0])
    if "%" in number or "cent" in number:
        return value / 100, True
    return value + (0.5 if "and a half" in number else 0.0), False
