"""Texts that ask for a motion without end: "keep waving", "wave until I say stop", "nod non-stop", "keep your arms up".

Such a motion goes round, or its pose is held, until another request ends it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

from mmm_core.language.at_once import is_pose
from mmm_core.language.commands import EXACTLY, Reading
from mmm_core.language.completed_at_once import imperative
from mmm_core.language.count_words import count_asked
from mmm_core.language.reading import read
from mmm_core.language.spelling import mended
from mmm_core.language.whole_gestures import has_strokes

MOST_WORDS = 24
"""Words of a text that is looked at, at most: a hostile one of hundreds would take a third of a second."""
_COURTESY = r"(?P<courtesy>(?:(?:please|now|just|and|then|ok|okay|so|(?:can|could|would|will) you|i want you to|you should)[ ,]+)*)"
_GOES_ON = re.compile(
    rf"{_COURTESY}(?:keep(?: on)?|continue|carry on|go on|(?:do not|never) (?:stop|quit|cease)) (?P<act>\w+ing\b.*)"
)
_LIMB = r"(?:hands?|arms?|fists?|palms?|elbows?|head|chin|eyes|upper body|body)"
_KEEPS = re.compile(rf"{_COURTESY}keep (?:(?:your|both|the) )+(?:left |right )?{_LIMB} .+")
_NO_END = (
    r"(?:keep going|keep at it|keep it up|keep (?:on )?doing (?:it|that|this|so)|do not (?:ever )?stop|never stop|"
    r"without (?:ever )?stopping|without (?:a |any )?(?:pauses?|breaks?|end)|non-?stop|continuously|constantly|endlessly|"
    r"forever|for ever|indefinitely|on repeat|over and over again|again and again|on and on)"
)
"""Not "move your hand in a loop", "roll your arms over and over" and "wave, go on", which say how, or spur on."""
_UNTIL = (
    r"(?:until|till|til) (?:i (?:say|tell|ask|order|signal|shout|call|give|stop|interrupt)\b|"
    r"(?:i am|i'm|we are|we're) (?:done|back|ready)\b|you (?:are|get|hear)\b(?! (?:up|down|tired|there))|told\b|further notice|"
    r"the next (?:command|order|instruction)|(?:someone|somebody|anyone|anybody|he|she|we|they) (?:says?|tells?|stops?|asks?)\b)"
    r"[^,.;!?]*"
)
_ENDING = r"(?:,? (?:please|now))?[.!]*$"
_AT_END = re.compile(rf"[,;.]? (?:and |but |just )*(?:{_NO_END}(?:,? {_UNTIL})?|{_UNTIL}){_ENDING}")
_STAYS = re.compile(
    r"[,;.]? (?:and )?(?:then )?(?:(?:just )?(?:keep|hold|leave) (?:it|them|that|this)"
    r"(?: (?:up|down|out|there|still|like (?:that|this)|in place|in the air|that way|pose|position))?|"
    rf"(?:stay|remain|freeze) (?:there|like (?:that|this)|in (?:that|this) (?:pose|position)))(?:,? {_UNTIL})?{_ENDING}"
)
"""A pose that lasts: "raise your arms and keep them up"."""
_BESIDE = re.compile(r"\b(?:as|meanwhile|and|while(?! (?:i|we|he|she|they|the|my|our)\b))\b")
"""Words beside a motion that lasts as long as another one: "keep nodding while you drum"."""
_TO_AND_FRO = re.compile(
    r"\b(?:left and right|right and left|up and down|back and forth|side to side|to and fro|round)\b"
)
_BENDS = re.compile(r"\b(?:bow|shrug)\b")
"""A gesture with strokes that is held all the same where that is said: "bow and hold it there"."""


class Endless(NamedTuple):
    """A motion without end.

    Attributes:
        text: what it is, in words without those for its length.
        is_pose: whether it is held instead of going round.
    """

    text: str
    is_pose: bool


@dataclass(frozen=True)
class WithoutEnd:
    """The reading of a text that asks for a motion without end, and whether its pose is held instead of going round."""

    reading: Reading
    is_pose: bool


def read_without_end(text: str, reads: Callable[[str], Reading]) -> WithoutEnd | None:
    """The reading of a text that asks for a motion without end, by `reads`; None for other texts."""
    found = endless(text)
    return None if found is None else WithoutEnd(replace(reads(found.text), text=text, plain=False), found.is_pose)


def endless(text: str) -> Endless | None:
    """What a text asks for without end; None for other texts, for several commands in turn, and where it names a number or seconds.

    >>> endless("Please keep waving until I say stop."), endless("keep your arms up"), endless("keep nodding, then bow")
    (Endless(text='please wave', is_pose=False), Endless(text='keep your arms up', is_pose=True), None)
    """
    if text.startswith(EXACTLY) or len(text.split(None, MOST_WORDS)) > MOST_WORDS:
        return None
    said = mended(text).strip(" .!")
    stays = _STAYS.search(said)
    rest = said[: stays.start()] if stays else _AT_END.sub("", said)
    says_the_end = rest != said
    if act := _GOES_ON.fullmatch(rest):
        rest = f"{act['courtesy']}{imperative(act['act'])}"
    elif rest == said and not _KEEPS.fullmatch(rest):
        return None
    reading = read(rest)
    if reading.denied or len(reading.steps) != 1:
        return None
    (commands,) = reading.steps
    if not says_the_end and (len(commands) > 1 or _BESIDE.search(rest)):
        return None
    if any(command.manner.hold_s or count_asked(command.text) for command in commands):
        return None
    is_held = all(_can_be_held(command.text, bool(stays)) for command in commands)
    goes_round = rest != said and not stays
    return Endless(rest, is_held) if is_held or goes_round else None


def _can_be_held(command: str, stays: bool) -> bool:
    """Whether a command has a pose that lasts; of gestures that have none by themselves a text may say that they stay."""
    if _BENDS.search(command):
        return stays
    return (stays or is_pose(command)) and not has_strokes(command) and _TO_AND_FRO.search(command) is None
