"""Checks the execution of a gesture strictly, against the reference performance of the gesture.

A recognisable gesture may still be badly executed: a circle that is an ellipse, strokes of uneven pace, arms out of step, hands
that pass each other. Each check measures one such fault against the reference performance, so that no table of families is
needed.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mmm_core.corpus.families import FAMILIES
from mmm_core.evaluation.reference import Reference, channels, palms
from mmm_core.evaluation.stroke_counts import TURN_SHARE, first_sense, turning_points
from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.recognition.signs import shows

Array = NDArray[np.floating]
Checks = dict[str, bool]
TURNS_SEEN = (1.0, 0.9, 0.8)
"""Parts of that share that are tried in turn until the reference shows a stroke: a slow kiss falls by 0.97 of it."""
PACE_RATIO = 1.42
"""Greatest ratio of longest to shortest time between strokes, each time divided by the reference's."""
HALF_PACE_RATIO = 2.0
"""Greatest ratio of longest to shortest time between turning points, each time divided by the reference's."""
TEMPO_RATIO = 1.8
"""Factor by which strokes may be faster or slower than the reference's."""
SIZE_RATIO, LEAST_SIZE = 1.75, 0.55
"""Greatest and least ratio of the strokes' size to the reference's."""
EVEN_SHARE = 0.5
"""Least ratio of smallest to largest stroke, as a share of the reference's ratio."""
ROUND_SHARE = 0.62
"""Least ratio of width to length of a closed path, as a share of the reference's ratio."""
TURNS_OFF = 0.4
"""Turns by which a closed path may differ from the reference's; more for paths of more than two turns."""
MARGIN_FRAMES = 2
"""Frames before and after a gesture in which its strokes may also lie."""
PHASE_OFF = 0.2
"""Share of a cycle by which the arms may be out of step."""
TOUCH_M, TOUCH_OFF_M = 0.15, 0.06
"""Metres between palms below which they touch, and by which a motion's palms may stay farther apart than the reference's."""
POSE_OFF_M, POSE_OFF_DEG, POSE_FRAMES = 0.15, 14.0, 4
"""Metres of a palm and degrees of head and trunk by which a pose may be off, and frames for which it must be held."""
WAY_OFF_SHARE = 0.36
"""Greatest mean distance from the reference, with time warped to fit, as a share of the reference's range."""
_DTW_EVERY = 2


def judge(s: PostureFeatures, ref: Reference) -> tuple[Checks, float]:
    """The outcome of each check that applies to the gesture, and the distance of the motion from the reference (0: equal)."""
    g = ref.gesture
    off, pairs = _warped(s, ref.shown)
    checks = {
        "sign": shows(s, g.family, g.side, g.direction),
        "way": off < WAY_OFF_SHARE,
        "arms": s.arms == ref.shown.arms,
    }
    core = _matched(pairs, ref.core, len(s.lift_m))
    if repeats(ref):
        checks |= _strokes(s, ref, core)
        if len(ref.acting) == 2:
            checks["phase"] = _in_step(s, ref, core)
    else:
        checks["pose"] = _takes_pose(s, ref)
    if ref.is_path and ref.acting and ref.acting[0] in ("left", "right"):
        checks["round"] = all(
            _goes_round(palms(s)[side][core], palms(ref.shown)[side][ref.core]) for side in ref.acting
        )
    meets = _apart(ref.shown)[ref.core]
    if meets.min() < TOUCH_M and ref.shown.arms == "both":
        checks["touch"] = _touches(_apart(s), _apart(ref.shown), ref)
    return checks, off


def repeats(ref: Reference) -> bool:
    """Whether the gesture has strokes."""
    return bool(FAMILIES[ref.gesture.family].counts) and bool(ref.acting)


