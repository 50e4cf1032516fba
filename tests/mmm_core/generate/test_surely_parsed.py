"""A likely answer of the parser replaces another reading, unless that has a task that must be refused."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from mmm_core.generate.surely_parsed import as_surely_parsed
from mmm_core.language.gesture_steps import ANY_ARM, ArmGesture, GestureSteps
from mmm_core.language.plain_gestures import OUTSIDE, Meant, gesture_of
from mmm_core.language.reading import read

WAVE: GestureSteps = ((ArmGesture(ANY_ARM, "wave"),),)
CLAP: GestureSteps = ((ArmGesture(ANY_ARM, "clap"),),)
TASK: GestureSteps = ((ArmGesture(ANY_ARM, OUTSIDE),),)


class _Parse:
    """A parser's answers for one sentence, each with its probability."""

    def __init__(self, shares: Mapping[GestureSteps, float]) -> None:
        self._shares = shares

    def likeliest(self, n: int) -> list[GestureSteps]:
        return sorted(self._shares, key=lambda steps: -self._shares[steps])[:n]

    def log_likelihoods(self, answers: Sequence[GestureSteps]) -> list[float]:
        return [math.log(self._shares.get(steps, 1e-6)) for steps in answers]


def _classes(commands: Sequence[str]) -> dict[str, Meant]:
    """The gesture that the first word of each command names."""
    return {text: Meant(gesture_of(text.split()[0]) or OUTSIDE, 1.0) for text in commands}


@pytest.mark.parametrize(
    ("text", "shares", "words", "denied"),
    [
        ("forget the clap, a wave is plenty", {WAVE: 0.9}, "wave your hand", None),
        ("no clapping", {(): 0.9}, "", ("clapping",)),
        ("wave your hand and clap", {(): 0.9}, "", ("wave your hand", "clap")),
        # less sure, of the same gestures, in doubt of what is no gesture, or of a task
        ("clap, do not wave", {WAVE: 0.84, CLAP: 0.1}, "clap", ("wave",)),
        ("clap twice, do not wave", {CLAP: 0.9}, "clap twice", ("wave",)),
        ("clap", {TASK: 0.9}, "clap", ()),
        ("clap, then run away", {CLAP: 0.9}, "clap, then run away", ()),
        ("party with your arms left and right in turn", {CLAP: 0.9}, "party with your arms left and right in turn", ()),
    ],
)
def test_a_sure_answer_takes_the_place_of_a_reading(
    text: str, shares: Mapping[GestureSteps, float], words: str, denied: tuple[str, ...] | None
) -> None:
    states: Any = SimpleNamespace(parse=_Parse(shares))
    found = as_surely_parsed(read(text), states, _classes)
    assert found.words == words
    assert denied is None or found.denied == denied


def test_number_and_manner_are_those_of_the_reading() -> None:
    states: Any = SimpleNamespace(parse=_Parse({CLAP: 0.9}))
    found = as_surely_parsed(read("clap slowly three times and nod"), states, _classes)
    ((command,),) = found.steps
    assert command.text == "clap three times"
    assert command.manner.tempo < 1


@pytest.mark.parametrize(("text", "stays"), [("wave both hands", True), ("salute with your left hand", False)])
def test_an_answer_that_only_leaves_the_arms_open_changes_nothing(text: str, stays: bool) -> None:
    states: Any = SimpleNamespace(parse=_Parse({WAVE: 0.9}))
    reading = read(text)
    found = as_surely_parsed(reading, states, lambda commands: {said: Meant(said.split()[0], 1.0) for said in commands})
    assert (found == reading) is stays
