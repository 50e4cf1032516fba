"""Places on a quadratic spline, and how the poses there depend on its control points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_WITHIN = (0.125, 0.25, 0.375, 0.625, 0.75, 0.875)
"""Further places in a segment: shapes that pass through each other between a frame and the middle touch only there."""


@dataclass(frozen=True)
class SplinePlaces:
    """Places on a spline of N segments: the ends of all segments, which are the frames, then their middles, then others.

    Attributes:
        segment: (M,) index of the segment, which is also the index of its last control point after the first two.
        u: (M,) place in the segment, 0 to 1.
    """

    segment: Indices
    u: Array

    @classmethod
    def of(cls, n_segments: int) -> SplinePlaces:
        """The ends and the middles of all segments."""
        return cls(np.tile(np.arange(n_segments, dtype=np.int64), 2), np.repeat((1.0, 0.5), n_segments))

    def and_within(self, segments: Indices) -> SplinePlaces:
        """Add six places to each of the given segments; a segment that already has them stays as it is."""
        if not len(segments):
            return self
        new = np.setdiff1d(segments, self.segment[np.isin(self.u, _WITHIN)])
        segment, u = np.repeat(new, len(_WITHIN)), np.tile(_WITHIN, len(new))
        return SplinePlaces(np.concatenate([self.segment, segment]), np.concatenate([self.u, u]))

    @property
    def point(self) -> Indices:
        """(M,) index of the later of the two control points that a pose depends on most, after the first two; -1 before those."""
        return self.segment - (self.u < 0.5)

    @property
    def share(self) -> Array:
        """(M, 2) weights in the pose of the control point before `point`, and of `point`.

        A segment's pose depends on three control points. The third has at most an eighth of the weight and counts as its neighbour.
        """
        share = np.empty((len(self.u), 2))
        share[:, 0] = np.where(self.u < 0.5, (1 - self.u) ** 2 / 2, 1 - self.u**2 / 2)
        share[:, 1] = 1 - share[:, 0]
        return share


def on_spline(control: Array, segment: Indices, u: Array) -> Array:
    """(n, J) poses at places `u` (n,), 0 to 1, in segments (n,) of a quadratic spline of control points (N + 2, J)."""
    c0, c1, c2 = control[segment], control[segment + 1], control[segment + 2]
    u = u[:, None]
    return (c0 + c1) / 2 + (c1 - c0) * u + (c2 - 2 * c1 + c0) * (u * u / 2)
