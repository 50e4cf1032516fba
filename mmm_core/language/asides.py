"""Leaves out statements beside commands: "you are grand", "he will feel at home"."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from mmm_core.language.commands import Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.sure_reading import begins_with_a_verb

_MAY_BE_A_GESTURE = 0.5
"""Probability of a gesture from which a statement is a command."""
_STATES = re.compile(
    r"(?:\w+ ){1,3}(?:is|are|am|was|were|will|would|should|can|could|has|have|had|does|did|may|might|must)\b"
)
"""Subject and verb of a statement."""


def without_asides(reading: Reading, meant: Mapping[str, float]) -> Reading:
    """A reading without statements beside commands or a denial: "you are grand", "he will feel at home".

    Such words are no phrase of the corpus, begin with no verb, name no limb, and probably mean no gesture. `notes` names them.

    Args:
        reading: the reading.
        meant: of the commands that are no phrases of the corpus, the probability that they mean a gesture.
    """
    unlikely = [text for text, probability in meant.items() if probability < _MAY_BE_A_GESTURE]
    asides = [text for text in unlikely if _is_statement(text.lower())]
    kept = tuple(tuple(c for c in step if c.text not in asides) for step in reading.steps)
    steps = tuple(step for step in kept if step)
    if not asides or not (steps or reading.denied):
        return reading
    notes = tuple(f"'{text}' is no command" for text in asides)
    return replace(reading, steps=steps, notes=(*reading.notes, *notes), plain=False)


def _is_statement(words: str) -> bool:
    return _STATES.match(words) is not None and not (begins_with_a_verb(words) or limbs_of(words))
