"""The reference performance of a gesture: the corpus's own motion with all randomness off."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.beat import BEAT_S, Calm
from mmm_core.corpus.body import perform
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.score import Score
from mmm_core.corpus.synthesis import rest_pose
from mmm_core.language.moods import MOODS
from mmm_core.motion.features import recover
from mmm_core.motion.motion import FPS
from mmm_core.motion.posture_features import PostureFeatures, posture_features
from mmm_core.recognition.checks import PALM_M

Array = NDArray[np.floating]
END_S = 0.3
"""Seconds of standing after a gesture."""
ARM_MOVES_M, ANGLE_MOVES_M = 0.05, 0.06
"""Range from which a channel counts as acting: metres of a hand, and of head and trunk with angles scaled to metres."""
ACTING_SHARE = 0.5
"""Share of the larger range of the two arms from which the other arm acts, too."""
_HEAD_DEG_PER_M, _TRUNK_DEG_PER_M, _FOREARM_M, _TWIST_M_PER_RAD, _LIFT = 100.0, 60.0, 0.25, 0.1, 3.0


def channels(s: PostureFeatures) -> dict[str, Array]:
    """Path (T, D) of each limb: left, right, head, trunk; metres, with angles scaled to similar weight."""
    out: dict[str, Array] = {}
    for side in ("left", "right"):
        twist = s.twist_rad[side]
        turned = np.zeros((len(s.lift_m), 1)) if twist is None else _TWIST_M_PER_RAD * twist[:, None]
        out[side] = np.concatenate([s.wrists_m[side], _FOREARM_M * s.fore[side], turned], -1)
    out["head"] = np.stack([s.head_yaw_deg, s.head_pitch_deg, s.head_roll_deg], -1) / _HEAD_DEG_PER_M
    trunk = np.stack([s.trunk_yaw_deg, s.trunk_pitch_deg, s.trunk_roll_deg], -1) / _TRUNK_DEG_PER_M
    out["trunk"] = np.concatenate([trunk, _LIFT * s.lift_m[:, None]], -1)
    return out


def palms(s: PostureFeatures) -> dict[str, Array]:
    """(T, 3) middle of each palm in the chest frame, metres."""
    return {side: s.wrists_m[side] + PALM_M * s.fore[side] for side in ("left", "right")}


@dataclass(frozen=True, eq=False)
class Reference:
    """The reference performance of a gesture.

    Attributes:
        gesture: the gesture.
        shown: posture features of its motion.
        core: frames of the gesture itself, without its onset and return.
        acting: channels that make the strokes or take the pose.
        axes: direction of the largest extent of each acting channel.
        is_path: whether the palms move round a closed path.
    """

    gesture: Gesture
    shown: PostureFeatures
    core: slice
    acting: tuple[str, ...]
    axes: dict[str, Array]
    is_path: bool

    def along(self, s: PostureFeatures, channel: str) -> Array:
        """(T,) position of a channel of `s` along its axis."""
        return channels(s)[channel] @ self.axes[channel]


@lru_cache(maxsize=512)
def reference(g: Gesture, otherwise: bool = False) -> Reference:
    """The reference performance of a gesture, which begins and ends at rest; `otherwise` takes the second of two variants."""
    rng = np.random.default_rng(0)
    score = Score(rng, rest_pose(Calm(rng)), follow_through=0.02, beat_s=BEAT_S, otherwise=otherwise)
    FAMILIES[g.family].perform(score, replace(g, hold_s=g.hold_s or 1.2 * FAMILIES[g.family].holds))
    starts, ends = min(score.strokes_s, default=0.0), score.time_s
    score.relax(0.8)
    score.hold(END_S)
    style = MOODS.get(g.style)
    posture = (style.trunk_pitch_rad, style.head_pitch_rad) if style else (0.0, 0.0)
    body = perform(score, int(np.ceil(score.time_s * FPS)), style.stiffness if style else 0.0, posture)
    motion = recover(body.features())
    shown = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    core = slice(int(starts * FPS), max(int(ends * FPS), int(starts * FPS) + 4))
    return Reference(g, shown, core, *_acting(shown, core, FAMILIES[g.family].limb), score.is_traced)


def _acting(s: PostureFeatures, core: slice, limb: str) -> tuple[tuple[str, ...], dict[str, Array]]:
    moving = {name: path[core] for name, path in channels(s).items()}
    reach = {name: float(np.linalg.norm(np.ptp(path, axis=0))) for name, path in moving.items()}
    wanted = ("left", "right") if limb == "arm" else (limb,) if limb else ()
    most = max((reach[name] for name in wanted), default=0.0)
    least = ARM_MOVES_M if limb == "arm" else ANGLE_MOVES_M
    acting = tuple(name for name in wanted if reach[name] > max(least, ACTING_SHARE * most))
    axes = {name: np.linalg.svd(moving[name] - moving[name].mean(0), full_matrices=False)[2][0] for name in acting}
    return acting, axes
