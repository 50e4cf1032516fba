"""What assistants say most, held to the motion that comes of it."""

from __future__ import annotations

import pytest

from mmm_core.generate.engine import Engine
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.signs import shows
from tests.support.sizes import few_and_long


@pytest.mark.parametrize(
    ("text", "family"),
    few_and_long(
        [("hello", "wave"), ("no", "shake_head"), ("well done", "clap"), ("be quiet", "hush")],
        [("say hello", "wave"), ("Good morning!", "wave"), ("bye", "wave"), ("thank you", "bow"), ("yes", "nod"),
         ("I agree", "nod"), ("I don't know", "shrug"), ("sorry", "heart"), ("come here", "beckon"), ("calm down", "stop"),
         ("one moment", "stop"), ("cheers", "toast")],
    ),
)  # fmt: skip
def test_the_motion_is_the_one_promised(engine: Engine, text: str, family: str) -> None:
    made = engine.generate(text, seed=1)
    assert made.status == "accepted"
    motion = made.motion
    assert shows(posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad), family)
