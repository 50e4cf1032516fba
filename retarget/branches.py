"""Which of an arm's ways to the same directions: dynamic programming over all frames and what was done before.

Staying within the limits and moving least decide. A joint whose turning cannot be seen at a frame (the yaw of a straight
arm, the first joint of an arm along its axis) has no say there: it counts as staying where it was last seen, so that an
arm led through such a pose comes out the way that is near on the other side.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_UNSEEN = 0.5
"""A joint seen less than this is filled in from the frames around."""


def choose(ways: Array, own_cost: Array, seen: Array, previous_rad: Array) -> tuple[Array, Array]:
    """Angles of the cheapest row of ways, and how much each is seen there, both (G, T, n).

    Args:
        ways: (G, T, C, n) angles of G arms in C ways, within the limits.
        own_cost: (G, T, C) what each costs by itself, in radians of movement.
        seen: (G, T, C, n) how much each joint shows, 0 to 1.
        previous_rad: (G, n) angles before the first frame.
    """
    G, T, C, _ = ways.shape
    arms = np.arange(G)[:, None]
    total = np.zeros((G, 1))
    kept = previous_rad[:, None]  # (G, C, n) where each joint was last seen on the way to each state
    came = np.zeros((T, G, C), np.int64)
    for t in range(T):
        weight, angles = seen[:, t], ways[:, t]
        gone = angles[:, :, None] - kept[:, None]  # (G, C to, C from, n)
        via = total[:, None] + (np.abs(gone) * weight[:, :, None]).sum(-1)
        best = came[t] = via.argmin(2)
        total = np.take_along_axis(via, best[..., None], 2)[..., 0] + own_cost[:, t]
        before = kept[arms, best]
        kept = before + weight * (angles - before)
    way = np.zeros((T, G), np.int64)
    way[-1] = total.argmin(1)
    for t in range(T - 1, 0, -1):
        way[t - 1] = came[t, arms[:, 0], way[t]]
    at = way.T[:, :, None, None]
    return np.take_along_axis(ways, at, 2)[:, :, 0], np.take_along_axis(seen, at, 2)[:, :, 0]


def fill_unseen(q_rad: Array, seen: Array, previous_rad: Array) -> NDArray[np.bool_]:
    """Draw a line in place over joints of `q_rad` (T, n) that are hardly seen; (T,) which frames were changed.

    Before the first seen frame a joint comes from `previous_rad` (n,); after the last it stays.
    """
    changed = np.zeros(len(q_rad), bool)
    for j in np.flatnonzero((seen < _UNSEEN).any(0)):
        hidden = seen[:, j] < _UNSEEN
        frames = np.flatnonzero(~hidden) + 1
        known = np.concatenate([previous_rad[j : j + 1], q_rad[~hidden, j]])
        q_rad[hidden, j] = np.interp(np.flatnonzero(hidden) + 1, np.concatenate([[0], frames]), known)
        changed |= hidden
    return changed
