"""What a text means after another command: "again", "slower", "with the other hand", "three more", "and now the left".

A pure function of the last command as it was read and the new text. A text refers to the last command where it consists of the
phrases of `words/context.txt` alone, or where it leaves out what a clause of one sentence may leave out too (`ellipsis`).
Rules and counter-examples: docs/language.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

from mmm_core.errors import MmmError
from mmm_core.language.at_once import is_pose
from mmm_core.language.commands import PlainCommand, Reading, Steps
from mmm_core.language.corrections import corrected
from mmm_core.language.count_words import ADVERBS, NUMBERS
from mmm_core.language.ellipsis import OTHER, completed
from mmm_core.language.inflection import singular
from mmm_core.language.limbs import ARMS, SOME_ARM, limbs_of
from mmm_core.language.manner import FASTEST, LARGEST, Manner
from mmm_core.language.reading import read
from mmm_core.language.requests import everyday
from mmm_core.language.spelling import mended
from mmm_core.language.word_tables import pairs

MOST_WORDS = 16
"""Most words of a text that refers to the last command."""
MOST_WORDS_OF_ELLIPSIS = 8
FEW = 3
"""Times of "a few more"."""
_LIMB = r"(?:hands?|arms?|fists?|palms?|fingers?|thumbs?|elbows?)"
_HAND_SIDE = re.compile(
    rf"\b(left|right)\b(?=[- ](?:handed\b|{_LIMB}\b|index))|(?<=with your )(?:left|right)\b(?! side)"
)
_WAY = re.compile(
    rf"\b(?:(?:left|right)\b(?![- ](?:handed\b|{_LIMB}\b|index))|up|down|forwards?|back(?:wards?)?|upwards?|downwards?)\b"
)
_OTHER_WAY = OTHER | {"backward": "forward", "backwards": "forward", "upwards": "downwards", "downwards": "upwards"} | {
    "upward": "downward", "downward": "upward"}  # fmt: skip
_ONE_ARM = re.compile(
    r"\b(?:(?:your|the|a|one) )?(?:(?:left|right) )?(?P<limb>hand|arm|fist|palm)\b(?! ?shake)", re.IGNORECASE
)
_SAID_TIMES = re.compile(
    rf"\b(?:(?:{'|'.join(NUMBERS)})(?: times|x)|{'|'.join(ADVERBS)}|(?:one|a single) time)\b(?: in a row)?"
)
_PRONOUN_IS_OBJECT = re.compile(
    r"^(?:and |now |then )*(?!(?:make|do|let|get|try|see|is|was|like|love|want|need)\b)\w+ (?:it|them|(?:that|this) (?:hand|arm))\b"
)
_HAS_PRONOUN = re.compile(r"\b(?:it|them|that|this)\b")
_NUMBER = rf"(?P<number>{'|'.join(NUMBERS)})"
_COUNTED_NOUN = re.compile(rf"\b(?:{'|'.join(NUMBERS)}) (?=(?:\w+ )?\w+s\b)")
_BETWEEN = re.compile(r"[\s,.;:!?-]+")


class NothingToReferToError(MmmError):
    """A text refers to a command that is not there, or that has nothing of what the text wants changed."""

    def __init__(self, found: str, allowed: str) -> None:
        self.found, self.allowed = found, allowed
        super().__init__(f"{found}; allowed: {allowed}")


@dataclass(frozen=True)
class InContext:
    """What a text means that refers to the last command.

    Attributes:
        reading: its commands.
        keeps_going: whether they are to go round until something ends them; a pose is to be held.
        times: how often the whole is to be done; 0 where the text does not say, or its number is in the commands' words.
        is_counted: whether the text names a number.
    """

    reading: Reading
    keeps_going: bool = False
    times: int = 0
    is_counted: bool = False

    @property
    def is_pose(self) -> bool:
        """Whether all that is left at its end is a pose, which is kept and not repeated."""
        return all(is_pose(c.text) for c in self.reading.steps[-1])


def in_context(text: str, before: Reading | None) -> InContext | None:
    """What a text means after the command that was read as `before`; None where it stands by itself.

    Raises:
        NothingToReferToError: it refers to a command, and there is none, or none that can be changed so.

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
    fits = len(sides) < 2 and _is_for_one_arm(steps) and all(_can(steps, _to_side(side.value)) for side in sides)
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
            steps, times = _times(steps, int(action.value))
        elif action.name != "again":
            steps = _changed(steps, action)
    return InContext(Reading(text, steps), keeps_going, times, any(a.name == "times" for a in actions))


