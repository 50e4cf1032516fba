"""The hand of the one command is found wherever the sentence names it, and not where it may mean the other one."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.reading import read
from mmm_core.language.said_arm import arm_said, with_said_arm, without_denied_arm

_SAID = (
    ("put your right one up to cover your mouth", "right"),
    ("scan the horizon for me with a hand above your eyes, left one", "left"),
    ("push the trolley with one hand, the right.", "right"),
    ("throw it underarm, lefty, we're playing bowls", "left"),
    ("make bye-bye with hand of right", "right"),
    ("take the squeegee in your right, no, silly me, left, and do that window", "left"),
    ("soup in, left hand.", "left"),
)
_NOT_SAID = (
    "look at the door on your left",
    "right, wave!",
    "do it right away",
    "that's right, clap",
    "raise your hand, but not the one with the plaster, that is your left",
    "not with your left hand",
    "your right arm is sore, use the other",
    "paint with the left and the right",
    "either the left or the right hand",
    "the phone is at your left ear",
)


@pytest.mark.parametrize(("sentence", "side"), _SAID)
def test_the_named_hand_is_found(sentence: str, side: str) -> None:
    assert arm_said(sentence) == side


@pytest.mark.parametrize("sentence", _NOT_SAID)
def test_a_direction_a_place_another_sense_and_a_denied_hand_are_no_hand(sentence: str) -> None:
    assert arm_said(sentence) == ""


@given(st.sampled_from([sentence for sentence, _ in _SAID[:3]]))
def test_the_mirrored_sentence_names_the_other_hand(sentence: str) -> None:
    assert {arm_said(sentence), arm_said(mirror_words(sentence))} == {"left", "right"}


@pytest.mark.parametrize(
    ("said", "command", "read"),
    [
        ("wave, lefty", "wave your hand", "wave your left hand"),
        ("wave three times, lefty", "wave your hand 3 times", "wave your left hand 3 times"),
        ("wave, lefty", "wave your right hand", "wave your right hand"),
        ("bow, lefty", "bow politely", "bow politely"),
        ("point up, lefty", "point your finger up", "point your finger up"),
        ("scratch that thing, lefty", "scratch that thing", "scratch that thing"),
        ("keep your arms down, don't raise them", "lower your arm", "lower both arms"),
        ("the arm goes down", "lower your arm", "lower your arm"),
        ("your left hand comes down", "lower your arm", "lower your left arm"),
        ("don't clasp them, put them on your hips", "put one hand on your hip", "put your hands on your hips"),
        ("a hand on your hips", "put one hand on your hip", "put one hand on your hip"),
    ],
)
def test_a_gesture_without_hand_takes_it_and_keeps_its_number(said: str, command: str, read: str) -> None:
    reading = Reading(said, ((PlainCommand(command, limbs=limbs_of(command)),),))
    assert with_said_arm(reading).steps[0][0].text == read


@pytest.mark.parametrize(
    ("command", "denied", "done"),
    [
        ("point up with your left hand", ("the left",), "point up with your right hand"),
        ("hold out your left fist for a bump", ("the left hand",), "hold out your right fist for a bump"),
        ("wave with your right hand", ("the left hand",), "wave with your right hand"),
        (
            "touch your left ear with your left hand",
            ("use your left hand",),
            "touch your left ear with your right hand",
        ),
        ("put your left hand on your right shoulder", ("the left one",), "put your left hand on your right shoulder"),
        ("raise your left hand", ("left",), "raise your left hand"),
        ("raise your left hand", ("your left ear",), "raise your left hand"),
        ("raise your left hand", ("the left hand", "the right hand"), "raise your left hand"),
    ],
)
def test_a_denied_arm_does_not_do_the_one_command(command: str, denied: tuple[str, ...], done: str) -> None:
    reading = Reading("", ((PlainCommand(command, limbs=limbs_of(command)),),), denied)
    assert without_denied_arm(reading).steps == ((PlainCommand(done, limbs=limbs_of(done)),),)


@pytest.mark.parametrize("at_once", [True, False])
def test_of_a_gesture_of_both_arms_the_denied_one_is_left_out(at_once: bool) -> None:
    """ "The right hand rests, clear your brow with your left" wiped with both."""
    left, right = (PlainCommand(f"wipe your brow with your {side} hand") for side in ("left", "right"))
    reading = Reading("", ((right, left),) if at_once else ((right,), (left,)), ("the right arm",))
    assert without_denied_arm(reading).steps == ((left,),)


def test_an_arm_that_one_of_several_commands_takes_stays() -> None:
    steps = tuple((PlainCommand(said, limbs=limbs_of(said)),) for said in ("wave your left hand", "bow politely"))
    reading = Reading("", steps, ("the left hand",))
    assert without_denied_arm(reading) == reading


@pytest.mark.parametrize(
    ("text", "side"),
    [
        ("raise your left arm and keep your left arm down", "left"),
        ("raise your right arm but keep your right arm still", "right"),
    ],
)
def test_an_arm_that_is_asked_for_and_denied_moves_no_other(text: str, side: str) -> None:
    """The arm that nobody had named moved."""
    found = without_denied_arm(replace(read(text), denied=(f"the {side} arm",)))
    assert found.words == f"raise your {side} arm" and not found.denied and f"not the {side} arm" in found.notes[0]
