"""Commands that hold several gestures, divided by what their parts mean."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.joined import SURE_OF_PART, with_parted_commands
from mmm_core.language.manner import Manner
from mmm_core.language.plain_gestures import SEVERAL, Meant

MEANT = {
    "bow": ("bow", 0.98),
    "your palms pressed in prayer": ("pray", 0.93),
    "a shrug": ("shrug", 0.97),
    "a head tilt to the right": ("tilt_head/right", 0.9),
    "a round of drinks": ("drink", SURE_OF_PART - 0.01),
    "serve an ace": ("tennis", 0.9),
    "tee off": ("golf", 0.9),
    "your eyes down": ("look/down", 0.9),
    "stir the sambar": ("stir", 0.9),
}

HOLDS_SEVERAL = Meant(SEVERAL, 0.9)


def _classes(texts: Sequence[str]) -> Mapping[str, Meant]:
    return {text: Meant(*MEANT.get(text, ("outside", 0.9))) for text in texts}


def _parted(said: str, meant: Meant = HOLDS_SEVERAL) -> list[list[str]]:
    reading = Reading(said, ((PlainCommand(said, Manner(tempo=0.5)),),))
    found = with_parted_commands(reading, {said: meant}, _classes)
    assert all(command.manner.tempo == 0.5 for step in found.steps for command in step)
    return [[command.text for command in step] for step in found.steps]


@pytest.mark.parametrize(
    ("said", "steps"),
    [
        ("bow with your palms pressed together in prayer", [["bow", "your palms pressed in prayer"]]),
        ("a shrug with a head tilt to the right thrown in, one combo move", [["a shrug", "a head tilt to the right"]]),
        ("with your eyes down stir the sambar", [["look down", "stir the sambar"]]),
        ("serve an ace. next up: tee off", [["serve an ace"], ["tee off"]]),
        ("tee off and serve an ace", [["tee off"], ["serve an ace"]]),
        ("tee off and serve an ace at the same time", [["tee off", "serve an ace"]]),
    ],
)
def test_both_parts_are_gestures(said: str, steps: list[list[str]]) -> None:
    assert _parted(said) == steps


@pytest.mark.parametrize("said", ["bow with a round of drinks", "bow with the tide", "bow", "bow and bow"])
def test_words_that_are_no_two_gestures_stay(said: str) -> None:
    assert _parted(said) == [[said]]


def test_a_command_of_one_gesture_stays() -> None:
    assert _parted("tee off and serve an ace", Meant("golf", 0.6)) == [["tee off and serve an ace"]]


def test_a_text_with_more_commands_at_once_than_body_parts_stays() -> None:
    said = "bow with your palms pressed in prayer"
    step = (PlainCommand(said), PlainCommand("nod"), PlainCommand("wave"))
    reading = Reading(said, (step,))
    assert with_parted_commands(reading, {said: Meant(SEVERAL, 0.9)}, _classes) is reading
