"""Words of size make a generated motion larger or smaller, arms by the way of the hand."""

from __future__ import annotations

import pytest

from mmm_core.corpus.heldout import Command
from mmm_core.evaluation.manner import judge_manner
from tests.support.shipped import shipped_engine

COMMANDS = (
    ("wave your left hand", "wave", "arm", "left"), ("clap", "clap", "arm", ""), ("shrug your shoulders", "shrug", "arm", ""),
    ("stretch your left arm forward", "arm_forward", "arm", "left"), ("bow", "bow", "trunk", ""), ("nod", "nod", "head", ""),
    ("turn your upper body to the left", "twist", "trunk", ""),
)  # fmt: skip


@pytest.mark.parametrize(("size", "factor"), [("large", 1.4), ("small", 0.6)])
def test_a_word_of_size_goes_the_right_way(size: str, factor: float) -> None:
    """All but one: motions differ by the processor's arithmetic, and one that is large already may not grow by 15 %."""
    wrong: list[str] = []
    for text, family, limb, side in COMMANDS:
        shown, plain = (
            shipped_engine().generate(t, seed=0).motion for t in (f"exactly: {text} ({factor} times as large)", text)
        )
        if judge_manner(Command(family, limb, side, size=size), shown, plain) != {"size": True}:
            wrong.append(text)
    assert len(wrong) <= 1, wrong
