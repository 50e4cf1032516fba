"""Synthesised gestures by name, for tests."""

import numpy as np

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.synthesis import ClipSpec, synthesise_spec
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import quat_wxyz


def gesture(name, count=3, seed=0):
    """A motion that shows a gesture `count` times, with both hands where it has that."""
    sides, directions = FAMILIES[name].sides, FAMILIES[name].directions
    direction = directions[0] if directions else ""
    side = "both" if "both" in sides else (sides or ("",))[0]
    body = synthesise_spec(
        ClipSpec((Gesture(name, side, count, direction, 1.0, 1.0),)), np.random.default_rng(seed)
    ).body
    T = len(body.joints_m)
    return Motion(
        body.joints_m.astype(np.float32), 20.0, quat_wxyz(body.head_R_world).astype(np.float32),
        body.forearm_twist_rad.astype(np.float32), np.zeros((T, 263), np.float32), np.zeros(0, np.int32), name, 0,
        "accepted", 1.0,
    )  # fmt: skip
