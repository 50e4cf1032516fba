"""Leaves out what is no command beside a command or a denial: "he will feel at home", "thanks a lot"."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from mmm_core.language.commands import Reading
from mmm_core.language.limbs import begins_with_a_verb, limbs_of
from mmm_core.language.plain_gestures import Meant, is_gesture, is_surely_outside

_MAY_BE_A_GESTURE = 0.5
"""Probability of a gesture from which a statement is a command."""
_STATES = re.compile(
    r"(?:\w+ ){1,3}(?:is|are|am|was|were|will|would|should|can|could|has|have|had|does|did|may|might|must)\b"
)
"""Subject and verb of a statement."""


def without_asides(reading: Reading, meant: Mapping[str, Meant]) -> Reading:
    """A reading without statements beside commands, and without what is surely no gesture beside a denial.

    Such words are no phrase of the corpus, begin with no verb, name no limb, and probably mean no gesture. `notes` names them.

    Args:
        reading: the reading.
        meant: what the commands mean that are no phrases of the corpus.
    """
    asides = [
        text
        for text, one in meant.items()
        if _names_no_act(text.lower())
        and not (is_gesture(one.name) and one.probability >= _MAY_BE_A_GESTURE)
        and (_STATES.match(text.lower()) or (reading.denied and is_surely_outside(one)))
    ]
    kept = tuple(tuple(c for c in step if c.text not in asides) for step in reading.steps)
    steps = tuple(step for step in kept if step)
    if not asides or not (steps or reading.denied):
        return reading
    notes = tuple(f"'{text}' is no command" for text in asides)
    return replace(reading, steps=steps, notes=(*reading.notes, *notes), plain=False)


def _names_no_act(words: str) -> bool:
    return not (begins_with_a_verb(words) or limbs_of(words))
