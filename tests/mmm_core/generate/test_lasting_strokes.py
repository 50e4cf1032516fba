"""Strokes go on for as long as a text says; a pose is held, and a number that the text names is kept."""

from __future__ import annotations

import pytest

from mmm_core.generate.engine import Engine
from mmm_core.generate.interpretation import interpret
from mmm_core.generate.lasting_strokes import with_lasting_strokes
from mmm_core.language.count_words import count_asked
from mmm_core.recognition.seen import scenes_seen
from tests.support.sizes import few_and_long


@pytest.mark.parametrize(
    ("text", "seconds"),
    few_and_long(
        [("wave for 10 seconds", 10.0), ("nod slowly for 12 seconds", 12.0)],
        [("clap for 15 seconds", 15.0), ("rub your belly for 6 seconds", 6.0), ("beckon for 10 s", 10.0),
         ("play the guitar for 8 seconds", 8.0), ("stir the soup with your left hand for 12 seconds", 12.0)],
    ),
)  # fmt: skip
def test_strokes_go_on_for_as_long_as_the_text_says(engine: Engine, text: str, seconds: float) -> None:
    """`say wave for 10 seconds` waved twice and then held its arm up for ten seconds."""
    assert engine.generate(text).motion.duration_s == pytest.approx(seconds, rel=0.15, abs=0.5)


def test_a_long_wave_is_all_waves(engine: Engine) -> None:
    made = engine.generate("wave for 10 seconds")
    ((act,),) = scenes_seen(made.motion, made.scenes)
    assert act.count is not None and act.count >= 8


@pytest.mark.parametrize(
    "text",
    [
        "raise your hand for 5 seconds", "salute for 5 seconds", "bow for 5 seconds", "take a bow for 5 seconds",
        "wave three times for 5 seconds", "wave", "cross your arms and nod for 5 seconds",
    ],
)  # fmt: skip
def test_poses_and_numbers_stay(engine: Engine, text: str) -> None:
    steps = interpret(engine, text).steps
    assert with_lasting_strokes(engine, steps) == list(steps)


@pytest.mark.parametrize(("seconds", "count"), [(0.1, 2), (30, 30)])
def test_there_are_two_strokes_at_least_and_thirty_at_most(engine: Engine, seconds: float, count: int) -> None:
    steps = interpret(engine, f"exactly: clap (for {seconds} s)").steps
    ((command,),) = with_lasting_strokes(engine, steps)
    assert count_asked(command.text) == count and command.manner.hold_s == 0
