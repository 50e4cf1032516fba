"""Chooses one of an arm's solutions in each frame, by dynamic programming over all frames and the pose before them.

The cost of a sequence is its excess over the limits and its movement. A joint that is unobservable in a frame (the yaw of a
straight arm, the first joint of an arm along its axis) adds no movement there: its last observable angle counts, so that an arm
that passes through such a pose leaves it on the solution that is nearest beyond it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
UNSEEN = 0.5
"""Observability below which a joint's angle is interpolated from neighbouring frames."""
_OUT_OF_QUESTION_RAD = 0.5
"""Radians of cost: a solution that exceeds them in every frame is discarded if another one costs nothing in any frame."""
_HIDDEN_SHARE = 0.3
"""Share of an unobservable change of angles that a switch between solutions costs; at 0 the solutions would alternate."""


def choose(solutions: Array, unary_cost: Array, observability: Array, previous_rad: Array) -> tuple[Array, Array]:
    """Angles of the cheapest sequence of solutions, and the observability of each angle, both (G, T, n).

    Args:
        solutions: (G, T, C, n) angles of G arms in C solutions.
        unary_cost: (G, T, C) cost of each solution by itself, in radians of movement.
        observability: (G, T, C, n) observability of each joint, 0 to 1.
        previous_rad: (G, n) angles before the first frame.
    """
    G, T, C, n = solutions.shape
    free, costly = unary_cost.max(1) == 0, unary_cost.min(1) > _OUT_OF_QUESTION_RAD  # (G, C)
    if (
        (free.sum(1) == 1) & (free | costly).all(1)
    ).all():  # one solution lies within the limits all along, the others never
        branch = free.argmax(1)[:, None, None, None]
        return np.take_along_axis(solutions, branch, 2)[:, :, 0], np.take_along_axis(observability, branch, 2)[:, :, 0]
    known = np.concatenate([np.broadcast_to(previous_rad[:, None, None], (G, 1, C, n)), solutions], 1)
    unhidden, hidden = known, observability < UNSEEN
    if hidden.any():
        known = known.copy()
        frames = np.arange(1, T + 1, dtype=np.int64)[:, None, None]
        last_seen = np.maximum.accumulate(np.where(hidden, 0, frames), 1)
        known[:, 1:] = np.take_along_axis(known, last_seen, 1)
    move = _moved(known)
    if hidden.any():
        move += _HIDDEN_SHARE * _moved(unhidden)
    branch = _cheapest(move, unary_cost)
    at = branch[:, :, None, None]
    return np.take_along_axis(solutions, at, 2)[:, :, 0], np.take_along_axis(observability, at, 2)[:, :, 0]


def _moved(angles: Array) -> Array:
    """(G, T, C to, C from) distances in joint space from each solution in (G, T + 1, C, n) to each one of the next frame."""
    return np.abs(angles[:, 1:, :, None] - angles[:, :-1, None]).sum(-1)


def fill_unseen(q_rad: Array, observability: Array, previous_rad: float) -> None:
    """Interpolate in place the angles (T,) of one joint over the frames in which its observability (T,) is below `UNSEEN`.

    Before the first observable frame the joint moves from `previous_rad`; after the last one it stays.
    """
    hidden = observability < UNSEEN
    if hidden.any():
        frames = np.concatenate([[0], np.flatnonzero(~hidden) + 1])
        known = np.concatenate([[previous_rad], q_rad[~hidden]])
        q_rad[hidden] = np.interp(np.flatnonzero(hidden) + 1, frames, known)


def _cheapest(move: Array, own: Array) -> Indices:
    """(G, T) index of the solution in each frame, for costs of transitions (G, T, C to, C from) and of solutions (G, T, C).

    All solutions start from one pose.
    """
    G, T, C = own.shape
    total, came = np.zeros((G, C)), np.empty((T, G, C), np.int64)
    for t in range(T):
        via = total[:, None] + move[:, t]
        via.argmin(2, out=came[t])
        total = np.minimum.reduce(via, 2) + own[:, t]
    branch, last = np.empty((G, T), np.int64), total.argmin(1).tolist()
    for g, at in enumerate(last):
        back = [at]
        for best in reversed(came[1:, g].tolist()):
            back.append(best[back[-1]])
        branch[g] = back[::-1]
    return branch
