"""Phrases that the shipped model performs badly are said in the plain command of a gesture.

Some phrases of the corpus are too rare for the model to learn, such as "be Katniss"; the gesture that they mean is known
nevertheless. The table `words/hard_phrases.txt` belongs to the shipped weights: `python -m docs.tools.hard_phrases` measures
phrases of the corpus. A phrase that goes to the left stands for its mirror image as well. `words/near_gestures.txt` has common
commands for which the corpus has no gesture, each with the gesture that comes nearest.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

from mmm_core.language.commands import EXACTLY, PlainCommand, Reading
from mmm_core.language.known_phrases import significant_words
from mmm_core.language.limbs import limbs_of
from mmm_core.language.plain_gestures import IN_TURN, plain_command, sides_of
from mmm_core.language.word_tables import pairs

_FEWEST_WORDS, _FEWEST_LETTERS = 2, 8
"""Number of significant words and of their letters: a phrase that has fewer of both would match other sentences by chance."""
_SIDE = re.compile(r"\b(left|right)\b")
_SIDE_OF_A_HAND = re.compile(
    r"\b(?:left|right)(?=(?: index| pointer| straight)? (?:hand|arm|fist|palm|fore?finger|finger|pointer|thumb)s?\b)"
)


def said_of(text: str) -> str:
    """The significant words of a phrase, by which it is found, without those for arms in turn; empty where they are too few."""
    words = significant_words(IN_TURN.sub(" ", text))
    return " ".join(words) if len(words) >= _FEWEST_WORDS or len("".join(words)) >= _FEWEST_LETTERS else ""


def without_hard_phrases(text: str, reading: Reading) -> Reading:
    """The reading of a text in which hard phrases are said in plain words; a text that is read verbatim stays as it is."""
    if text.startswith(EXACTLY):
        return reading
    steps = tuple(tuple(map(_in_plain_words, step)) for step in reading.steps)
    return reading if steps == reading.steps else replace(reading, steps=steps, plain=False)


def _in_plain_words(command: PlainCommand) -> PlainCommand:
    gesture = to_said_side(_gestures().get(said_of(command.text), ""), command.text)
    words = plain_command(gesture, command.text) if gesture else ""
    return replace(command, text=words, limbs=limbs_of(words)) if words else command


def to_said_side(gesture: str, text: str) -> str:
    """A gesture; if it goes to a side, to the one that a text names, and none where that names no side or both.

    >>> to_said_side("point/left", "aim your left finger to the right"), to_said_side("nod", "nod to the right")
    ('point/right', 'nod')
    """
    if not sides_of(gesture):
        return gesture
    named = {*_SIDE.findall(_SIDE_OF_A_HAND.sub(" ", text.lower()))}
    return _SIDE.sub(named.pop(), gesture) if len(named) == 1 else ""


@cache
def _gestures() -> dict[str, str]:
    known = (*pairs("hard_phrases"), *pairs("near_gestures"))
    return {said_of(phrase): gesture for gesture, phrase in known}
