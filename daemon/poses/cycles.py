"""Finds the part of a motion that can loop without a seam, and the frame in which the motion can be held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.poses.pose_sequence import PoseSequence, distance_deg, mixed, smooth_step, standing

Array = NDArray[np.float64]

SHORTEST_LOOP_S = 0.8
LOOP_ALIKE_DEG = 15.0
"""Degrees by which poses (and, over 0.1 s, movements) may differ and be blended into each other without visible change."""
CLOSING_S = 0.4
"""Seconds before a loop's end over which the loop is led back to its beginning."""
_STILL_DEG_S = 20.0


@dataclass(frozen=True)
class Marks:
    """Loop and hold of a clip, in frames; a mark is None until it is computed.

    Attributes:
        loop: first frame and end of the part that loops; None when there is none.
        hold: frame in which the motion is held.
    """

    loop: tuple[int, int] | None
    hold: int


def marks_of(posture: PoseSequence) -> Marks:
    """Find loop and hold of a clip."""
    return Marks(find_loop(posture), find_hold(posture))


def find_loop(p: PoseSequence) -> tuple[int, int] | None:
    """First frame and end of the part that loops best; None when no part does.

    The part ends as it begins, is lively, and stays away from standing where possible: a wave loops above the shoulder. A part from
    rest to rest counts: the loop is then the whole gesture.
    """
    shortest = round(SHORTEST_LOOP_S * p.fps)
    T = len(p)
    if T <= shortest + 2:
        return None
    speed = np.concatenate([[0.0], distance_deg(p[1:], p[:-1])]) * p.fps
    away = distance_deg(_stand(p), p)
    travelled = np.concatenate([[0.0], np.cumsum(speed)])
    best: tuple[float, int, int] | None = None
    for span in range(shortest, T - 1):
        a = np.arange(1, T - span)
        pose = distance_deg(p.at(a), p.at(a + span))
        step = 0.5 * (distance_deg(p.at(a + 1), p.at(a + span + 1)) + distance_deg(p.at(a - 1), p.at(a + span - 1)))
        unlike = np.maximum(pose, step)
        lively = (travelled[a + span] - travelled[a]) / span
        stays = np.lib.stride_tricks.sliding_window_view(away, span + 1).min(1)[a]
        worth = np.where(unlike < LOOP_ALIKE_DEG, lively + stays - 2 * unlike, -np.inf)
        k = int(worth.argmax())
        if np.isfinite(worth[k]) and lively[k] > _STILL_DEG_S and (best is None or worth[k] > best[0]):
            best = (float(worth[k]), int(a[k]), int(a[k]) + span)
    return None if best is None else best[1:]


def closed(p: PoseSequence, loop: tuple[int, int]) -> PoseSequence:
    """The frames of a loop, the last of which lead back to those before its first, so that looping makes no step."""
    a, b = loop
    n = min(round(CLOSING_S * p.fps), (b - a) // 2)
    weight = np.zeros(b - a)
    weight[-n:] = smooth_step(n)
    return mixed(p[a:b], p.at(np.arange(2 * a - b, a)), weight)


def after_loop(p: PoseSequence, loop: tuple[int, int]) -> PoseSequence:
    """The frames after the last round: from the loop's beginning they lead into the end of the motion."""
    a, b = loop
    tail = p[b:]
    n = min(round(CLOSING_S * p.fps), len(tail))
    weight = np.ones(len(tail))
    weight[:n] = smooth_step(n)
    return mixed(p.at(np.arange(a, a + len(tail))), tail, weight)


def find_hold(p: PoseSequence) -> int:
    """The most expressive frame with little movement, in which the motion is held."""
    away = distance_deg(_stand(p), p)
    speed = np.concatenate([[0.0], distance_deg(p[1:], p[:-1])]) * p.fps
    return int((away - 0.3 * speed).argmax())


def _stand(p: PoseSequence) -> PoseSequence:
    return standing().at(np.zeros(len(p), np.intp))
