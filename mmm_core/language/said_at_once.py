"""Joins commands in turn that a sentence says to be done at once, and leaves out a command that is named twice.

Rules and tags divide a sentence into commands; how these follow each other may be said far from both: "hands on the wheel, and
check over your shoulder, all in one go".
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import combinations

from mmm_core.language.at_once import are_apart
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.word_tables import any_of

_TOGETHER = re.compile(rf"\b{any_of('at_once', 'said for all')}\b", re.IGNORECASE)
"""Words anywhere in a sentence that say its commands to be done at once."""
_IN_TURN = re.compile(rf"\b{any_of('at_once', 'said in turn')}\b", re.IGNORECASE)
"""Words that say commands to be done one after the other."""
_AGAIN = re.compile(r"\b(?:again|another|(?:once|one|\w+) more|repeat\w*|twice|over and over|encore)\b", re.IGNORECASE)
_ARM = re.compile(r" with (?:your|the|both|one) (?:(?:left|right) )?(?:hand|arm)s?$|\b(?:left|right) (?=hand|arm)")
"""The arm of a command: "salute with your right hand", "put your left hand to your ear"."""
_MOST_TOGETHER = 2


def said_at_once(reading: Reading) -> Reading:
    """A reading whose two commands in turn are one step where the sentence says so and their limbs differ."""
    if len(reading.steps) != _MOST_TOGETHER or any(len(step) != 1 for step in reading.steps):
        return reading
    (first,), (second,) = reading.steps
    is_said = _TOGETHER.search(reading.text) is not None and _IN_TURN.search(reading.text) is None
    return (
        replace(reading, steps=((first, second),), plain=False)
        if is_said and are_apart(first.limbs, second.limbs)
        else reading
    )


def without_repeats(reading: Reading) -> Reading:
    """A reading that has each command once, if the sentence names it twice in other words: "a salute, hand at the brow"."""
    if asks_again(reading.text):
        return reading
    flat = [command for step in reading.steps for command in step]
    repeated = {
        id(other)
        for one, other in combinations(flat, 2)
        if _says_again(one, other) and not _is_named_twice(one, reading.text)
    }
    if not repeated:
        return reading
    kept = (tuple(command for command in step if id(command) not in repeated) for step in reading.steps)
    return replace(reading, steps=tuple(filter(None, kept)), plain=False)


def asks_again(text: str) -> bool:
    """Whether a text has words for doing something more than once."""
    return _AGAIN.search(text) is not None


def _says_again(one: PlainCommand, other: PlainCommand) -> bool:
    """Whether a command has words and manner of another one, apart from an arm that only one of them names."""
    if one.manner != other.manner:
        return False
    names_none = any(_ARM.search(command.text) is None for command in (one, other))
    return one.text == other.text or (names_none and _ARM.sub("", one.text) == _ARM.sub("", other.text))


def _is_named_twice(command: PlainCommand, text: str) -> bool:
    """Whether a sentence has the first word of a command more than once: "clap. clap."."""
    verb = command.text.lower().partition(" ")[0]
    return len(re.findall(rf"\b{re.escape(verb)}", text.lower())) > 1
