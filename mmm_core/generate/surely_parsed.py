"""Replaces a reading by the parser's answer where the parser gives that answer a high probability."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

from mmm_core.generate.encoded_sentence import Encoded
from mmm_core.language.candidates import is_task
from mmm_core.language.commands import Reading
from mmm_core.language.completed_at_once import base_of
from mmm_core.language.denial import is_denied_act, surely_denies
from mmm_core.language.gesture_steps import ANY_ARM, GestureSteps, is_all_gestures
from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.parsed_reading import reading_in, steps_asked
from mmm_core.language.plain_gestures import Meant, alternates, family_of
from mmm_core.language.sides_said import contradicts_sides

LOG_SURE = math.log(0.85)
"""Log-probability from which on an answer is so likely that no other one is sought; training leaves none much above 0.9."""
_LOG_REST = math.log(0.15)
"""Log-probability from which on no other answer can be that likely."""
_NEGATIVE = re.compile(r"\b(?:not?|never|nor|without|stop|skip|except|leave out|drop|dont|cant|wont)\b|n't\b")
_FEW = 2
"""Words of a denied act, at most, that may begin otherwise than with a verb of gestures alone: "a bow"."""


def as_surely_parsed(
    found: Reading, states: Encoded, classes: Callable[[Sequence[str]], Mapping[str, Meant]]
) -> Reading:
    """A reading, or the parser's answer if it is sure of another one.

    Where a denial ends, often the sense alone tells: "I said wave, not salute" and "forget the high fives a little wave is plenty"
    ask to wave, and "google no not google robot okay robot raise both hands no just one the left" asks to raise the left hand.
    So it does where words beside a command are none: "the queen is coming in, show her some respect and bow". A task that is no
    gesture stays, and is refused; nothing stays where the first words deny all that follows; and what alone is denied, in
    plain words, is not done.

    Args:
        found: the reading.
        states: what the networks say of the sentence.
        classes: tells the gesture that each of some words means by itself.
    """
    if alternates(found) or (not found.steps and surely_denies(found.text)):
        return found
    meant = classes([command.text for step in found.steps for command in step])
    own = steps_asked(found, meant)
    if states.parse.log_likelihoods([own])[0] > _LOG_REST or any(
        is_task(command, one) for command, one in meant.items()
    ):
        return found
    answer = next(iter(states.parse.likeliest(1)), None)
    if answer is None or not is_all_gestures(answer) or states.parse.log_likelihoods([answer])[0] < LOG_SURE:
        return found
    if contradicts_sides(answer, found.text) or _is_vaguer(answer, own):
        return found
    asked = reading_in(answer, found.text, (found,), meant)
    if asked is None:
        return found
    families = {family_of(one.gesture) for step in answer for one in step}
    acts = classes(found.denied)
    contrary = [words for words in found.denied if family_of(acts[words].name) in families]
    if len(found.denied) == 1 and any(_is_plainly_denied(words, found.text.lower()) for words in contrary):
        return found
    return replace(asked, denied=tuple(words for words in asked.denied if words not in contrary), plain=False)


def _is_vaguer(answer: GestureSteps, than: GestureSteps) -> bool:
    """Whether an answer has the same gestures and only leaves arms open: "bring the ball to your chest" takes both."""
    pairs = [*zip(chain.from_iterable(answer), chain.from_iterable(than), strict=False)]
    alike = all(said.gesture == one.gesture and said.arm in (ANY_ARM, one.arm) for said, one in pairs)
    return alike and [*map(len, answer)] == [*map(len, than)]


def _is_plainly_denied(denied: str, text: str) -> bool:
    """Whether denied words follow a negative word and name an act at once: "bow", "wave at me", but not "be shy blow me a kiss"."""
    first = denied.partition(" ")[0]
    negative = _NEGATIVE.search(text)
    follows = negative is not None and text.find(denied) > negative.start()
    return follows and (is_gesture_verb(base_of(first)) or (denied.count(" ") < _FEW and is_denied_act(denied)))
