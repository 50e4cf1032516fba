"""Which of an arm's solutions for the same directions: dynamic programming over all frames and the pose before them.

Staying within the limits and moving least decide. A joint whose turning cannot be seen at a frame (the yaw of a straight
arm, the first joint of an arm along its axis) has no say there: it counts as staying where it was last seen, so that an
arm led through such a pose comes out the way that is near on the other side.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
UNSEEN = 0.5
"""A joint seen less than this is filled in from the frames around."""
_OUT_OF_QUESTION_RAD = 0.5
"""Radians: a solution that costs more in every frame is left out where another costs nothing."""
_HIDDEN_SHARE = 0.3
"""Share of the angles' change that a change of solutions costs where it is not observable; with none, solutions alternate."""


def choose(solutions: Array, unary_cost: Array, observability: Array, previous_rad: Array) -> tuple[Array, Array]:
    """Angles of the cheapest sequence of solutions, and the observability of each, both (G, T, n).

    Args:
        solutions: (G, T, C, n) angles of G arms in C solutions.
        unary_cost: (G, T, C) cost of each by itself, in radians of movement.
        observability: (G, T, C, n) of each joint, 0 to 1.
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
    """(G, T, C to, C from) how far the joints go from each solution of (G, T + 1, C, n) to each of the next frame."""
    return np.abs(angles[:, 1:, :, None] - angles[:, :-1, None]).sum(-1)


def fill_unseen(q_rad: Array, observability: Array, previous_rad: float) -> None:
    """Draw a line in place over the angles (T,) of one joint where it is hardly seen (T,).

    Before the first seen frame the joint comes from `previous_rad`; after the last it stays.
    """
    hidden = observability < UNSEEN
    if hidden.any():
        frames = np.concatenate([[0], np.flatnonzero(~hidden) + 1])
        known = np.concatenate([[previous_rad], q_rad[~hidden]])
        q_rad[hidden] = np.interp(np.flatnonzero(hidden) + 1, frames, known)


def _cheapest(move: list[list[list[float]]], own: list[list[float]]) -> list[int]:
    """The solution of each frame, for costs of going (T, C to, C from) and of being there (T, C); all start as one.

    Plain numbers: with so few solutions a loop is faster than arrays.
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
