"""Gives each command the number at which the parser points in its sentence: "clap and bow, four of each"."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from mmm_core.generate.word_models import WordModels
from mmm_core.language.commands import Reading
from mmm_core.language.count_words import MOST, count_asked
from mmm_core.language.number_words import NumberWord, number_words
from mmm_core.language.parsed_reading import steps_asked
from mmm_core.language.plain_gestures import SURE, is_gesture, plain_command
from mmm_core.language.spelling import mended
from mmm_core.language.stroke_numbers import with_numbers
from mmm_core.language.tagged_words import words_of
from mmm_core.model.text import MAX_WORD_PIECES, strip_emoji

_MOST_WORDS = MAX_WORD_PIECES - 2
"""Words of a sentence, at most: one piece each between those that mark beginning and end."""
LIKELY, UNLIKELY = 0.5, 0.03
"""Probabilities from which on a number says how often a gesture is to be done, and below which it surely does not."""
_FEW = 2
"""A sentence with at most so many words more than its commands says nothing beside them, so their numbers are its numbers."""


def with_pointed_numbers(reading: Reading, models: WordModels) -> Reading:
    """A reading whose commands have the numbers at which the parser points.

    The parser is asked where the sentence has other numbers than its commands, or says more than they do.
    """
    text = mended(strip_emoji(reading.text))
    words = [text[start:end] for start, end in words_of(text)]
    commands = [command.text for step in reading.steps for command in step]
    numbers = [one for one in number_words(words) if one.value <= MOST]
    if not commands or not numbers or len(words) > _MOST_WORDS:
        return reading
    own = [count_asked(command) for command in commands]
    n_more = len(words) - sum(len(command.split()) for command in commands)
    if n_more <= _FEW and Counter(one.value for one in numbers) == Counter(one for one in own if one):
        return reading
    meant = models.classes(commands)
    likely = models.encode(text).parse.number_probabilities([one.place for one in numbers], steps_asked(reading, meant))
    if likely is None:
        return reading
    chosen = [_chosen(numbers, mine, likely[:, k].tolist()) for k, mine in enumerate(own)]
    sure = {text: one.name for text, one in meant.items() if one.probability >= SURE and is_gesture(one.name)}
    return with_numbers(reading, chosen, {text: plain_command(name, text) for text, name in sure.items()})


def _chosen(numbers: Sequence[NumberWord], own: int | None, likely: Sequence[float]) -> int | None:
    """The number of a command whose words say `own`, given the probability of each number of the sentence."""
    best, probability = max(zip(numbers, likely, strict=True), key=lambda one: one[1])
    if probability >= LIKELY:
        return best.value
    of_own = [p for one, p in zip(numbers, likely, strict=True) if one.value == own]
    return None if of_own and max(of_own) < UNLIKELY else own
