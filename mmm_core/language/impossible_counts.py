"""Numbers of times, and of seconds, that no motion can have.

More than thirty times become thirty, "3.5 times" becomes three, a longer hold than thirty seconds is made that long, and what is
asked for zero times is left out.
"""

from __future__ import annotations

import re
from dataclasses import replace

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import MOST, NUMBERS, count_asked
from mmm_core.language.limbs import is_gesture_verb, limbs_of
from mmm_core.language.manner import LONGEST_HOLD_S

_UNIT = r"(?:one|two|three|four|five|six|seven|eight|nine)"
_TENS = r"(?:forty|fifty|sixty|seventy|eighty|ninety)"
_ANY = rf"(?:{'|'.join(word for word in NUMBERS if word.isalpha())}|{_TENS})"
_LARGE = re.compile(
    rf"\b(?:(?:(?:a|several|many|{_ANY}|\d+) )?(?:hundred|thousand|million)s?\b(?: of)?(?:(?: and)? {_ANY})*|"
    rf"(?:thirty[ -]{_UNIT}|{_TENS}(?:[ -]{_UNIT})?)\b|(?<![-.,\d])\d{{1,3}}(?:,\d{{3}})+|(?<![-.,\d])\d{{2,}})(?![.,]\d)",
    re.IGNORECASE,
)
_ZERO = re.compile(
    rf"(?:\b(?:zero|0|no)|(?:(?<!\w)-|\b(?:minus|negative) )(?:\d+|{_ANY})) times\b|\b(?:0x|x0)\b", re.IGNORECASE
)
"""No number of strokes: "zero times", "-3 times"."""
_BROKEN = re.compile(
    rf"\b(?P<whole>\d+)\.\d+(?P<times> ?(?:times|x)\b)|"
    rf"\b(?P<word>{'|'.join(word for word in NUMBERS if word.isalpha())}) and a half(?P<times_of_word> times)\b",
    re.IGNORECASE,
)
"""A number of times that is not whole: "3.5 times", "two and a half times"."""
_TIMES = re.compile(r" ?(?:times|x)\b", re.IGNORECASE)
_MOST_BEFORE_STROKES = 3
"""Words after a number among which its strokes are, at most: "fifty quick head shakes"."""
_X_BEFORE = re.compile(r"\bx(\d{2,})\b", re.IGNORECASE)
"""A number of times as in "wave x100"."""


def within_counts(reading: Reading) -> Reading:
    """A reading whose commands name thirty whole times and thirty seconds at most, without those that are to be done zero times.

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
    if command.manner.hold_s > LONGEST_HOLD_S:
        notes.append(f"{command.manner.hold_s:g} s of '{command.text}' are more than the most, {LONGEST_HOLD_S:g} s")
        command = replace(command, manner=replace(command.manner, hold_s=LONGEST_HOLD_S))
    if broken := _BROKEN.search(command.text):
        number = broken["word"] or max(int(broken["whole"]), 1)
        whole = f"{number}{broken['times'] or broken['times_of_word']}"
        text = f"{command.text[: broken.start()]}{whole}{command.text[broken.end() :]}"
        notes.append(f"'{broken[0]}' is no whole number: '{text}'")
    elif many := _too_many(command.text):
        said, text = many
        notes.append(f"'{said}' is more than the most, {MOST}: '{text}'")
    else:
        return command
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
        is_small = figures.isdigit() and int(figures) <= MOST
        if not is_small and count_asked(thirty) == MOST and _counts_strokes(text[number.end() :]):
            return number[0], thirty
    return None


def _counts_strokes(after: str) -> bool:
    """Whether a number with these words after it counts strokes: "times", "big nods", but not "singers"."""
    words = after.lower().split()[:_MOST_BEFORE_STROKES]
    return bool(_TIMES.match(after)) or any(is_gesture_verb(word[:-1]) or is_gesture_verb(word[:-2]) for word in words)