def _strokes(s: PostureFeatures, ref: Reference, core: slice) -> Checks:
    """Whether count, pace and size of the strokes match, along the axis of each acting channel."""
    wide = slice(max(0, core.start - MARGIN_FRAMES), core.stop + MARGIN_FRAMES)
    made, meant = [], []
    checks = {"count": True, "pace": True, "size": True}
    for name in ref.acting:
        signal, clean = ref.along(s, name)[wide], ref.along(ref.shown, name)[ref.core]
        reach = TURN_SHARE * float(np.ptp(clean))
        out = first_sense(clean, reach)
        turn = next((share * reach for share in TURNS_SEEN if turning_points(out * clean, share * reach)), reach)
        made.append(turning_points(out * signal, turn))
        meant.append(turning_points(out * clean, turn))
        if len(made[-1]) == len(meant[-1]) > 1:
            checks["pace"] &= _steady(made[-1], meant[-1], PACE_RATIO)
            turns = [
                sorted([*peaks, *turning_points(-out * x, turn)])
                for peaks, x in ((made[-1], signal), (meant[-1], clean))
            ]
            checks["pace"] &= len(turns[0]) != len(turns[1]) or _steady(turns[0], turns[1], HALF_PACE_RATIO)
        checks["size"] &= _sized(out * signal, out * clean, turn)
    counts, clean_counts = [len(m) for m in made], [len(m) for m in meant]
    if ref.gesture.side == "alternating":  # either arm may have begun
        counts, clean_counts = sorted(counts), sorted(clean_counts)
    checks["count"] = counts == clean_counts
    return checks


def _sized(made: Array, meant: Array, turn: float) -> bool:
    """Whether the distances between turning points match the reference's and each other."""
    ways = []
    for signal in (made, meant):
        turns = sorted([0, *turning_points(signal, turn), *turning_points(-signal, turn), len(signal) - 1])
        way = np.abs(np.diff(signal[turns])) if len(signal) else np.zeros(1)
        ways.append(way[way > 0.5 * turn])
    if not len(ways[0]) or not len(ways[1]):
        return len(ways[0]) == len(ways[1])
    ratio = float(np.median(ways[0]) / np.median(ways[1]))
    even = [float(w.min() / w.max()) for w in ways]
    return LEAST_SIZE < ratio < SIZE_RATIO and even[0] > EVEN_SHARE * even[1]


def _steady(made: list[int], meant: list[int], most: float) -> bool:
    """Whether the times between strokes are as even as the reference's, and of similar length."""
    ratio = np.diff(made) / np.diff(meant)
    return bool(ratio.max() / ratio.min() < most and 1 / TEMPO_RATIO < np.median(ratio) < TEMPO_RATIO)


def _in_step(s: PostureFeatures, ref: Reference, core: slice) -> bool:
    """Whether both arms have the reference's phase: together, opposed or one after the other."""
    a, b = ref.acting
    meant = _lag(ref.along(ref.shown, a)[ref.core], ref.along(ref.shown, b)[ref.core])
    made = _lag(ref.along(s, a)[core], ref.along(s, b)[core])
    if meant is None or made is None:
        return meant is None
    return abs((made - meant + 0.5) % 1.0 - 0.5) < PHASE_OFF


def _lag(a: Array, b: Array) -> float | None:
    """Phase of `b` behind `a`, as a share of the cycle of their strongest common frequency; None without one."""
    n = min(len(a), len(b))
    if n < 6:
        return None
    window = np.hanning(n + 2)[1:-1]
    x, y = (np.fft.rfft((v[:n] - v[:n].mean()) * window, 8 * n) for v in (a, b))
    first = 8  # index of the frequency with one cycle in all frames
    k = first + int(np.argmax((np.abs(x) * np.abs(y))[first:]))
    return float(np.angle(x[k] * np.conj(y[k])) / (2 * np.pi))


def _goes_round(made: Array, meant: Array) -> bool:
    """Whether a palm's path is as round as the reference's, with as many turns in the same sense."""
    if len(made) < 5:
        return False
    plane = np.linalg.svd(meant - meant.mean(0), full_matrices=False)[2][:2]
    a, b = (made - made.mean(0)) @ plane.T, (meant - meant.mean(0)) @ plane.T
    narrow = [s[1] / max(float(s[0]), 1e-6) for s in (np.linalg.svd(v, compute_uv=False) for v in (a, b))]
    return bool(
        narrow[0] > ROUND_SHARE * narrow[1] and abs(_turns(a) - _turns(b)) < TURNS_OFF * max(1.0, abs(_turns(b)) / 2)
    )


def _turns(path: Array) -> float:
    around = np.unwrap(np.arctan2(path[:, 1], path[:, 0]))
    return float((around[-1] - around[0]) / (2 * np.pi))


