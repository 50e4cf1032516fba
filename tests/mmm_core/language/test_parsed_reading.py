"""Readings in the gestures that the parser proposes."""

from __future__ import annotations

import pytest

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.gesture_steps import ANY_ARM, LEFT, RIGHT, ArmGesture
from mmm_core.language.manner import Manner
from mmm_core.language.parsed_reading import reading_in, steps_asked
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, Meant

MEANT = {
    "wave with your left hand twice": Meant("wave", 0.9),
    "bow": Meant("bow", 1.0),
    "sing a song": Meant(OUTSIDE, 0.9),
    "both of it": Meant(SEVERAL, 0.9),
}
SLOW_WAVE = PlainCommand("wave with your left hand twice", Manner(tempo=0.62), frozenset({"left_arm"}))
READ = Reading("text", ((SLOW_WAVE,), (PlainCommand("bow"),)))


def _words(reading: Reading | None) -> list[list[str]]:
    assert reading is not None
    return [[command.sentence for command in step] for step in reading.steps]


def test_the_gestures_of_a_reading_are_those_that_its_commands_mean() -> None:
    assert steps_asked(READ, MEANT) == ((ArmGesture(LEFT, "wave"),), (ArmGesture(ANY_ARM, "bow"),))
    unknown = Reading("text", ((PlainCommand("sing a song"), PlainCommand("both of it")),))
    assert steps_asked(unknown, MEANT) == ((ArmGesture(ANY_ARM, OUTSIDE), ArmGesture(ANY_ARM, OUTSIDE)),)


@pytest.mark.parametrize(
    ("steps", "words"),
    [
        (((ArmGesture(LEFT, "wave"),),), [["wave with your left hand twice (0.62 times as fast)"]]),
        (((ArmGesture(RIGHT, "wave"),),), [["wave your right hand 2 times (0.62 times as fast)"]]),
        (
            ((ArmGesture(ANY_ARM, "bow"), ArmGesture(RIGHT, "heart")),),
            [["bow", "put your right hand on your heart"]],
        ),
    ],
)
def test_a_command_takes_words_and_manner_from_a_reading_with_its_gesture(
    steps: tuple[tuple[ArmGesture, ...], ...], words: list[list[str]]
) -> None:
    assert _words(reading_in(steps, "text", [READ], MEANT)) == words


def test_what_is_no_gesture_cannot_be_said() -> None:
    assert reading_in(((ArmGesture(ANY_ARM, OUTSIDE),),), "text", [READ], MEANT) is None


def test_what_is_denied_stays_so_and_all_is_where_nothing_is_asked_for() -> None:
    denying = Reading("text", ((PlainCommand("bow"),),), denied=("wave",))
    found = reading_in(((ArmGesture(ANY_ARM, "bow"),),), "text", [READ, denying], MEANT)
    assert found is not None
    assert found.denied == ("wave",)
    nothing = reading_in((), "text", [READ], MEANT)
    assert nothing is not None
    assert (nothing.steps, nothing.denied) == ((), ("wave with your left hand twice", "bow"))
