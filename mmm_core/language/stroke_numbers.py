"""Says in the words of commands how often they are to be done: "bow politely", 2 -> "bow politely 2 times"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import count_asked, with_count
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import is_gesture_verb, limbs_of
from mmm_core.language.plain_gestures import gesture_of

_COUNT = re.compile(r" (?:once|twice|[\w-]+ times)$")


def with_numbers(reading: Reading, numbers: Sequence[int | None]) -> Reading:
    """A reading whose commands are done as often as numbers say, in their order; None for a command without a number.

    A command that is no phrase of the corpus, or whose number cannot be exchanged, stays as it is.
    """
    given = iter(numbers)
    steps = tuple(tuple(_numbered(command, next(given)) for command in step) for step in reading.steps)
    return reading if steps == reading.steps else replace(reading, steps=steps, plain=False)


def _numbered(command: PlainCommand, number: int | None) -> PlainCommand:
    own = count_asked(command.text)
    if number == own:
        return command
    bare = command.text if own is None else _COUNT.sub("", command.text)
    if number is None:
        text = bare
    elif _is_gesture(bare):
        text = f"{bare} {number} times" if number > 1 else f"{bare} once"
    else:
        text = (with_count(command.text, number) if number > 1 else None) or command.text
    return replace(command, text=text, limbs=limbs_of(text))


def _is_gesture(command: str) -> bool:
    """Whether a command is a phrase of the corpus, the plain command of a gesture, or a verb alone, too short for a phrase."""
    is_verb = " " not in command and is_gesture_verb(command.lower())
    return is_verb or is_known_phrase(command) or gesture_of(command) != ""
