"""Small movements of an idle robot: breath in chest and shoulders, weight that shifts, a wandering gaze.

They are made as poses like any motion, so that retargeting keeps limits and self-contact as always. They begin from the standing
person and never stray far from that pose: amplitudes are a few degrees.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daemon.poses.motion_source import MotionSource
from daemon.poses.pose_sequence import PoseSequence, mixed, smooth_step, standing
from mmm_core.motion.motion import FPS
from mmm_core.motion.skeleton import JOINT_NAMES, normalise

Array = NDArray[np.float64]

STRETCH_S = 2.0
RISE_S = 3.0
"""Seconds from stillness to full movement."""
_BREATH_HZ = 0.25
_SPINE = [JOINT_NAMES.index(name) for name in ("spine2", "spine3", "neck")]
_SHOULDERS = [JOINT_NAMES.index(name) for name in ("left_shoulder", "right_shoulder")]
_ELBOWS = [JOINT_NAMES.index(name) for name in ("left_elbow", "right_elbow")]
_GAZE_HZ = ((0.043, 0.071, 0.113), (0.037, 0.083, 0.101))
"""Hz of slow oscillations without a common period, for yaw and pitch, so that the gaze wanders without repeating."""
_WEIGHT_HZ = (0.021, 0.047, 0.061)
_WEIGHT_HELD = 4.0
"""Steepness of the weight's shift: the weight rests on one leg for some seconds and then on the other, as a person's does."""


@dataclass(frozen=True)
class IdleStyle:
    """Amplitudes of an idle style in degrees."""

    breath_deg: float
    gaze_yaw_deg: float
    gaze_pitch_deg: float
    sway_deg: float


STYLES = {"calm": IdleStyle(1.5, 6.0, 2.5, 1.0), "lively": IdleStyle(2.5, 16.0, 6.0, 2.2)}


class IdleSource(MotionSource):
    """Endless idle movements."""

    def __init__(self, style: str, seed: int = 0) -> None:
        self._style = STYLES[style]
        self._phase = np.random.default_rng(seed).uniform(0, 2 * np.pi, (3, 3))
        self._frame = 0
        self._finishing = False

    def finish(self) -> None:
        """Let the next segment lead to stillness and be the last."""
        self._finishing = True

    def next(self) -> tuple[PoseSequence, bool]:
        """The next two seconds of poses, and whether they are the last."""
        n = round(STRETCH_S * FPS)
        t_s = (self._frame + np.arange(n)) / FPS
        self._frame += n
        share = np.clip(t_s / RISE_S, 0, 1)
        rise = share**2 * (3 - 2 * share)
        last = self._finishing
        if last:
            rise = rise * (1 - smooth_step(n))
        return self._posture(t_s, rise), last

    def _posture(self, t_s: Array, rise: Array) -> PoseSequence:
        style = self._style
        stand = standing().at(np.zeros(len(t_s), np.intp))
        breath = np.deg2rad(style.breath_deg) * rise * (1 - np.cos(2 * np.pi * _BREATH_HZ * t_s)) / 2
        yaw = np.deg2rad(style.gaze_yaw_deg) * rise * self._wander(t_s, 0, _GAZE_HZ[0])
        pitch = np.deg2rad(style.gaze_pitch_deg) * rise * self._wander(t_s, 1, _GAZE_HZ[1])
        sway = np.deg2rad(style.sway_deg) * rise * np.tanh(_WEIGHT_HELD * self._wander(t_s, 2, _WEIGHT_HZ))
        bones = stand.bones.copy()
        bones[:, _SPINE, 2] -= breath[:, None]
        bones[:, _SPINE, 0] += sway[:, None]
        bones[:, _SHOULDERS, 1] += breath[:, None]
        bones[:, _ELBOWS, 0] += breath[:, None] * np.array([0.6, -0.6])
        return replace(stand, bones=normalise(bones), head_quat_wxyz=head_wxyz(yaw, pitch))

    def _wander(self, t_s: Array, k: int, hz: tuple[float, float, float]) -> Array:
        """A wandering value between -1 and 1 for each time, from 0 at the start."""
        w = 2 * np.pi * np.array(hz)
        return (np.sin(np.outer(t_s, w) + self._phase[k]) - np.sin(self._phase[k])).sum(1) / 6


def head_wxyz(yaw_rad: Array, pitch_rad: Array) -> Array:
    """(T, 4) orientation of a head turned left by `yaw_rad` (T,) and then down by `pitch_rad` (T,)."""
    zero = np.zeros_like(yaw_rad)
    cy, sy, cp, sp = np.cos(yaw_rad / 2), np.sin(yaw_rad / 2), np.cos(pitch_rad / 2), np.sin(pitch_rad / 2)
    # Rotate about y (up), then about x (the person's left): the product of (cy, 0, sy, 0) and (cp, sp, 0, 0).
    return np.stack([cy * cp, cy * sp, sy * cp, zero - sy * sp], -1)


def looking(p: PoseSequence, yaw_rad: float, pitch_rad: float, weight: Array) -> PoseSequence:
    """`p` with the head turned to a direction, frame by frame by `weight` (T,)."""
    n = len(p)
    aim = replace(p, head_quat_wxyz=np.repeat(head_wxyz(np.array([yaw_rad]), np.array([pitch_rad])), n, 0))
    return replace(p, head_quat_wxyz=mixed(p, aim, weight).head_quat_wxyz)