@dataclass(frozen=True)
class _Action:
    """One thing to do with the last command, by how much, and the stem of the noun that is counted: "two more nods"."""

    name: str
    value: str = ""
    noun: str = ""


@cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    return tuple(
        (re.compile(rf"(?:{_with_numbers(pattern)})(?![\w'])"), action) for pattern, action in pairs("context")
    )


def _with_numbers(pattern: str) -> str:
    """A pattern of the table with its numbers; each stands in a group of its own name."""
    parts = pattern.split("N ")
    return parts[0] + "".join(_NUMBER.replace("number", f"n{i}") + " " + part for i, part in enumerate(parts[1:]))


def _actions(said: str) -> list[_Action] | None:
    """The actions that a text consists of, without those that do nothing; None where it consists of anything else."""
    found: list[_Action] = []
    at = 0
    while at < len(said):
        matches = [(m, action) for pattern, action in _patterns() if (m := pattern.match(said, at))]
        if not matches:
            return None
        best, action = max(matches, key=lambda match: match[0].end())
        if best.end() == at:
            return None
        if action != "nothing":
            found.append(_action(action, best))
        gap = _BETWEEN.match(said, best.end())
        at = gap.end() if gap else best.end()
    return found or None


def _action(action: str, found: re.Match[str]) -> _Action:
    name, _, value = action.partition(" ")
    groups = {key: v for key, v in found.groupdict().items() if v}
    if name == "side":
        value = groups["side"]
    elif name == "few_times":
        name, value = "times", str(2 if "couple" in found[0] else FEW)
    elif name == "times":
        noun = groups.pop("noun", "") or groups.pop("one_noun", "")
        word = next(iter(groups.values()))
        value = str(NUMBERS.get(word) or ADVERBS.get(word) or 1)
        return _Action(name, value, noun[:4])
    return _Action(name, value)


Change = Callable[[PlainCommand], PlainCommand | None]
"""A command, changed; None where it has nothing of the kind."""


def _changed(steps: Steps, action: _Action) -> Steps:
    """Each command changed that can be.

    Raises:
        NothingToReferToError: none can.
    """
    changes: dict[str, tuple[Change, str]] = {
        "other_hand": (_other_hand, "one hand or arm"),
        "other_way": (_other_way, "a direction"),
        "other": (lambda c: _other_hand(c) or _other_way(c), "a side or a direction"),
        "both": (_with_both, "one hand or arm"),
        "side": (_to_side(action.value), "one side"),
        "tempo": (lambda c: _in_manner(c, tempo=float(action.value)), ""),
        "size": (lambda c: _in_manner(c, size=float(action.value)), ""),
        "as_usual": (lambda c: replace(c, manner=Manner(hold_s=c.manner.hold_s)), ""),
    }
    change, has = changes[action.name]
    if not _can(steps, change) or (action.name in ("both", "side") and not _is_for_one_arm(steps)):
        raise NothingToReferToError(f"the last command was {Reading('', steps).words[:60]!r}", f"after one with {has}")
    return tuple(tuple(change(c) or c for c in step) for step in steps)


def _can(steps: Steps, change: Change) -> bool:
    return any(change(c) is not None for step in steps for c in step)


def _is_for_one_arm(steps: Steps) -> bool:
    """Whether no step has a command for either arm, so that one of them can change."""
    return all(sum(bool(c.limbs & (ARMS | SOME_ARM)) for c in step) < 2 for step in steps)


def _in_words(command: PlainCommand, words: str) -> PlainCommand | None:
    return None if words == command.text else PlainCommand(words, command.manner, limbs_of(words))


def _other_hand(command: PlainCommand) -> PlainCommand | None:
    """With the other hand; with the left one where none is named, as the right one is the usual one."""
    if named := _in_words(command, _HAND_SIDE.sub(lambda m: OTHER[m[0]], command.text)):
        return named
    return _with_hand(command, "left") if command.limbs == SOME_ARM else None


