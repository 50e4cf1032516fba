"""The plain command of a gesture, in words that the model knows well, with the arm and the number that a command names.

`words/plain_gestures.txt` has a command for each gesture of the corpus. "rap on the hatch twice with your left" means "knock", so
its plain command is "knock on the door with your left hand two times".
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from types import MappingProxyType
from typing import NamedTuple

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import count_asked, with_times, without_times
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.limbs import ARMS, limbs_of
from mmm_core.language.word_tables import pairs

OUTSIDE, SEVERAL = "outside", "several"
"""Classes of texts that are no gesture of the corpus: what the robot cannot do, and several gestures."""
_SIDES = {frozenset({"left_arm"}): "left", frozenset({"right_arm"}): "right"}
_SIDE = re.compile(
    r"(?<!all )(?<!just )\b(left|right)\b"
    r"(?!-? ?(?:(?:now|away|here|there|after|before|then|next|up|down|over|on|in|at)\b|$|[,.;!?]))"
)
"""A side that is named without a limb: "a left hook"."""
_LAST_SIDE = re.compile(r"(?<!\bthe )(?<!\byour )(?<!\bto )(?<!\ball )\b(left|right)[.!?]?$")
"""A side at the end, which is the arm of a gesture that has no directions: "uppercut left"."""
_WITH_SIDE = re.compile(
    r"\b(?:with|from|using|by|on) (?:your |the )?(left|right)\b(?! (?:side|ear|eye|knee|shoulder|hip|cheek|foot|leg)\b)"
)
"""A hand that is named without a noun: "two jabs with the left"."""
_ADDS = re.compile(
    r"\b(?:each(?! (?:other|time))|half ?way|all the way(?! a?round)|"
    r"(?:shoulder|waist|hip|chest|head|knee|eye)s?[- ](?:height|high|level)|below|beneath|higher|lower than|low down|down low)\b"
)
"""Words for which a plain command has no place: heights, and numbers for each arm."""
_ADDS_OR_HIGH = re.compile(rf"{_ADDS.pattern}|\b(?:overhead|above|(?:as|up) high)\b")
_IS_HIGH = re.compile(r"\b(?:(?:above|over) your head|(?:look|hold|hands|finger|arms) up)\b")
"""Words of the plain commands of gestures that are high anyway: "make a heart above your head"."""
IN_TURN = re.compile(
    r"\b(?:with alternating (?:hands|arms|fists)|alternat\w*|in turns?|by turns|one after the other)\b"
)
"""Words for arms that take turns."""


SURE, SURE_OF_ALL = 0.75, 0.96
"""Least probability of a gesture for a command to be said in plain words, and for a sentence that was divided to be one command."""
_EVEN = 0.5
SURELY_DENIED = 0.9
"""Least probability that a sentence asks for nothing, for none of its commands to be done."""
_MAY_DENY = re.compile(
    r"\b(?:no|not|nor|neither|never|none|nobody|nothing|nuh|without|but|bar|except|besides|other than|rather|else|only|was|were|"
    r"had|rude|cancel\w*|withdr[ae]w\w*|dropp?ed|scrap\w*|banned|forbidden|prohibited|over|enough|stop\w*|skip\w*|quit\w*|forget|"
    r"leave|refrain|avoid|hold|off|out|dinnae|dont|cant|wont|cut|instead|spare|save|ignore|disregard|resist|drop|ditch|bin|swap|replace|veto\w*|"
    r"denied|refuse\w*|plenty|last thing|put an? (?:sock|cork|lid|pin|stop|end)|zip it)\b|n't\b"
)
"""Words of which a sentence that asks for nothing has one."""


class Meant(NamedTuple):
    """The gesture that a text asks for, its manners, and whether the text denies all.

    Attributes:
        name: the likeliest gesture, or class of texts that are none.
        probability: the probability of that class.
        manners: the probability of each tempo and size (`mmm_core.language.tagged_words.MANNERS`).
        denied: the probability that the text asks for no motion at all.
    """

    name: str
    probability: float
    manners: Mapping[str, float] = MappingProxyType({})
    denied: float = 0.0


@cache
def gestures() -> tuple[str, ...]:
    """The names of all gestures of the corpus, each with its direction: "knock", "look/up left"."""
    return tuple(_plain())


def plain_command(gesture: str, said: str, *, both_arms: bool = False) -> str:
    """The plain command of a gesture with the arm and the number of strokes that `said` names.

    Empty where the plain command cannot say what `said` does: a height, arms in turn, or an arm that the gesture does not have.

    Args:
        gesture: one of `gestures`.
        said: a command, in any words.
        both_arms: whether words that name no arm mean both: "make a muscle pose".
    """
    said = said.lower()
    any_arm, one_arm, with_both, in_turn = _plain()[gesture]
    if (_ADDS if _IS_HIGH.search(any_arm) else _ADDS_OR_HIGH).search(said):
        return ""
    limbs = limbs_of(said)
    side = _SIDES.get(limbs, "")
    if (
        not side
        and one_arm
        and not gesture.endswith(("left", "right"))
        and (named := _SIDE.search(said) or _WITH_SIDE.search(said) or ("/" not in gesture and _LAST_SIDE.search(said)))
    ):
        side = named[1]
    if IN_TURN.search(said):
        command = in_turn
    elif side:
        command = one_arm.replace("{S}", side)
    else:
        command = with_both if (limbs == ARMS or both_arms) and with_both else any_arm
    count = count_asked(said)
    return with_times(command, count) if command and count else command


def family_of(gesture: str) -> str:
    """The family of a gesture: "look" of "look/up left"."""
    return gesture.partition("/")[0]


def sides_of(gesture: str) -> set[str]:
    """The sides to which a gesture goes, "left" or "right": none, or one."""
    return {"left", "right"} & {*gesture.partition("/")[2].split()}


def gesture_of(command: str) -> str:
    """The gesture whose plain command this is, with whatever arm and number of strokes; empty for other words."""
    return _by_command().get(without_times(command), "")


def in_plain_words(reading: Reading, whole: Meant, commands: Mapping[str, Meant]) -> Reading:
    """A reading whose commands are said in plain words where it is likely which gestures they mean.

    Args:
        reading: the sentence as it was read.
        whole: what the whole sentence means.
        commands: what single commands mean, by their words; others stay as they are.
    """
    said = [command for step in reading.steps for command in step]
    doubtful = any(not is_sure_of(commands[command.text]) for command in said if command.text in commands)
    if len(said) > 1 and doubtful and not reading.denied and (one := _plain_words(whole, reading.text, SURE_OF_ALL)):
        manner = next((command.manner for command in said if not command.manner.plain), said[0].manner)
        return replace(reading, steps=((PlainCommand(one, manner, limbs_of(one)),),), plain=False)
    found = {text: words for text, meant in commands.items() if (words := _plain_words(meant, text, SURE))}
    if not found:
        return reading
    steps = tuple(tuple(_said(command, found.get(command.text, "")) for command in step) for step in reading.steps)
    return replace(reading, steps=steps, plain=False)


def said_plainly(reading: Reading, meant: Sequence[Meant]) -> Reading:
    """A reading whose commands are said in plain words where it is likely which gesture each means in its sentence.

    Args:
        reading: the sentence as it was read. Phrases of the corpus are left as they are.
        meant: what each of its commands means in the sentence, in order; none where that is not known.
    """
    if not meant:
        return reading
    of_commands = iter(meant)
    return replace(
        reading, steps=tuple(tuple(in_plain_words_of(c, next(of_commands)) for c in s) for s in reading.steps)
    )


def in_plain_words_of(command: PlainCommand, meant: Meant) -> PlainCommand:
    """A command in plain words of the gesture that it means, if that is likely; phrases of the corpus stay as they are."""
    return command if is_known_phrase(command.text) else plainly_said(command, meant)


def plainly_said(command: PlainCommand, meant: Meant, least: float = SURE, *, both_arms: bool = False) -> PlainCommand:
    """A command in plain words of the gesture that it means, if that is likely; a plain command stays: "box like a champion".

    Args:
        command: the command, be it a phrase of the corpus or not.
        meant: what it means.
        least: least probability of its gesture.
        both_arms: whether a command that names no arm means both.
    """
    words = "" if gesture_of(command.text) else _plain_words(meant, command.text, least, both_arms=both_arms)
    return _said(command, words)


def without_unasked(reading: Reading, meant: Sequence[Meant]) -> Reading:
    """A reading of a sentence that may deny something, in which commands that it does not ask for in all likelihood are denied.

    Args:
        reading: the sentence as it was read.
        meant: what each of its commands means in the sentence, in order; none where that is not known.
    """
    if not meant or not may_deny(reading.text):
        return reading
    of_commands = iter(meant)
    steps = [[(command, not is_surely_outside(next(of_commands))) for command in step] for step in reading.steps]
    denied = [command.text for step in steps for command, is_asked in step if not is_asked]
    kept = (tuple(command for command, is_asked in step if is_asked) for step in steps)
    return replace(reading, steps=tuple(filter(None, kept)), denied=(*reading.denied, *denied)) if denied else reading


def is_likely_outside(meant: Meant) -> bool:
    """Whether words more likely ask for no gesture than for any."""
    return meant.name == OUTSIDE and meant.probability >= _EVEN


def is_surely_outside(meant: Meant) -> bool:
    """Whether words ask for no gesture in all likelihood."""
    return meant.name == OUTSIDE and meant.probability >= SURELY_DENIED


def without_denied_acts(reading: Reading, whole: Meant) -> Reading:
    """A reading of a sentence that asks for no motion in all likelihood, without commands: "everyone but you is to clap"."""
    is_denial = whole.denied >= SURELY_DENIED and may_deny(reading.text)
    if not is_denial or not reading.steps or reading.denied:  # what is denied beside a command was found already
        return reading
    acts = tuple(command.text for step in reading.steps for command in step)
    return replace(reading, steps=(), denied=acts, plain=False)


def alternates(reading: Reading) -> bool:
    """Whether a reading is one command of arms in turn: "party with your arms left and right in turn"."""
    said = [command.text for step in reading.steps for command in step]
    return len(said) == 1 and IN_TURN.search(said[0]) is not None


def may_deny(text: str) -> bool:
    """Whether a text has a word of a denial."""
    return _MAY_DENY.search(text.lower()) is not None


def is_gesture(name: str) -> bool:
    """Whether a class is a gesture of the corpus."""
    return name in _plain()


def is_sure_of(meant: Meant) -> bool:
    """Whether a gesture is likely enough for its plain command."""
    return meant.probability >= SURE and is_gesture(meant.name)


def _plain_words(meant: Meant, said: str, least: float, *, both_arms: bool = False) -> str:
    is_likely = meant.probability >= least and is_gesture(meant.name)
    return plain_command(meant.name, said, both_arms=both_arms) if is_likely else ""


def _said(command: PlainCommand, words: str) -> PlainCommand:
    return replace(command, text=words, limbs=limbs_of(words)) if words else command


@cache
def _by_command() -> dict[str, str]:
    """Maps plain commands to their gestures."""
    return {
        command.replace("{S}", side): gesture
        for gesture, said in _plain().items()
        for command in said
        for side in ("left", "right")
        if command
    }


@cache
def _plain() -> dict[str, tuple[str, str, str, str]]:
    """Maps each gesture to its four plain commands: for any arm, one arm, both arms, and arms in turn; missing ones are empty."""
    found: dict[str, tuple[str, str, str, str]] = {}
    for gesture, said in pairs("plain_gestures"):
        any_arm, one_arm, both_arms, in_turn, *_ = [*(part.strip() for part in said.split("|")), "", "", ""]
        found[gesture] = any_arm, one_arm, both_arms, in_turn
    return found
