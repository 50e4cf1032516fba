"""Finds the hand that a sentence of one command names anywhere: "scan the horizon with a hand above your eyes, left one".

A command in plain words has lost what stands apart from its verb. Nor is it done with the hand that the sentence denies.
"""

from __future__ import annotations

import re
from dataclasses import replace

from mmm_core.language.commands import Reading
from mmm_core.language.count_words import count_asked
from mmm_core.language.denial import denied_side
from mmm_core.language.ellipsis import OTHER
from mmm_core.language.gesture_steps import ANY_ARM, arm_of
from mmm_core.language.limbs import SOME_ARM, limbs_of
from mmm_core.language.plain_gestures import gesture_of, plain_command
from mmm_core.language.spelling import mended

_ARM_NOUN = "(?:hand|arm|fist|palm|forearm|wrist)"
_AN_ARM = re.compile(rf"\b(?:(?:the|your) (?:left|right)(?: one)?|(?:left|right) {_ARM_NOUN})$")
"""A denied side that is an arm and no direction."""
_NO_HAND = r"(?! (?:side|ear|eye|knee|hip|cheek|foot|boot|leg|away|now|here|there|time|order|amount|place|moment)\b)"
_HANDS = tuple(
    re.compile(form)
    for form in (
        r"\b(?P<side>left|right) (?:hand|arm|fist|palm|forearm|mitt|paw|glove|wing|claw|finger|biceps?|one|flipper|limb)(?:'?s)?\b",
        r"\b(?P<side>left|right)-? ?(?:handed|hander|armed)\b",
        r"\b(?P<side>left|right)y\b",
        r"\b(?:with|using|by|in|off|use|only|just) (?:(?:your|the|own|good|bad|weak|strong) )*(?P<side>left|right)\b"
        + _NO_HAND,
        r"\byour (?P<side>left|right)(?=$|[,.;:!?]| (?:and|to|please|then|up|out|goes|does|is|alone|only|for|across)\b)",
        r"(?:^|[,;:.!?-] )(?:the )?(?P<side>left)(?: please| only)?(?=$|[,.;:!?])",
        r"[,;:.!?-] (?:the )?(?P<side>right)(?: please| only)?(?=$|[.;:!])",
        r"\b(?:hand|arm|one|fist|palm) (?:of )?(?P<side>left|right)\b",
        r"\bthe (?P<side>left|right) (?:alone|only)\b",
    )
)
"""A side that is a hand and no direction, by its noun or by the words before and after it."""
_PLACES = re.compile(r"\b(?:on|to|at|down|from|there) (?:your |the )?$")
_OTHERWISE = re.compile(
    r"\b(?:other(?!s)|free|remain\w*|rests?|stays?|hurts?|sore|swap\w*|switch\w*|either|turns?|alternat\w*|trade|copy|likewise|brother)\b|"
    r"\bnot (?:with )?(?:the|your) (?:one|hand|arm)\b|\bthat is your\b|\b(?:do|did|is) not (?:\w+ )?with\b|\bis not\b|"
    r"\bhands off\b|"
    r"\b(?:whichever|whatever|dirty|poorly|bad|wrapped|sticky|make it|actually|both hands|two hands)\b|"
    r"\b(?:and|or|then) (?:the )?(?:left|right)\b|\bleft, right\b"
)
"""Words after which the hand that is named may not be the one that is meant."""
_UNWANTED = re.compile(
    r"\b(?:not|no|never|without|than|except|but|leave|spare|keep|forget|pretend|hands off|both)\b(?: [\w'-]+){0,4} $"
)
"""Words before a hand that is not to act, in the same clause."""
_CORRECTED = re.compile(
    r"\b(?:left|right)\b.*\b(?:no|sorry|oops|wait|i meant?|or rather|scratch that|make it|it should be)\b,? "
    r"(?:[\w']+,? ){0,6}?(?P<side>left|right)(?: (?:hand|arm|one))?\b"
)
"""A hand that takes the place of another one: "with your right hand, no, sorry, with your left"."""
_BOTH = {
    "arms_down": re.compile(r"\b(?:arms|hands|them|both)\b"),
    "hands_on_hips": re.compile(r"\bhips\b"),
    "behind_back": re.compile(r"\b(?:arms|hands) (?:[\w']+ ){0,3}(?:behind|back)\b"),
    "behind_head": re.compile(r"\b(?:arms|hands) (?:[\w']+ ){0,3}behind\b"),
}
"""Words that ask for both arms, of gestures whose plain command takes one."""
_ONE_ARM = re.compile(r"\b(?:an?|one|your|the|that|this|either) (?:hand|arm)\b")


