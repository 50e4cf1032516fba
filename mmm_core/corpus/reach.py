"""Computes arm poses from the place of the palm: two-bone inverse kinematics in the chest frame.

Places are (outward, up, forward) in metres from the middle between the shoulders, for the acting arm: outward is to the
left for the left arm. The 22 joints end at the wrist; the palm lies `PALM_M` further along the forearm.
"""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.score import ArmPose, Vector
from mmm_core.motion.skeleton import BONE_LENGTHS_M, REST_DIRECTIONS

PALM_M = 0.08
SHOULDER_OUT_M = float(BONE_LENGTHS_M[13] * REST_DIRECTIONS[13][0] + BONE_LENGTHS_M[16])
_UPPER_M, _FORE_M = float(BONE_LENGTHS_M[18]), float(BONE_LENGTHS_M[20]) + PALM_M
ELBOW_DOWN: Vector = (0.45, -0.85, -0.2)
ELBOW_OUT: Vector = (1.0, -0.15, -0.1)
ELBOW_UP: Vector = (0.8, 0.5, 0.0)


def reach(palm_m: Vector, elbow: Vector = ELBOW_DOWN, twist_rad: float = 0.0) -> ArmPose:
    """The pose that brings the palm to a place, or as near as the arm is long.

    Args:
        palm_m: (outward, up, forward) from the middle between the shoulders.
        elbow: direction in which the elbow lies, as far as the arm allows.
        twist_rad: forearm twist, palm up positive.
    """
    to_palm = np.array(palm_m) - np.array([SHOULDER_OUT_M, 0.0, 0.0])
    distance = float(np.linalg.norm(to_palm))
    along = to_palm / max(distance, 1e-6)
    distance = min(max(distance, abs(_FORE_M - _UPPER_M) + 0.02), 0.995 * (_UPPER_M + _FORE_M))
    aside = np.array(elbow) - (np.array(elbow) @ along) * along
    aside /= max(float(np.linalg.norm(aside)), 1e-6)
    cosine = (distance**2 + _UPPER_M**2 - _FORE_M**2) / (2 * distance * _UPPER_M)
    upper = cosine * along + np.sqrt(max(0.0, 1 - cosine**2)) * aside
    fore = distance * along - _UPPER_M * upper
    return ArmPose(_vector(upper), _vector(fore), twist_rad)


def beside(place_m: Vector, out_m: float = 0.0, up_m: float = 0.0, forward_m: float = 0.0) -> Vector:
    """`place_m` moved outward, up and forward, metres."""
    return (place_m[0] + out_m, place_m[1] + up_m, place_m[2] + forward_m)


def palm_m(pose: ArmPose) -> Vector:
    """The place of a pose's palm, metres; the inverse of `reach`."""
    v = pose.vector()
    return _vector(np.array([SHOULDER_OUT_M, 0, 0]) + _UPPER_M * v[:3] + _FORE_M * v[3:6])


def _vector(v: np.ndarray) -> Vector:
    return (float(v[0]), float(v[1]), float(v[2]))
