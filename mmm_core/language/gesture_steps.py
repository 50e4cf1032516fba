"""Describes what a sentence asks for as gestures with their arms, step by step, and as the tokens of the sentence parser.

"raise your left hand and nod, then bow" is `((left raise, nod), (bow))`; its tokens are: then, left, raise, with, any, nod, then,
any, bow, end.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import islice, permutations, product
from typing import NamedTuple

from mmm_core.language.count_words import without_times
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.plain_gestures import OUTSIDE, gestures, plain_command

THEN, WITH, START, END = "then", "with", "start", "end"
ANY_ARM, LEFT, RIGHT, BOTH, IN_TURN = ARMS = ("any", "left", "right", "both", "in turn")
_SAID = {LEFT: "left hand", RIGHT: "right hand", BOTH: "both hands", IN_TURN: "alternating hands"}
_OTHER_ARM = {LEFT: RIGHT, RIGHT: LEFT}


class ArmGesture(NamedTuple):
    """A gesture of the corpus, or the class of texts that are none, and the arm that is named: one of `ARMS`."""

    arm: str
    gesture: str


GestureSteps = tuple[tuple[ArmGesture, ...], ...]
"""Steps in order; each holds what is done at the same time."""
NO_GESTURE: GestureSteps = ((ArmGesture(ANY_ARM, OUTSIDE),),)
"""The steps of a sentence that asks for no gesture of the corpus."""


@cache
def tokens() -> tuple[str, ...]:
    """All tokens; the first four are START, END, THEN and WITH, then come the arms, then the gestures and OUTSIDE."""
    return (START, END, THEN, WITH, *(f"arm {arm}" for arm in ARMS), *gestures(), OUTSIDE)


@cache
def _numbers() -> dict[str, int]:
    return {token: i for i, token in enumerate(tokens())}


def token_ids(steps: GestureSteps) -> list[int]:
    """The numbers of the tokens of steps, with START and END: three for each gesture."""
    number, found = _numbers(), [START]
    for step in steps:
        for i, (arm, gesture) in enumerate(step):
            found += [WITH if i else THEN, f"arm {arm}", gesture]
    return [number[token] for token in (*found, END)]


def steps_of(ids: Sequence[int]) -> GestureSteps | None:
    """The steps of tokens without START and END; None for tokens in an order that `token_ids` never gives."""
    names = [tokens()[i] for i in ids]
    steps: list[list[ArmGesture]] = []
    for i in range(0, len(names), 3):
        relation, arm, gesture = [*names[i : i + 3], "", ""][:3]
        one = ArmGesture(arm.removeprefix("arm "), gesture)
        if not arm.startswith("arm ") or (gesture not in gestures() and gesture != OUTSIDE):
            return None
        if relation == THEN:
            steps.append([one])
        elif relation == WITH and steps:
            steps[-1].append(one)
        else:
            return None
    return tuple(map(tuple, steps))


def arm_of(said: str, gesture: str) -> str:
    """The arm that words name for a gesture: one of `ARMS`; `ANY_ARM` also where the gesture leaves no choice."""
    if gesture == OUTSIDE:
        return ANY_ARM
    return _arms(gesture).get(without_times(plain_command(gesture, said)), ANY_ARM)


def with_own_arm(one: ArmGesture) -> ArmGesture:
    """A gesture with its arm, or without where the plain commands of the gesture leave no choice."""
    return one if one.gesture != OUTSIDE and one.arm in _arms(one.gesture).values() else one._replace(arm=ANY_ARM)


def plainly(one: ArmGesture) -> str:
    """The plain command of a gesture with its arm; empty where there is none."""
    return plain_command(one.gesture, _SAID.get(one.arm, "")) if one.gesture != OUTSIDE else ""


def in_every_order(steps: GestureSteps, most: int = 12) -> list[GestureSteps]:
    """The steps with what is done at the same time in every order, `most` of them at most."""
    return list(islice(product(*map(permutations, steps)), most))


def is_all_gestures(steps: GestureSteps) -> bool:
    """Whether all that is asked for are gestures of the corpus."""
    return all(one.gesture != OUTSIDE for step in steps for one in step)


def mirrored(steps: GestureSteps) -> GestureSteps:
    """The steps of the mirror image."""
    return tuple(
        tuple(ArmGesture(_OTHER_ARM.get(one.arm, one.arm), mirror_words(one.gesture)) for one in step) for step in steps
    )


@cache
def _arms(gesture: str) -> dict[str, str]:
    """Maps the plain commands of a gesture to the arms that they name; what it says without an arm is `ANY_ARM`.

    Without an arm "raise your right hand" is said for `raise`: there the command is that of the right arm.
    """
    said = {arm: plain_command(gesture, words) for arm, words in _SAID.items()}
    found = {plain_command(gesture, ""): ANY_ARM}
    if said[LEFT] != said[RIGHT]:
        found |= {said[LEFT]: LEFT, said[RIGHT]: RIGHT}
    for arm in (BOTH, IN_TURN):
        found.setdefault(said[arm], arm)
    found.pop("", None)
    return found
