"""A size is reduced where it would destroy the gesture, and only there."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from mmm_core.generate.kept_sizes import with_kept_sizes
from mmm_core.motion.performing import Stretch, motion_of, performed
from mmm_core.motion.posture_features import posture_features
from mmm_core.recognition.seen import seen
from tests.support.shipped import shipped_engine


def families_seen(features: NDArray[np.float32], words: str) -> set[str]:
    motion = motion_of(features)
    shown = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    return {act.family for act in seen(shown, words)}


@pytest.mark.parametrize(
    ("text", "family", "size"),
    [("clap once", "clap", 0.55), ("play the trumpet", "flute", 0.6), ("play the trumpet", "flute", 1.4)],
)
def test_a_gesture_that_its_size_destroys_is_kept(text: str, family: str, size: float) -> None:
    features = shipped_engine().generate(text, seed=1).motion.features
    asked = [Stretch(0, len(features), size=size)]
    assert family not in families_seen(performed(features, asked)[0], text), "the size destroys nothing: choose another"
    kept = with_kept_sizes(features, asked, [text])
    assert family in families_seen(performed(features, kept)[0], text)
    assert abs(kept[0].size - 1) < abs(size - 1)


def test_a_size_that_destroys_nothing_stays() -> None:
    features = shipped_engine().generate("wave with your left hand", seed=1).motion.features
    asked = [Stretch(0, len(features), size=0.6)]
    assert with_kept_sizes(features, asked, ["wave with your left hand"]) == asked


def test_a_motion_without_sizes_is_not_looked_at() -> None:
    asked = [Stretch(0, 40, tempo=1.4), Stretch(40, 80, hold_s=2.0)]
    assert with_kept_sizes(None, asked, ["nod", "bow"]) == asked  # type: ignore[arg-type]


def test_of_two_commands_only_the_destroyed_one_is_reduced() -> None:
    engine = shipped_engine()
    texts = ("clap once", "wave with your left hand")
    rows = [engine.generate(text, seed=1).motion.features for text in texts]
    features = np.concatenate(rows)
    ends = [len(rows[0]), len(features)]
    asked = [Stretch(0, ends[0], size=0.55), Stretch(*ends, size=0.6)]
    kept = with_kept_sizes(features, asked, texts)
    assert kept[0].size > 0.55
    assert kept[1].size == 0.6
