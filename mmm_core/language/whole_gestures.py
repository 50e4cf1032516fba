"""Gestures without strokes, which are done as a whole as often as a number says: "salute twice" is two salutes.

The corpus performs such a gesture once, so the model has not learnt to do it more often; the generator repeats it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import count_asked, without_times
from mmm_core.language.known_phrases import BESIDE
from mmm_core.language.limbs import limbs_of
from mmm_core.language.phrase_gestures import gesture_of_phrase
from mmm_core.language.plain_gestures import SURE, Meant, family_of, gesture_of, gestures, plain_command
from mmm_core.language.word_tables import lines


def is_whole(gesture: str) -> bool:
    """Whether a gesture has no strokes."""
    return family_of(gesture) in _families()


def once(command: str) -> str:
    """The plain command for a whole gesture without its number: "salute" of "salute 3 times"; empty for other commands."""
    bare = without_times(command)
    return bare if bare != command and is_whole(gesture_of(bare)) else ""


def has_strokes(command: str) -> bool:
    """Whether a command surely repeats a stroke: a phrase of such a gesture, or its verb alone."""
    bare = BESIDE.sub("", command.lower()).strip()
    gesture = gesture_of(bare) or gesture_of_phrase(bare)
    return not is_whole(gesture) if gesture else bare in _verbs_of_strokes()


def with_plain_repetitions(reading: Reading, classes: Callable[[Sequence[str]], Mapping[str, Meant]]) -> Reading:
    """A reading in which whole gestures that are to be done several times are said in plain words, with the number.

    Args:
        reading: the reading.
        classes: tells which gestures commands mean.
    """
    asked = [c.text for step in reading.steps for c in step if _may_be_whole(c.text)]
    if not asked:
        return reading
    meant = classes(asked)
    steps = tuple(tuple(_in_plain_words(c, meant.get(c.text)) for c in step) for step in reading.steps)
    return reading if steps == reading.steps else replace(reading, steps=steps, plain=False)


def _in_plain_words(command: PlainCommand, meant: Meant | None) -> PlainCommand:
    if meant is None or meant.probability < SURE or not is_whole(meant.name):
        return command
    text = plain_command(meant.name, command.text)
    return replace(command, text=text, limbs=limbs_of(text)) if text else command


def _may_be_whole(command: str) -> bool:
    """Whether a command names a number above one and may be for a gesture without strokes; most verbs of strokes tell it is not."""
    first = command.split(" ", 1)[0].lower()
    return first not in _verbs_of_strokes() and (count_asked(command) or 1) > 1


@cache
def _families() -> frozenset[str]:
    return frozenset(lines("whole_gestures"))


@cache
def _verbs_of_strokes() -> frozenset[str]:
    """First words of plain commands of gestures that have strokes, but not of others; "do" and "tip" fit others, too."""
    first = {gesture: plain_command(gesture, "").split(" ", 1)[0] for gesture in gestures()}
    of_whole = {verb for gesture, verb in first.items() if is_whole(gesture)}
    return frozenset(first.values()) - of_whole - {"do", "tip"}
