"""A number of strokes that a sentence names once for all its commands: "clap and bow, three times each"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from mmm_core.language.commands import PlainCommand
from mmm_core.language.count_words import ADVERBS, NUMBERS, count_asked, with_times

_EACH = r"each(?: one)?(?: of (?:them|those|these))?"
_NUMBER = "|".join(NUMBERS)
_FORMS = (
    rf"(?:{_NUMBER})(?: times|x) {_EACH}", rf"(?:{_NUMBER}) (?:of|for) {_EACH}", rf"(?:{'|'.join(ADVERBS)}) {_EACH}",
    rf"{_EACH} (?:{_NUMBER})(?: times|x)", rf"{_EACH} (?:{'|'.join(ADVERBS)})",
)  # fmt: skip
_OF_EACH = re.compile(rf",?(?: and)?(?: do)? (?P<said>{'|'.join(_FORMS)})[.!]*$")
_WORD = re.compile(rf"\b(?:{'|'.join(ADVERBS)}|{_NUMBER})(?=x|\b)")


def without_number_of_each(text: str) -> tuple[str, int]:
    """A sentence in lower case without the number that it names at its end for each command, and that number; 0 for none.

    >>> without_number_of_each("clap and bow, three times each"), without_number_of_each("wave each arm twice")
    (('clap and bow', 3), ('wave each arm twice', 0))
    """
    found = _OF_EACH.search(text)
    if found is None:
        return text, 0
    said = found["said"].replace("each one", "each")
    number = _WORD.search(said)
    assert number is not None  # each form has one
    return text[: found.start()], ADVERBS.get(number[0]) or NUMBERS[number[0]]


def each_done(steps: Sequence[Sequence[PlainCommand]], times: int) -> list[tuple[PlainCommand, ...]]:
    """Steps whose commands are done so many times each, where they name no number of their own."""
    if not times:
        return [tuple(step) for step in steps]
    return [
        tuple(c if count_asked(c.text) else replace(c, text=with_times(c.text, times)) for c in step) for step in steps
    ]
