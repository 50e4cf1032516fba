"""The corpus's own performances meet the expectations by which motions are judged: each gesture alone, and two gestures in turn."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import Command, Sentence
from mmm_core.evaluation.probes import judge
from mmm_core.evaluation.reconstruction import performed
from mmm_core.evaluation.robot_capability import as_motion
from mmm_core.evaluation.sentences import as_probe, judge_sentence
from mmm_core.motion.posture_features import PostureFeatures, posture_features
from mmm_core.recognition.expected import acts_with, goes
from mmm_core.recognition.seen import STILL_FAMILIES

OPPOSITE = {"left": "right", "right": "left", "up": "down", "down": "up", "forward": "back", "back": "forward"}
PAIRS = 40


@cache
def _commands() -> tuple[Command, ...]:
    """A command for each gesture, with each side and direction that its family has."""
    return tuple(_each_command())


def _each_command() -> Iterator[Command]:
    for name, family in FAMILIES.items():
        for side in family.sides or ("",):
            for direction in family.directions or ("",):
                yield Command(name, family.limb, side, direction=direction)


def _shown(*commands: Command, seed: int = 0) -> PostureFeatures:
    """The corpus's performances of commands, one after the other."""
    parts = [as_motion(performed(as_probe(command), seed)) for command in commands]
    return posture_features(
        np.concatenate([m.joints_m for m in parts]),
        np.concatenate([m.head_quat_wxyz for m in parts]),
        np.concatenate([m.forearm_twist_rad for m in parts]),
    )


def _pairs() -> list[tuple[Command, Command]]:
    """Pairs of commands at random, some of which leave their side open."""
    rng = random.Random(0)
    moving = [c for c in _commands() if c.family not in (*STILL_FAMILIES, "arms_down")]
    return [
        (first, second if rng.random() < 0.5 else Command(second.family, second.limb, direction=second.direction))
        for first, second in (rng.sample(moving, 2) for _ in range(PAIRS))
        if (first.family, first.direction) != (second.family, second.direction)
    ]


@pytest.mark.parametrize("command", _commands(), ids=lambda c: " ".join((c.family, c.side, c.direction)).strip())
def test_each_gesture_meets_what_is_expected_of_it(command: Command) -> None:
    assert all(judge(as_probe(command), _shown(command), with_pose=True).values())


@pytest.mark.parametrize("command", [c for c in _commands() if c.direction in OPPOSITE])
def test_no_gesture_goes_in_the_opposite_direction(command: Command) -> None:
    assert not goes(_shown(command), command.family, command.side, OPPOSITE[command.direction])


@pytest.mark.parametrize("command", [c for c in _commands() if c.side in ("left", "right")])
def test_no_gesture_is_done_with_the_other_arm(command: Command) -> None:
    assert not acts_with(_shown(command), command.family, OPPOSITE[command.side])


@pytest.mark.parametrize(("first", "second"), _pairs(), ids=lambda c: f"{c.family} {c.side}")
def test_two_gestures_are_in_order_one_way_round(first: Command, second: Command) -> None:
    shown = _shown(first, second)
    assert judge_sentence(Sentence("", "in_turn", ((first,), (second,))), shown)["order"]
    assert not judge_sentence(Sentence("", "in_turn", ((second,), (first,))), shown)["order"]
