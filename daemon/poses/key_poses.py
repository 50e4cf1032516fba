"""Leads a motion exactly through given poses, which the model meets within a few degrees; transitions are smooth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daemon.poses.pose_sequence import PoseSequence, mixed

REACH_S = 1.0
"""Seconds before a pose's time from which the motion is led towards the pose, and seconds after it until the motion is unchanged
again."""


@dataclass(frozen=True)
class KeyPose:
    """One frame of posture, due at a time from the motion's start."""

    at_s: float
    pose: PoseSequence


def led_through(p: PoseSequence, keys: Sequence[KeyPose]) -> PoseSequence:
    """`p`, changed so that each key pose appears exactly in its frame.

    The weight of a pose rises and falls on a minimum-jerk curve over `REACH_S`, or over the time to the next pose where
    that is shorter, so that poses do not disturb each other.
    """
    order = sorted(keys, key=lambda key: key.at_s)
    frames = [min(len(p) - 1, round(key.at_s * p.fps)) for key in order]
    for k, (key, frame) in enumerate(zip(order, frames, strict=True)):
        before = frame - frames[k - 1] if k else len(p)
        after = frames[k + 1] - frame if k + 1 < len(frames) else len(p)
        t = np.arange(len(p)) - frame
        reach = np.where(t < 0, min(before, REACH_S * p.fps), min(after, REACH_S * p.fps))
        u = np.clip(1 - np.abs(t) / np.maximum(reach, 1), 0, 1)
        w = u**3 * (10 - 15 * u + 6 * u**2)
        still = key.pose.at(np.zeros(len(p), np.intp))
        p = mixed(p, PoseSequence(still.bones, p.lengths_m, still.head_quat_wxyz, still.forearm_twist_rad, p.fps), w)
    return p
