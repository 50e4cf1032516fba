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
        stops = [control_rad[: n + 2] for n in brakes_after]
        ways = [np.concatenate([stop[-2:], braking_points(stop, loss_rad)]) for stop in stops]
        if stops:
            control_rad = np.concatenate([stops[-1], ways[-1][2:]])
        N = len(control_rad) - 2
        places = SplinePlaces.of(N).and_within(within[within < N])
        J = control_rad.shape[1]
        q_rad = [on_spline(control_rad, places.segment, places.u)]
        # The pose at the end of a segment, computed as the proof of a path computes it.
        q_rad[0][:N] = (control_rad[1:-1] + control_rad[2:]) / 2
        segment, point = [places.segment], [places.point]
        share = [np.repeat(places.share[:, :, None], J, 2)]
        group, most = [np.arange(len(places.u))], [np.full(len(places.u), _MOST_PAIRS)]
        for way, n in zip(ways, brakes_after, strict=True):
            moved = _moved(way, loss_rad)
            if n == brakes_after[-1]:
                late = np.flatnonzero(places.segment >= n)
                along = on_spline(moved, places.segment[late] - n, places.u[late])
                point[0] = np.minimum(point[0], n - 1)
                share[0][late, 0], share[0][late, 1] = -along, 1 + along
                group[0][late], most[0][late] = -1, _MOST_BRAKING
            else:
                of = SplinePlaces.of(len(way) - 2)
                along = on_spline(moved, of.segment, of.u)
                q_rad.append(on_spline(way, of.segment, of.u))
                segment.append(np.full(len(of.u), n - 1))
                point.append(segment[-1])
                share.append(np.stack([-along, 1 + along], 1))
                group.append(np.full(len(of.u), -2))
                most.append(np.full(len(of.u), _MOST_BRAKING))
        return cls(control_rad, *(np.concatenate(x) for x in (q_rad, segment, point, share, group, most)))


def braking_points(control_rad: Array, loss_rad: Array) -> Array:
    """(n, J) control points after `control_rad` when every joint's steps lose (J,) `loss_rad` each until the joint rests."""
    step = control_rad[-1] - control_rad[-2]
    n = int(np.ceil((np.abs(step) / loss_rad).max()))
    left = np.maximum(np.abs(step) - np.arange(1, n + 1)[:, None] * loss_rad, 0.0)
    return control_rad[-1] + np.cumsum(np.sign(step) * left, 0)


def _moved(way_rad: Array, loss_rad: Array) -> Array:
    """(n, J) how many times the step between the first two control points each of n points lies beyond the second.

    Points after the second lie less far by an amount that the step does not change.
    """
    step = np.abs(way_rad[1] - way_rad[0])
    moves = step > loss_rad * np.arange(1, len(way_rad) - 1)[:, None]
    none = np.zeros((1, len(step)))
    return np.concatenate([none - 1, none, np.cumsum(moves, 0)])
