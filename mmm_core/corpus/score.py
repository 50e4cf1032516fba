"""A gesture as a score: each channel of the upper body moves between key poses along minimum-jerk paths.

Channels: `left` and `right` arm (upper arm direction, forearm direction, forearm twist), `head` and `trunk` (yaw, pitch,
roll), `shrug`. Directions are given in the chest frame as (outward, up, forward), so that one pose serves both arms.
Minimum jerk: Flash and Hogan 1985.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mmm_core.features import features_from_joints
from mmm_core.motion import FPS
from mmm_core.skeleton import (
    BONE_LENGTHS_M,
    REST_DIRECTIONS,
    Array,
    forward_kinematics,
    normalise,
    rotation_about,
    rotation_y,
)

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class ArmPose:
    """Directions (outward, up, forward) of upper arm and forearm, and the forearm's twist in radians."""

    upper: Vector
    fore: Vector
    twist_rad: float = 0.0

    def vector(self) -> Array:
        """(7,) channel value: unit directions and the twist."""
        return np.concatenate([normalise(np.array(self.upper)), normalise(np.array(self.fore)), [self.twist_rad]])


REST_ARM = ArmPose((0.2, -0.97, 0.02), (0.1, -0.93, 0.3))


@dataclass
class Score:
    """Key poses in time; `move` and `hold` write it from left to right."""

    rng: np.random.Generator
    rest: dict[str, Array]
    time_s: float = 0.0
    keys: dict[str, list[tuple[float, Array]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Every channel starts at rest."""
        for name, value in self.rest.items():
            self.keys[name] = [(0.0, value)]

    def now(self, channel: str) -> Array:
        """The value that `channel` holds at the current time."""
        return self.keys[channel][-1][1]

    def move(self, duration_s: float, **targets: Array | ArmPose | Vector | float) -> None:
        """Move the named channels to their targets; others hold. Time advances."""
        for name, target in targets.items():
            value = target.vector() if isinstance(target, ArmPose) else np.atleast_1d(np.asarray(target, float))
            self.keys[name] += [(self.time_s, self.now(name)), (self.time_s + duration_s, value)]
        self.time_s += duration_s

    def hold(self, duration_s: float) -> None:
        """Keep everything where it is."""
        self.time_s += duration_s

    def relax(self, duration_s: float) -> None:
        """Bring every channel back to rest."""
        away = {name: self.rest[name] for name in self.keys if not np.allclose(self.now(name), self.rest[name])}
        self.move(duration_s, **away)

    def sample(self, channel: str, times_s: Array) -> Array:
        """(T, D) values of `channel`."""
        at = np.array([t for t, _ in self.keys[channel]])
        values = np.array([v for _, v in self.keys[channel]])
        segment = np.clip(np.searchsorted(at, times_s, side="right") - 1, 0, len(at) - 1)
        following = np.minimum(segment + 1, len(at) - 1)
        span = np.maximum(at[following] - at[segment], 1e-6)
        u = np.clip((times_s - at[segment]) / span, 0, 1)
        s = u**3 * (10 - 15 * u + 6 * u**2)
        return values[segment] + (values[following] - values[segment]) * s[:, None]


@dataclass(frozen=True)
class Body:
    """A motion of the common body before it becomes features."""

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


def _smooth(values: Array, sigma_frames: float) -> Array:
    """Gaussian filter along time with held ends: rounds the corners where keys follow each other without a stop."""
    radius = int(np.ceil(3 * sigma_frames))
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sigma_frames) ** 2)
    kernel /= kernel.sum()
    padded = np.pad(values, ((radius, radius), (0, 0)), mode="edge")
    return np.stack([np.convolve(padded[:, d], kernel, mode="valid") for d in range(values.shape[1])], -1)


def perform(score: Score, n_frames: int) -> Body:
    """The score on the common body: arms, head and trunk from the channels, legs standing, a little sway and breath."""
    rng = score.rng
    times = np.arange(n_frames) / FPS
    lag = rng.uniform(0.0, 0.06)  # the forearm follows the upper arm, the trunk starts first
    sigma = rng.uniform(0.7, 1.2)
    trunk = _smooth(score.sample("trunk", times), 1.5)
    head = _smooth(score.sample("head", times), 0.8)
    shrug = _smooth(score.sample("shrug", times), 1.0)
    trunk += np.deg2rad(rng.uniform(0.1, 0.4)) * np.sin(
        2 * np.pi * (times[:, None] * rng.uniform(0.15, 0.35, 3) + rng.random(3))
    )
    breath = 0.004 * np.sin(2 * np.pi * (times * rng.uniform(0.2, 0.3) + rng.random()))
    joints, chest = _trunk(trunk, shrug[:, 0] + breath, rng)
    twists = np.zeros((n_frames, 2))
    for row, (name, sign, shoulder, elbow, wrist) in enumerate((("left", 1, 16, 18, 20), ("right", -1, 17, 19, 21))):
        upper = _smooth(score.sample(name, times)[:, :3], sigma)
        fore = _smooth(score.sample(name, times - lag)[:, 3:6], sigma)
        out = np.array([sign, 1, 1])
        for joint, parent, direction in ((elbow, shoulder, upper), (wrist, elbow, fore)):
            bone = np.einsum("tij,tj->ti", chest, normalise(direction) * out)
            joints[:, joint] = joints[:, parent] + BONE_LENGTHS_M[joint] * bone
        twists[:, row] = sign * _smooth(score.sample(name, times - lag)[:, 6:], sigma)[:, 0]
    head_R = chest @ euler(head)
    joints[:, 15] = joints[:, 12] + BONE_LENGTHS_M[15] * (head_R @ REST_DIRECTIONS[15])
    return Body(joints, head_R, twists)


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
    lift = np.einsum("tij,j->ti", chest, np.array([0.0, 1.0, 0.0])) * (0.06 * shrug)[:, None]
    for joint in (16, 17):
        joints[:, joint] += lift
    return joints, chest
