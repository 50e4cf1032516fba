"""Finds the number of strokes that a sentence of one command names anywhere: "cherries, left hand, five of them".

A command in plain words has lost what stands apart from its verb. The words are in `words/stroke_numbers.txt`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from mmm_core.language.commands import Reading
from mmm_core.language.count_words import ADVERBS, NUMBERS, count_asked, with_count
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import is_gesture_verb, limbs_of
from mmm_core.language.plain_gestures import gesture_of
from mmm_core.language.spelling import mended
from mmm_core.language.word_tables import any_of

_IN_WORDS = {
    "half a dozen": 6,
    "half dozen": 6,
    "a dozen": 12,
    "a couple of": 2,
    "a couple": 2,
    "a pair of": 2,
    "a trio of": 3,
}
_VALUES = NUMBERS | ADVERBS | _IN_WORDS | {"double": 2, "triple": 3, "quadruple": 4}
_STROKE, _DOUBLE, _UNIT, _ASKS = (any_of("stroke_numbers", kind) for kind in ("stroke", "double", "unit", "asks"))


def _number(words: Iterable[str]) -> str:
    """A pattern of a number, but not of a larger one, a time of day, a fraction or a part of a word."""
    any_word = "|".join(sorted(words, key=len, reverse=True))
    return rf"(?<![\w.-])(?P<n>{any_word})(?![\w%-]|[.:]\d| (?:hundred|thousand|thirds?|quarters?|half|point)\b)"


_NUMBER = _number(NUMBERS | _IN_WORDS)
_SEVERAL = _number(word for word in NUMBERS | _IN_WORDS if word not in ("one", "1"))
"""A number above one: "one" stands for a thing or a person more often than for a stroke."""
_ADJECTIVES = (
    r"(?:(?!(?:times|of|or|and|to|for|in|at|on|with|seconds?|minutes?|people|kids|children)\b)[a-z'-]+ ){0,2}?"
)
_OF_STROKES = re.compile(rf"{_SEVERAL} (?!{_UNIT}\b){_ADJECTIVES}{_STROKE}\b(?! (?:ago|ahead|away)\b)")
_FORMS = _OF_STROKES, *(
    re.compile(form)
    for form in (
        rf"{_NUMBER} ?(?:times|x)(?! (?:the |as |a |per )?(?:speed|tempo|slower|faster|bigger|larger|size|two|three|five)\b)",
        rf"\b(?:x ?|times )(?P<n>{'|'.join(NUMBERS)})\b(?! ?{_UNIT}\b)",
        rf"\b(?:count|reps|n|repeat|taps|laps|claps|number of \w+) ?[:=]? ?{_NUMBER}(?! ?{_UNIT}\b)",
        r"(?<!\bat )(?<!\bthis )(?<!\bfor )(?<!\bthe )"
        r"\b(?P<n>once(?=$|[,.;:!?]| (?:please|only|and|with|for|to|using|from|slowly|quickly|over|now)\b)|twice|thrice)\b"
        r"(?! (?:more|again|upon|you|he|she|it|that|this|the|i|they|we|in a|as|over,? size|your|a (?:day|week)|with each)\b)",
        rf"{_SEVERAL} of (?:them|those|these|em)\b(?! (?:are|is|all|big|small|old)\b)",
        rf"{_SEVERAL} (?:in (?:all|total|a row)|all (?:up|told)|on the trot|altogether)\b",
        rf"\b{_ASKS} {_SEVERAL}(?=$|[.,;!?]| (?:more|please|from|with|one after)\b)",
        rf"[,:;!?.] (?:just |only |about |exactly |say |that is )?{_SEVERAL}(?: please| more| only| now)?(?=$|[.,;!?])(?!, \d)",
        rf"\b(?P<n>double|triple|quadruple) {_DOUBLE}\b",
        r"\b(?P<n>just one|just 1|only one|just the one|a single|one single|one) (?:(?:last|quick|strong|big|small|final|more) )?"
        r"(?:clap|nod|punch|jab|knock|wave|hook|uppercut|pump|bow|shrug|dab|kiss|tap|chop|salute|blow|hug|slash|shot|arrow)\b",
    )
)  # fmt: skip
_PLACE = re.compile(rf"\b{any_of('stroke_numbers', 'place')} $")
_OTHER = re.compile(rf"\b{any_of('stroke_numbers', 'other')} $")
_DENIED = re.compile(rf"\b{any_of('stroke_numbers', 'denied')} $")
_CORRECTS = re.compile(rf"\b{any_of('stroke_numbers', 'corrects')}\b")
_ANY_NUMBER = re.compile(
    rf"\d|\b(?:{'|'.join(word for word in _VALUES if word.isalpha())}|half|dozen|couple|pair|trio|single)\b"
)
_TIMES = re.compile(r" ?(?:times|x)\b")
_COUNTING = re.compile(rf"[ ,.!]+(?:and )?(?:{'|'.join(NUMBERS)})\b")
"""The next number of somebody who counts: "one, two, three"."""


class _Mention(NamedTuple):
    """A number of strokes and where it stands in its sentence."""

    start: int
    value: int


def with_said_number(reading: Reading) -> Reading:
    """A reading whose one command, a phrase of the corpus, has the number of strokes that the sentence names in the end.

    To which of several commands a number belongs is said by its place alone.
    """
    if [len(step) for step in reading.steps] != [1]:
        return reading
    (command,) = reading.steps[0]
    own = count_asked(command.text)
    number = strokes_said(reading.text) if own is not None or _is_gesture(command.text) else None
    if number in (None, own):
        return reading
    if own is None:
        text = f"{command.text} {number} times" if number > 1 else f"{command.text} once"
    else:
        text = (with_count(command.text, number) if number > 1 else None) or command.text
    return replace(reading, steps=((replace(command, text=text, limbs=limbs_of(text)),),), plain=False)


def strokes_said(sentence: str) -> int | None:
    """The number of strokes that a sentence names; None where it names none, or several that do not correct each other.

    >>> strokes_said("knock with your right five times, oh go on, make it six")
    6
    """
    text = mended(sentence).lower()
    found = _mentions(text)
    if len({one.value for one in found}) == 1:
        return found[0].value
    if len(found) > 1 and _CORRECTS.search(text[found[-2].start : found[-1].start]):
        return found[-1].value
    return None


def _mentions(text: str) -> list[_Mention]:
    if _ANY_NUMBER.search(text) is None:
        return []
    found: dict[int, _Mention] = {}
    for form in _FORMS:
        for match in form.finditer(text):
            start, end = match.span("n")
            before = text[:start]
            counts_strokes = _TIMES.match(text, end) is not None or match.re is _OF_STROKES
            is_other = (
                _OTHER.search(before) is not None
                or (_PLACE.search(before) is not None and not counts_strokes)
                or _COUNTING.match(text, end) is not None
            )
            if not is_other and _DENIED.search(before) is None:
                found.setdefault(start, _Mention(start, _VALUES.get(match["n"], 1)))
    return [found[start] for start in sorted(found)]


def _is_gesture(command: str) -> bool:
    """Whether a command is a phrase of the corpus, the plain command of a gesture, or a verb alone, too short for a phrase."""
    is_verb = " " not in command and is_gesture_verb(command.lower())
    return is_verb or is_known_phrase(command) or gesture_of(command) != ""
