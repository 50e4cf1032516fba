"""Steps of gestures as tokens of the parser, and the arms that words name."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.gesture_steps import (
    ANY_ARM,
    ARMS,
    BOTH,
    END,
    LEFT,
    RIGHT,
    START,
    ArmGesture,
    arm_of,
    in_every_order,
    mirrored,
    plainly,
    steps_of,
    token_ids,
    tokens,
    with_own_arm,
)
from mmm_core.language.plain_gestures import OUTSIDE, gestures

ONES = st.builds(ArmGesture, st.sampled_from(ARMS), st.sampled_from((*gestures(), OUTSIDE)))
STEPS = st.lists(st.lists(ONES, min_size=1, max_size=3).map(tuple), max_size=4).map(tuple)


@given(STEPS)
def test_tokens_of_steps_are_read_back(steps: tuple[tuple[ArmGesture, ...], ...]) -> None:
    first, *ids, last = token_ids(steps)
    assert (tokens()[first], tokens()[last]) == (START, END)
    assert steps_of(ids) == steps


@pytest.mark.parametrize(
    "names",
    [
        ("then",),
        ("then", "arm left"),
        ("with", "arm any", "wave"),
        ("then", "then", "wave"),
        ("then", "arm any", "arm any"),
        ("then", "arm any", "wave", "bow"),
        ("then", "arm any", "wave", "arm any", "arm any", "bow"),
    ],
)
def test_tokens_in_another_order_are_no_steps(names: tuple[str, ...]) -> None:
    assert steps_of([tokens().index(name) for name in names]) is None


def test_what_is_done_at_once_comes_in_every_order() -> None:
    nod, bow, clap = (ArmGesture(ANY_ARM, name) for name in ("nod", "bow", "clap"))
    assert in_every_order(((nod, bow), (clap,))) == [((nod, bow), (clap,)), ((bow, nod), (clap,))]
    assert in_every_order(()) == [()]
    assert len(in_every_order(((nod, bow, clap),) * 8)) == 12


@given(STEPS)
def test_the_mirror_image_of_the_mirror_image_is_the_same(steps: tuple[tuple[ArmGesture, ...], ...]) -> None:
    assert mirrored(mirrored(steps)) == steps


@given(ONES)
def test_the_plain_command_of_a_gesture_names_its_own_arm(one: ArmGesture) -> None:
    own = with_own_arm(one)
    if words := plainly(own):
        said = (
            {own.arm, RIGHT} if one.gesture == "raise" else {own.arm}
        )  # "raise your right hand" where no arm is named
        assert arm_of(words, own.gesture) in said


@pytest.mark.parametrize(
    ("words", "gesture", "arm"),
    [
        ("wave with your left hand three times", "wave", LEFT),
        ("wave both hands", "wave", BOTH),
        ("wave at her", "wave", ANY_ARM),
        ("throw a right hook", "hook", RIGHT),
        ("look to the left", "look/left", ANY_ARM),
        ("play the guitar with both hands", "guitar", ANY_ARM),
        ("raise your right hand", "raise", RIGHT),
        ("sing with your left hand", OUTSIDE, ANY_ARM),
    ],
)
def test_the_arm_is_the_one_that_words_name_where_there_is_a_choice(words: str, gesture: str, arm: str) -> None:
    assert arm_of(words, gesture) == arm


def test_an_arm_that_a_gesture_does_not_have_is_dropped() -> None:
    assert with_own_arm(ArmGesture(BOTH, "guitar")) == ArmGesture(ANY_ARM, "guitar")
    assert with_own_arm(ArmGesture(LEFT, "wave")) == ArmGesture(LEFT, "wave")
    assert with_own_arm(ArmGesture(LEFT, OUTSIDE)) == ArmGesture(ANY_ARM, OUTSIDE)
