"""Says in the words of commands how often they are to be done: "bow politely", 2 -> "bow politely 2 times"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import count_asked, with_count, with_times, without_times
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import is_gesture_verb, limbs_of
from mmm_core.language.plain_gestures import gesture_of


def with_numbers(reading: Reading, numbers: Sequence[int | None], plain: Mapping[str, str] | None = None) -> Reading:
    """A reading whose commands are done as often as numbers say, in their order; None for a command without a number.

    Args:
        reading: the reading.
        numbers: of its commands.
        plain: plain commands by the words of commands whose gesture is sure. A command that has none stays as it is where its
            own words cannot say the number.
    """
    given = iter(numbers)
    steps = tuple(tuple(_numbered(command, next(given), plain or {}) for command in step) for step in reading.steps)
    return reading if steps == reading.steps else replace(reading, steps=steps, plain=False)


def _numbered(command: PlainCommand, number: int | None, plain: Mapping[str, str]) -> PlainCommand:
    own = count_asked(command.text)
    if number == own:
        return command
    ways = [with_count(command.text, number) or ""] if own and number and number > 1 else []
    bare, in_plain_words = without_times(command.text), without_times(plain.get(command.text, ""))
    ways += [
        words if number is None else with_times(words, number)
        for words in (bare, in_plain_words)
        if _takes_numbers(words)
    ]
    text = next((words for words in ways if words and count_asked(words) == number), command.text)
    return command if text == command.text else replace(command, text=text, limbs=limbs_of(text))


def _takes_numbers(command: str) -> bool:
    """Whether a command is a phrase of the corpus, the plain command of a gesture, or a verb alone, too short for a phrase."""
    is_verb = " " not in command and is_gesture_verb(command.lower())
    return is_verb or is_known_phrase(command) or gesture_of(command) != ""
