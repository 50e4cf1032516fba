"""The sides that a sentence asks for, so that no gesture goes to a side that the sentence never asked for."""

from __future__ import annotations

import re

from mmm_core.language.gesture_steps import GestureSteps
from mmm_core.language.plain_gestures import sides_of
from mmm_core.language.spelling import mended

_SIDE = re.compile(
    r"(?P<denied>(?:\b(?:not|never|nor|without)|n't)(?: (?:to|with|on|at|in|using|towards?|your|the|my|his|her|their))* )?"
    r"\b(?P<side>left|right)\b"
)
_ANY_SIDE = re.compile(
    r"\b(?:other|opposite|contrary|mirror\w*|revers\w*|switch\w*|swap\w*|both|either|each|alternat\w*|instead)\b"
)
"""Words by which a side is asked for that is not named."""


def contradicts_sides(steps: GestureSteps, text: str) -> bool:
    """Whether a gesture goes to a side that a sentence denies, or does not name although it names the other one.

    "Twist to the right, but not to the left" asks for no twist to the left. Arms are not looked at: "any arm except the left"
    asks for the right one.
    """
    sides = {side for step in steps for one in step for side in sides_of(one.gesture)}
    if not sides or _ANY_SIDE.search(text.lower()):
        return False
    found = list(_SIDE.finditer(mended(text).lower()))
    return bool(found) and not sides <= {one["side"] for one in found if not one["denied"]}
