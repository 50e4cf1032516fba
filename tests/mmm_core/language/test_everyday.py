"""What assistants say most, held to the motion that comes of it."""

from __future__ import annotations

import pytest

from mmm_core.generate.engine import Engine
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.signs import shows


@pytest.mark.parametrize(
    ("text", "family"),
    [
        ("hello", "wave"), ("say hello", "wave"), ("Good morning!", "wave"), ("bye", "wave"), ("thank you", "bow"),
        ("yes", "nod"), ("I agree", "nod"), ("no", "shake_head"), ("I don't know", "shrug"), ("sorry", "heart"),
        ("well done", "clap"), ("come here", "beckon"), ("calm down", "stop"), ("one moment", "stop"), ("be quiet", "hush"),
        ("cheers", "toast"),
    ],
)  # fmt: skip
def test_the_motion_is_the_one_promised(engine: Engine, text: str, family: str) -> None:
    made = engine.generate(text, seed=1)
    assert made.status == "accepted"
    motion = made.motion
    assert shows(posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad), family)
