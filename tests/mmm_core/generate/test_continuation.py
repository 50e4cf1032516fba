"""Motions that go on from what is there: they begin near its end, and their first frame is the one after its last."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from daemon.poses.pose_sequence import distance_deg, posture_of
from mmm_core.errors import GenerationError
from mmm_core.generate.continuation import continue_motion
from mmm_core.generate.engine import Engine
from mmm_core.generate.keyframes import features_of
from mmm_core.model.tokens import MAX_TOKENS
from mmm_core.motion.motion import Motion


@pytest.fixture(scope="module")
def raised(engine: Engine) -> Motion:
    """The 1.6 s in which both arms go up, as the daemon shows what it plays: posture alone."""
    motion = engine.generate("raise both arms", seed=1).motion
    up = int(motion.joints_m[:, 20:22, 1].sum(1).argmax()) + 1
    shown = posture_of(motion).at(np.arange(up - 32, up)).motion()
    return replace(shown, features=features_of(shown).numpy())


def begins_deg(motion: Motion, before: Motion) -> float:
    """Between the last frame of one and the first of the next."""
    return float(distance_deg(posture_of(before)[-1:], posture_of(motion)[:1])[0])


@pytest.mark.long
def test_it_begins_nearer_to_where_the_other_ends(engine: Engine, raised: Motion) -> None:
    """The shipped model begins every clip at rest and hardly goes on from elsewhere: docs/daemon.md has how near it comes."""
    texts = ("wave with your right hand", "clap your hands", "cross your arms")
    without = [begins_deg(engine.generate(t, seed=4).motion, raised) for t in texts]
    after = [begins_deg(continue_motion(engine, raised, 1.6, t, seed=4).motion, raised) for t in texts]
    assert min(without) > 100 and max(after) < 0.65 * min(without), (without, after)


def test_what_is_given_back_is_the_new_motion_alone(engine: Engine, raised: Motion) -> None:
    made = continue_motion(engine, raised, 0.8, "wave with your right hand", seed=3, seconds=3.0)
    assert made.status == "accepted" and len(made.motion.joints_m) == len(made.motion.features) == 60
    assert len(engine.ids_of(made.motion)) == 15 and made.motion.text == "wave with your right hand"
    assert np.abs(made.motion.joints_m[0, 0, [0, 2]]).max() < 1e-6, "it stands at the origin in its first frame"


def test_its_frames_are_those_of_one_pass_over_both(engine: Engine, raised: Motion) -> None:
    made = continue_motion(engine, raised, 0.8, "nod", seed=3)
    both = torch.cat([engine.ids_of(raised), engine.ids_of(made.motion)])
    whole = engine.model.tokenizer.decode(both[None])[0].numpy()
    assert np.array_equal(whole[32 : 32 + len(made.motion.features)], made.motion.features)


def test_a_request_gives_one_motion_and_another_prefix_another(engine: Engine, raised: Motion) -> None:
    one, again, longer = (continue_motion(engine, raised, s, "wave", seed=5).motion for s in (0.8, 0.8, 1.6))
    assert np.array_equal(one.joints_m, again.joints_m)
    assert len(one.joints_m) != len(longer.joints_m) or not np.array_equal(one.joints_m, longer.joints_m)


def test_several_commands_go_on_one_after_the_other(engine: Engine, raised: Motion) -> None:
    made = continue_motion(engine, raised, 0.8, "raise your left arm, then bow deeply", seed=2)
    alone = engine.generate("raise your left arm, then bow deeply", seed=2)
    assert ", then " in made.understood and len(made.motion.joints_m) == len(alone.motion.joints_m)
    assert begins_deg(made.motion, raised) < begins_deg(alone.motion, raised)


def test_a_motion_that_leaves_no_room_for_a_prefix_has_none(engine: Engine, raised: Motion) -> None:
    made = continue_motion(engine, raised, 1.6, "wave with your right hand", seed=3, seconds=9.8)
    assert len(engine.ids_of(made.motion)) == MAX_TOKENS


def test_what_cannot_be_done_is_rejected(engine: Engine, raised: Motion) -> None:
    made = continue_motion(engine, raised, 0.8, "walk to the window")
    assert made.status == "rejected" and made.reason and not len(made.motion.joints_m)


@pytest.mark.parametrize("prefix_s", [0.0, 0.05, 1.8, -1.0])
def test_a_prefix_out_of_range_is_named(engine: Engine, raised: Motion, prefix_s: float) -> None:
    with pytest.raises(GenerationError, match=r"0\.2 to 1\.6"):
        continue_motion(engine, raised, prefix_s, "wave")


def test_a_prefix_longer_than_what_there_is_is_named(engine: Engine, raised: Motion) -> None:
    short = replace(
        raised, **{k: getattr(raised, k)[:8] for k in ("joints_m", "head_quat_wxyz", "forearm_twist_rad", "features")}
    )
    with pytest.raises(GenerationError, match=r"of 0\.4 s"):
        continue_motion(engine, short, 0.8, "wave")
