"""The mirrored text gives the mirrored motion, also where "left" and "right" mean something else."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.evaluation.mirrored import limb_angles_deg, mirrored_figures
from mmm_core.generate.editing import Edit, edit
from mmm_core.generate.engine import Engine
from mmm_core.generate.interpretation import interpret
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.model.sampling import OFFICIAL_SAMPLING
from mmm_core.motion.features import mirror
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import MIRROR
from tests.support.sizes import few_and_long


@pytest.mark.parametrize(
    ("text", "read", "is_mirrored"),
    [
        ("wave with your right hand", "wave with your right hand", False),
        ("wave with your left hand", "wave with your right hand", True),
        ("raise your left hand right away", "raise your right hand right away", True),
        ("she left the room, wave with the right hand", "she left the room, wave with the right hand", False),
        ("with the hand on the left hip on the right", "with the hand on the right hip on the left", True),
        ("look left, then right", "look right, then left", True),
        ("turn counter clockwise", "turn clockwise", True),
        ("turn anticlockwise", "turn clockwise", True),
        ("turn CW", "turn CW", False),
        ("clap your hands right now", "clap your hands right now", False),
        ("turn left as she came", "turn left as she came", False),
        ("", "", False),
    ],
)
def test_one_of_a_text_and_its_mirror_image_is_read(text: str, read: str, is_mirrored: bool) -> None:
    assert canonical(text) == (read, is_mirrored)


@pytest.mark.parametrize("text", ["punch left, right, left", "Left arm up!", "lean rightwards, not left", "spin ccw"])
def test_both_of_a_pair_read_the_same(text: str) -> None:
    assert canonical(text)[0] == canonical(mirror_words(text))[0]
    assert canonical(text)[1] != canonical(mirror_words(text))[1]


@pytest.mark.parametrize(
    ("one", "other"),
    few_and_long(
        [("wave with your left hand", "wave with your right hand")],
        [
            ("raise your left hand right away", "raise your right hand right away"),
            ("wave, hand on the left, other on the right hip", "wave, hand on the right, other on the left hip"),
            ("look to the left, then look to the right", "look to the right, then look to the left"),
            ("wave with the left hand, not with the right", "wave with the right hand, not with the left"),
        ],
    ),
)  # fmt: skip
def test_the_mirrored_text_gives_the_mirrored_motion(engine: Engine, one: str, other: str) -> None:
    for seed in (0, 7):
        a, b = engine.generate(one, seed=seed), engine.generate(other, seed=seed)
        assert a.status == b.status != "rejected" and a.scope_score == b.scope_score
        assert mirror_words(a.understood) == b.understood and mirror_words(a.reason) == b.reason
        assert limb_angles_deg(a.motion, b.motion).max() < 0.01
        flipped = b.motion.joints_m[:, list(MIRROR)] * np.array([-1, 1, 1], np.float32)
        np.testing.assert_allclose(a.motion.joints_m, flipped, atol=1e-5)
        np.testing.assert_allclose(a.motion.forearm_twist_rad, -b.motion.forearm_twist_rad[:, ::-1], atol=1e-5)
        np.testing.assert_array_equal(a.motion.features, mirror(b.motion.features))
        assert a.motion.text == one and len(a.motion.tokens) == len(b.motion.tokens)


@pytest.mark.long
def test_a_mirrored_motion_can_be_edited(engine: Engine) -> None:
    motion = engine.generate("wave with your left hand", seed=1, seconds=4).motion
    again = edit(engine, motion, Edit(start_s=3.0), "wave with your left hand", seed=2).motion
    kept = np.linalg.norm(again.joints_m[:40] - motion.joints_m[:40], axis=-1)
    assert kept.mean() < 0.05


def test_texts_without_a_side_are_as_they_were(engine: Engine) -> None:
    motion = engine.generate("clap your hands", seed=3).motion
    ids = engine.ids_of(motion)
    states, verdict = engine.understand("clap your hands")
    again = engine.motion(ids, "clap your hands", 3, verdict, engine.predicted_frames(states))
    np.testing.assert_array_equal(motion.features, again.features)


def test_an_imported_model_is_asked_as_it_stands(engine: Engine) -> None:
    plain = Engine(engine.model, engine.encoder, "", OFFICIAL_SAMPLING)
    plain.model.rest_pose = "humanml3d"
    try:
        assert not interpret(plain, "wave with your left hand").is_mirrored
    finally:
        plain.model.rest_pose = "mmmd"


class TestTheMeasure:
    def test_another_motion_is_far(self, engine: Engine) -> None:
        a, b = (engine.generate(t, seconds=3).motion for t in ("wave with your left hand", "wave with your left hand"))
        assert limb_angles_deg(a, b).max() > 60
        assert limb_angles_deg(a, mirror_image(b)).max() < 0.01

    def test_its_figures(self, engine: Engine) -> None:
        motions = {s: engine.generate("raise your right arm", seed=s, seconds=2).motion for s in (0, 1)}

        def unmirrored(_text: str, seed: int) -> Motion:
            return motions[seed]

        found = mirrored_figures(unmirrored, ["raise your right arm", "clap"], [0, 1])
        assert found["n"] == 2 and found["rms_deg"] > 5 and found["worst_rms_deg"] >= found["rms_deg"]
        right = mirrored_figures(lambda t, s: engine.generate(t, seed=s).motion, ["raise your right arm"], [0])
        assert right == {"n": 1, "rms_deg": 0.0, "worst_rms_deg": 0.0}
        assert mirrored_figures(unmirrored, ["clap"], [0]) == {"n": 0}

    def test_motions_of_two_lengths_are_refused(self, engine: Engine) -> None:
        a, b = (engine.generate("nod", seconds=s).motion for s in (1.0, 2.0))
        with pytest.raises(ValueError, match="20 and 40 frames"):
            limb_angles_deg(a, b)


def mirror_image(m: Motion) -> Motion:
    flip = np.array([-1, 1, 1], np.float32)
    return Motion(
        m.joints_m[:, list(MIRROR)] * flip, m.fps, m.head_quat_wxyz * np.array([1, 1, -1, -1], np.float32),
        -m.forearm_twist_rad[:, ::-1], mirror(m.features), m.tokens, m.text, m.seed, m.status, m.scope_score,
    )  # fmt: skip
