"""Measures a motion by its posture features (`mmm_core.motion.posture_features`), without its text: limb, strokes, direction.

Each check answers one question about a motion of one of the corpus's families. Tests hold them against right motions, and
against mirrored, absent and other ones.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.motion import FPS
from mmm_core.motion.posture_features import PostureFeatures, angle_deg
from mmm_core.motion.repetitions import peaks_beyond

Array = NDArray[np.floating]

HEAD_MOVED_DEG = 11.0
"""Degrees beyond which the head counts as moved."""
TRUNK_MOVED_DEG = 6.0
"""Degrees beyond which the trunk counts as moved."""
PALM_M = 0.08
"""Metres from the wrist joint to the middle of the palm."""
_STERNUM_M = np.array([0.0, -0.13, 0.13])


def limb(s: PostureFeatures) -> str:
    """The limb that moves most clearly: "arm", "trunk", "head", or "" where none moves."""
    if s.arms:
        return "arm"
    trunk, head = reach_deg(s, "trunk"), reach_deg(s, "head")
    if trunk > max(TRUNK_MOVED_DEG, 0.4 * head):  # the trunk goes along a little when the head looks aside
        return "trunk"
    return "head" if head > HEAD_MOVED_DEG else ""


def reach_deg(s: PostureFeatures, limb_name: str) -> float:
    """Degrees that "head" or "trunk" turns away from its first direction at most, about any axis."""
    if limb_name == "trunk":
        return max(_reach(s.trunk_yaw_deg), _reach(s.trunk_pitch_deg), _reach(s.trunk_roll_deg))
    return max(_reach(s.head_yaw_deg), _reach(s.head_pitch_deg), _reach(s.head_roll_deg))


def count(s: PostureFeatures, family: str, side: str = "") -> int | None:
    """Number of strokes of a repetitive gesture; None for families whose strokes are not counted.

    Args:
        s: posture features of the motion.
        family: the family of the gesture.
        side: "alternating" adds up both arms' strokes; otherwise the arm with more strokes counts.
    """
    signals = _stroke_signals(s, family)
    if not signals:
        return None
    counts = [strokes(signal, least) for signal, least in signals]
    if family == "shake_head":
        return max(0, sum(counts) - 1)
    return sum(counts) if family == "punch" or side == "alternating" else max(counts)


def cycle_s(s: PostureFeatures, family: str) -> float | None:
    """Median seconds from stroke to stroke; None with fewer than two strokes."""
    found = [peaks(signal, least) for signal, least in _stroke_signals(s, family)]
    best = max(found, key=len, default=[])
    return float(np.median(np.diff(best))) / FPS if len(best) > 1 else None


def held_s(s: PostureFeatures, limb_name: str) -> float:
    """Seconds of a limb's longest pause far from its first position."""
    if limb_name == "arm":
        sides = ("left", "right") if s.arms in ("both", "") else (s.arms,)
        return max(_still_s(s.wrists_m[side] * 100, 20.0) for side in sides)
    angles = (s.head_yaw_deg, s.head_pitch_deg, s.head_roll_deg)
    if limb_name == "trunk":
        angles = (s.trunk_yaw_deg, s.trunk_pitch_deg, s.trunk_roll_deg)
    return _still_s(np.stack(angles, -1), 20.0)


def _still_s(path: Array, most_per_s: float) -> float:
    """Seconds of the longest segment of `path` (T, D) that is far from its start and slower than `most_per_s`."""
    far = np.linalg.norm(path - path[0], axis=-1)
    slow = np.linalg.norm(np.gradient(path, axis=0), axis=-1) * FPS < most_per_s
    longest = run = 0
    for ok in (slow & (far > 0.6 * far.max())).tolist():
        run = run + 1 if ok else 0
        longest = max(longest, run)
    return longest / FPS


def _stroke_signals(s: PostureFeatures, family: str) -> list[tuple[Array, float]]:
    """Signals whose peaks are the family's strokes, each with its least range; smaller signals have no strokes."""
    if family == "nod":
        return [(s.head_pitch_deg, 8.0)]
    if family == "shake_head":
        return [(s.head_yaw_deg, 12.0), (-s.head_yaw_deg, 12.0)]
    if family == "bow":
        return [(s.trunk_pitch_deg, 12.0)]
    if family == "sway":
        return [(s.trunk_roll_deg, 6.0)]
    if family == "clap":
        return [(-np.linalg.norm(s.wrists_m["left"] - s.wrists_m["right"], axis=-1)[_raised(s)], 0.08)]
    if family not in _ARM_SIGNALS:
        return []
    sides = ("left", "right") if s.arms in ("both", "") else (s.arms,)
    return [_ARM_SIGNALS[family](s, side) for side in sides]


