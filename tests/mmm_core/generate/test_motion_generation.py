"""A draft after one step, and the motion whose beginning it is: the same whether or not there was a draft."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmm_core.corpus.heldout import Command
from mmm_core.evaluation.sentences import seen_at_once
from mmm_core.generate.motion_generation import OPENING_TOKENS
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.posture_features import posture_features
from tests.support.shipped import shipped_engine
from tests.support.sizes import few_and_long

TEXTS = (
    "wave with your right hand", "wave with your left hand", "clap three times", "nod, then bow", "point up with your left hand",
    "wave and nod", "lean left with your arms up", "look left and bow",
)  # fmt: skip
LOOK, LEAN = Command("look", "head", direction="left"), Command("lean", "trunk", direction="right")
SALUTE, HIP, HEART = (
    Command("salute", "arm", "right"),
    Command("hands_on_hips", "arm", "left"),
    Command("heart", "arm", "left"),
)
AT_ONCE = (
    ("lean to the right while looking to the left", (LEAN, LOOK)),
    ("salute with your right hand and put your left hand on your hip", (SALUTE, HIP)),
    ("bow while your left hand is on your heart", (Command("bow", "trunk"), HEART)),
    ("nod while turning your body to the left", (Command("nod", "head"), Command("twist", "trunk", direction="left"))),
)


@pytest.mark.parametrize("text", few_and_long(["wave with your left hand", "wave and nod"], TEXTS))
def test_the_motion_is_the_same_with_and_without_a_draft(text: str) -> None:
    generation = shipped_engine().begin(text, seed=3)
    draft, motion = generation.preview(), generation.result().motion
    assert draft is not None and draft.status == "accepted"
    assert np.array_equal(motion.features, shipped_engine().generate(text, seed=3).motion.features)
    assert np.array_equal(motion.tokens, shipped_engine().generate(text, seed=3).motion.tokens)


@pytest.mark.parametrize("text", few_and_long(["wave with your left hand", "wave and nod"], TEXTS))
def test_the_motion_begins_as_its_draft_does(text: str) -> None:
    generation = shipped_engine().begin(text, seed=3)
    draft, motion = generation.preview(), generation.result().motion
    assert draft is not None
    half = OPENING_TOKENS * FRAMES_PER_TOKEN // 2
    apart_m = np.linalg.norm(draft.motion.joints_m[:half] - motion.joints_m[:half], axis=-1)
    assert apart_m.max() < 0.03


def test_the_later_part_of_a_motion_is_made_anew() -> None:
    """Where the model is not sure in its first step; a wave it may know at once."""
    same = []
    for text in ("dance", "be happy", "greet the visitors", "celebrate", "show me something", "move about"):
        generation = shipped_engine().begin(text, seed=3)
        draft, motion = generation.preview(), generation.result().motion
        if draft is None:
            continue
        assert np.array_equal(draft.motion.tokens[:OPENING_TOKENS], motion.tokens[:OPENING_TOKENS])
        same.append(np.array_equal(draft.motion.tokens, motion.tokens))
    assert same and not all(same)


@pytest.mark.parametrize("seconds", [None, 3.3])
def test_the_motion_has_as_many_frames_as_was_told(seconds: float | None) -> None:
    for text in ("wave with your right hand", "nod, then bow"):
        generation = shipped_engine().begin(text, seed=1, seconds=seconds)
        assert generation.n_frames == len(generation.result().motion.joints_m)


def test_of_several_commands_the_first_is_drafted() -> None:
    generation = shipped_engine().begin("nod, then clap your hands", seed=1)
    draft = generation.preview()
    assert draft is not None
    assert len(draft.motion.joints_m) == len(shipped_engine().begin("nod", seed=1).result().motion.joints_m)
    assert generation.n_frames > len(draft.motion.joints_m)


def test_what_is_rejected_has_no_draft() -> None:
    generation = shipped_engine().begin("do a backflip", seed=1)
    assert generation.preview() is None
    assert generation.result().status == "rejected" and generation.n_frames == 0


@pytest.mark.parametrize(("text", "commands"), few_and_long(AT_ONCE[:1], AT_ONCE))
def test_each_of_two_commands_at_once_is_seen(text: str, commands: tuple[Command, Command]) -> None:
    motion = shipped_engine().generate(text, seed=1).motion
    shown = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    assert seen_at_once(commands, shown)
    assert not seen_at_once((commands[0], replace(commands[1], side="right", direction="down")), shown)
