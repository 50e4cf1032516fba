"""Scales the size of a motion: each rotation turns farther from a reference, or less far.

Arms that repeat a stroke swing about the path that the strokes have in common, so that a small wave is still made with a raised
hand. Arms that draw one circle do so about its middle. All other rotations are scaled from their value in the first frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from mmm_core.motion.drawn_circles import drawn_circle, farther_hand, width_m
from mmm_core.motion.motion import Motion
from mmm_core.motion.repetitions import Strokes, about_mean, strokes_of
from mmm_core.motion.skeleton import Array, forward_kinematics, from_six_d, six_d

_TRUNK_HEAD = (3, 6, 9, 12, 15)
_ARMS = (13, 14, 16, 17, 18, 19, 20, 21)
_WRISTS = slice(20, 22)
_SIZED = (*_TRUNK_HEAD, *_ARMS)
"""Joints whose rotations a size changes."""
_N_BODY = len(_TRUNK_HEAD)
MOST_ARM_RAD = 2.9
"""Radians from the first frame that an enlarged arm joint reaches at most; `_MOST` has other bounds for some joints."""
_MOST = {18: 2.4, 19: 2.4, 13: 0.6, 14: 0.6}
"""Radians from the first frame that enlarged elbows and collars reach at most."""
_MOST_RAD = np.array([_MOST.get(joint, MOST_ARM_RAD) for joint in _SIZED])
CYCLE_MISFIT = 0.7
"""Largest misfit of a cycle whose strokes are scaled about their middle; the model's waves and claps reach it."""
ROUNDS = 3
"""Rounds in which arm rotations are scaled anew, until the wrist's path has the requested size."""
_PATH = 0.35
"""Exponent of a size below 1 that scales the common path of the strokes: a small stroke is made a little lower."""
_MOST_FACTOR, _LEAST_WAY_M = 3.0, 0.04
"""Greatest factor on arm rotations, and metres that a wrist has to move for its size to be corrected."""
_AROUND_CIRCLE_FRAMES = 8
"""Frames before and after a drawn circle in which its size comes and goes."""


@dataclass(frozen=True)
class _Act:
    """The act of a motion's arms; it decides about which path their rotations are scaled.

    Attributes:
        period: frames of a stroke that is repeated; 0 without one.
        circle: first and last frame of a circle that is drawn once.
    """

    period: int = 0
    circle: tuple[int, int] | None = None


def is_cyclic(strokes: Strokes | None) -> bool:
    """Whether a motion repeats a stroke clearly enough for the stroke to be scaled by itself."""
    return strokes is not None and len(strokes.frames) > 1 and strokes.misfit <= CYCLE_MISFIT


def sized(local: Array, rest: Array, motion: Motion, size: float, ramp: Array) -> Array:
    """Rotations (T, 22, 3, 3) in another size.

    A hand's path grows less than the rotations of its arm, so the factor on the rotations is corrected over a few rounds; the
    round whose path comes nearest to the requested size wins.

    Args:
        local: rotations of the motion, each relative to its parent.
        rest: (22, 3, 3) rotations from which those without an own middle are scaled.
        motion: the motion itself.
        size: factor of size.
        ramp: (T,) how much of the size each frame has, 0 to 1.
    """
    act = _act(motion)
    weights = 1.0 + (size - 1.0) * ramp
    reference = _reference(local, rest, act, weights)
    away = _rotation_vectors(np.swapaxes(reference, -1, -2) @ local[:, _SIZED])
    angle = np.linalg.norm(away, axis=-1)
    most = np.maximum(angle, _MOST_RAD) / np.maximum(angle, 1e-6)
    way = _way_m(local, act)
    out = local.copy()
    body, arms = slice(None, _N_BODY), slice(_N_BODY, None)
    out[:, _TRUNK_HEAD] = _turned(reference, away, np.minimum(weights[:, None], most), body)
    arm_ramp = ramp if act.circle is None else ramp * _around(act.circle, len(local))
    found: list[tuple[float, Array]] = []
    factor = size
    for _ in range(ROUNDS):
        weights = 1.0 + (factor - 1.0) * arm_ramp
        out[:, _ARMS] = _turned(reference, away, np.minimum(weights[:, None], most), arms)
        if way < _LEAST_WAY_M:
            return out
        reached = _way_m(out, act) / way
        found.append((abs(reached - size), out.copy()))
        factor = float(np.clip(factor * size / max(reached, 0.05), 1 / _MOST_FACTOR, _MOST_FACTOR))
    return min(found, key=lambda pair: pair[0])[1]


def _act(motion: Motion) -> _Act:
    strokes = strokes_of(motion)
    if strokes is not None and is_cyclic(strokes):
        return _Act(period=strokes.period_frames)
    return _Act(circle=drawn_circle(farther_hand(motion.joints_m)))


def _reference(local: Array, rest: Array, act: _Act, weights: Array) -> Array:
    """(T, J, 3, 3) rotations from which those of `_SIZED` are scaled by (T,) weights."""
    reference = np.repeat(rest[None, _SIZED], len(local), axis=0)
    if act.circle is not None:
        first, last = act.circle
        reference[:, _N_BODY:] = from_six_d(six_d(local[first:last, _ARMS]).mean(0))
    if act.period:
        smooth = uniform_filter1d(six_d(local[:, _ARMS]), max(3, act.period), axis=0, mode="nearest")
        from_rest = _rotation_vectors(np.swapaxes(rest[_ARMS,], -1, -2) @ from_six_d(smooth))
        lower = (np.minimum(weights, 1.0) ** _PATH)[:, None, None]
        reference[:, _N_BODY:] = rest[_ARMS,] @ _matrices(from_rest * lower)
    return reference


def _around(circle: tuple[int, int], n_frames: int) -> Array:
    """(T,) weights: 1 while a circle is drawn, less and less before and after it."""
    frames = np.arange(n_frames)
    outside = np.maximum(np.maximum(circle[0] - frames, frames - circle[1]), 0)
    return np.maximum(0.0, 1.0 - outside / _AROUND_CIRCLE_FRAMES)


def _way_m(local: Array, act: _Act) -> float:
    """Metres that the farther-moving hand goes: from its first position, across its circle, or about the path of its strokes."""
    joints, _ = forward_kinematics(local, np.zeros((len(local), 3)))
    wrists = joints[:, _WRISTS]
    if act.circle is not None:
        return width_m(farther_hand(joints)[act.circle[0] : act.circle[1] + 1])
    if act.period:
        return float(np.ptp(about_mean(wrists, act.period), axis=0).max())
    return float(np.linalg.norm(wrists - wrists[0], axis=-1).max())


def _turned(reference: Array, away: Array, factors: Array, joints: slice) -> Array:
    """Rotations (T, n, 3, 3) of some joints: the reference, turned by its angles times (T, J) factors."""
    return reference[:, joints] @ _matrices(away[:, joints] * factors[:, joints, None])


def _rotation_vectors(rotations: Array) -> Array:
    """Rotation vectors (..., 3) of rotations (..., 3, 3)."""
    return Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_rotvec().reshape(rotations.shape[:-1])


def _matrices(vectors: Array) -> Array:
    """Rotations (..., 3, 3) of rotation vectors (..., 3)."""
    return Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(*vectors.shape, 3)
