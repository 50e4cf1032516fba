"""Finds the circle that a hand draws once: a flat, round, closed path away from where the hand began.

A circle drawn several times is a repeated stroke (`repetitions`); one drawn once is no repetition, but has a middle of its own.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from mmm_core.motion.skeleton import Array

_SHORTEST_FRAMES, _LONGEST_FRAMES = 10, 40
"""Shortest and longest time in which a circle is drawn, frames: 0.5 to 2 s."""
_FAR = 0.4
"""Share of the greatest distance from the first position beyond which a circle lies."""
_LEAST_M, _OPEN, _DEEP = 0.12, 0.2, 0.12
"""Least width of a circle, metres; and as shares of it, the greatest gap between its ends and the greatest depth."""
_UNROUND = 0.17
"""Greatest standard deviation of a circle's radius, as a share of the mean radius."""
_TRIED = 40
"""Number of the largest nearly closed paths that may be the circle."""


def drawn_circle(hand_m: Array) -> tuple[int, int] | None:
    """First and last frame of the roundest large circle in a hand's path (T, 3), metres; None where it draws none."""
    roundest = sorted((_unroundness(hand_m[start : end + 1]), start, end) for start, end in _closed(hand_m))
    return next(((start, end) for _, start, end in roundest if _is_circle(hand_m[start : end + 1])), None)


def loop_width_m(hand_m: Array) -> float:
    """Diameter of a circle as large as the largest area that a hand's path (T, 3), metres, goes round; 0 where it goes round none.

    Ways there and back enclose nothing, so that the way to a circle does not count.
    """
    area = max((_area_m2(hand_m[start : end + 1]) for start, end in _closed(hand_m)), default=0.0)
    return 2 * float(np.sqrt(area / np.pi))


def _area_m2(path_m: Array) -> float:
    """Area that a closed path (T, 3) goes round, seen from where it is largest."""
    centred = path_m - path_m.mean(0)
    return float(np.linalg.norm(np.cross(centred, np.roll(centred, -1, axis=0)).sum(0))) / 2


def farther_hand(joints_m: NDArray[np.floating]) -> Array:
    """(T, 3) path of the hand that moves farther from its first position, of joints (T, 22, 3)."""
    wrists = np.asarray(joints_m[:, 20:22], np.float64)
    return wrists[:, int(np.linalg.norm(wrists - wrists[0], axis=-1).max(0).argmax())]


def width_m(path_m: Array) -> float:
    """Greatest extent of a path (T, 3), metres."""
    return float(_extents_m(path_m)[0])


def _closed(hand_m: Array) -> list[tuple[int, int]]:
    """First and last frame of the largest nearly closed paths away from where the hand began, the largest first."""
    away = np.linalg.norm(hand_m - hand_m[0], axis=-1)
    far = away > _FAR * away.max()
    closed: list[tuple[float, int, int]] = []
    for period in range(_SHORTEST_FRAMES, min(_LONGEST_FRAMES, len(hand_m) - 1) + 1):
        windows = sliding_window_view(hand_m, period + 1, axis=0)
        width = np.linalg.norm(np.ptp(windows, axis=-1), axis=-1)
        gap = np.linalg.norm(hand_m[period:] - hand_m[:-period], axis=-1)
        ok = sliding_window_view(far, period + 1).all(-1) & (gap < _OPEN * width)
        closed += [(float(width[at] - gap[at]), int(at), int(at) + period) for at in np.flatnonzero(ok)]
    return [(start, end) for _, start, end in sorted(closed, reverse=True)[:_TRIED]]


def _is_circle(path_m: Array) -> bool:
    width, _, depth = _extents_m(path_m)
    gap = float(np.linalg.norm(path_m[-1] - path_m[0]))
    round_enough = _unroundness(path_m) <= _UNROUND
    return round_enough and width >= _LEAST_M and gap <= _OPEN * width and depth <= _DEEP * width


def _unroundness(path_m: Array) -> float:
    """Standard deviation of the distance from the middle, as a share of its mean."""
    radius = np.linalg.norm(path_m - path_m.mean(0), axis=-1)
    return float(radius.std() / max(radius.mean(), 1e-9))


def _extents_m(path_m: Array) -> Array:
    """(3,) extents along the path's own main directions, the greatest first."""
    centred = path_m - path_m.mean(0)
    return np.ptp(centred @ np.linalg.svd(centred, full_matrices=False)[2].T, axis=0)
