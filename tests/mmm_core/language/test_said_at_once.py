"""Commands in turn that a sentence says to be done at once, and commands that are named twice."""

from __future__ import annotations

import pytest

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner import Manner
from mmm_core.language.said_at_once import said_at_once, without_repeats


def _reading(text: str, *steps: tuple[str, ...]) -> Reading:
    return Reading(text, tuple(tuple(PlainCommand(c, limbs=limbs_of(c)) for c in step) for step in steps))


def _shown(reading: Reading) -> list[list[str]]:
    return [[command.text for command in step] for step in reading.steps]


@pytest.mark.parametrize(
    ("text", "first", "second"),
    [
        ("hands on the wheel, and look over your shoulder, all in one go", "steer a car", "look over your left shoulder"),
        ("sway to the song and keep clapping", "sway from side to side", "clap your hands"),
        ("left hand waves, the right one on the hip throughout", "wave your left hand", "put your right hand on your hip"),
    ],
)  # fmt: skip
def test_two_commands_are_at_once_where_the_sentence_says_so(text: str, first: str, second: str) -> None:
    assert _shown(said_at_once(_reading(text, (first,), (second,)))) == [[first, second]]


@pytest.mark.parametrize(
    ("text", "first", "second"),
    [
        ("clap and nod", "clap your hands", "nod your head"),  # nothing says so
        ("clap, then nod at the same time as the others", "clap your hands", "nod your head"),  # in turn is said, too
        ("wave and salute at the same time", "wave your right hand", "salute with your right hand"),  # one arm
        ("clap and keep waving", "clap your hands", "wave both arms"),
    ],
)  # fmt: skip
def test_other_commands_stay_in_turn(text: str, first: str, second: str) -> None:
    given = _reading(text, (first,), (second,))
    assert said_at_once(given) is given


@pytest.mark.parametrize(
    ("text", "steps", "kept"),
    [
        ("a salute, hand at the brow", (("salute with your right hand",), ("salute",)), [["salute with your right hand"]]),
        ("wheel in both hands, driving", (("steer a car", "steer a car"),), [["steer a car"]]),
        ("finger to the lips, hushing, and shake", (("hush",), ("hush",), ("shake",)), [["hush"], ["shake"]]),
        ("clap, clap", (("clap",), ("clap",)), [["clap"], ["clap"]]),
        ("wave, and another one", (("wave",), ("wave",)), [["wave"], ["wave"]]),
        ("the left salutes, the right salutes", (("salute with your left hand",), ("salute with your right hand",)),
         [["salute with your left hand"], ["salute with your right hand"]]),
    ],
)  # fmt: skip
def test_a_command_that_is_named_twice_is_done_once(
    text: str, steps: tuple[tuple[str, ...], ...], kept: list[list[str]]
) -> None:
    assert _shown(without_repeats(_reading(text, *steps))) == kept


def test_a_command_in_another_manner_is_another_one() -> None:
    given = Reading("shrug slowly, later fast", tuple((PlainCommand("shrug", Manner(tempo=t)),) for t in (0.62, 1.6)))
    assert without_repeats(given) == given
