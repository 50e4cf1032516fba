"""Recognises gestures by their signs: for each family, places and movement of the palms, or movement of head and trunk.

A sign is read from joints and head orientation alone, and leaves room for other ways to make the same gesture. Places are
(outward, up, forward) in metres in the chest frame from the middle between the shoulders, outward for the acting arm. Tests on
synthesised motions check that each sign finds its own family, but not standing still and hardly any other family.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS
from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.recognition.checks import PALM_M, strokes
from mmm_core.recognition.sign_tables import DIRECTED, HEAD_TRUNK, ONE_LEADS, SIGNS, Box, Sign

Array = NDArray[np.floating]
LEAST_FRAMES = 3
"""Frames (0.15 s) that a palm has to spend in a place for the place to count as visited."""
TOUCHING_M = 0.16
"""Metres between the palms up to which they count as together."""
SLOW_M_S = 0.3
"""Metres a second below which a palm rests."""
HELD_FRAMES = 6
"""Frames that a palm has to rest in a pose that is held."""
TRANSITION_FRAMES = 7
"""Frames left out at both ends of a gesture, in which the arm rises and comes down."""
LEAST_ROUNDNESS = 0.3
"""Roundness of a path that counts as a circle, at least."""
_HANGING_M = np.array([0.3, -0.52, 0.1])
_OTHER = {"left": "right", "right": "left"}


@dataclass(frozen=True)
class Arm:
    """An arm in the chest frame with its outward axis positive.

    Attributes:
        palm: (T, 3) middle of the palm, metres.
        fore: (T, 3) direction of the forearm.
        bend_deg: (T,) bend of the elbow.
        away: (T,) whether the arm is away from hanging.
    """

    palm: Array
    fore: Array
    bend_deg: Array
    away: NDArray[np.bool_]


@lru_cache(maxsize=16)
def arm_of(s: PostureFeatures, side: str) -> Arm:
    """The arm of a side, "left" or "right"."""
    out = np.array([1.0 if side == "left" else -1.0, 1, 1])
    palm = (s.wrists_m[side] + PALM_M * s.fore[side]) * out
    fore, upper = s.fore[side] * out, s.upper[side] * out
    bend = np.rad2deg(np.arccos(np.clip((fore * upper).sum(-1), -1, 1)))
    hanging = palm[0] if palm[0, 1] < -0.42 else _HANGING_M
    return Arm(palm, fore, bend, (np.linalg.norm(palm - hanging, axis=-1) > 0.12) | (bend > 50))


def shows(s: PostureFeatures, family: str, side: str = "", direction: str = "", least_strokes: int = 1) -> bool:
    """Whether the motion shows a gesture of the family: with the arm of `side`, with both, or for "" with either.

    Args:
        s: the motion.
        family: one of `HEAD_TRUNK`, `DIRECTED` or `SIGNS`.
        side: "left", "right", "both", "alternating" or "".
        direction: of the gesture, where it has one.
        least_strokes: strokes at least, of a family whose sign has a swing. An arm that is raised and lowered makes one.
    """
    if family == "arms_down":
        sides = (side,) if side in _OTHER else ("left", "right")
        return any(_comes_down(s, one) for one in sides) if not side else all(_comes_down(s, one) for one in sides)
    if family in HEAD_TRUNK:
        return HEAD_TRUNK[family](s, direction)
    sign = DIRECTED.get((family, direction)) or SIGNS[family]
    if side in _OTHER:
        return _has(s, sign, side, least_strokes)
    of_sides = (_has(s, sign, one, least_strokes) for one in _OTHER)
    return all(of_sides) if side in ("both", "alternating") and family not in ONE_LEADS else any(of_sides)


def palms_meet(family: str) -> bool:
    """Whether the palms of a family's gesture come together: a clap, praying, clasped hands."""
    return family in SIGNS and SIGNS[family].apart_m[1] <= TOUCHING_M


