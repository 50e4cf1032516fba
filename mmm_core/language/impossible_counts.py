"""Numbers of times that no motion can have: more than thirty become thirty, and what is asked for zero times is left out."""

from __future__ import annotations

import re
from dataclasses import replace

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import MOST, NUMBERS, count_asked
from mmm_core.language.limbs import limbs_of

_UNIT = r"(?:one|two|three|four|five|six|seven|eight|nine)"
_TENS = r"(?:forty|fifty|sixty|seventy|eighty|ninety)"
_ANY = rf"(?:{'|'.join(word for word in NUMBERS if word.isalpha())}|{_TENS})"
_LARGE = re.compile(
    rf"\b(?:(?:(?:a|several|many|{_ANY}|\d+) )?(?:hundred|thousand|million)s?\b(?: of)?(?:(?: and)? {_ANY})*|"
    rf"(?:thirty[ -]{_UNIT}|{_TENS}(?:[ -]{_UNIT})?)\b|(?<![-.,\d])\d{{1,3}}(?:,\d{{3}})+|(?<![-.,\d])\d{{2,}})(?![.,]\d)",
    re.IGNORECASE,
)
_ZERO = re.compile(r"\b(?:(?:zero|0|no) times|0x|x0)\b", re.IGNORECASE)
_X_BEFORE = re.compile(r"\bx(\d{2,})\b", re.IGNORECASE)
"""A number of times as in "wave x100"."""


def within_counts(reading: Reading) -> Reading:
    """A reading whose commands name at most thirty times, without those that are to be done zero times.

    `notes` says what was changed, `denied` names what is left out.
    """
    steps, denied, notes = list[tuple[PlainCommand, ...]](), list(reading.denied), list(reading.notes)
    for step in reading.steps:
        kept = [limited for command in step if (limited := _limited(command, denied, notes)) is not None]
        if kept:
            steps.append(tuple(kept))
    if tuple(steps) == reading.steps:
        return reading
    return replace(reading, steps=tuple(steps), denied=tuple(denied), notes=tuple(notes), plain=False)


def _limited(command: PlainCommand, denied: list[str], notes: list[str]) -> PlainCommand | None:
    """A command with thirty times for more, or None for zero times; adds to `denied` or `notes` what was changed."""
    if zero := _ZERO.search(command.text):
        denied.append(" ".join((command.text[: zero.start()] + command.text[zero.end() :]).split()))
        return None
    many = _too_many(command.text)
    if many is None:
        return command
    said, text = many
    notes.append(f"'{said}' is more than the most, {MOST}: '{text}'")
    return replace(command, text=text, limbs=limbs_of(text))


def _too_many(command: str) -> tuple[str, str] | None:
    """The number above thirty that a command says as its number of times, and the command with thirty in its place.

    >>> _too_many("wave your hand a hundred times")
    ('a hundred', 'wave your hand 30 times')
    """
    text = _X_BEFORE.sub(r"\1 times", command)
    for number in _LARGE.finditer(text):
        figures = number[0].replace(",", "")
        thirty = f"{text[: number.start()]}{MOST}{text[number.end() :]}"
        if not (figures.isdigit() and int(figures) <= MOST) and count_asked(thirty) == MOST:
            return number[0], thirty
    return None
