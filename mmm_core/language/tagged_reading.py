"""Reads a sentence with the help of tags: they divide it into commands, the rules read each command.

Rules alone (`mmm_core.language.reading`) divide sentences in phrasings that their tables have; a tagger learnt it from sentences of
many writers. Each command that the tags mark is completed with the words that it omits and read by the rules, or said in the plain
words of the gesture that it means in its sentence.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import chain, pairwise

from mmm_core.language.clause_patterns import LIMB_FIRST
from mmm_core.language.commands import MOST_AT_ONCE, MOST_STEPS, PlainCommand, Reading
from mmm_core.language.completed_at_once import beside_each_other
from mmm_core.language.denial import denied_side, with_other_side
from mmm_core.language.ellipsis import OTHER, completed
from mmm_core.language.limbs import begins_with_a_verb
from mmm_core.language.one_arm import of_one_arm
from mmm_core.language.plain_gestures import (
    Meant,
    said_plainly,
    without_unasked,
)
from mmm_core.language.reading import command_of, read
from mmm_core.language.requests import without_request
from mmm_core.language.spelling import mended
from mmm_core.language.tagged_words import BEFORE, BEGINS, INSIDE, THEN, WITH, MarkedCommands, words_of

_AND = re.compile(r"\band\b ?")
_SIDE_AND_WAY = re.compile(
    r"(?:and |your |the )*(?P<side>left|right|other)(?: one)? "
    r"(?P<way>(?:up|down|out|forwards?|backwards?|back|in|on|at|behind|over|to|by|across|overhead|sideways|straight|high|low)\b.*)"
)
_SIDED_LIMB = re.compile(
    r"(?P<your>\b(?:your|the) )?\b(?P<side>left|right) (?P<limb>hand|arm|fist|palm|elbow|wrist|shoulder|thumb)\b"
)
_HAND_BEFORE = re.compile(
    r"(?:and )?(?:with )?(?:the |your )?(?:left|right)(?: (?:hand|arm))?,? (?:you(?: are|'re|'ll| will)? )?"
)
_IS_LEFT_OVER = re.compile(r"(?:,? (?:with|and|while|as|then|but|so))+$")
"""Words at the end of a command that belong to the one after it."""
_ALL = re.compile(r"^(?:all(?: of (?:it|them|that))?|both|everything|each)\b ?")


def reading_of(text: str, marked: MarkedCommands, meant: Sequence[Meant] = ()) -> Reading:
    """The marked commands of a text, each completed and read by the rules or said as it is meant.

    Args:
        text: the sentence.
        marked: its commands.
        meant: the gestures that they mean in their sentence, in the order of the steps; none where that is not known.
    """
    return without_unasked(said_plainly(_completed(text, marked), meant), meant)


def can_be_read(marked: MarkedCommands) -> bool:
    """Whether there are commands or denials, and no more steps and commands at once than a text may have."""
    sizes = [len(step) for step in marked.steps]
    return bool(sizes or marked.denied) and len(sizes) <= MOST_STEPS and max(sizes, default=0) <= MOST_AT_ONCE


def without_splits(text: str, tags: Sequence[str]) -> list[str]:
    """Tags in which a command that follows another one without any word between begins with the verb of a gesture.

    Such a beginning is more often an error of the tagger ("shrug | your shoulders") than a list without marks ("nod shrug wave").
    """
    found, spans = _with_hands(text, tags), words_of(text)
    for i, ((start, _end), (before, tag)) in enumerate(zip(spans[1:], pairwise(tags), strict=True), 1):
        follows = before == INSIDE or before in BEGINS
        if follows and tag in (THEN, WITH, BEFORE) and not begins_with_a_verb(text[start:].lower()):
            found[i] = INSIDE
    return found


def _with_hands(text: str, tags: Sequence[str]) -> list[str]:
    """Tags in which a hand alone belongs to the command after it: "with the left | you hold a cup"."""
    found, spans = list(tags), words_of(text)
    begins = [i for i, tag in enumerate(tags) if tag in BEGINS]
    for i, k in pairwise(begins):
        if _HAND_BEFORE.fullmatch(text[spans[i][0] : spans[k][0]].lower()):
            found[i + 1 : k + 1] = [INSIDE] * (k - i)
    return found


def _completed(text: str, marked: MarkedCommands) -> Reading:
    for_all = _AND.sub("", " ".join(_ALL.sub("", _plain(words)) for words in marked.for_all))
    verb_of_all = begins_with_a_verb(for_all)
    steps: list[list[str]] = []
    before = ""
    for step in marked.steps:
        commands: list[str] = []
        for words in step:
            said = _IS_LEFT_OVER.sub("", without_request(_plain(words)))
            if verb_of_all and not (begins_with_a_verb(said) or LIMB_FIRST.match(said)):
                said = f"{for_all} {said}"
            before = (_of_the_other_limb(said, before) or completed(said, before) or said) if before else said
            commands.append(before)
        steps.append(beside_each_other(commands) if len(commands) > 1 else commands)
    beside = f" {for_all}" if for_all and not verb_of_all else ""
    side = next(filter(None, (denied_side(_plain(what)) for what in marked.denied)), "")
    with_arms = iter(of_one_arm([with_other_side(c + beside, side) for c in chain.from_iterable(steps)]))
    return Reading(text, tuple(tuple(_one_command(next(with_arms)) for _ in step) for step in steps), marked.denied)


def _plain(words: str) -> str:
    return mended(words).strip(" ,.!?;:")


def _of_the_other_limb(said: str, before: str) -> str:
    """A command that names a side and a way alone, with verb and limb of the command before: "the left one back"; else empty."""
    found, last = _SIDE_AND_WAY.fullmatch(said), _SIDED_LIMB.search(before)
    if found is None or last is None:
        return ""
    side = found["side"] if found["side"] != "other" else OTHER[last["side"]]
    return f"{before[: last.start()]}{last['your'] or ''}{side} {last['limb']} {found['way']}"


def _one_command(words: str) -> PlainCommand:
    """The command of words that the tags hold to be one command."""
    steps = read(words).steps
    return steps[0][0] if [len(step) for step in steps] == [1] else command_of(words)
