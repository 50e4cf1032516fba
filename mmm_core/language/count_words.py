"""The number of repetitions that a text names: "three times", "twice", "two bows" -> 3, 2, 2.

A rule, not a model: numbers are a closed set of words.
"""

from __future__ import annotations

import re

MOST = 30
"""Largest number read as a count; that many strokes take half a minute."""
_WORDS = (
    "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve",
    "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty",
)  # fmt: skip
NUMBERS = {word: i for i, word in enumerate(_WORDS, 1)} | {"thirty": 30} | {str(i): i for i in range(1, MOST + 1)}
"""Number by the word or the digits for it."""
ADVERBS = {"once": 1, "twice": 2, "thrice": 3}
"""Adverbs that name a number of times by themselves."""
TIMES = rf"(?:(?:{'|'.join(NUMBERS)})(?: times?|x)|a single time|{'|'.join(ADVERBS)})\b(?: in a row)?"
"""Pattern of a number of times, for tables."""
SAID_TIMES = re.compile(rf"\b{TIMES}")
"""A number of times in a command in lower case: "three times in a row", "2x", "once"."""
_NUMBER = rf"(?<![-.])(?<!\btwenty )({'|'.join(NUMBERS)})(?! (?:hundred|thousand|one|two|three|four|five|six|seven|eight|nine)\b)"
_NOT_STROKES = (
    "arms?|hands?|fists?|palms?|fingers?|thumbs?|eyes?|ears?|elbows?|shoulders?|wrists?|knees?|legs?|feet|foot|heads?|sides?|"
    "s|secs?|seconds?|minutes?|degrees?|met(?:er|re)s?|cm|inch(?:es)?|people|persons?|kids?|children|guys?|girls?|boys?|men|women|ladies|guests?|fans?|"
    "friends?|students?|pupils?|players?|kilos?|pounds?|euros?|miles?|percent|things?|others?|us|of|or|to|and|"
    "balls|oranges|plates|pins|hours?|days?|weeks?|months?|years?|beats?|heartbeats?|counts?|bars?|measures?"
)
OF_A_LIMB = (
    "bumps|pumps|circles|shakes|rolls|curls|claps|knocks|pats|taps|punches|waves|turns|raises|lifts|tilts|nods|swings|shrugs|"
    "strokes|chops|wobbles"
)
"""Strokes that are named after the limb: "two head shakes"."""
_BETWEEN = "for|with|at|in|on|by|from|your|the|my|his|her|our|then|times?|x"
"""Words that never stand between a number and its strokes."""
_ONCE = re.compile(
    r"(?<!\bat )\b(once(?! more)|twice|thrice)\b(?! (?:again|upon|you|he|she|it|that|this|the|i|they|we)\b)",
    re.IGNORECASE,
)
_SINGLE = re.compile(
    r"\b(?:one time|(?:a|one) single|(?:just|only) one)\b|"
    r"(?<!other )(?<!left )(?<!right )(?<!this )(?<!that )(?<!the )"
    rf"\bone (?:(?!(?:{_NOT_STROKES}|and|with|more|last|after|by|at|in|on)\b)[a-z-]+ ){{0,2}}"
    r"(?:(?:fist|head|arm|karate|high) )?"
    r"(?:bump|pump|shake|five|nod|clap|bow|knock|punch|jab|hook|uppercut|tap|pat|chop|circle|shrug|throw|kiss|dab|salute|facepalm|yawn)\b",
    re.IGNORECASE,
)
_TIMES = re.compile(rf"\b{_NUMBER}\s*(?:times|x)\b", re.IGNORECASE)
_LAST_TIMES = re.compile(
    rf" (?:once|twice|thrice|one time|a single time|[\w-]+ (?:times|x)|(?:{'|'.join(NUMBERS)})(?: of (?:each|them|those))?)$",
    re.IGNORECASE,
)
_THINGS = re.compile(
    r"(?<!\bfor )(?<!\bin )(?<!\bone )(?<!\bhigh )(?<!the )(?<!those )(?<!these )(?<!your )(?<!my )(?<!all )(?<!at )"
    r"(?<!to )(?<!of )(?<!(?<!would )like )(?<!\bon )(?<!\bhad )(?<!\bhas )(?<!\bhave )(?<!\bthan )(?<!\bfrom )(?<!\bbetween )"
    rf"\b{_NUMBER}\s+(?:(?!(?:{_NOT_STROKES})\b(?! (?:{OF_A_LIMB})\b)|(?:{_BETWEEN})\b)[a-z-]+\s+){{0,2}}"
    rf"(?!(?:{_NOT_STROKES})\b)(?:high five|[a-z-]+s)\b",
    re.IGNORECASE,
)


def count_asked(text: str) -> int | None:
    """The number of strokes that a text names; None where it names none, several, or one greater than thirty."""
    text = " ".join(text.split())
    found = {ADVERBS[m[1].lower()] for m in _ONCE.finditer(text)}
    found |= {1} if _SINGLE.search(text) else set()
    found |= {NUMBERS[m[1].lower()] for m in _TIMES.finditer(text)}
    found |= {
        n for m in _THINGS.finditer(text) if (n := NUMBERS[m[1].lower()]) > 1 and not _TIMES.match(text, m.start())
    }
    return found.pop() if len(found) == 1 else None


def with_times(text: str, count: int) -> str:
    """A text that names no number, with a number of times at its end, as plain commands have it.

    >>> with_times("nod your head", 3)
    'nod your head 3 times'
    """
    return f"{text} {count} times" if count > 1 else f"{text} once"


def without_times(text: str) -> str:
    """A text without the number of times at its end.

    >>> without_times("nod your head 3 times")
    'nod your head'
    """
    return _LAST_TIMES.sub("", text)


def with_count(text: str, count: int) -> str | None:
    """`text`, which names strokes by a number above one, with `count` (two or more) of them; None where that cannot be said."""
    found = [*_TIMES.finditer(text), *_THINGS.finditer(text)]
    spans = sorted({m.span(1) for m in found if NUMBERS[m[1].lower()] > 1}, reverse=True)
    for start, end in spans:
        word = str(count) if text[start:end].isdigit() or count > len(_WORDS) else _WORDS[count - 1]
        text = text[:start] + word + text[end:]
    return text if spans and count_asked(text) == count else None
