"""Chooses one of an arm's solutions in each frame, by dynamic programming over all frames and the pose before them.

The cost of a sequence is its excess over the limits and its movement. A joint that is unobservable in a frame (the yaw of a
straight arm, the first joint of an arm along its axis) adds no movement there: its last observable angle counts, so that an arm
that passes through such a pose leaves it on the solution that is nearest beyond it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
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
    branch = np.array([_cheapest(move[g].tolist(), unary_cost[g].tolist()) for g in range(G)])
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


def _cheapest(move: list[list[list[float]]], own: list[list[float]]) -> list[int]:
    """Index of the solution of each frame, for costs of transitions (T, C to, C from) and of solutions (T, C).

    All solutions start from one pose. The function takes lists of numbers because for four solutions a loop is faster than arrays.
    """
    total = [0.0] * len(own[0])
    came: list[list[int]] = []
    for to_each, own_t in zip(move, own, strict=True):
        best: list[int] = []
        after: list[float] = []
        for costs, unary_cost in zip(to_each, own_t, strict=True):
            via = [a + b for a, b in zip(total, costs, strict=True)]
            least = min(via)
            best.append(via.index(least))
            after.append(least + unary_cost)
        came.append(best)
        total = after
    branch = [total.index(min(total))]
    for best in reversed(came[1:]):
        branch.append(best[branch[-1]])
    return branch[::-1]
