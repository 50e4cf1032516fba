"""Words of size make a generated motion larger or smaller, arms by the way of the hand."""

from __future__ import annotations

import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import Command
from mmm_core.evaluation.manner import judge_manner, plain_sentence
from tests.support.shipped import shipped_engine
from tests.support.sizes import few_and_long

COMMANDS = (
    ("wave your left hand", "wave", "arm", "left"), ("clap", "clap", "arm", ""), ("shrug your shoulders", "shrug", "arm", ""),
    ("stretch your left arm forward", "arm_forward", "arm", "left"), ("bow", "bow", "trunk", ""), ("nod", "nod", "head", ""),
    ("turn your upper body to the left", "twist", "trunk", ""), ("flap your arms", "flap", "arm", ""),
    ("conduct the choir", "conduct", "arm", ""),
)  # fmt: skip


@pytest.mark.parametrize("n", few_and_long([3], [len(COMMANDS)]))
@pytest.mark.parametrize(("size", "factor"), few_and_long([("large", 1.4)], [("small", 0.6)]))
def test_a_word_of_size_goes_the_right_way(size: str, factor: float, n: int) -> None:
    """All but one: motions differ by the processor's arithmetic, and one that is large already may not grow by 15 %."""
    wrong: list[str] = []
    for text, family, limb, side in COMMANDS[:n]:
        shown, plain = (
            shipped_engine().generate(t, seed=0).motion for t in (f"exactly: {text} ({factor} times as large)", text)
        )
        if judge_manner(Command(family, limb, side, size=size), shown, plain) != {"size": True}:
            wrong.append(text)
    assert len(wrong) <= 1, wrong


def test_a_motion_that_is_no_larger_or_smaller_fails() -> None:
    for text, family, limb, side in COMMANDS[:3]:
        plain = shipped_engine().generate(text, seed=0).motion
        for size in ("large", "small"):
            assert judge_manner(Command(family, limb, side, size=size), plain, plain) == {"size": False}, text


def test_every_family_has_a_plain_sentence_with_and_without_a_direction() -> None:
    for name, family in FAMILIES.items():
        for way in ("", *family.directions):
            for side in ("", *family.sides):
                said = plain_sentence(Command(name, family.limb, side, direction=way, size="small"))
                assert said and not set("{}|()") & set(said), (name, way, side)