def with_said_arm(reading: Reading) -> Reading:
    """A reading whose one command, a gesture without a direction, has the hand that the sentence names, if it names none itself.

    It has both where the sentence speaks of several: "don't clasp them, put them on your hips".
    """
    if [len(step) for step in reading.steps] != [1]:
        return reading
    (command,) = reading.steps[0]
    gesture = gesture_of(command.text)
    if not gesture or "/" in gesture or arm_of(command.text, gesture) != ANY_ARM or command.limbs - SOME_ARM:
        return reading
    side, count = arm_said(reading.text), count_asked(command.text)
    arms = f"{side} hand" if side else "both hands" if _speaks_of_both(reading.text, gesture) else ""
    times = f" {count} times" if count else ""
    text = plain_command(gesture, f"{arms}{times}") if arms else ""
    if text in ("", plain_command(gesture, times)):
        return reading
    return replace(reading, steps=((replace(command, text=text, limbs=limbs_of(text)),),), plain=False)


def _speaks_of_both(sentence: str, gesture: str) -> bool:
    text = mended(sentence).lower()
    return gesture in _BOTH and _BOTH[gesture].search(text) is not None and _ONE_ARM.search(text) is None


def without_denied_arm(reading: Reading) -> Reading:
    """A reading; its one command has the other arm if it names one that the sentence denies ("point up w/o using the left").

    Of a gesture that both arms do, at once or in turn, the one of the denied arm is left out: "the right rests, rub your left eye".
    """
    sides = {side for words in reading.denied if (side := denied_side(words)) and _AN_ARM.search(words)}
    if len(sides) != 1 or not reading.steps:
        return reading
    (side,) = sides
    if sum(map(len, reading.steps)) > 1:
        return _without_gestures_of(side, reading)
    other, (command,) = OTHER[side], reading.steps[0]
    text = re.sub(rf"\b{side}(?= {_ARM_NOUN}\b)", other, command.text)
    if text == command.text or re.search(rf"\b{other}\b", command.text):
        return reading
    if _n_named(side, mended(reading.text)) > _n_named(side, " ".join(reading.denied)):
        return _with_asked_arm(reading, side, command.text)
    return replace(reading, steps=((replace(command, text=text, limbs=limbs_of(text)),),))


def _n_named(side: str, words: str) -> int:
    return len(re.findall(rf"\b{side}\b", words.lower()))


def _with_asked_arm(reading: Reading, side: str, command: str) -> Reading:
    """A reading without the denial of an arm that its command asks for by name: no other arm is to move for it."""
    denied = tuple(words for words in reading.denied if denied_side(words) != side)
    note = f"'not the {side} arm' is left out, since '{command}' asks for it"
    return replace(reading, denied=denied, notes=(*reading.notes, note))


def _without_gestures_of(side: str, reading: Reading) -> Reading:
    """A reading without commands of an arm whose gesture another command does with the other arm."""
    of_other = {
        gesture_of(command.text)
        for step in reading.steps
        for command in step
        if _is_of_arm(command.text, OTHER[side]) and not _is_of_arm(command.text, side)
    } - {""}
    steps = (
        tuple(c for c in step if not (_is_of_arm(c.text, side) and gesture_of(c.text) in of_other))
        for step in reading.steps
    )
    return replace(reading, steps=tuple(filter(None, steps)))


def _is_of_arm(command: str, side: str) -> bool:
    return re.search(rf"\b{side} {_ARM_NOUN}\b", command) is not None


def arm_said(sentence: str) -> str:
    """The hand that a sentence surely names, "left" or "right"; empty where it names none, or may mean the other one.

    >>> arm_said("push the shopping trolley with one hand, the right.")
    'right'
    """
    text = mended(sentence).lower()
    if "left" not in text and "right" not in text:
        return ""
    if (corrected := _CORRECTED.search(text)) is not None:
        return corrected["side"]
    found = {
        match["side"]
        for form in _HANDS
        for match in form.finditer(text)
        if not any(words.search(text[: match.start("side")]) for words in (_PLACES, _UNWANTED))
    }
    return found.pop() if len(found) == 1 and _OTHERWISE.search(text) is None else ""
