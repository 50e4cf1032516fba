"""Texts that say when to begin: "in ten seconds, clap", "wait five seconds, then wave", "bow after 3 seconds".

"Clap in five seconds" may mean a length as well, and is none of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from mmm_core.language.commands import EXACTLY, Reading
from mmm_core.language.count_words import NUMBERS
from mmm_core.language.reading import read
from mmm_core.language.spelling import mended

LONGEST_DELAY_S = 40.0
"""Longest time that a text may wait; a client that waits for the end of its motion gives up after a minute."""
MOST_WORDS = 60
"""Words of a text that is looked at, at most."""
_SECONDS = {**NUMBERS, "a": 1, "a couple of": 2, "a few": 3, "half a": 0.5}
_NUMBER = "|".join(re.escape(word) for word in sorted(_SECONDS, key=len, reverse=True)) + r"|\d+(?:\.\d+)?"
_TIME = rf"(?:about |exactly )?(?P<n>{_NUMBER}) ?(?P<unit>seconds?|secs?|s|minutes?|mins?)"
_LATER = _TIME.replace("P<n>", "P<m>").replace("P<unit>", "P<units>")
_COURTESY = r"(?P<before>(?:(?:please|now|ok|okay|so|can you|could you|would you)[ ,]+)*)"
_FORMS = (
    re.compile(rf"{_COURTESY}(?:in|after) {_TIME}(?: from now)?[,:]? (?:then )?(?!of\b|time\b)(?P<rest>\w.+)"),
    re.compile(rf"{_COURTESY}wait(?: for)? {_TIME},? (?:and then|then|and|before you) (?P<rest>\w.+)"),
    re.compile(rf"(?P<before>)(?P<rest>\w.+?),? (?:in {_TIME} from now|after {_LATER})"),
)


class Delayed(NamedTuple):
    """What a text asks for, and seconds until it begins."""

    text: str
    delay_s: float


def delayed(text: str) -> Delayed | None:
    """What a text asks for later; None for other texts, and for longer than `LONGEST_DELAY_S`.

    >>> delayed("In ten seconds, clap."), delayed("wait 5 seconds and then wave"), delayed("wave for ten seconds")
    (Delayed(text='clap', delay_s=10.0), Delayed(text='wave', delay_s=5.0), None)
    """
    if text.startswith(EXACTLY) or len(text.split(None, MOST_WORDS)) > MOST_WORDS:
        return None
    said = mended(text).strip(" .!")
    found = next(filter(None, (form.fullmatch(said) for form in _FORMS)), None)
    if found is None:
        return None
    groups = found.groupdict()
    number, unit = groups["n"] or groups.get("m", ""), groups["unit"] or groups.get("units", "")
    seconds = float(_SECONDS[number] if number in _SECONDS else number) * (60 if unit.startswith("min") else 1)
    if found.re is _FORMS[-1] and len(read(found["rest"]).steps) != 1:  # "raise your arm and lower it after 3 seconds"
        return None
    return Delayed(f"{found['before']}{found['rest']}", seconds) if 0 < seconds <= LONGEST_DELAY_S else None


def read_later(text: str, reads: Callable[[str], Reading]) -> Reading | None:
    """The reading of a text that says when to begin, by `reads`, with a note of the time; None for other texts."""
    found = delayed(text)
    if found is None:
        return None
    reading = reads(found.text)
    return replace(reading, text=text, notes=(*reading.notes, f"begins {found.delay_s:g} s later"), plain=False)
