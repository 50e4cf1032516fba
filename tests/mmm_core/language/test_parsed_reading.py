"""Readings in the gestures that the parser proposes."""

from __future__ import annotations

import math

import pytest

from mmm_core.language.commands import MOST_STEPS, PlainCommand, Reading
from mmm_core.language.gesture_steps import ANY_ARM, BOTH, LEFT, RIGHT, ArmGesture
from mmm_core.language.manner import Manner
from mmm_core.language.parsed_reading import denies_itself, keeps_denials, reading_in, steps_asked
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, Meant

MEANT = {
    "wave with your left hand twice": Meant("wave", 0.9),
    "bow": Meant("bow", 1.0),
    "raise your right hand": Meant("raise", 1.0),
    "look up": Meant("look/up", 0.9),
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


@pytest.mark.parametrize(
    ("one", "denied", "is_kept"),
    [
        (ArmGesture(LEFT, "wave"), ["wave with your left hand twice"], False),
        (ArmGesture(RIGHT, "wave"), ["wave with your left hand twice"], True),
        (ArmGesture(BOTH, "wave"), ["wave with your left hand twice"], False),
        (ArmGesture(ANY_ARM, "wave"), ["wave with your left hand twice"], False),
        (ArmGesture(ANY_ARM, "raise"), ["raise your right hand"], False),
        (ArmGesture(ANY_ARM, "look/up left"), ["look up"], False),
        (ArmGesture(ANY_ARM, "look/down"), ["look up"], True),
        (ArmGesture(ANY_ARM, "bow"), ["look up", "bow"], False),
        (ArmGesture(ANY_ARM, "nod"), ["both of it"], False),
        (ArmGesture(ANY_ARM, "bow"), ["both of it"], True),
        (ArmGesture(ANY_ARM, "nod"), [], True),
    ],
)
def test_what_a_reading_denies_is_not_done(one: ArmGesture, denied: list[str], is_kept: bool) -> None:
    """Beside a denial of unknown words only what its reading does is sure: a bow and a wave here."""
    denying = Reading("text", READ.steps, denied=tuple(denied))
    assert keeps_denials(((one,),), [READ, denying], MEANT, MEANT) is is_kept


@pytest.mark.parametrize(
    ("gesture", "denied", "log_parsed", "is_kept"),
    [
        ("nod", "sing a song", math.log(0.9), True),
        ("nod", "sing a song", math.log(0.6), False),
        ("nod", "both of it", math.log(0.9), False),  # acts of which one may be to nod
        ("look/up", "look up", math.log(0.9), False),
    ],
)
def test_beside_an_unknown_denial_the_parser_is_believed_if_sure(
    gesture: str, denied: str, log_parsed: float, is_kept: bool
) -> None:
    denying = Reading("text", READ.steps, denied=(denied,))
    steps = ((ArmGesture(ANY_ARM, gesture),),)
    assert keeps_denials(steps, [denying], MEANT, MEANT, log_parsed) is is_kept


def test_what_nobody_could_do_is_no_reading() -> None:
    nod = ArmGesture(ANY_ARM, "nod")
    assert reading_in(((nod,) * 4,), "text", [READ], MEANT) is None
    assert reading_in(((nod,),) * (MOST_STEPS + 1), "text", [READ], MEANT) is None
    assert reading_in(((ArmGesture(BOTH, "raise"),),), "text", [READ], MEANT) is None


def test_a_gesture_asked_for_twice_has_each_of_its_manners() -> None:
    slow, fast = (PlainCommand("bow", Manner(tempo=tempo)) for tempo in (0.62, 1.6))
    both = Reading("text", ((slow,), (fast,)))
    bow = (ArmGesture(ANY_ARM, "bow"),)
    assert _words(reading_in((bow, bow), "text", [Reading("text", ((slow,),)), both], MEANT)) == [
        ["bow (0.62 times as fast)"],
        ["bow (1.6 times as fast)"],
    ]


def test_what_is_denied_stays_so_and_all_is_where_nothing_is_asked_for() -> None:
    denying = Reading("text", ((PlainCommand("bow"),),), denied=("wave",))
    found = reading_in(((ArmGesture(ANY_ARM, "bow"),),), "text", [READ, denying], MEANT)
    assert found is not None
    assert found.denied == ("wave",)
    nothing = reading_in((), "text", [READ], MEANT)
    assert nothing is not None
    assert (nothing.steps, nothing.denied) == ((), ("wave with your left hand twice", "bow"))


@pytest.mark.parametrize(
    ("commands", "denied", "contradicts"),
    [
        (["bow", "look up"], "look up", True),
        (["bow", "look up"], "sing a song", False),
        (["look up"], "look up", False),  # "why don't you look up? Look up!"
        (["bow", "raise your right hand"], "raise your left hand", False),
        (["bow", "wave with your left hand twice"], "wave three times", False),
        (["bow", "look up"], "look up slowly", False),
    ],
)
def test_a_reading_of_several_commands_may_deny_none_of_them(
    commands: list[str], denied: str, contradicts: bool
) -> None:
    acts = {
        "look up": Meant("look/up", 0.9), "look up slowly": Meant("look/up", 0.9), "sing a song": Meant(OUTSIDE, 0.9),
        "raise your left hand": Meant("raise", 1.0), "wave three times": Meant("wave", 0.9),
    }  # fmt: skip
    reading = Reading("text", tuple((PlainCommand(words),) for words in commands), (denied,))
    assert denies_itself(reading, MEANT, acts) is contradicts
