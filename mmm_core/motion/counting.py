"""Gives a motion that repeats a stroke exactly the requested number of strokes: whole strokes are repeated or cut.

The frames before the first stroke and after the last one stay. Between them one stroke of the motion is repeated as often as
needed: the stroke that ends nearest to its beginning and is largest. A seam lies at a peak, where the body stands still for
a moment, and is crossfaded there over a few frames, as in motion graphs (Kovar et al., SIGGRAPH 2002).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.features import HUMANML3D, features_from_rotations, root_path
from mmm_core.motion.performing import Stretch, motion_of
from mmm_core.motion.repetitions import Strokes, strokes_of
from mmm_core.motion.skeleton import forward_kinematics, from_six_d, rotation_y

FADE_FRAMES = 4
"""Frames over which a seam is crossfaded."""
LONGEST_FRAMES = 400
"""Frames of the longest motion that repeated strokes may make."""
MOST_TRIED = 3
"""Number of strokes that are tried in turn as the repeated one, until the result has the requested count."""
_SMALLER = 0.5
"""Weight of a stroke's smallness, against the distance between its beginning and its end, in the choice of a stroke."""


def with_counts(
    features: NDArray[np.float32], stretches: Sequence[Stretch], counts: Sequence[int | None], opening_frames: int
) -> tuple[NDArray[np.float32], list[Stretch]]:
    """Features (T, 263) whose stretches have the requested numbers of strokes, and the stretches with their new frames.

    Args:
        features: of our definition (`rest_pose` "mmmd").
        stretches: in order, without gaps, from 0 to T.
        counts: strokes wanted of each stretch; None leaves it as it is.
        opening_frames: frames at the beginning of each stretch that do not change.
    """
    parts: list[NDArray[np.float32]] = []
    found: list[Stretch] = []
    for stretch, count in zip(stretches, counts, strict=True):
        part = features[stretch.start : stretch.end]
        part = part if count is None else counted(part, count, opening_frames)
        start = found[-1].end if found else 0
        parts.append(part)
        found.append(replace(stretch, start=start, end=start + len(part)))
    return np.concatenate(parts), found


def counted(features: NDArray[np.float32], count: int, opening_frames: int = 0) -> NDArray[np.float32]:
    """Features (T, 263) with `count` strokes; unchanged where `count` is right already or no change leads to it.

    Args:
        features: of our definition (`rest_pose` "mmmd").
        count: strokes wanted, at least 1.
        opening_frames: frames at the beginning that do not change.
    """
    strokes = strokes_of(motion_of(features))
    if strokes is not None and len(strokes.frames) == count:
        return features
    for places in [] if strokes is None else _orders(strokes, count, opening_frames):
        if len(places) <= LONGEST_FRAMES:
            joined = _joined(features, places)
            seen = strokes_of(motion_of(joined))
            if seen is not None and len(seen.frames) == count:
                return joined
    return features


def _orders(strokes: Strokes, count: int, opening_frames: int) -> list[list[int]]:
    """Lists of frame numbers, each with another stroke repeated or cut, the most suitable first."""
    frames, T = strokes.frames, len(strokes.path)
    kept = next((i for i, f in enumerate(frames) if f >= opening_frames + FADE_FRAMES), count)
    again = count - kept - 1
    if len(frames) < 2 or again < 0:
        return []
    suited = sorted(pairwise(frames), key=lambda pair: _cost(strokes, pair))[: MOST_TRIED if again else 1]
    return [[*range(frames[kept]), *[*range(*pair)] * again, *range(frames[-1], T)] for pair in suited]


def _cost(strokes: Strokes, pair: tuple[int, int]) -> float:
    """Cost of repeating the stroke between a `pair` of peaks: its two ends differ, or it is small."""

    def reach(a: int, b: int) -> float:
        return float(np.linalg.norm(np.ptp(strokes.path[a : b + 1], axis=0)))

    largest = max(reach(a, b) for a, b in pairwise(strokes.frames))
    return strokes.apart(*pair) + _SMALLER * (1 - reach(*pair) / max(largest, 1e-9))


def _joined(features: NDArray[np.float32], places: list[int]) -> NDArray[np.float32]:
    """Features of the frames at `places`, crossfaded after each jump."""
    yaw, root = root_path(np.asarray(features, np.float64))
    turned = np.asarray(features[:, 67:193], np.float64).reshape(-1, 21, 6)
    T = len(features)
    shown = np.concatenate([yaw[:, None], root, turned.reshape(T, -1)], -1)
    out = shown[places]
    for i, (before, after) in enumerate(pairwise(places), 1):
        if after == before + 1:
            continue
        for k in range(min(FADE_FRAMES, len(places) - i)):
            w = (k + 1) / (FADE_FRAMES + 1)
            out[i + k] = (1 - w) * shown[min(before + 1 + k, T - 1)] + w * out[i + k]
    rotations = from_six_d(out[:, 4:].reshape(-1, 21, 6))
    whole = np.concatenate([rotation_y(out[:, 0])[:, None], rotations], 1)
    joints, _ = forward_kinematics(whole, out[:, 1:4])
    return features_from_rotations(joints, out[:, 0], rotations, HUMANML3D)
