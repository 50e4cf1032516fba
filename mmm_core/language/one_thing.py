"""The thing that successive commands handle: "pick up a cup with your right hand, drink from it, put it down".

A thing that is taken and then handled only once is one gesture ("take your hat and lift it"), so such sentences stay as they are.
"""

from __future__ import annotations

import re

from mmm_core.language.ellipsis_patterns import KEEPS_ON
from mmm_core.language.limbs import HEAD, limbs_of
from mmm_core.language.word_tables import LIMB

LEAST_HANDLED = 2
"""Least number of later commands with "it" or "them"; with fewer the sentence is one gesture."""
_TAKES = re.compile(
    r"^(?:pick(?: up)?|take|grab|catch|grasp|fetch|get|seize|draw|pluck|reach for|lift(?: up)?) "
    r"(?:an?|the|some|one|my) (?:imaginary |invisible )?"
    rf"(?P<noun>(?!(?:left |right )?{LIMB}\b|(?:bow|look|step|turn|deep|break|moment)\b)[a-z]+(?: [a-z]+)??)"
    r"(?=$|,| (?:and|then|from|with|off|in|on|out|using|of)\b)"
)
_BETWEEN = re.compile(r"(,? and then |,? then |,? and |[,.;] (?:and then |and |then )?)")
_IT = re.compile(r"\b(?:it|them)\b")
_SIDE = re.compile(r"\b(?:left|right)\b")


def of_one_thing(text: str) -> str:
    """A text in lower case with the thing that its first command takes in place of "it", and the hand that takes it.

    >>> of_one_thing("take a cup with your left hand, drink from it and put it down")
    'take a cup with your left hand, then drink from the cup with your left hand, then put the cup down with your left hand'
    >>> of_one_thing("take a hat and lift it")
    'take a hat and lift it'
    """
    taken = _TAKES.match(text)
    if taken is None:
        return text
    first, *parts = _BETWEEN.split(text)
    betweens, parts = parts[::2], parts[1::2]
    handled = [bool(_IT.search(part)) and not KEEPS_ON.match(part) for part in parts]
    if sum(handled) < LEAST_HANDLED:
        return text
    side = _SIDE.search(first)
    hand = f" with your {side[0]} hand" if side else ""
    return first + "".join(
        f", then {_with(part, taken['noun'], hand)}" if it else between + part
        for between, part, it in zip(betweens, parts, handled, strict=True)
    )


def _with(part: str, noun: str, hand: str) -> str:
    words = _IT.sub(f"the {noun}", part, count=1)
    return words if _SIDE.search(words) or limbs_of(words) == HEAD else f"{words.rstrip(' .!')}{hand}"
