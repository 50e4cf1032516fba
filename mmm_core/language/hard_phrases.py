"""Phrases that the shipped model performs badly are said in the plain command of a gesture.

Some phrases of the corpus are too rare for the model to learn, such as "be Katniss"; the gesture that they mean is known
nevertheless. The table `words/hard_phrases.txt` belongs to the shipped weights: `python -m docs.tools.hard_phrases` measures
phrases of the corpus. `words/near_gestures.txt` has common commands for which the corpus has no gesture, each with the gesture
that comes nearest.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from mmm_core.language.commands import EXACTLY, PlainCommand, Reading
from mmm_core.language.known_phrases import significant_words
from mmm_core.language.limbs import limbs_of
from mmm_core.language.plain_gestures import IN_TURN, plain_command
from mmm_core.language.word_tables import pairs

_FEWEST_WORDS, _FEWEST_LETTERS = 2, 8
"""Number of significant words and of their letters: a phrase that has fewer of both would match other sentences by chance."""


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
    gesture = _gestures().get(said_of(command.text), "")
    words = plain_command(gesture, command.text) if gesture else ""
    return replace(command, text=words, limbs=limbs_of(words)) if words else command


@cache
def _gestures() -> dict[str, str]:
    known = (*pairs("hard_phrases"), *pairs("near_gestures"))
    return {said_of(phrase): gesture for gesture, phrase in known}
