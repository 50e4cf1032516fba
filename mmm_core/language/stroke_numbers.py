"""Says in the words of commands how often they are to be done: "bow politely", 2 -> "bow politely 2 times"."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import NUMBERS, count_asked, with_count
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import is_gesture_verb, limbs_of
from mmm_core.language.plain_gestures import gesture_of

_COUNT = re.compile(rf" (?:once|twice|[\w-]+ times|(?:{'|'.join(NUMBERS)})(?: of (?:each|them|those))?)$")


def with_numbers(reading: Reading, numbers: Sequence[int | None], plain: Mapping[str, str] | None = None) -> Reading:
    """A reading whose commands are done as often as numbers say, in their order; None for a command without a number.

    Args:
        reading: the reading.
        numbers: of its commands.
        plain: plain commands for other words. A command that has none and is no phrase of the corpus may have to stay as it is.
    """
    given = iter(numbers)
    steps = tuple(tuple(_numbered(command, next(given), plain or {}) for command in step) for step in reading.steps)
    return reading if steps == reading.steps else replace(reading, steps=steps, plain=False)


def _numbered(command: PlainCommand, number: int | None, plain: Mapping[str, str]) -> PlainCommand:
    if number == count_asked(command.text):
        return command
    text = bare = _COUNT.sub("", command.text)
    if number is not None:
        bare = bare if _is_gesture(bare) else _COUNT.sub("", plain.get(command.text, ""))
        said = f"{bare} {number} times" if number > 1 else f"{bare} once"
        text = said if bare else (with_count(command.text, number) if number > 1 else None) or command.text
    return command if text == command.text else replace(command, text=text, limbs=limbs_of(text))


def _is_gesture(command: str) -> bool:
    """Whether a command is a phrase of the corpus, the plain command of a gesture, or a verb alone, too short for a phrase."""
    is_verb = " " not in command and is_gesture_verb(command.lower())
    return is_verb or is_known_phrase(command) or gesture_of(command) != ""