def _apart(s: PostureFeatures) -> Array:
    both = palms(s)
    return np.linalg.norm(both["left"] - both["right"], axis=-1)


def _touches(made: Array, meant: Array, ref: Reference) -> bool:
    """Whether the palms touch as often as in the reference."""
    near = float(meant[ref.core].min())
    if made.min() > near + TOUCH_OFF_M:
        return False
    turn = TURN_SHARE * float(np.ptp(meant[ref.core]))
    if not repeats(ref) or turn < TOUCH_OFF_M / 2:
        return True
    again, clean = turning_points(-made, turn), turning_points(-meant, turn)
    return len(again) == len(clean) and float(made[again].max()) < near + 2 * TOUCH_OFF_M


def _takes_pose(s: PostureFeatures, ref: Reference) -> bool:
    """Whether palms, head and trunk reach the pose that the reference holds, and hold it for `POSE_FRAMES`."""
    meant = channels(ref.shown)
    body = np.concatenate(list(meant.values()), -1)
    away = np.linalg.norm(body - body[0], axis=-1)
    speed = np.linalg.norm(np.gradient(body, axis=0), axis=-1)
    inside = np.zeros(len(body), bool)
    inside[ref.core] = True
    held = inside & (away > 0.6 * away[ref.core].max())
    if not held.any():
        return True
    at = int(np.flatnonzero(held)[speed[held].argmin()])
    near = np.ones(len(s.lift_m), bool)
    hands, there = palms(s), palms(ref.shown)
    for side in ("left", "right"):
        if ref.shown.arms in (side, "both"):
            near &= np.linalg.norm(hands[side] - there[side][at], axis=-1) < POSE_OFF_M
    for made, clean in _angles(s, ref.shown):
        near &= np.abs(made - clean[at]) < POSE_OFF_DEG
    return _longest(near) >= POSE_FRAMES


def _angles(s: PostureFeatures, t: PostureFeatures) -> Iterable[tuple[Array, Array]]:
    names = ("head_yaw_deg", "head_pitch_deg", "head_roll_deg", "trunk_yaw_deg", "trunk_pitch_deg", "trunk_roll_deg")
    return ((getattr(s, name), getattr(t, name)) for name in names)


def _longest(yes: NDArray[np.bool_]) -> int:
    longest = run = 0
    for one in yes.tolist():
        run = run + 1 if one else 0
        longest = max(longest, run)
    return longest


def _warped(s: PostureFeatures, t: PostureFeatures) -> tuple[float, list[tuple[int, int]]]:
    """Mean distance of two motions with time warped to fit best, as a share of the second's range, and pairs of matched frames."""
    a, b = (np.concatenate(list(channels(x).values()), -1)[::_DTW_EVERY] for x in (s, t))
    apart = np.linalg.norm(a[:, None] - b[None], axis=-1)
    n, m = apart.shape
    total = np.full((n + 1, m + 1), np.inf)
    total[0, 0] = 0.0
    for i in range(n):
        row, above, costs = total[i + 1], total[i], apart[i].tolist()
        best = np.minimum(above[1:], above[:-1]).tolist()
        left = float("inf")
        for j, cost in enumerate(costs):
            left = cost + (best[j] if best[j] < left else left)
            row[j + 1] = left
    pairs, i, j = [], n, m
    while i > 0 and j > 0:
        pairs.append((i - 1, j - 1))
        step = int(np.argmin((total[i - 1, j - 1], total[i - 1, j], total[i, j - 1])))
        i, j = (i - 1, j - 1) if step == 0 else (i - 1, j) if step == 1 else (i, j - 1)
    reach = float(np.linalg.norm(b - b[0], axis=-1).max())
    off = float(np.mean([apart[p] for p in pairs])) / max(reach, 0.3)
    return off, [(_DTW_EVERY * x, _DTW_EVERY * y) for x, y in reversed(pairs)]


def _matched(pairs: list[tuple[int, int]], core: slice, n_frames: int) -> slice:
    """Frames of a motion that match the core of the reference."""
    frames = [x for x, y in pairs if core.start <= y < core.stop]
    return slice(frames[0], min(n_frames, frames[-1] + 1)) if frames else slice(0, 0)
