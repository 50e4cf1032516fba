"""Tables of the signs of all families: places and movements of palms, or movements of head and trunk; `signs` reads them.

Places are (outward, up, forward) in metres in the chest frame from the middle between the shoulders, outward for the acting
arm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.recognition import places
from mmm_core.recognition.checks import strokes

Array = NDArray[np.floating]
Vector = tuple[float, float, float]
Box = tuple[float, float, float, float, float, float]
"""Least and greatest outward, least and greatest up, least and greatest forward coordinate of a place."""
SHAKE_FRAMES = 8
"""Frames within which a shaken head comes from one side to the other."""
_OUT, _UP, _FORWARD = 0, 1, 2
_ANYWHERE: Box = (-9, 9, -9, 9, -9, 9)


def near(place: Vector, within_m: float = 0.12) -> Box:
    """The cube about a place, from `within_m` before it to `within_m` behind it along each axis."""
    (a, b, c), r = place, within_m
    return (a - r, a + r, b - r, b + r, c - r, c + r)


@dataclass(frozen=True)
class Sign:
    """Conditions that the acting arm, or both arms, must meet.

    Attributes:
        at: places that the palm visits.
        fore: direction of the forearm at the first place, and the least cosine to it.
        swing: axis and least travel of the palm, metres, while the arm is away from hanging.
        held: whether the palm rests at its first place for a while.
        rests: whether it may do so.
        bend_deg: least and greatest elbow bend at the first place.
        turn: the two axes of a circle, and its least turns; its sign is the sense from the first towards the second axis.
        other: place of the other palm.
        opposed: axis along which the two palms move against each other.
        together: axis along which the two palms move together.
        apart_m: least and greatest distance of the palms at the first place.
        share: least share of the gesture's frames that the palm spends at its places.
        twist_rad: least range of the forearm's twist; not checked for motions without twist.
    """

    at: tuple[Box, ...] = (_ANYWHERE,)
    fore: tuple[Vector, float] | None = None
    swing: tuple[int, float] | None = None
    held: bool = False
    rests: bool = True
    bend_deg: tuple[float, float] = (0.0, 180.0)
    turn: tuple[int, int, float] | None = None
    other: Box | None = None
    opposed: int | None = None
    together: int | None = None
    apart_m: tuple[float, float] = (0.0, 9.0)
    share: float = 0.42
    twist_rad: float = 0.0


_TRUNK_STILL_DEG, _HEAD_STILL_DEG = 9.0, 9.0


def _span(x: Array) -> float:
    return float(np.ptp(x))


def _head_only(s: PostureFeatures) -> bool:
    return not s.arms and max(_span(s.trunk_yaw_deg), _span(s.trunk_pitch_deg), _span(s.trunk_roll_deg)) < 22


def _trunk_only(s: PostureFeatures) -> bool:
    return not s.arms


def _lasts(x: Array, above: float, share: float) -> bool:
    """Whether a movement spends more than `share` of its frames beyond a value, as a pose does and a stroke does not."""
    moving = x > 0.25 * above
    return bool(moving.sum() and (x > above).sum() > share * moving.sum())


def _largest_roll(s: PostureFeatures) -> float:
    return float(s.head_roll_deg[np.abs(s.head_roll_deg).argmax()])


def _fast(yaw_deg: Array) -> bool:
    """Whether the head turns from one side to the other within `SHAKE_FRAMES`."""
    left = np.flatnonzero(yaw_deg > 0.85 * yaw_deg.max())
    right = np.flatnonzero(yaw_deg < 0.85 * yaw_deg.min())
    return bool(np.abs(left[:, None] - right).min() <= SHAKE_FRAMES)


def _bends_deep_or_with_the_head(s: PostureFeatures) -> bool:
    """Whether the trunk bends as far as only in a bow, or the head goes along as in a bow: who leans forward keeps it up."""
    trunk, head = (pitch.max() - pitch[0] for pitch in (s.trunk_pitch_deg, s.head_pitch_deg))
    return bool(trunk > 24 or head > 4)


HEAD_TRUNK: dict[str, Callable[[PostureFeatures, str], bool]] = {
    "nod": lambda s, d: _head_only(s) and _span(s.head_pitch_deg) > 10 > _span(s.head_yaw_deg) and _span(s.head_roll_deg) < 10 and strokes(s.head_pitch_deg, 8.0) >= 1 and not _lasts(np.abs(s.head_pitch_deg - s.head_pitch_deg[0]), 10, 0.8),
    "shake_head": lambda s, d: _head_only(s) and s.head_yaw_deg.max() > 12 and s.head_yaw_deg.min() < -12 and _fast(s.head_yaw_deg) and _span(s.head_roll_deg) < 14,
    "tilt_head": lambda s, d: _head_only(s) and _largest_roll(s) * {"right": -1.0}.get(d, 1.0) > 10 and _span(s.head_yaw_deg) < 20,
    "wobble_head": lambda s, d: _head_only(s) and s.head_roll_deg.max() > 8 and s.head_roll_deg.min() < -8 and _span(s.head_pitch_deg) < 14,
    "look": lambda s, d: _head_only(s) and max(_span(s.head_yaw_deg), _span(s.head_pitch_deg)) > 18 and _span(s.head_roll_deg) < 18,
    "look_back": lambda s, d: not s.arms and np.abs(s.head_yaw_deg + s.trunk_yaw_deg).max() > 65 and _span(s.head_roll_deg) < 20,
    "look_around": lambda s, d: _head_only(s) and s.head_yaw_deg.max() > 25 and s.head_yaw_deg.min() < -25 and not _fast(s.head_yaw_deg),
    "roll_head": lambda s, d: _head_only(s) and _span(s.head_pitch_deg) > 15 and s.head_roll_deg.max() > 8 and s.head_roll_deg.min() < -8,
    "bow": lambda s, d: _trunk_only(s) and _span(s.trunk_pitch_deg) > 18 and s.trunk_pitch_deg.max() - s.trunk_pitch_deg[0] > 16 and _bends_deep_or_with_the_head(s) and max(_span(s.trunk_yaw_deg), _span(s.trunk_roll_deg)) < 12,
    "lean": lambda s, d: _trunk_only(s) and max(_span(s.trunk_pitch_deg), _span(s.trunk_roll_deg)) > 5 and _span(s.trunk_yaw_deg) < 10,
    "twist": lambda s, d: _trunk_only(s) and np.abs(s.trunk_yaw_deg - s.trunk_yaw_deg[0]).max() > 12 and _span(s.trunk_roll_deg) < 12,
    "sway": lambda s, d: _trunk_only(s) and s.trunk_roll_deg.max() > 4 and s.trunk_roll_deg.min() < -4 and _span(s.trunk_pitch_deg) < 9,
    "twist_repeat": lambda s, d: _trunk_only(s) and s.trunk_yaw_deg.max() > 9 and s.trunk_yaw_deg.min() < -9,
    "trunk_circle": lambda s, d: _trunk_only(s) and s.trunk_roll_deg.max() > 5 and s.trunk_roll_deg.min() < -5 and _span(s.trunk_pitch_deg) > 10,
    "breathe": lambda s, d: not s.arms and _span(s.trunk_pitch_deg) > 3 and _span(s.lift_m) > 0.015,
    "slump": lambda s, d: _trunk_only(s) and s.trunk_pitch_deg.max() - s.trunk_pitch_deg[0] > 7 and s.head_pitch_deg.max() - s.head_pitch_deg[0] > 9,
    "stand": lambda s, d: not s.arms and max(_span(s.head_yaw_deg), _span(s.head_pitch_deg), _span(s.head_roll_deg)) < _HEAD_STILL_DEG and max(_span(s.trunk_yaw_deg), _span(s.trunk_pitch_deg), _span(s.trunk_roll_deg)) < _TRUNK_STILL_DEG,
    "shift": lambda s, d: not s.arms and 1.0 < _span(s.trunk_roll_deg) < 12 and max(_span(s.head_yaw_deg), _span(s.head_pitch_deg)) < 12,
}  # fmt: skip

_FACE = places.MOUTH
_BELOW_THE_EYES: Box = (-0.07, 0.13, 0.04, 0.225, 0.03, 0.27)
"""The mouth, without what is nearer to the eyes."""
_TOUCHING = (0.0, 0.16)
ONE_LEADS = (
    "superhero",
    "archery",
    "traffic",
    "disco",
    "guitar",
    "violin",
    "flute",
    "saw",
    "dab",
    "arm_wave",
    "robot",
    "cross_arms",
    "golf",
)
SIGNS: dict[str, Sign] = {
    # between people
    "wave": Sign(((0.02, 0.85, -0.35, 0.75, -0.1, 0.65),), ((0.1, 1, 0.1), 0.6), (_OUT, 0.12), share=0.5),
    "big_wave": Sign(((-0.1, 0.9, 0.25, 0.8, -0.2, 0.4),), None, (_OUT, 0.2), bend_deg=(0, 35)),
    "point": Sign(bend_deg=(0, 78), held=True, share=0.3),
    "present": Sign(((0.5, 0.9, -0.3, 0.1, -0.1, 0.45), (-0.1, 0.35, -0.4, 0.05, 0.3, 0.65)), bend_deg=(15, 90)),
    "beckon": Sign(((0.05, 0.5, -0.3, 0.35, 0.2, 0.65),), None, (_UP, 0.13), bend_deg=(35, 150)),
    "go_away": Sign(((0.05, 0.5, -0.3, 0.25, 0.3, 0.65),), None, (_FORWARD, 0.06)),
    "clap": Sign(((-0.06, 0.3, -0.35, 0.1, 0.15, 0.5),), None, (_OUT, 0.07), apart_m=(0, 0.15)),
    "shrug": Sign(((0.3, 0.7, -0.4, 0.05, 0.1, 0.5),), bend_deg=(40, 110)),
    "hug": Sign(((0.45, 0.9, -0.25, 0.25, 0.1, 0.6),), bend_deg=(8, 70), held=True),
    "handshake": Sign(((0.0, 0.4, -0.4, 0.05, 0.35, 0.65),), ((0, 0, 1), 0.75), (_UP, 0.07), bend_deg=(15, 85)),
    "high_five": Sign(((0.15, 0.55, 0.2, 0.6, 0.2, 0.6),), ((0, 1, 0.8), 0.7), held=True),
    "fist_bump": Sign(((0.05, 0.42, -0.25, 0.1, 0.42, 0.68),), ((0, 0, 1), 0.85), bend_deg=(18, 70), held=True),
    "fist_pump": Sign(((0.15, 0.6, 0.15, 0.7, -0.05, 0.5), (0.1, 0.6, -0.35, 0.15, 0.05, 0.35)), None, (_UP, 0.2), share=0.15),
    "cheer": Sign(((0.1, 0.7, 0.3, 0.8, -0.2, 0.5),), ((0, 1, 0), 0.8), (_UP, 0.05)),
    "celebrate": Sign(((0.3, 0.75, 0.3, 0.7, -0.2, 0.4),), ((0.3, 1, 0), 0.8)),
    "toast": Sign(((0.05, 0.42, -0.02, 0.35, 0.4, 0.65),), ((0, 0.4, 0.9), 0.85), bend_deg=(10, 75)),
    "traffic": Sign(((0.2, 0.8, -0.3, 0.4, 0.15, 0.6),), None, (_OUT, 0.12), other=(0.55, 0.9, -0.2, 0.3, -0.2, 0.4)),
    "pat_back": Sign(((0.05, 0.45, -0.3, 0.2, 0.4, 0.68),), ((0, 0, 1), 0.8), (_UP, 0.06), bend_deg=(0, 60)),
    # poses
    "raise": Sign(((0.05, 0.55, 0.35, 0.75, -0.2, 0.45),), ((0, 1, 0.1), 0.75), held=True, bend_deg=(0, 55)),
    "hands_up": Sign(((0.02, 0.6, 0.38, 0.75, -0.25, 0.4),), ((0, 1, 0), 0.85), held=True, bend_deg=(0, 50)),
    "arm_forward": Sign(((0.0, 0.45, -0.15, 0.25, 0.48, 0.68),), ((0, 0, 1), 0.9), held=True, bend_deg=(0, 28)),
    "zombie": Sign(((0.0, 0.45, -0.2, 0.25, 0.48, 0.68),), ((0, 0, 1), 0.9), held=True, bend_deg=(0, 32)),
    "arm_side": Sign(((0.65, 0.9, -0.18, 0.25, -0.15, 0.3),), ((1, 0, 0), 0.9), held=True, bend_deg=(0, 30)),
    "t_pose": Sign(((0.65, 0.9, -0.18, 0.25, -0.15, 0.3),), ((1, 0, 0), 0.9), held=True, bend_deg=(0, 30)),
    "stretch": Sign(((-0.1, 0.35, 0.42, 0.75, -0.2, 0.35),), ((0, 1, 0), 0.85), apart_m=(0, 0.5)),
    "victory": Sign(((0.4, 0.75, 0.28, 0.7, -0.2, 0.3),), ((0.6, 0.75, 0), 0.85), held=True, bend_deg=(0, 35)),
    "superhero": Sign(((0.0, 0.45, 0.28, 0.65, 0.15, 0.6),), bend_deg=(0, 40), other=near(places.HIP, 0.17)),
    "flex": Sign(((0.25, 0.6, 0.1, 0.5, -0.15, 0.3),), ((0, 1, 0), 0.7), held=True, bend_deg=(60, 130)),
    "stop": Sign(((0.05, 0.45, -0.02, 0.4, 0.3, 0.62),), ((0, 0.6, 0.8), 0.85), held=True, bend_deg=(25, 90)),
    "oath": Sign(((0.25, 0.65, -0.05, 0.35, -0.1, 0.3),), ((0.1, 1, 0.1), 0.75), held=True, bend_deg=(85, 150)),
    "offer": Sign(((0.12, 0.5, -0.35, 0.02, 0.3, 0.6),), ((0, 0, 1), 0.85), held=True, bend_deg=(35, 90)),
    "carry": Sign(((0.08, 0.4, -0.38, -0.02, 0.25, 0.55),), ((0, 0, 1), 0.85), held=True, bend_deg=(45, 110)),
    "block": Sign(((-0.02, 0.35, 0.1, 0.42, 0.1, 0.45),), ((0, 1, 0), 0.75), held=True, bend_deg=(65, 130)),
    # hands on the body
    "cross_arms": Sign(((-0.3, 0.05, -0.42, -0.08, 0.02, 0.32),), ((-1, 0.1, 0), 0.6), other=(-0.3, 0.08, -0.42, -0.08, 0.0, 0.34)),
    "cross_hands_x": Sign(((-0.3, 0.06, -0.15, 0.25, 0.12, 0.45),), apart_m=(0.0, 0.35), held=True),
    "hands_on_hips": Sign((near(places.HIP, 0.13),), bend_deg=(50, 130), held=True),
    "behind_head": Sign((near(places.NAPE, 0.13),), held=True),
    "behind_back": Sign((near(places.LOWER_BACK, 0.14),), held=True),
    "think": Sign((near((0.04, 0.12, 0.13), 0.1),), ((-0.2, 1, 0), 0.5), held=True, bend_deg=(105, 160)),
    "salute": Sign((near(places.BROW, 0.11),), ((-0.7, 0.6, 0), 0.6), held=True),
    "shade_eyes": Sign((near((0.05, 0.33, 0.17), 0.09),), held=True),
    "facepalm": Sign((near((0.05, 0.27, 0.13), 0.09),), held=True),
    "forehead": Sign((near(places.FOREHEAD, 0.1),), held=True),
    "wipe_brow": Sign((near(places.FOREHEAD, 0.13),), None, (_OUT, 0.09)),
    "heart": Sign((near(places.HEART, 0.11),), held=True),
    "beat_chest": Sign(((-0.1, 0.18, -0.25, 0.08, 0.05, 0.27), (0.0, 0.4, -0.25, 0.1, 0.2, 0.5)), None, (_FORWARD, 0.08), bend_deg=(85, 160)),
    "belly_rub": Sign((near(places.BELLY, 0.16),), turn=(_OUT, _UP, -0.6)),
    "hold_belly": Sign((near(places.BELLY, 0.12),), held=True),
    "listen": Sign((near(places.EAR, 0.13),), held=True),
    "phone": Sign((near(places.EAR, 0.12),), held=True),
    "cover_ears": Sign((near(places.EAR, 0.11),), held=True),
    "cover_eyes": Sign((near(places.EYES, 0.1),), held=True),
    "kiss": Sign((near(_FACE, 0.1), (0.05, 0.5, -0.2, 0.3, 0.35, 0.65)), None, (_FORWARD, 0.2)),
    "hush": Sign((near((0.05, 0.16, 0.16), 0.09),), held=True),
    "cover_mouth": Sign((_BELOW_THE_EYES,), held=True),
    "yawn": Sign((_BELOW_THE_EYES,)),
    "drink": Sign((near((0.06, 0.18, 0.18), 0.1),), held=True),
    "eat": Sign((near(places.MOUTH, 0.12), (-0.1, 0.4, -0.42, -0.12, 0.2, 0.5)), None, (_UP, 0.22)),
    "brush_teeth": Sign((near((0.05, 0.17, 0.18), 0.12),), None, (_OUT, 0.05)),
    "scratch_head": Sign((near((0.09, 0.36, -0.02), 0.13),)),
    "pat_head": Sign((near((0.05, 0.42, 0.02), 0.12),)),
    "touch_shoulder": Sign((near(places.OTHER_SHOULDER, 0.13),), held=True),
    "pray": Sign(((-0.06, 0.13, -0.2, 0.05, 0.12, 0.36),), apart_m=_TOUCHING, held=True, bend_deg=(80, 150)),
    "rub_hands": Sign(((-0.06, 0.13, -0.36, -0.05, 0.12, 0.42),), None, (_FORWARD, 0.04), apart_m=_TOUCHING),
    "clasp_hands": Sign(((-0.08, 0.13, -0.45, -0.18, 0.12, 0.36),), apart_m=_TOUCHING, held=True),
    "watch_time": Sign(((-0.12, 0.15, -0.25, 0.05, 0.22, 0.48),), ((-0.9, 0.3, 0.3), 0.5), held=True),
    "sternum_fist": Sign(((-0.1, 0.14, -0.28, 0.0, 0.08, 0.28), (-0.05, 0.25, -0.25, 0.0, 0.25, 0.45)), None, (_FORWARD, 0.07)),
    # sport
    "punch": Sign(((0.0, 0.42, -0.2, 0.2, 0.44, 0.68), (0.05, 0.5, -0.4, 0.25, 0.1, 0.45)), None, None, rests=False),
    "hook": Sign(((0.0, 0.6, -0.15, 0.2, 0.2, 0.62),), ((-0.75, 0, 0.6), 0.3), (_OUT, 0.15), share=0.12),
    "uppercut": Sign(((0.0, 0.42, 0.0, 0.42, 0.2, 0.6), (0.05, 0.5, -0.5, 0.0, -0.1, 0.55)), ((0, 1, 0.4), 0.7), (_UP, 0.2), share=0.12),
    "throw": Sign(((0.2, 0.75, 0.15, 0.65, -0.5, 0.0), (-0.15, 0.5, -0.5, 0.5, 0.25, 0.68)), None, (_FORWARD, 0.4)),
    "throw_low": Sign(((0.0, 0.5, -0.25, 0.35, 0.3, 0.68), (0.1, 0.65, -0.65, -0.2, -0.65, -0.05)), None, None, share=0.1),
    "catch": Sign(((-0.12, 0.15, -0.38, -0.05, 0.12, 0.38), (-0.05, 0.4, -0.2, 0.15, 0.42, 0.68)), None),
    "archery": Sign(((-0.4, 0.5, -0.2, 0.4, -0.1, 0.55),), ((-1, 0.1, 0.3), 0.4), other=(0.3, 0.85, -0.2, 0.3, 0.05, 0.6), bend_deg=(70, 170), share=0.15),
    "sword": Sign(((0.05, 0.6, 0.25, 0.75, -0.3, 0.5), (-0.2, 0.45, -0.45, 0.0, 0.25, 0.65)), None, (_UP, 0.35)),
    "karate_chop": Sign(((0.1, 0.6, -0.3, 0.35, 0.15, 0.62),), None, (_UP, 0.15), rests=False),
    "swim_crawl": Sign(((-0.1, 0.6, -0.5, 0.65, -0.5, 0.65), (-0.1, 0.5, 0.15, 0.65, -0.4, 0.6)), turn=(_UP, _FORWARD, 0.7), opposed=_FORWARD),
    "swim_back": Sign(((-0.1, 0.6, -0.5, 0.65, -0.5, 0.65), (-0.1, 0.5, 0.15, 0.65, -0.4, 0.6)), turn=(_UP, _FORWARD, -0.7), opposed=_FORWARD),
    "swim_breast": Sign(((0.25, 0.65, -0.35, 0.1, 0.1, 0.6), (-0.1, 0.18, -0.35, 0.1, 0.1, 0.6)), None, (_OUT, 0.18), together=_OUT),
    "march_arms": Sign(((0.0, 0.5, -0.5, 0.0, 0.25, 0.65),), None, (_FORWARD, 0.25), bend_deg=(0, 45), opposed=_FORWARD, share=0.2),
    "run_arms": Sign(((0.0, 0.45, -0.35, 0.15, 0.2, 0.6),), None, (_FORWARD, 0.1), bend_deg=(60, 140), opposed=_FORWARD),
    "row": Sign(((0.05, 0.45, -0.35, 0.15, 0.42, 0.68), (0.1, 0.5, -0.4, 0.05, 0.0, 0.42)), None, (_FORWARD, 0.18), together=_FORWARD),
    "jumping_jack": Sign(((0.05, 0.7, 0.3, 0.75, -0.2, 0.45), (0.2, 0.85, -0.62, -0.1, -0.15, 0.45)), None, (_UP, 0.45), together=_UP, share=0.3),
    "basketball": Sign(((0.0, 0.4, 0.25, 0.65, 0.2, 0.6), (-0.08, 0.25, 0.05, 0.4, 0.1, 0.45)), None, together=_UP),
    "tennis": Sign(((0.35, 0.9, -0.45, 0.3, -0.5, 0.3), (-0.4, 0.35, -0.4, 0.4, 0.0, 0.68)), None, (_OUT, 0.25), share=0.1),
    "golf": Sign(((-0.45, -0.05, -0.25, 0.4, 0.02, 0.55), (0.08, 0.5, -0.25, 0.4, 0.02, 0.55)), None, (_OUT, 0.25), opposed=_OUT, share=0.25),
    "lift_weight": Sign(((0.1, 0.45, -0.25, 0.25, 0.05, 0.5), (0.1, 0.45, -0.6, -0.2, -0.05, 0.5)), None, (_UP, 0.12), share=0.35),
    "overhead_press": Sign(((0.05, 0.55, 0.38, 0.75, -0.2, 0.4), (0.1, 0.6, -0.1, 0.3, -0.1, 0.4)), None, (_UP, 0.25), together=_UP),
    # work
    "push": Sign(((0.05, 0.45, -0.15, 0.2, 0.46, 0.68), (0.1, 0.5, -0.3, 0.15, 0.1, 0.42)), None, (_FORWARD, 0.13)),
    "pull": Sign(((0.05, 0.45, -0.2, 0.2, 0.46, 0.68), (0.1, 0.5, -0.35, 0.15, 0.0, 0.42)), None, None),
    "lift": Sign(((0.05, 0.42, 0.1, 0.5, 0.25, 0.65), (0.05, 0.42, -0.6, -0.25, 0.15, 0.6)), None, (_UP, 0.45), together=_UP),
    "pick": Sign(((0.05, 0.5, 0.28, 0.7, 0.1, 0.6), (0.05, 0.5, -0.4, 0.0, 0.2, 0.6)), None, (_UP, 0.4)),
    "climb": Sign(((0.05, 0.5, 0.2, 0.7, 0.1, 0.65), (0.05, 0.5, -0.35, 0.2, 0.15, 0.65)), None, (_UP, 0.2), opposed=_UP),
    "knock": Sign(((0.1, 0.5, -0.1, 0.35, 0.22, 0.6),), None, (_FORWARD, 0.05), bend_deg=(40, 120)),
    "wipe": Sign(((-0.3, 0.55, -0.2, 0.3, 0.35, 0.65),), None, (_OUT, 0.22)),
    "wipe_table": Sign(((-0.3, 0.55, -0.5, -0.2, 0.2, 0.6),), None, (_OUT, 0.22)),
    "paint": Sign(((0.0, 0.4, 0.08, 0.5, 0.3, 0.65), (0.0, 0.4, -0.45, -0.05, 0.3, 0.65)), None, (_UP, 0.25)),
    "draw_circle": Sign(((-0.2, 0.5, -0.3, 0.4, 0.25, 0.62),), turn=(_OUT, _UP, -0.6)),
    "stir": Sign(((-0.15, 0.35, -0.5, -0.1, 0.15, 0.55),), turn=(_OUT, _FORWARD, -0.6)),
    "crank": Sign(((-0.1, 0.35, -0.4, 0.15, 0.15, 0.6),), turn=(_UP, _FORWARD, 0.6)),
    "roll_arms": Sign(((-0.15, 0.2, -0.45, 0.05, 0.15, 0.55),), turn=(_UP, _FORWARD, 0.6), opposed=_UP),
    "type": Sign(((0.05, 0.45, -0.4, 0.0, 0.25, 0.55),), ((0, 0, 1), 0.8), (_UP, 0.05)),
    "hammer": Sign(((0.1, 0.55, 0.05, 0.5, 0.0, 0.55), (0.05, 0.5, -0.3, 0.1, 0.35, 0.66)), None, (_UP, 0.18)),
    "saw": Sign(((0.0, 0.45, -0.5, -0.05, 0.3, 0.66), (0.0, 0.5, -0.5, -0.05, -0.15, 0.3)), None, (_FORWARD, 0.18), other=(-0.05, 0.4, -0.5, -0.1, 0.25, 0.6)),
    "sow": Sign(((0.4, 0.85, -0.4, 0.15, 0.1, 0.6), (-0.3, 0.1, -0.5, -0.1, 0.1, 0.45)), None, (_OUT, 0.4)),
    "turn_key": Sign(((0.1, 0.45, -0.3, 0.05, 0.3, 0.62),), ((0, 0.1, 1), 0.85), bend_deg=(35, 95), twist_rad=1.0),
    "flip_palm": Sign(((0.1, 0.5, -0.35, 0.05, 0.3, 0.62),), ((0, 0.1, 1), 0.85), bend_deg=(30, 95), twist_rad=1.0),
    "pour": Sign(((0.05, 0.5, -0.2, 0.2, 0.35, 0.66),), ((-0.2, 0.1, 1), 0.8), bend_deg=(20, 90), twist_rad=0.9),
    "steer": Sign(((0.0, 0.35, -0.45, 0.1, 0.3, 0.6),), None, (_UP, 0.13), opposed=_UP),
    # play
    "drum": Sign(((0.05, 0.5, -0.4, 0.1, 0.2, 0.55),), None, (_UP, 0.1)),
    "piano": Sign(((0.1, 0.55, -0.4, 0.05, 0.25, 0.58),), ((0, 0, 1), 0.7), (_UP, 0.05)),
    "guitar": Sign(((-0.2, 0.2, -0.5, -0.12, 0.1, 0.4),), None, (_UP, 0.08), other=(0.25, 0.75, -0.25, 0.25, 0.1, 0.55)),
    "violin": Sign(((-0.3, 0.2, -0.1, 0.25, 0.15, 0.5), (0.12, 0.45, -0.3, 0.1, 0.25, 0.6)), None, (_OUT, 0.2), other=(0.1, 0.55, -0.05, 0.4, 0.25, 0.66)),
    "flute": Sign((near((0.0, 0.13, 0.3), 0.12),), other=near((0.0, 0.14, 0.26), 0.15), apart_m=(0, 0.3)),
    "conduct": Sign(((0.1, 0.6, -0.35, 0.35, 0.25, 0.62),), None, (_UP, 0.15), bend_deg=(20, 120)),
    "arm_circle": Sign(((0.5, 0.9, -0.55, 0.6, -0.5, 0.6),), bend_deg=(0, 40), turn=(_UP, _FORWARD, 0.6)),
    "flap": Sign(((0.5, 0.9, -0.5, 0.5, -0.2, 0.35),), None, (_UP, 0.25), bend_deg=(0, 45), together=_UP),
    "chicken": Sign(((0.1, 0.5, -0.3, 0.25, 0.05, 0.4),), bend_deg=(100, 160)),
    "robot": Sign(((0.25, 0.65, 0.02, 0.45, -0.15, 0.3),), bend_deg=(60, 125), other=(0.25, 0.65, -0.6, -0.05, -0.15, 0.4), share=0.15),
    "disco": Sign(((0.35, 0.8, 0.2, 0.7, -0.1, 0.45), (-0.4, 0.25, -0.6, -0.2, 0.0, 0.5)), None, (_UP, 0.5), other=near(places.HIP, 0.17)),
    "sway_arms": Sign(((-0.2, 0.75, 0.35, 0.75, -0.2, 0.4),), None, (_OUT, 0.18), bend_deg=(0, 35), opposed=_OUT),
    "arm_wave": Sign(((0.6, 0.9, -0.3, 0.35, -0.2, 0.35),), None, (_UP, 0.06)),
    "dance_pump": Sign(((0.05, 0.5, -0.25, 0.4, 0.15, 0.6),), None, (_UP, 0.1), bend_deg=(45, 130)),
    "dab": Sign(((0.5, 0.9, 0.12, 0.55, -0.2, 0.35),), other=(-0.4, 0.2, 0.05, 0.45, 0.1, 0.55), bend_deg=(0, 35)),
    "shake_out": Sign(((0.1, 0.65, -0.7, -0.3, -0.1, 0.45),), None, (_FORWARD, 0.06)),
    "heart_over_head": Sign(((-0.08, 0.2, 0.33, 0.65, -0.15, 0.3),), apart_m=(0, 0.25), bend_deg=(35, 110), held=True),
    "binoculars": Sign((near((0.07, 0.25, 0.19), 0.1),), held=True),
    "juggle": Sign(((0.05, 0.4, -0.5, 0.05, 0.25, 0.55),), None, (_UP, 0.12), opposed=_UP),
    "pull_hat": Sign((near((0.1, 0.36, 0.07), 0.12), (0.05, 0.35, 0.34, 0.6, 0.0, 0.35)), None, None),
}  # fmt: skip
DIRECTED: dict[tuple[str, str], Sign] = {
    ("clap", "up"): Sign(((-0.08, 0.36, 0.25, 0.65, -0.05, 0.4),), None, (_OUT, 0.08), apart_m=(0, 0.16)),
    ("hug", "in"): Sign(((-0.35, 0.1, -0.35, 0.08, 0.1, 0.5), (0.4, 0.9, -0.25, 0.25, 0.1, 0.6)), None),
    ("point", "self"): Sign((near(places.HEART, 0.17),), held=True),
    ("point", "back"): Sign(((0.15, 0.65, 0.0, 0.5, -0.4, 0.3),), ((0.1, 0.6, -0.8), 0.6), held=True),
    ("arm_circle", "back"): Sign(((0.5, 0.9, -0.55, 0.6, -0.5, 0.6),), bend_deg=(0, 40), turn=(_UP, _FORWARD, -0.6)),
    ("arm_circle", "forward"): SIGNS["arm_circle"],
}  # fmt: skip
