"""Clips of the corpus put together by body parts show what each of them shows; what no part was taken from is not seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmm_core.corpus.heldout import Command, Probe
from mmm_core.evaluation.reconstruction import Features, performed
from mmm_core.evaluation.robot_capability import as_motion
from mmm_core.evaluation.sentences import seen_at_once
from mmm_core.motion.body_parts import FADE_FRAMES, PARTS, BodyPart, of_rotations, put_together
from mmm_core.motion.posture_features import posture_features

LEFT, RIGHT = Command("salute", "arm", "left"), Command("heart", "arm", "right")
LOOK, LEAN, BOW = (
    Command("look", "head", direction="left"),
    Command("lean", "trunk", direction="right"),
    Command("bow", "trunk"),
)
PAIRS: list[tuple[Command, BodyPart, Command, BodyPart]] = [
    (LEFT, "left_arm", RIGHT, "right_arm"),
    (LOOK, "head", LEAN, "trunk"),
    (LOOK, "head", BOW, "trunk"),
    (LEFT, "left_arm", LEAN, "trunk"),
    (RIGHT, "right_arm", LOOK, "head"),
]  # fmt: skip
N_FRAMES = 48


def clip(command: Command) -> Features:
    """A clip in which the corpus performs a command, `N_FRAMES` long."""
    features = performed(Probe("", command.family, command.limb, command.side, None, command.direction), 3)[:N_FRAMES]
    return np.concatenate([features, np.repeat(features[-1:], N_FRAMES - len(features), 0)])


def seen(commands: tuple[Command, ...], features: Features) -> bool:
    motion = as_motion(features)
    return seen_at_once(commands, posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad))


@pytest.mark.parametrize(("a", "part_a", "b", "part_b"), PAIRS)
def test_two_clips_are_both_seen(a: Command, part_a: BodyPart, b: Command, part_b: BodyPart) -> None:
    both = put_together(clip(a), {part_a: clip(a), part_b: clip(b)}, 0, N_FRAMES)
    assert seen((a, b), both)
    assert not seen((a, b), clip(a))
    assert not seen((a, replace(b, side="", direction="up", family="look", limb="head")), both)


def test_a_clip_put_together_of_itself_is_itself() -> None:
    own = clip(BOW)
    again = put_together(own, dict.fromkeys(PARTS, own), 0, N_FRAMES)
    np.testing.assert_allclose(again[:, :193], of_rotations(own)[:, :193], atol=1e-5)


def test_edges_inside_a_motion_are_faded_and_frames_outside_stay() -> None:
    own, other = clip(LOOK), clip(LEFT)
    mixed = put_together(own, {"left_arm": other}, 12, 36)
    np.testing.assert_allclose(mixed[:12, 67:193], own[:12, 67:193], atol=1e-4)
    np.testing.assert_allclose(mixed[36:, 67:193], own[36:, 67:193], atol=1e-4)
    steps = np.abs(np.diff(mixed[:, 67:193], axis=0)).max()
    whole = np.abs(own[:, 67:193] - other[:, 67:193]).max()
    assert steps < np.abs(np.diff(other[:, 67:193], axis=0)).max() + whole / (FADE_FRAMES - 1)
