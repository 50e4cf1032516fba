"""Performs a score with a body: arms, head and trunk follow its channels, and smaller movements are added.

Added are: the trunk turns and leans a little with the hands, the head stays towards the listener, the forearm lags, the
body breathes and sways.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.score import Score
from mmm_core.motion.features import features_from_joints
from mmm_core.motion.motion import FPS
from mmm_core.motion.skeleton import (
    BONE_LENGTHS_M,
    REST_DIRECTIONS,
    Array,
    forward_kinematics,
    normalise,
    rotation_about,
    rotation_y,
)

_ARMS = (("left", 1.0, 16, 18, 20), ("right", -1.0, 17, 19, 21))
_YAW_PER_M, _ROLL_PER_M, _PITCH_PER_M = 0.16, 0.05, 0.05
"""Radians of trunk yaw for a metre between the hands forward, of roll for a metre between them up, and of pitch for a metre of
their mean reach forward."""
SHRUG_M = 0.06
"""Metres that a full shrug lifts the shoulders."""


@dataclass(frozen=True)
class Body:
    """A motion of the common body, from which features are computed."""

    joints_m: Array
    head_R_world: Array
    forearm_twist_rad: Array

    def features(self) -> NDArray[np.float32]:
        """(T, 263) features."""
        return features_from_joints(self.joints_m, self.head_R_world, self.forearm_twist_rad)


def euler(yaw_pitch_roll: Array) -> Array:
    """(T, 3) yaw (to the left), pitch (forward), roll (to the left), radians -> (T, 3, 3)."""
    yaw, pitch, roll = yaw_pitch_roll.T
    x, z = np.array([1.0, 0, 0]), np.array([0.0, 0, 1])
    return rotation_y(yaw) @ rotation_about(x, pitch) @ rotation_about(z, -roll)


def smooth(values: Array, sigma_frames: float) -> Array:
    """Gaussian filter along time with repeated ends, which rounds corners where key poses follow each other without a stop."""
    radius = int(np.ceil(3 * sigma_frames))
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sigma_frames) ** 2)
    kernel /= kernel.sum()
    padded = np.concatenate([values[:1].repeat(radius, 0), values, values[-1:].repeat(radius, 0)])
    T = len(values)
    out = kernel[0] * padded[:T]
    for i in range(1, 2 * radius + 1):
        out += kernel[i] * padded[i : i + T]
    return out


def perform(score: Score, n_frames: int, stiffness: float = 0.0, posture_rad: tuple[float, float] = (0.0, 0.0)) -> Body:
    """The motion of a score on the common body, standing.

    Args:
        score: movements of the channels.
        n_frames: frames of the motion.
        stiffness: 0 is a person; 1 is a machine without lag, sway or any added movement.
        posture_rad: pitch added to trunk and head throughout, forward and down positive.
    """
    rng = score.rng
    loose = 1.0 - stiffness
    times = np.arange(n_frames) / FPS
    lag = loose * rng.uniform(0.0, 0.06)  # seconds by which the forearm follows the upper arm
    sigma = rng.uniform(0.7, 1.2) * (0.4 + 0.6 * loose)
    arms = {name: smooth(score.sample(name, times, lag), sigma) for name, *_ in _ARMS}
    trunk_head = smooth(np.concatenate([score.sample("trunk", times), score.sample("head", times)], 1), 1.0)
    shrug = smooth(score.sample("shrug", times), 1.0)[:, 0]
    along = loose * rng.uniform(0.6, 1.2) * _going_along(arms)
    trunk = trunk_head[:, :3] + along
    head = trunk_head[:, 3:] - rng.uniform(0.6, 0.9) * along  # the gaze keeps its direction
    alive = 0.0 if score.beat_s else loose  # clean gestures neither sway nor breathe
    sway = np.sin(2 * np.pi * (times[:, None] * rng.uniform(0.15, 0.35, 3) + rng.random(3)))
    trunk += alive * np.deg2rad(rng.uniform(0.1, 0.4)) * sway
    breath = alive * 0.004 / SHRUG_M * np.sin(2 * np.pi * (times * rng.uniform(0.2, 0.3) + rng.random()))
    trunk[:, 1] += posture_rad[0]
    head[:, 1] += posture_rad[1]
    joints, chest = _trunk(trunk, shrug + breath, rng)
    twists = np.zeros((n_frames, 2))
    for row, (name, sign, shoulder, elbow, wrist) in enumerate(_ARMS):
        out = np.array([sign, 1, 1])
        for joint, parent, first in ((elbow, shoulder, 0), (wrist, elbow, 3)):
            bone = np.einsum("tij,tj->ti", chest, normalise(arms[name][:, first : first + 3]) * out)
            joints[:, joint] = joints[:, parent] + BONE_LENGTHS_M[joint] * bone
        twists[:, row] = sign * arms[name][:, 6]
    head_R = chest @ euler(head)
    joints[:, 15] = joints[:, 12] + BONE_LENGTHS_M[15] * (head_R @ REST_DIRECTIONS[15])
    return Body(joints, head_R, twists)


def _going_along(arms: dict[str, Array]) -> Array:
    """(T, 3) yaw, pitch and roll of the trunk that follow from the hands: the shoulder of a reaching arm comes forward."""
    hand = {name: BONE_LENGTHS_M[18] * v[:, :3] + BONE_LENGTHS_M[20] * v[:, 3:6] for name, v in arms.items()}
    up = hand["right"][:, 1] - hand["left"][:, 1]
    forward = hand["right"][:, 2] - hand["left"][:, 2]
    both = (hand["right"][:, 2] + hand["left"][:, 2]) / 2
    angles = np.stack([_YAW_PER_M * forward, _PITCH_PER_M * both, _ROLL_PER_M * up], -1)
    return smooth(angles - angles[0], 1.5)


def _trunk(trunk: Array, shrug: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """Joints (T, 22, 3) of legs, spine, neck and shoulders, and the chest's world rotation (T, 3, 3)."""
    T = len(trunk)
    local = np.tile(np.eye(3), (T, 22, 1, 1))
    spread = rng.uniform(-0.02, 0.08)
    for knee, side in ((4, 1.0), (5, -1.0)):
        local[:, knee] = rotation_about(np.array([0.0, 0, 1]), np.full(T, side * spread))
    third = euler(trunk / 3)
    for joint in (3, 6, 9):
        local[:, joint] = third
    root = np.zeros((T, 3))
    root[:, 1] = 0.93
    joints, world = forward_kinematics(local, root)
    joints[:, :, 1] -= joints[0, [10, 11], 1].min()
    chest = world[:, 9]
    lift = chest[:, :, 1] * (SHRUG_M * shrug)[:, None]
    for joint in (16, 17):
        joints[:, joint] += lift
    return joints, chest
