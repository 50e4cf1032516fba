"""Between two commands no body part moves that ends where it begins again."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from numpy.typing import NDArray

from mmm_core.generate.engine import Engine
from mmm_core.generate.transitions import TRANSITION_TOKENS, transitions
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.repetitions import body_path
from tests.support.sizes import few_and_long

MOST_ASIDE_M = 0.1
"""Metres by which a wrist may leave the straight way between two commands."""


def _aside_m(path: NDArray[np.floating]) -> float:
    """Greatest distance of either wrist from the straight way from the first to the last frame of a path (T, 18)."""
    straight = np.linspace(path[0], path[-1], len(path))
    return float(np.linalg.norm((path - straight)[:, :6].reshape(-1, 2, 3), axis=-1).max())


@pytest.mark.parametrize(
    ("first", "second"),
    few_and_long(
        [("wave with your right hand", "look to the left")],
        [
            ("punch with your left hand", "punch with your right hand"),
            ("point up with your left hand", "salute with your right hand"),
            ("nod", "clap"),
        ],
    ),
)
def test_arms_at_rest_stay_at_rest(engine: Engine, first: str, second: str) -> None:
    """Between a punch of the left hand and one of the right both fists went forward by 20 cm."""
    n = len(engine.generate(first, seed=0).motion.joints_m)
    path = body_path(engine.generate(f"{first}, then {second}", seed=0).motion)
    assert _aside_m(path[n - 2 : n + TRANSITION_TOKENS * FRAMES_PER_TOKEN + 2]) < MOST_ASIDE_M


def test_only_an_arm_that_is_elsewhere_is_moved_by_the_model(engine: Engine) -> None:
    made = torch.from_numpy(engine.generate("raise your left hand", seed=0).motion.features[None])
    with torch.inference_mode():
        row = engine.model.tokenizer.encode(made)[0]
        cut, states = row[: len(row) // 2], engine.read(["raise your left hand"])
        whole, half = (transitions(engine, [left, row], [states, states], 3)[0] for left in (row, cut))
    parts = engine.model.tokenizer.part_names
    right = parts.index("right_arm")
    assert torch.equal(whole, torch.stack([row[-1], row[0]]))
    assert half[:, right].tolist() == [int(cut[-1, right]), int(row[0, right])]
    assert half.shape == (TRANSITION_TOKENS, len(parts)) and int(half.max()) < engine.model.transformer.ids.mask


def test_a_single_motion_has_no_transition(engine: Engine) -> None:
    assert transitions(engine, [torch.zeros(4, 3, dtype=torch.int64)], [], 0) == []