def _other_way(command: PlainCommand) -> PlainCommand | None:
    """In the other direction; a command without a direction, with the other hand."""
    turned = _WAY.sub(lambda m: _OTHER_WAY[m[0]], command.text)
    return _in_words(command, turned) or (_other_hand(command) if _HAND_SIDE.search(command.text) else None)


def _to_side(side: str) -> Change:
    """With a hand; a command of head or trunk, to a side."""

    def change(command: PlainCommand) -> PlainCommand | None:
        if _HAND_SIDE.search(command.text):
            return PlainCommand(words := _HAND_SIDE.sub(side, command.text), command.manner, limbs_of(words))
        if command.limbs == SOME_ARM and not re.search(r"\b(?:left|right)\b", command.text):
            return _with_hand(command, side)
        if not re.search(r"\b(?:left|right)\b", command.text):
            return None
        words = re.sub(r"\b(?:left|right)\b", side, command.text)
        return PlainCommand(words, command.manner, limbs_of(words))

    return change


def _with_hand(command: PlainCommand, side: str) -> PlainCommand | None:
    limb = _ONE_ARM.search(command.text)
    if limb is None:
        return _in_words(command, f"{command.text} with your {side} hand")
    return _in_words(command, f"{command.text[: limb.start()]}your {side} {limb['limb']}{command.text[limb.end() :]}")


def _with_both(command: PlainCommand) -> PlainCommand | None:
    if command.limbs == ARMS:
        return command
    if not command.limbs & (ARMS | SOME_ARM):
        return None
    words, n = _ONE_ARM.subn(lambda m: f"both {m['limb']}s", command.text, count=1)
    return _in_words(command, words if n else f"{command.text} with both hands")


def _in_manner(command: PlainCommand, *, tempo: float = 1.0, size: float = 1.0) -> PlainCommand:
    manner = command.manner
    fast, large = manner.tempo * tempo, manner.size * size
    fast, large = min(FASTEST, max(1 / FASTEST, fast)), min(LARGEST, max(1 / LARGEST, large))
    return replace(command, manner=Manner(fast, large, manner.hold_s))


def _times(steps: Steps, times: int) -> tuple[Steps, int]:
    """Steps of which there are so many strokes; where there are several commands the whole is done so often."""
    only = next(c for step in steps for c in step)
    if sum(map(len, steps)) > 1 or is_pose(only.text):
        return steps, times
    number = {1: "once", 2: "twice"}.get(times, f"{_word(times)} times")
    words, n = _SAID_TIMES.subn(number, only.text, count=1)
    if not n and (nouns := _COUNTED_NOUN.search(only.text)):  # "give me two nods"
        words, n = f"{only.text[: nouns.start()]}{{N}} {only.text[nouns.end() :]}", 1
        words = singular(words) if times == 1 else words.replace("{N}", _word(times))
    return ((PlainCommand(words if n else f"{only.text} {number}", only.manner, only.limbs),),), 0


def _word(number: int) -> str:
    return next(word for word, n in NUMBERS.items() if n == number)


def _left_out(text: str, said: str, steps: Steps) -> InContext | None:
    """A text that leaves out what the last command said: "and up", "wave it", "salute with the other hand"; None for others."""
    if not steps or len(said.split()) > MOST_WORDS_OF_ELLIPSIS:
        return None
    if _HAS_PRONOUN.search(said) and not _PRONOUN_IS_OBJECT.match(said):
        return None
    bare = re.sub(r"^(?:(?:and|now|then|ok|okay|so|please|but|yes|no)\b[ ,]*)+", "", said)
    whole = completed(bare, steps[-1][-1].text)
    if whole is None or whole == bare:
        return None
    return InContext(replace(read(whole), text=text))


def conversation(texts: Sequence[str]) -> list[InContext | Reading]:
    """What each of several texts means that follow each other on one connection.

    Raises:
        NothingToReferToError: the first refers to a command before it, or a later one to what is not there.
    """
    meant: list[InContext | Reading] = []
    before: Reading | None = None
    for text in texts:
        found = in_context(text, before) or read(text)
        meant.append(found)
        now = found.reading if isinstance(found, InContext) else found
        before = now if now.steps else before
    return meant
