"""Weights of the bones of an arm in each frame, for arms that cannot match the directions of both bones at once.

An arm of two or three joints cannot reach every pair of directions. Where a forearm swings about a still upper arm (a wave, a
beat), the direction of the forearm carries the gesture. In other frames the position of the hand carries the gesture, above all
where hands meet. For a hand before the chest both directions count: a finger that points at the chest must point at it. The
error of a frame is

    w_upper |e_upper|^2 + w_fore |e_fore|^2 + w_hand |l_upper e_upper + l_fore e_fore|^2

with the errors e of both unit directions and the bone lengths l of a person, scaled to the mean 1: the hand's position counts
relative to the shoulder, whatever the robot's proportions. The weights change smoothly with time, and so does the best pose. Arms
of four and more joints reach every pair of directions; both of their bones have weight 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.skeleton import BONE_LENGTHS_M
from retarget.human.human import HumanPose
from retarget.robot.kinematics import smooth_step

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BoneWeights:
    """Weights of the squared errors of the upper arm, the forearm, and the hand."""

    upper: float
    fore: float
    hand: float


REACHING = BoneWeights(0.7, 0.7, 2.0)
SWINGING = BoneWeights(0.3, 1.0, 0.0)
MEETING = BoneWeights(0.3, 0.3, 4.0)
AT_CHEST = BoneWeights(1.0, 1.0, 0.0)
"""Weights in the four kinds of frames, tuned on generated gestures and recordings on OP3, see docs/retargeting.md."""
_SWING_RAD_S = (0.6, 1.5)
"""Root mean square speeds of a forearm at which swinging begins to count and counts fully."""
_STILL_SHARE = (0.65, 0.35)
"""Ratios of the upper arm's speed to the forearm's at which the upper arm counts as moving and as still."""
_SWING_S = 0.4
"""Seconds of standard deviation of the Gaussian window in which speeds are averaged."""
_MEET_M, _CHEST_M = (0.32, 0.2), (0.22, 0.12)
"""Metres between the wrists, and from a wrist to the breastbone, at which a meeting begins to count and counts fully."""
_UPPER_M, _FORE_M = float(BONE_LENGTHS_M[18]), float(BONE_LENGTHS_M[20])
_SHOULDERS_M = np.array([[0.0, 0.17, 0.0], [0.0, -0.17, 0.0]])
_BREASTBONE_M = np.array([0.13, 0.0, -0.13])
"""Metres from the middle of the shoulders of the common body to the shoulders and the breastbone, in the chest frame
(forward, left, up)."""


def bone_weights(human: HumanPose) -> Array:
    """(2, T, 2, 2) symmetric weights of the errors of upper arm and forearm, by side."""
    swing = swinging(human)
    wrists = _SHOULDERS_M[:, None] + _UPPER_M * human.upper + _FORE_M * human.fore
    meet = smooth_step(np.linalg.norm(wrists[0] - wrists[1], axis=-1), *_MEET_M) * (1 - swing)
    chest = smooth_step(np.linalg.norm(wrists - _BREASTBONE_M, axis=-1), *_CHEST_M) * (1 - swing - meet)
    shares = ((1 - swing - meet - chest, REACHING), (swing, SWINGING), (meet, MEETING), (chest, AT_CHEST))
    lengths = np.array([_UPPER_M, _FORE_M]) / np.mean([_UPPER_M, _FORE_M])
    weights = np.zeros((2, human.upper.shape[1], 2, 2))
    for amount, of in shares:
        weights += amount[..., None, None] * (np.diag([of.upper, of.fore]) + of.hand * np.outer(lengths, lengths))
    return weights


def swinging(human: HumanPose) -> Array:
    """(2, T) degree, 0 to 1, to which each forearm swings about a still upper arm."""
    upper, fore = np.split(_speed_rad_s(np.concatenate([human.upper, human.fore]), human.fps), 2)
    return smooth_step(fore, *_SWING_RAD_S) * smooth_step(upper / np.maximum(fore, 1e-6), *_STILL_SHARE)


def _speed_rad_s(directions: Array, fps: float) -> Array:
    """(K, T) root mean square speed of K unit directions (K, T, 3) around each frame."""
    if directions.shape[1] < 2:
        return np.zeros(directions.shape[:2])
    step = np.empty_like(directions)
    step[:, 1:-1] = (directions[:, 2:] - directions[:, :-2]) / 2
    step[:, 0], step[:, -1] = directions[:, 1] - directions[:, 0], directions[:, -1] - directions[:, -2]
    squares = ((step * fps) ** 2).sum(-1)
    reach = max(1, round(3 * _SWING_S * fps))
    share = np.exp(-0.5 * (np.arange(-reach, reach + 1) / (_SWING_S * fps)) ** 2)
    share /= share.sum()
    first, last = np.repeat(squares[:, :1], reach, 1), np.repeat(squares[:, -1:], reach, 1)
    around = np.concatenate([first, squares, last], 1)
    return np.sqrt(np.stack([np.convolve(s, share, "valid") for s in around]))