def _has(s: PostureFeatures, sign: Sign, side: str, least_strokes: int) -> bool:
    arm, other = arm_of(s, side), arm_of(s, _OTHER[side])
    core = _core(arm.away)
    apart = np.linalg.norm(arm.palm - other.palm * np.array([-1.0, 1, 1]), axis=-1)
    first = _inside(arm.palm, sign.at[0]) & core
    first &= (arm.bend_deg >= sign.bend_deg[0]) & (arm.bend_deg <= sign.bend_deg[1])
    first &= (apart >= sign.apart_m[0]) & (apart <= sign.apart_m[1])
    if sign.fore is not None:
        direction, least = sign.fore
        first &= arm.fore @ (np.array(direction) / np.linalg.norm(direction)) > least
    if sign.other is not None:
        first &= _inside(other.palm, sign.other)
    places = [_inside(arm.palm, box) & core for box in sign.at]
    visited = [(_inside(arm.palm, box) & arm.away).sum() for box in sign.at[1:]]
    if first.sum() < LEAST_FRAMES or any(n < 2 for n in visited):
        return False
    there = first if sign.held or sign.fore is not None else np.any(places, axis=0)
    if there.sum() < sign.share * core.sum():
        return False
    if sign.held or not sign.rests:
        does_rest = (first & _slow(arm.palm)).sum() >= max(HELD_FRAMES, 0.25 * core.sum())
        if does_rest != sign.held:
            return False
    used = arm.palm[core]
    if sign.swing is not None:
        axis, least = sign.swing
        way = used[:, axis]
        if _spread(way) < 0.8 * least or max(strokes(way, least), strokes(-way, least)) < least_strokes:
            return False
    if sign.turn is not None:
        path = used[:, [sign.turn[0], sign.turn[1]]]
        if _turns(path) * np.sign(sign.turn[2]) < abs(sign.turn[2]) or _roundness(path) < LEAST_ROUNDNESS:
            return False
    twist = s.twist_rad[side]
    if sign.twist_rad and twist is not None and np.ptp(twist[core]) < sign.twist_rad:
        return False
    both = core & _core(other.away)
    return all(
        axis is None or (both.sum() > 5 and way * _correlation(arm.palm[both, axis], other.palm[both, axis]) > 0.3)
        for axis, way in ((sign.opposed, -1), (sign.together, 1))
    )


def _comes_down(s: PostureFeatures, side: str) -> bool:
    """Whether the arm begins raised and ends hanging."""
    palm = arm_of(s, side).palm
    return bool(palm[:3, 1].min() > -0.15 and palm[-3:, 1].max() < -0.4)


def _core(away: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Frames of the gesture itself, without those in which the arm rises and comes down."""
    at = np.flatnonzero(away)
    core = np.zeros_like(away)
    if len(at):
        ends = min(TRANSITION_FRAMES, (at[-1] - at[0]) // 4)
        stays = at[-1] == len(away) - 1
        core[at[0] + ends : at[-1] + 1 - (0 if stays else ends)] = True
    return core & away


def _slow(palm: Array) -> NDArray[np.bool_]:
    """Frames in which the palm hardly moves."""
    return np.linalg.norm(np.gradient(palm, axis=0), axis=-1) * FPS < SLOW_M_S


def _spread(x: Array) -> Array:
    """Range of a signal without its outermost tenth."""
    return np.percentile(x, 95, axis=0) - np.percentile(x, 5, axis=0)


def _inside(palm: Array, box: Box) -> NDArray[np.bool_]:
    low, high = np.array(box[::2]), np.array(box[1::2])
    return np.all((palm >= low) & (palm <= high), axis=-1)


def _turns(path: Array) -> float:
    """Signed number of turns that a path (T, 2) makes about the middle of its extent."""
    if len(path) < 5:
        return 0.0
    middle = (np.percentile(path, 90, axis=0) + np.percentile(path, 10, axis=0)) / 2
    around = np.unwrap(np.arctan2(*(path - middle).T[::-1]))
    return float((around[-1] - around[0]) / (2 * np.pi))


def _roundness(path: Array) -> float:
    """The ratio of the narrowest to the widest spread of a path (T, 2): 1 of a circle, 0 of a line."""
    narrow, wide = np.linalg.eigvalsh(np.cov(path.T))
    return float(np.sqrt(max(narrow, 0.0) / max(wide, 1e-9)))


def _correlation(a: Array, b: Array) -> float:
    a, b = a - a.mean(), b - b.mean()
    return float((a * b).sum() / max(float(np.sqrt((a * a).sum() * (b * b).sum())), 1e-6))
