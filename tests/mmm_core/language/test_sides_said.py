"""Sides that a sentence asks for, and gestures that go to no other one."""

from __future__ import annotations

import pytest

from mmm_core.language.gesture_steps import ANY_ARM, LEFT, RIGHT, ArmGesture
from mmm_core.language.sides_said import contradicts_sides


@pytest.mark.parametrize(
    ("text", "gesture", "contradicts"),
    [
        ("twist to the right as far as it goes, but not to the left", "twist/left", True),
        ("twist to the right as far as it goes, but not to the left", "twist/right", False),
        ("lean left without tilting your head left", "lean/right", True),
        ("lean left without tilting your head left", "lean/left", False),
        ("look lfet", "look/up right", True),
        ("never left, lean right", "lean/left", True),
        ("turn left, no, right", "twist/right", False),
        ("not to the left but the other way", "lean/right", False),
        ("look up at the clock", "look/up left", False),
        ("don't look left", "look/down", False),
    ],
)
def test_no_gesture_goes_to_a_side_that_is_denied_or_never_named(text: str, gesture: str, contradicts: bool) -> None:
    assert contradicts_sides(((ArmGesture(ANY_ARM, gesture),),), text) is contradicts


def test_the_arm_is_left_open() -> None:
    assert not contradicts_sides(
        ((ArmGesture(RIGHT, "wave"),), (ArmGesture(LEFT, "raise"),)), "any arm except the left"
    )
