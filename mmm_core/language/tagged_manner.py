"""Tempo and size in words that the rules do not know: a tagger finds them, and a plain adverb takes their place.

"Bow as if you waded through treacle, then nod" becomes "Bow slowly, then nod", which the rules read. Where the gesture would be
lost without the words ("pump those arms like you're sprinting"), the one command of the sentence takes their manner.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner_words import asked_manners
from mmm_core.language.reading import command_of, read
from mmm_core.language.spelling import mended
from mmm_core.language.tagged_words import FAST, LARGE, MANNERS, SLOW, SMALL, words_of

_ADVERBS = {SLOW: "slowly", FAST: "quickly", SMALL: "slightly", LARGE: "hugely"}
_OF_WORDS = 1.0
"""Weight of what the words of a phrase say of its manner, against what the tagger says."""
_LEAST_PROBABILITY = 0.7
"""Mean probability, over the words of a phrase, below which a manner is not believed."""
LIKELY_OF_WHOLE, LIKELY_OF_PART = 0.4, 0.9
"""Least probability of a manner that no words were found for: of a sentence of one command, and of others or with a hold."""
_ENDS_A_SENTENCE = re.compile(r"[.!?;:](?=\s|$)")
_MARKS_AT_START = re.compile(r"^[\s,.;:!?\u2026\u2013\u2014-]+")
_MARKS_AT_END = re.compile(r"[\s,.;:!?\u2026\u2013\u2014-]+$")
_COUNTS = re.compile(r"\bx ?\d|\d ?x\b|\b(?:once|twice|thrice|times)\b", re.IGNORECASE)
"""A number of strokes, which is no manner."""
_FEW_WORDS = 2
"""Words that may stand beside a manner in a sentence of its own: "och, easy now"."""


@dataclass(frozen=True)
class MannerPhrase:
    """Words that ask for one tempo or size.

    Attributes:
        start: first character of the phrase in its sentence.
        end: end of the phrase.
        manner: one of `MANNERS`, but "none".
    """

    start: int
    end: int
    manner: str


def manner_phrases(sentence: str, log_probability: NDArray[np.float32]) -> list[MannerPhrase]:
    """The phrases of a sentence that ask for a tempo or a size, in order.

    Neighbouring words that are likelier of some manner than of none are one phrase; its manner has the greatest mean probability.
    Words with a number of strokes are no phrase of manner.

    Args:
        sentence: the sentence.
        log_probability: (N, 5) log-probability of each of `MANNERS` for each of its N `words_of`.
    """
    spans, probability = words_of(sentence), np.exp(log_probability)
    found: list[MannerPhrase] = []
    for some, group in groupby(range(len(spans)), key=lambda i: bool(probability[i].argmax())):
        words = list(group)
        if not some:
            continue
        start, end = spans[words[0]][0], spans[words[-1]][1]
        said = sentence[start:end]
        share = probability[words].mean(0) * np.exp([0.0, *(_OF_WORDS * np.array(asked_manners(said)))])
        share /= share.sum()
        best = int(share[1:].argmax()) + 1
        if share[best] >= _LEAST_PROBABILITY and not _COUNTS.search(said):
            found.append(MannerPhrase(start, end, MANNERS[best]))
    return found


def with_plain_manner(text: str, phrases: Sequence[MannerPhrase]) -> str:
    """A text with an adverb in place of each phrase of manner that the rules do not understand.

    >>> with_plain_manner("Nod at the speed of a snail.", [MannerPhrase(4, 27, "slow")])
    'Nod slowly.'
    """
    unknown = [phrase for phrase in phrases if not _is_understood(text, phrase)]
    if not unknown:
        return text
    said = ""
    for start, end in _sentences(text):
        inside = [phrase for phrase in phrases if start <= phrase.start < end]
        if said and inside and _n_words(text, start, end, inside) <= _FEW_WORDS:  # "Stir the tea. Och, easy now."
            adverbs = dict.fromkeys(_ADVERBS[phrase.manner] for phrase in inside)
            said = f"{_MARKS_AT_END.sub('', said)} {' '.join(adverbs)}."
            continue
        sentence = text[start:end]
        for phrase in reversed([phrase for phrase in inside if phrase in unknown]):
            sentence = _replaced(sentence, phrase.start - start, phrase.end - start, _ADVERBS[phrase.manner])
        said += sentence
    return said


def with_left_manner(reading: Reading, text: str, phrases: Sequence[MannerPhrase]) -> Reading:
    """A reading of one command with the manner of the phrases, where it has none of that kind.

    Commands and denials that are nothing but words of manner are left out before: "let it take its time", "don't you dare rush it".
    A phrase around a denied act ("less of the drumming") is none.
    """
    acts = [set(_words(mended(what))) for what in reading.denied if limbs_of(what)]
    manners: dict[str, set[str]] = {}
    for phrase in phrases:
        words = set(_words(mended(text[phrase.start : phrase.end])))
        if not any(act <= words for act in acts):
            manners.setdefault(phrase.manner, set()).update(words)
    said = set[str]().union(*manners.values())
    steps = [[c for c in step if not set(_words(c.text)) <= said] for step in reading.steps]
    steps = [step for step in steps if step] or [list(step) for step in reading.steps]
    if not manners or sum(map(len, steps)) != 1:
        return reading
    ((command,),) = steps
    for manner in manners:
        command = _in_manner(command, manner)
    denied = tuple(what for what in reading.denied if not set(_words(mended(what))) <= said)
    return replace(reading, steps=((command,),), denied=denied)


def with_likely_manner(
    reading: Reading, whole: Mapping[str, float], commands: Mapping[str, Mapping[str, float]] = MappingProxyType({})
) -> Reading:
    """A reading whose commands have the tempo and the size that their words most likely ask for, where no word says another.

    Args:
        reading: the reading.
        whole: the probability of each manner of the whole sentence, which its only command takes.
        commands: the probabilities of single commands, by their words, for a reading of several.
    """
    said = [command for step in reading.steps for command in step]
    if len(said) == 1:
        commands = {said[0].text: whole}
    is_one_without_hold = len(said) == 1 and not said[0].manner.hold_s  # "wait like that for two seconds" says no tempo
    least = LIKELY_OF_WHOLE if is_one_without_hold else LIKELY_OF_PART

    def in_manner(command: PlainCommand) -> PlainCommand:
        probabilities = commands.get(command.text, {})
        for manner in sorted(probabilities, key=lambda name: -probabilities[name]):
            if probabilities[manner] >= least:
                command = _in_manner(command, manner)
        return command

    steps = tuple(tuple(map(in_manner, step)) for step in reading.steps)
    return reading if steps == reading.steps else replace(reading, steps=steps, plain=False)


def _in_manner(command: PlainCommand, manner: str) -> PlainCommand:
    """A command with a tempo or a size, if it has none."""
    given = command_of(f"nod {_ADVERBS[manner]}").manner
    tempo, size = (
        a if a != 1 else b for a, b in ((command.manner.tempo, given.tempo), (command.manner.size, given.size))
    )
    return replace(command, manner=replace(command.manner, tempo=tempo, size=size))


def _words(said: str) -> list[str]:
    return re.findall(r"[a-z]+", said.lower())


def _is_understood(text: str, phrase: MannerPhrase) -> bool:
    """Whether the rules read a tempo or a size, of whatever kind, in the phrase: more commands have one with it than without."""
    return _n_scaled(text, phrase.manner) > _n_scaled(text[: phrase.start] + text[phrase.end :], phrase.manner)


def _n_scaled(text: str, manner: str) -> int:
    manners = [command.manner for step in read(text).steps for command in step]
    return sum((m.tempo if manner in (SLOW, FAST) else m.size) != 1 for m in manners)


def _sentences(text: str) -> list[tuple[int, int]]:
    """Start and end of each sentence of a text, with its final mark and without a space between."""
    edges = [0, *(found.end() for found in _ENDS_A_SENTENCE.finditer(text)), len(text)]
    return [(a, b) for a, b in pairwise(edges) if text[a:b].strip()]


def _n_words(text: str, start: int, end: int, phrases: Sequence[MannerPhrase]) -> int:
    """Number of words between two characters that belong to no phrase."""
    return sum(
        text[start + a].isalnum() and not any(p.start <= start + a < p.end for p in phrases)
        for a, _ in words_of(text[start:end])
    )


def _replaced(sentence: str, start: int, end: int, adverb: str) -> str:
    before, after = sentence[:start], sentence[end:]
    if not before.strip():
        return f"{before}{adverb} {_MARKS_AT_START.sub('', after)}".rstrip()
    space = " " if after[:1].isalnum() else ""
    return f"{_MARKS_AT_END.sub('', before)} {adverb}{space}{after}"
