"""Gives each command the number at which the parser points in its sentence: "clap and bow, four of each"."""

from __future__ import annotations

from collections import Counter

from mmm_core.generate.word_models import WordModels
from mmm_core.language.commands import EXACTLY, Reading
from mmm_core.language.count_words import MOST, count_asked
from mmm_core.language.number_words import NumberWord, number_words
from mmm_core.language.parsed_reading import steps_asked
from mmm_core.language.plain_gestures import SURE, is_gesture, plain_command
from mmm_core.language.stroke_numbers import with_numbers
from mmm_core.language.tagged_words import words_of
from mmm_core.model.text import MAX_WORD_PIECES

LIKELY, UNLIKELY = 0.5, 0.03
"""Probabilities from which on a number says how often a gesture is to be done, and below which it surely does not."""
_FEW = 2
"""Words of a sentence, at most, that are in no command where its numbers are surely those of the commands that name them."""


def with_pointed_numbers(reading: Reading, models: WordModels) -> Reading:
    """A reading whose commands have the numbers at which the parser points, where its sentence has others than their words."""
    commands = [command.text for step in reading.steps for command in step]
    words = [reading.text[start:end] for start, end in words_of(reading.text)]
    numbers = [one for one in number_words(words) if one.value <= MOST]
    is_read_exactly = reading.text.startswith(EXACTLY) or len(words) > MAX_WORD_PIECES
    if not commands or not numbers or is_read_exactly:
        return reading
    own = [count_asked(command) for command in commands]
    n_left_out = len(words) - len(" ".join(commands).split())
    if Counter(one.value for one in numbers) == Counter(one for one in own if one) and n_left_out <= _FEW:
        return reading
    parse = models.parse(models.encode(reading.text))
    meant = models.classes(commands)
    likely = parse.number_probabilities([one.place for one in numbers], steps_asked(reading, meant))
    chosen = [_chosen(numbers, mine, likely[:, k].tolist()) for k, mine in enumerate(own)]
    sure = {text: one.name for text, one in meant.items() if one.probability >= SURE and is_gesture(one.name)}
    return with_numbers(reading, chosen, {text: plain_command(name, text) for text, name in sure.items()})


def _chosen(numbers: list[NumberWord], own: int | None, likely: list[float]) -> int | None:
    """The number of a command whose words say `own`, given the probability of each number of the sentence."""
    best, probability = max(zip(numbers, likely, strict=True), key=lambda one: one[1])
    if probability >= LIKELY:
        return best.value
    is_another_s = probability < UNLIKELY and own in {one.value for one in numbers}
    return None if is_another_s else own
