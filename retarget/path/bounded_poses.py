"""The poses of a path whose distances the program of `refining` bounds: on its spline, and while the path brakes.

A path that brakes as fast as it can stops at a place that its last two control points decide. Braking poses are therefore part of
the program as functions of these two points; the program would otherwise learn of a contact there only from the proof of the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.path.spline_places import SplinePlaces, on_spline

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_MOST_PAIRS, _MOST_BRAKING = 8, 16
"""Numbers of nearest pairs that are part of the program: of each pose, and of all poses of one braking together."""


@dataclass(frozen=True)
class BoundedPoses:
    """M poses: those at the ends of the path's N segments, in their middles, at more places within some, and while braking.

    Attributes:
        control_rad: (N + 2, J) control points of the path and of the braking at its end.
        q_rad: (M, J) poses.
        segment: (M,) index of the segment with which each pose shares its reserve of distance.
        point: (M,) index of the later of the two control points on which a pose depends, after the first two; -1 before those.
        share: (M, 2, J) derivatives of each joint by the control point before `point`, and by `point`.
        group: (M,) poses of one group share their number of pairs in the program.
        most: (M,) that number.
    """

    control_rad: Array
    q_rad: Array
    segment: Indices
    point: Indices
    share: Array
    group: Indices
    most: Indices

    @classmethod
    def of(cls, control_rad: Array, within: Indices, brakes_after: Sequence[int], loss_rad: Array) -> BoundedPoses:
        """The poses of a path.

        Args:
            control_rad: (n, J) control points.
            within: segments in which more places are bounded.
            brakes_after: numbers of segments, in rising order, after which the path must be able to brake. After the last of them
                it does brake, whatever control points follow there; without any it follows all of them.
            loss_rad: (J,) change of a step, radians, by which braking slows down.
        """
        ends = [control_rad[n : n + 2] for n in brakes_after]
        ways = [np.concatenate([end, braking_points(end, loss_rad)]) for end in ends]
        if ways:
            control_rad = np.concatenate([control_rad[: brakes_after[-1]], ways[-1]])
        N = len(control_rad) - 2
        places = SplinePlaces.of(N).and_within(within[within < N])
        segment, point, M = places.segment, places.point, len(places.u)
        q_rad = on_spline(control_rad, segment, places.u)
        # The poses at the ends of segments, computed as the proof of a path computes them.
        q_rad[:N] = (control_rad[1:-1] + control_rad[2:]) / 2
        share = np.empty((M, 2, control_rad.shape[1]))
        share[:] = places.share[:, :, None]
        group, most = np.arange(M, dtype=np.int64), np.full(M, _MOST_PAIRS)
        if ways:
            n = brakes_after[-1]
            late = np.flatnonzero(segment >= n)
            share[late] = _shares(ways[-1], loss_rad, segment[late] - n, places.u[late])
            point, group[late], most[late] = np.minimum(point, n - 1), -1, _MOST_BRAKING
        path = cls(control_rad, q_rad, segment, point, share, group, most)
        return path.and_also([cls._braking(*at, loss_rad) for at in zip(brakes_after[:-1], ways[:-1], strict=True)])

    @classmethod
    def _braking(cls, n: int, way_rad: Array, loss_rad: Array) -> BoundedPoses:
        """The poses on the way (K, J) from the last two of n + 2 control points to rest."""
        places = SplinePlaces.of(len(way_rad) - 2)
        M = len(places.u)
        share = _shares(way_rad, loss_rad, places.segment, places.u)
        last, group, most = np.full(M, n - 1), np.full(M, -2), np.full(M, _MOST_BRAKING)
        return cls(way_rad, on_spline(way_rad, places.segment, places.u), last, last, share, group, most)

    def and_also(self, more: Sequence[BoundedPoses]) -> BoundedPoses:
        """A copy with further poses at its end."""
        if not more:
            return self
        every = (self, *more)
        names = ("q_rad", "segment", "point", "share", "group", "most")
        return BoundedPoses(self.control_rad, *(np.concatenate([getattr(x, name) for x in every]) for name in names))


def braking_points(control_rad: Array, loss_rad: Array) -> Array:
    """(n, J) control points after `control_rad` when every joint's steps lose (J,) `loss_rad` each until the joint rests."""
    step = control_rad[-1] - control_rad[-2]
    n = int(np.ceil((np.abs(step) / loss_rad).max()))
    left = np.maximum(np.abs(step) - np.arange(1, n + 1)[:, None] * loss_rad, 0.0)
    return control_rad[-1] + np.cumsum(np.sign(step) * left, 0)


def _shares(way_rad: Array, loss_rad: Array, segment: Indices, u: Array) -> Array:
    """(K, 2, J) derivatives of poses on a braking path (n, J) by its first two control points.

    A point of the path lies some times their step beyond the second, less an amount that the step does not change.
    """
    step = np.abs(way_rad[1] - way_rad[0])
    times = np.zeros_like(way_rad)
    times[0] = -1.0
    np.cumsum(step > loss_rad * np.arange(1, len(way_rad) - 1)[:, None], 0, out=times[2:])
    along = on_spline(times, segment, u)
    return np.stack([-along, 1 + along], 1)
