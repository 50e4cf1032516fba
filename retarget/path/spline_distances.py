"""Distances that are known on a spline: at the borders of its segments, and in the middles of some."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.path.distances import Measured, Placed
from retarget.path.slopes import NearPairs

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Seen:
    """Distances measured on a spline.

    Attributes:
        control_rad: (N + 2, J) control points of the spline.
        near: near pairs in its N frames, which are the borders of its segments after the first, in the N middles of the
            segments, and perhaps in more poses.
    """

    control_rad: Array
    near: NearPairs

    def shared(self, control_rad: Array) -> int:
        """Number of first segments that another spline shares."""
        n = min(len(control_rad), len(self.control_rad))
        other = (control_rad[:n] != self.control_rad[:n]).any(1)
        return max(int(other.argmax()) if other.any() else n, 2) - 2


@dataclass(frozen=True)
class SplineDistances:
    """Poses of a spline with B borders of segments, and lower bounds of the P distances in each pose.

    Attributes:
        placed: the shapes in R poses.
        least_m: (R, P) lower bounds of distances.
        way: (R, P, 3) approximate vectors between nearest points; 0 where a distance is not measured.
        measured: (R, P) whether a distance is measured.
        border: (B,) index of the pose at each border.
        middle: (B - 1,) index of the pose in the middle of each segment; -1 for a pose that is not among them.
    """

    placed: Placed
    least_m: Array
    way: Array
    measured: NDArray[np.bool_]
    border: Indices
    middle: Indices

    @classmethod
    def at_borders(cls, placed: Placed, least_m: Array) -> SplineDistances:
        """Bounds at the borders alone."""
        B = len(least_m)
        border, middle = np.arange(B, dtype=np.int64), np.full(B - 1, -1, np.int64)
        return cls(placed, least_m, np.zeros((*least_m.shape, 3)), np.zeros(least_m.shape, bool), border, middle)

    @classmethod
    def after(cls, seen: Seen, shared: int, others: Placed, least_m: Array) -> SplineDistances:
        """Distances on the first `shared` segments as seen, and bounds (n, P) at the n other borders in `others`."""
        near, n, N = seen.near, len(least_m), len(seen.control_rad) - 2
        frames = np.arange(shared, dtype=np.int64)
        others_at = len(near.least_m) + np.arange(n, dtype=np.int64)
        border = np.concatenate([others_at[:1], frames, others_at[1:]])
        middle = np.full(len(border) - 1, -1, np.int64)
        middle[:shared] = N + frames
        every_m = np.concatenate([near.least_m, least_m])
        known = cls(
            near.placed.and_also(others), every_m, np.zeros((*every_m.shape, 3)), np.zeros(every_m.shape, bool),
            border, middle,
        )  # fmt: skip
        known.enter(near.found)
        return known

    def enter(self, found: Measured) -> None:
        """Take distances that were measured; their bounds are known already."""
        self.way[found.pose, found.pair] = found.way
        self.measured[found.pose, found.pair] = True
