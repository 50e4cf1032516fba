"""Words of size make a generated motion larger or smaller, arms by the way of the hand."""

from __future__ import annotations

import pytest

from mmm_core.corpus.heldout import Command
from mmm_core.evaluation.manner import judge_manner
from tests.support.shipped import shipped_engine


@pytest.mark.parametrize("size", ["large", "small"])
@pytest.mark.parametrize(
    ("text", "family", "limb", "side"),
    [
        ("wave your left hand", "wave", "arm", "left"), ("clap", "clap", "arm", ""), ("shrug your shoulders", "shrug", "arm", ""),
        ("stretch your left arm forward", "arm_forward", "arm", "left"), ("bow", "bow", "trunk", ""), ("nod", "nod", "head", ""),
        ("turn your upper body to the left", "twist", "trunk", ""),
    ],
)  # fmt: skip
def test_a_word_of_size_goes_the_right_way(text: str, family: str, limb: str, side: str, size: str) -> None:
    factor = 1.45 if size == "large" else 0.6
    command = Command(family, limb, side, size=size)
    shown, plain = (
        shipped_engine().generate(t, seed=0).motion for t in (f"exactly: {text} ({factor} times as large)", text)
    )
    assert judge_manner(command, shown, plain) == {"size": True}
