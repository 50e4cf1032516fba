"""A text that names many strokes gets them: the period of a motion with two strokes is repeated."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from mmm_core.generate import repeated_strokes
from mmm_core.generate.engine import Engine
from mmm_core.generate.interpretation import interpret
from mmm_core.generate.repeated_strokes import Repetition, expected_tokens, periods, repeated, with_few_strokes
from mmm_core.model.tokens import MAX_TOKENS
from mmm_core.motion.features import mirror
from mmm_core.motion.repetitions import strokes_of
from tests.support.sizes import few_and_long


def tokens(engine: Engine, text: str) -> list[int]:
    """The packed ids of a text's motion."""
    return engine.generate(text).motion.tokens.tolist()


@pytest.mark.parametrize(
    "text", few_and_long(["nod {} times"], ["bow {} times", "knock {} times with your right hand"])
)
def test_many_strokes_are_two_whose_period_is_repeated(engine: Engine, text: str) -> None:
    two = tokens(engine, text.format("two"))
    lengths = []
    for count in ("four", "five", "eight", "twelve"):
        many = tokens(engine, text.format(count))
        lengths.append(len(many))
        assert set(many) == set(two), "nothing is made up or left out"
        assert many[:2] == two[:2] and many[-2:] == two[-2:], "it begins and ends as it did"
    period = lengths[1] - lengths[0]
    assert 2 <= period < len(two)
    assert lengths == [len(two) + period * n for n in (2, 3, 6, 10)]


def test_many_strokes_take_as_long_as_they_take(engine: Engine) -> None:
    assert len(tokens(engine, "bow ten times")) > MAX_TOKENS


@pytest.mark.parametrize("count", few_and_long([3, 8], [4, 5, 6, 12]))
def test_strokes_are_as_many_as_the_text_names(engine: Engine, count: int) -> None:
    found = strokes_of(engine.generate(f"nod {count} times").motion)
    assert found is not None and len(found.frames) == count


@pytest.mark.parametrize("text", few_and_long(["salute {}"], ["take {} sips from your glass", "give me {} high fives"]))
def test_a_gesture_without_strokes_is_done_as_often_as_a_text_says(engine: Engine, text: str) -> None:
    numbers = ("two times", "four times") if text == "salute {}" else ("two", "four")
    two, four = (tokens(engine, text.format(number)) for number in numbers)
    once = len(two) // 2
    assert four == two + two[once:] * 2, "all but the opening of the first, which the draft has given already"
    assert two[once + 2 :] == two[2:once]


def test_each_step_of_a_text_has_its_own_number(engine: Engine) -> None:
    made = engine.generate("nod five times, then clap four times")
    frames = [round(scene.end_s * 20) for scene in made.scenes]
    assert len(frames) == 2
    alone = engine.generate("nod five times").motion
    assert frames[0] == len(alone.joints_m)


def test_the_mirrored_text_gives_the_mirrored_strokes(engine: Engine) -> None:
    left, right = (engine.generate(f"wave six times with your {side} hand").motion for side in ("left", "right"))
    np.testing.assert_allclose(mirror(left.features), right.features, atol=1e-5)


@pytest.mark.parametrize(
    "text", ["clap", "clap twice", "clap two times", "nod once", "wave six times while you nod three times"]
)
def test_other_commands_stay_as_they_are(engine: Engine, text: str) -> None:
    steps = interpret(engine, text).steps
    found, counts = with_few_strokes(engine, steps)
    assert tuple(found) == steps and counts == [None] * len(steps)


def test_a_given_length_is_kept(engine: Engine) -> None:
    assert len(engine.generate("clap five times", seconds=4.0).motion.joints_m) == 80


def test_the_expected_length_is_near_the_length(engine: Engine) -> None:
    for text in ("nod six times", "bow five times", "clap eight times"):
        made = engine.begin(text)
        assert 0.7 < made.n_frames / len(made.result().motion.joints_m) < 1.4, text
    assert expected_tokens(12, None) == 12 and expected_tokens(12, Repetition(3, of_whole=True)) == 36


def test_a_motion_that_does_not_return_is_not_repeated(engine: Engine) -> None:
    """No period fits into so few tokens."""
    (command,) = interpret(engine, "nod six times").steps[0]
    assert periods(engine, command)
    ids = torch.arange(6).reshape(2, 3)
    with torch.inference_mode():
        assert repeated(engine, engine.model.tokenizer, command, ids, Repetition(6), 2) is None


def test_strokes_that_cannot_be_repeated_are_the_model_s_own(engine: Engine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(repeated_strokes, "_FARTHEST", 0.0)
    own = tokens(engine, "nod six times")
    monkeypatch.setattr(repeated_strokes, "FROM_COUNT", 100)
    assert own[2:] == tokens(engine, "nod six times")[2:], "all but the opening, which the draft has given already"
