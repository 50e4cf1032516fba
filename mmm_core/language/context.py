"""Texts that refer to the last command: "again", "slower", "with the other hand", "three more", "and now the left".

Their meaning is a pure function of the reading of the last command and the new text. A text refers to the last command if it
consists of phrases of `words/context.txt` alone, or if it omits words that a later clause of one sentence may omit too
(`ellipsis`). Rules and counter-examples: docs/language.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

from mmm_core.language.at_once import is_pose
from mmm_core.language.command_changes import (
    Action,
    NothingToReferToError,
    can_change,
    changed,
    is_for_one_arm,
    to_side,
    with_times,
)
from mmm_core.language.commands import Reading, Steps
from mmm_core.language.corrections import corrected
from mmm_core.language.count_words import ADVERBS, MOST, NUMBERS
from mmm_core.language.delays import read_later
from mmm_core.language.ellipsis import completed
from mmm_core.language.endless import WithoutEnd, read_without_end
from mmm_core.language.multiples import multiple_in
from mmm_core.language.reading import read
from mmm_core.language.requests import everyday
from mmm_core.language.spelling import mended
from mmm_core.language.stop_words import means_stop
from mmm_core.language.word_tables import pairs

MOST_WORDS = 16
"""Largest number of words in a text that refers to the last command."""
MOST_WORDS_OF_ELLIPSIS = 8
"""Largest number of words in a text that omits words of the last command."""
FEW = 3
"""Repetitions of "a few more"."""
_PRONOUN_IS_OBJECT = re.compile(
    r"^(?:and |now |then )*(?!(?:make|do|let|get|try|see|is|was|like|love|want|need)\b)\w+ (?:it|them|(?:that|this) (?:hand|arm))\b"
)
_HAS_PRONOUN = re.compile(r"\b(?:it|them|that|this)\b")
_NUMBER = rf"(?P<number>{'|'.join(NUMBERS)})"
_BETWEEN = re.compile(r"[\s,.;:!?-]+")


@dataclass(frozen=True)
class InContext:
    """The meaning of a text that refers to the last command.

    Attributes:
        reading: commands of the text.
        keeps_going: whether the commands repeat, or the pose is held, until another request ends them.
        times: repetitions of all commands; 0 where the text names no number, or the number stands in the commands' words.
        is_counted: whether the text names a number.
    """

    reading: Reading
    keeps_going: bool = False
    times: int = 0
    is_counted: bool = False

    @property
    def is_pose(self) -> bool:
        """Whether the last step is a pose, which is held instead of repeated."""
        return all(is_pose(c.text) for c in self.reading.steps[-1])


def in_context(text: str, before: Reading | None) -> InContext | None:
    """The meaning of a text after the command `before`; None if the text stands by itself.

    Raises:
        NothingToReferToError: the text refers to an earlier command, but there is none, or it cannot be changed like this.

    >>> in_context("slower, with the other hand", read("wave with your right hand")).reading.sentences
    ('wave with your left hand (0.65 times as fast)',)
    """
    if len(text.split(None, MOST_WORDS)) > MOST_WORDS:
        return None
    said = corrected(mended(text).strip(" .,!?;:"))
    if before is None and everyday(said):
        return None
    actions = _actions(said)
    steps = before.steps if before is not None else ()
    if not actions:
        return _left_out(text, said, steps)
    sides = [a for a in actions if a.name == "side"]
    fits = len(sides) < 2 and is_for_one_arm(steps) and all(can_change(steps, to_side(side.value)) for side in sides)
    if len(sides) == len(actions) and not (steps and fits):
        return None  # "left", by itself
    if any(a.noun and a.noun not in Reading("", steps).words for a in actions):
        return None  # "two more claps" after a wave
    if not steps:
        raise NothingToReferToError(
            f"{text[:60]!r} refers to a command before it, and there is none",
            "a text that stands by itself, or one soon after another on the same connection",
        )
    keeps_going, times = False, 0
    for action in actions:
        if action.name == "keep_going":
            keeps_going = True
        elif action.name == "times":
            steps, times = with_times(steps, int(action.value))
        elif action.name != "again":
            steps = changed(steps, action)
    return InContext(Reading(text, steps), keeps_going, times, any(a.name == "times" for a in actions))


@cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    return tuple(
        (re.compile(rf"(?:{_with_numbers(pattern)})(?![\w'])"), action) for pattern, action in pairs("context")
    )


def _with_numbers(pattern: str) -> str:
    """A pattern of the table in which each N is replaced by a group that matches a number; each group has its own name."""
    parts = pattern.split("N ")
    return parts[0] + "".join(_NUMBER.replace("number", f"n{i}") + " " + part for i, part in enumerate(parts[1:]))


def _actions(said: str) -> list[Action] | None:
    """The actions whose phrases make up a text, without empty ones; None if the text has other words or no action."""
    found: list[Action] = []
    at = 0
    while at < len(said):
        multiple = multiple_in(said, at)
        if multiple is not None and multiple.start == at:
            found.append(
                Action(*("tempo", str(multiple.tempo)) if multiple.tempo != 1 else ("size", str(multiple.size)))
            )
            at = _end_of_gap(said, multiple.end)
            continue
        matches = [(m, action) for pattern, action in _patterns() if (m := pattern.match(said, at))]
        if not matches:
            return None
        best, action = max(matches, key=lambda match: match[0].end())
        if best.end() == at:
            return None
        if action != "nothing":
            found.append(_action(action, best))
        at = _end_of_gap(said, best.end())
    return found or None


def _end_of_gap(said: str, at: int) -> int:
    gap = _BETWEEN.match(said, at)
    return gap.end() if gap else at


def _action(action: str, found: re.Match[str]) -> Action:
    name, _, value = action.partition(" ")
    groups = {key: v for key, v in found.groupdict().items() if v}
    if name == "side":
        value = groups["side"]
    elif name == "most_times":
        name, value = "times", str(MOST)
    elif name == "few_times":
        name, value = "times", str(2 if "couple" in found[0] else FEW)
    elif name == "times":
        noun = groups.pop("noun", "") or groups.pop("one_noun", "")
        word = next(iter(groups.values()))
        value = str(NUMBERS.get(word) or ADVERBS.get(word) or 1)
        return Action(name, value, noun[:4])
    return Action(name, value)


def _left_out(text: str, said: str, steps: Steps) -> InContext | None:
    """The meaning of a text that omits words of the last command: "and up", "salute with the other hand"; None for others."""
    if not steps or len(said.split()) > MOST_WORDS_OF_ELLIPSIS:
        return None
    if _HAS_PRONOUN.search(said) and not _PRONOUN_IS_OBJECT.match(said):
        return None
    bare = re.sub(r"^(?:(?:and|now|then|ok|okay|so|please|but|yes|no)\b[ ,]*)+", "", said)
    whole = completed(bare, steps[-1][-1].text)
    if whole is None or whole == bare:
        return None
    return InContext(replace(read(whole), text=text))


def conversation(
    texts: Sequence[str], reads: Callable[[str], Reading] = read
) -> list[InContext | WithoutEnd | Reading]:
    """The meanings of texts that follow each other on one connection; a text that means to stop has no commands.

    Args:
        texts: the texts in their order.
        reads: reads a text that stands by itself.

    Raises:
        NothingToReferToError: a text refers to an earlier command, but there is none, or it cannot be changed like this.
    """
    meant: list[InContext | WithoutEnd | Reading] = []
    before: Reading | None = None
    for text in texts:
        if means_stop(text):
            meant.append(Reading(text, ()))
            continue
        found = in_context(text, before) or read_later(text, reads) or read_without_end(text, reads) or reads(text)
        meant.append(found)
        now = found if isinstance(found, Reading) else found.reading
        before = now if now.steps else before
    return meant
