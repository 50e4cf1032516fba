"""Counts the strokes of a repetitive motion, of any gesture: peaks along the main direction of its most regular cycle.

The body's motion is a path in one space (wrists, forearms, head, trunk). A cycle is a segment of that path that recurs after
one period; the count needs no knowledge of the gesture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features

Array = NDArray[np.floating]

SHORTEST_FRAMES, LONGEST_FRAMES = 6, 32
"""Shortest and longest period of a cycle, frames: 0.3 to 1.6 s."""
LEAST_M, LEAST_SHARE = 0.05, 0.2
"""Least range of a cycle: metres, and share of the whole motion's range."""
NEARLY, NEARLY_ADD = 1.3, 0.08
"""Factor and sum by which a shorter period's misfit may exceed the best one: longer periods of about equal misfit are
multiples of the cycle."""
TURN_SHARE = 0.45
"""Share of the cycle's range by which a stroke rises and falls at least."""
_HEAD_DEG_PER_M, _TRUNK_DEG_PER_M, _FOREARM_M = 100.0, 60.0, 0.25


@dataclass(frozen=True)
class Strokes:
    """The strokes of a motion.

    Attributes:
        path: (T, D) body, metres; angles are scaled to lengths of similar weight.
        frames: frames of the strokes' peaks.
        sure: whether there are as many peaks as valleys.
        range_m: range of one cycle, metres.
        misfit: mean distance between the body and itself one period earlier, as a share of the range; 0 is exact.
    """

    path: Array
    frames: list[int]
    sure: bool
    range_m: float
    misfit: float

    @property
    def period_frames(self) -> int:
        """Frames from stroke to stroke, the median; of two strokes at least."""
        return int(np.median(np.diff(self.frames)))

    def apart(self, i: int, j: int) -> float:
        """Distance of the body between frames i and j, as a share of a cycle's range."""
        return float(np.linalg.norm(self.path[i] - self.path[j])) / self.range_m


def strokes_of(motion: Motion) -> Strokes | None:
    """The strokes of a motion; None where nothing moves."""
    path = body_path(motion)
    found = _cycle(path)
    if found is None:
        return None
    start, period, misfit, range_m = found
    cycle = path[start : start + 2 * period]
    along = (path - cycle.mean(0)) @ np.linalg.svd(cycle - cycle.mean(0), full_matrices=False)[2][0]
    low, high = float(along[start : start + 2 * period].min()), float(along[start : start + 2 * period].max())
    along = np.clip(along, low - 0.3 * (high - low), high + 0.3 * (high - low))
    up, down = (peaks_beyond(sign * along, TURN_SHARE * (high - low)) for sign in (1, -1))
    return Strokes(path, min(up, down, key=len), len(up) == len(down), range_m, misfit)


def about_mean(path: Array, period_frames: int) -> Array:
    """(T, ...) path from its mean over one period: what repeats, without what leads to it."""
    return np.asarray(path - uniform_filter1d(path, max(3, period_frames), axis=0, mode="nearest"))


def body_path(motion: Motion) -> Array:
    """(T, 18) wrists, head, trunk and forearms of a motion, metres; angles are scaled to lengths of similar weight."""
    s = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    head = np.stack([s.head_yaw_deg, s.head_pitch_deg, s.head_roll_deg], -1) / _HEAD_DEG_PER_M
    trunk = np.stack([s.trunk_yaw_deg, s.trunk_pitch_deg, s.trunk_roll_deg], -1) / _TRUNK_DEG_PER_M
    forearms = [_FOREARM_M * s.fore[side] for side in ("left", "right")]
    return np.concatenate([s.wrists_m["left"], s.wrists_m["right"], head, trunk, *forearms], -1)


def peaks_beyond(signal: Array, turn: float) -> list[int]:
    """Frames of the peaks that rise by more than `turn` from the valley before; all but the last also fall by as much."""
    found: list[int] = []
    rising, valley, peak = False, float(signal[0]), float(signal[0])
    for frame, value in enumerate(signal[1:].tolist(), 1):
        if rising:
            if value > peak:
                peak, found[-1] = value, frame
            if value < peak - turn:
                rising, valley = False, value
        else:
            valley = min(valley, value)
            if value > valley + turn:
                found.append(frame)
                rising, peak = True, value
    return found


def _cycle(path: Array) -> tuple[int, int, float, float] | None:
    """First frame, period, misfit and range of the most regular cycle; None where none has enough range."""
    T = len(path)
    least_m = max(LEAST_M, LEAST_SHARE * float(np.ptp(path, axis=0).max())) if T else 0.0
    high, low = path.copy(), path.copy()  # of the window that begins at each frame
    found: list[tuple[int, int, float, float]] = []
    for period in range(2, LONGEST_FRAMES + 1):
        if T < 2 * period:
            break
        high, low = np.maximum(high[:-1], path[period - 1 :]), np.minimum(low[:-1], path[period - 1 :])
        if period < SHORTEST_FRAMES:
            continue
        away = np.concatenate([[0.0], np.cumsum(np.linalg.norm(path[period:] - path[:-period], axis=-1))])
        n = T - 2 * period + 1
        range_m = (high - low)[:n].max(1)
        misfit = (away[period : period + n] - away[:n]) / period / np.maximum(range_m, 1e-9)
        misfit[range_m < least_m] = np.inf
        start = int(misfit.argmin())
        if np.isfinite(misfit[start]):
            found.append((start, period, float(misfit[start]), float(range_m[start])))
    if not found:
        return None
    best = min(f[2] for f in found)
    return next(f for f in found if f[2] <= max(NEARLY * best, best + NEARLY_ADD))