def direction(s: PostureFeatures, family: str) -> str:
    """Direction of a gesture ("left", "up left", "self"); "" where it goes nowhere or its family has no direction."""
    if family == "look":
        yaw, pitch = s.head_yaw_deg, s.head_pitch_deg
        t = int(np.argmax(np.abs(yaw) + np.abs(pitch)))
        return _aim(float(yaw[t]) / 40, -float(pitch[t]) / 30, 0.4)
    if family == "tilt_head":
        return _largest({"left": s.head_roll_deg.max(), "right": -s.head_roll_deg.min()}, 10)
    if family == "lean":
        roll, pitch = s.trunk_roll_deg - s.trunk_roll_deg[0], s.trunk_pitch_deg - s.trunk_pitch_deg[0]
        return _largest({"left": roll.max(), "right": -roll.min(), "forward": pitch.max(), "back": -pitch.min()}, 5)
    if family == "twist":
        return _largest({"left": s.trunk_yaw_deg.max(), "right": -s.trunk_yaw_deg.min()}, 9)
    if family == "look_back":
        yaw = s.head_yaw_deg + s.trunk_yaw_deg
        return _largest({"left": yaw.max(), "right": -yaw.min()}, 40)
    if family == "stretch":
        return _largest({"left": s.trunk_roll_deg.max(), "right": -s.trunk_roll_deg.min()}, 6) or "up"
    if family == "point":
        side = s.arms if s.arms in ("left", "right") else "right"
        held = _held(s, side)
        x, y, z = (float(v) for v in s.fore[side][held].mean(0))
        palm = (s.wrists_m[side][held] + PALM_M * s.fore[side][held]).mean(0)
        if np.linalg.norm(palm - _STERNUM_M) < 0.2:
            return "self"
        if z < -0.45:
            return "back"
        aim = _aim(x / 0.7, (y if y > 0 else 1.3 * y) / 0.8, 0.55)
        return "forward" if z > 0.75 or not aim else aim  # pointing at the floor is half forward
    return ""


def _wave_signal(s: PostureFeatures, side: str) -> tuple[Array, float]:
    up = s.fore[side][:, 1] > 0.55
    return (s.fore[side][:, 0] * (1 if side == "left" else -1))[up], 0.25


def _forward_signal(s: PostureFeatures, side: str) -> tuple[Array, float]:
    return s.wrists_m[side][:, 2], 0.12


def _fold_signal(s: PostureFeatures, side: str) -> tuple[Array, float]:
    return s.fore[side][:, 1][s.upper[side][:, 2] > 0.25], 0.35


def _height_signal(s: PostureFeatures, side: str) -> tuple[Array, float]:
    return s.wrists_m[side][:, 1], 0.3


_ARM_SIGNALS = {
    "wave": _wave_signal, "punch": _forward_signal, "beckon": _fold_signal,
    "jumping_jack": _height_signal, "lift_weight": _height_signal,
}  # fmt: skip


def _raised(s: PostureFeatures) -> NDArray[np.bool_]:
    """Frames in which both wrists are raised above the hanging pose."""
    return (s.wrists_m["left"][:, 1] > -0.35) & (s.wrists_m["right"][:, 1] > -0.35)


def _held(s: PostureFeatures, side: str) -> NDArray[np.bool_]:
    """Frames in which an arm is away from hanging and moves least."""
    away = angle_deg(s.upper[side], np.array([0.0, -1, 0])) + angle_deg(s.fore[side], np.array([0.0, -1, 0]))
    wanted = away > 0.7 * away.max()
    speed = np.linalg.norm(np.gradient(s.fore[side], axis=0), axis=-1)
    return wanted & (speed <= np.median(speed[wanted]))


def strokes(signal: Array, least: float) -> int:
    """Number of peaks of a signal; 0 when its range is below `least`.

    A peak rises from the valley before it, and falls afterwards or ends the signal, each time by a share of the range. One that
    ends the signal is in the upper half of the range: a hand that is lowered slowly swings back a little.
    """
    return len(peaks(signal, least))


def peaks(signal: Array, least: float) -> list[int]:
    """Frames of the peaks that `strokes` counts."""
    if len(signal) < 3 or np.ptp(signal) < least:
        return []
    found = peaks_beyond(signal, max(0.6 * least, 0.22 * float(np.ptp(signal))))
    ends_low = found and found[-1] == len(signal) - 1 and signal[-1] < (signal.min() + signal.max()) / 2
    return found[:-1] if ends_low else found


def _aim(left: float, up: float, least: float) -> str:
    """Direction "left", "right", "up", "down" or a height with a side; "" when both components are below `least`."""
    height = "up" if up > least else "down" if up < -least else ""
    side = "left" if left > least else "right" if left < -least else ""
    if height and side and min(abs(up), abs(left)) < 0.5 * max(abs(up), abs(left)):
        return height if abs(up) > abs(left) else side
    return f"{height} {side}".strip()


def _largest(values: dict[str, float], least: float) -> str:
    best = max(values, key=lambda key: values[key])
    return best if values[best] > least else ""


def _reach(angle_deg: Array) -> float:
    return float(np.abs(angle_deg - angle_deg[0]).max())
