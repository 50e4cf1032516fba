"""Changes of the last command that a text requests: another hand, direction, tempo, size or number of strokes.

Each change is a pure function of a plain command. Rules and counter-examples: docs/language.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

from mmm_core.errors import MmmError
from mmm_core.language.at_once import is_pose
from mmm_core.language.commands import PlainCommand, Reading, Steps
from mmm_core.language.count_words import NUMBERS, SAID_TIMES
from mmm_core.language.ellipsis import OTHER
from mmm_core.language.inflection import singular
from mmm_core.language.limbs import ARMS, SOME_ARM, limbs_of
from mmm_core.language.manner import FASTEST, LARGEST, Manner

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
_COUNTED_NOUN = re.compile(rf"\b(?:{'|'.join(NUMBERS)}) (?=(?:\w+ )?\w+s\b)")


class NothingToReferToError(MmmError):
    """A text refers to an earlier command, but there is none, or it lacks the property that the text changes."""

    def __init__(self, found: str, allowed: str) -> None:
        self.found, self.allowed = found, allowed
        super().__init__(f"{found}; allowed: {allowed}")


@dataclass(frozen=True)
class Action:
    """One change of the last command: its name, its value, and the stem of a counted noun ("two more nods")."""

    name: str
    value: str = ""
    noun: str = ""


Change = Callable[[PlainCommand], PlainCommand | None]
"""Gives a changed command; None for a command without the property that changes."""


def changed(steps: Steps, action: Action) -> Steps:
    """Apply an action to each command that it can change.

    Raises:
        NothingToReferToError: the action can change none of the commands.
    """
    changes: dict[str, tuple[Change, str]] = {
        "other_hand": (_other_hand, "one hand or arm"),
        "other_way": (_other_way, "a direction"),
        "other": (lambda c: _other_hand(c) or _other_way(c), "a side or a direction"),
        "both": (_with_both, "one hand or arm"),
        "side": (to_side(action.value), "one side"),
        "tempo": (lambda c: _in_manner(c, tempo=float(action.value)), ""),
        "size": (lambda c: _in_manner(c, size=float(action.value)), ""),
        "as_usual": (lambda c: replace(c, manner=Manner(hold_s=c.manner.hold_s)), ""),
    }
    change, has = changes[action.name]
    if not can_change(steps, change) or (action.name in ("both", "side") and not is_for_one_arm(steps)):
        raise NothingToReferToError(f"the last command was {Reading('', steps).words[:60]!r}", f"after one with {has}")
    return tuple(tuple(change(c) or c for c in step) for step in steps)


def can_change(steps: Steps, change: Change) -> bool:
    """Whether the change applies to at least one command."""
    return any(change(c) is not None for step in steps for c in step)


def is_for_one_arm(steps: Steps) -> bool:
    """Whether no step has two commands for arms, so that a command can change its arm."""
    return all(sum(bool(c.limbs & (ARMS | SOME_ARM)) for c in step) < 2 for step in steps)


def _in_words(command: PlainCommand, words: str) -> PlainCommand | None:
    return None if words == command.text else PlainCommand(words, command.manner, limbs_of(words))


def _other_hand(command: PlainCommand) -> PlainCommand | None:
    """The command with the other hand; with the left hand if the command names none, since the right hand is the default."""
    if named := _in_words(command, _HAND_SIDE.sub(lambda m: OTHER[m[0]], command.text)):
        return named
    return _with_hand(command, "left") if command.limbs == SOME_ARM else None


def _other_way(command: PlainCommand) -> PlainCommand | None:
    """The command in the opposite direction; a command without a direction, with the other hand."""
    turned = _WAY.sub(lambda m: _OTHER_WAY[m[0]], command.text)
    return _in_words(command, turned) or (_other_hand(command) if _HAND_SIDE.search(command.text) else None)


def to_side(side: str) -> Change:
    """A change to the hand of a side; for a command of head or trunk, a change to that side."""

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
    return replace(command, manner=replace(manner, tempo=fast, size=large))


def with_times(steps: Steps, times: int) -> tuple[Steps, int]:
    """Steps with the number of strokes in the words of a single command; for several commands, the steps and their repetitions."""
    only = next(c for step in steps for c in step)
    if sum(map(len, steps)) > 1 or is_pose(only.text):
        return steps, times
    number = {1: "once", 2: "twice"}.get(times, f"{_word(times)} times")
    words, n = SAID_TIMES.subn(number, only.text, count=1)
    if not n and (nouns := _COUNTED_NOUN.search(only.text)):  # "give me two nods"
        words, n = f"{only.text[: nouns.start()]}{{N}} {only.text[nouns.end() :]}", 1
        words = singular(words) if times == 1 else words.replace("{N}", _word(times))
    return ((PlainCommand(words if n else f"{only.text} {number}", only.manner, only.limbs),),), 0


def _word(number: int) -> str:
    return next(word for word, n in NUMBERS.items() if n == number)
