"""A story told step by step, by engines that keep nothing between the steps; motion through poses."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from mmm_core.corpus.heldout import Command
from mmm_core.errors import GenerationError
from mmm_core.evaluation.sentences import seen_at_once
from mmm_core.generate.engine import Engine
from mmm_core.generate.keyframes import Keyframe, between
from mmm_core.generate.story import Scene, StoryState, continue_story, generate_story
from mmm_core.motion.posture_features import posture_features

SCENES = [
    Scene("wave with your right hand", 2.0),
    Scene("   "),
    Scene("clap your hands"),
    Scene("nod", 0.8),
    Scene("bow"),
]


@pytest.mark.long
def test_step_by_step_it_is_the_same_story(engine: Engine) -> None:
    """`StoryState` goes through bytes between the steps, as between two machines."""
    whole = np.concatenate([p.features for p in generate_story(engine, SCENES, seed=4)])
    state, pieces = b"", []
    for i, scene in enumerate(SCENES):
        told = msgspec.msgpack.decode(state, type=StoryState) if state else StoryState()
        piece, told, verdict = continue_story(engine, scene, told, seed=4, last=i == len(SCENES) - 1)
        state = msgspec.msgpack.encode(told)
        assert len(state) < 2000  # nothing that grows
        assert (verdict.status == "rejected") == (not scene.text.strip())
        pieces.append(piece.features)
    np.testing.assert_array_equal(np.concatenate(pieces), whole)


def test_a_story_can_be_ended_after_its_last_scene(engine: Engine) -> None:
    whole = np.concatenate([p.features for p in generate_story(engine, SCENES[:1], seed=4)])
    first, told, _ = continue_story(engine, SCENES[0], StoryState(), seed=4)
    rest, _, _ = continue_story(engine, None, told, seed=4, last=True)
    np.testing.assert_array_equal(np.concatenate([first.features, rest.features]), whole)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_scene_shows_both_of_two_commands_at_once(engine: Engine, seed: int) -> None:
    """A story joined the ids of both commands, and the decoder, which reads all parts, lost the nod."""
    pieces = [
        p for p in generate_story(engine, [Scene("clap and nod along to the beat")], seed=seed) if len(p.joints_m)
    ]
    joints_m, head_wxyz, twist_rad = (
        np.concatenate([getattr(p, name) for p in pieces])
        for name in ("joints_m", "head_quat_wxyz", "forearm_twist_rad")
    )
    shown = posture_features(joints_m, head_wxyz, twist_rad)
    assert seen_at_once((Command("clap", "arm", "both"), Command("nod", "head")), shown)


@pytest.mark.parametrize("row", [[1, 2], [0, 0, 100_000], [0, -1, 0]])
def test_ids_of_another_model_are_refused(engine: Engine, row: list[int]) -> None:
    with pytest.raises(GenerationError, match="another model"):
        continue_story(engine, Scene("bow"), StoryState(1, "nod", [row], [row], 0))


def test_a_motion_through_poses_has_their_length_and_comes_near_them(engine: Engine) -> None:
    pose = engine.generate("raise your left arm", seed=1, seconds=2).motion
    high = int(pose.joints_m[:, 20, 1].argmax())
    raised = type(pose)(**{k: v[high : high + 1] if k in _FRAMES else v for k, v in vars(pose).items()})
    low = type(pose)(**{k: v[:1] if k in _FRAMES else v for k, v in vars(pose).items()})
    made = between(engine, [Keyframe(0, low), Keyframe(1.5, raised), Keyframe(3, low)], seed=2)
    assert len(made.joints_m) == 60
    wrist_m = made.joints_m[:, 20, 1]
    assert wrist_m[24:34].max() > wrist_m[0] + 0.5 * (pose.joints_m[high, 20, 1] - pose.joints_m[0, 20, 1])


_FRAMES = ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features")


@pytest.mark.parametrize(
    ("times", "text", "found"),
    [
        ([], "", "no pose"),
        ([0.0, 0.1], "", "another at 0 s"),
        ([-1.0], "", "-1 s"),
        ([12.0], "", "12"),
        ([1.0], "qx zzt vfp", "was given"),
    ],
)
def test_what_cannot_be_met_is_refused(engine: Engine, times: list[float], text: str, found: str) -> None:
    pose = engine.generate("nod", seed=1, seconds=1).motion
    with pytest.raises(GenerationError, match=found):
        between(engine, [Keyframe(t, pose) for t in times], text)
