"""Lower bound of the distance of two shapes between two poses, to second order in the movement of the joints.

In the frame of the last body that carries both shapes take any fixed direction n. Along n they are apart by the least,
over their points, of n . (b - a), which is not more than their distance. Between two instants h apart the points'
accelerations are at most A, so that this keeps above its smaller value at both instants less A h^2 / 8. A point r from the axes of
joints that turn by w and are accelerated by w' has at most sum(w) sum(r w) + sum(r w'): its second derivatives by two
joints are a1 x (a2 x r), not longer than the reach of the outer one, which is the shorter reach of both.

A bound from first derivatives alone falls off with h; the second-order bound therefore saves most halvings of a segment.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
_LEAST_M = 1e-9


@dataclass(frozen=True)
class Known:
    """Positions of all shapes and distances of n pairs of them, in R poses.

    Attributes:
        centre: (R, geoms, 3) centres of all shapes.
        turn: (R, geoms, 9) their rotations.
        distance: (R, n) of each pair.
        apart: (R, n, 3) approximate vectors between the nearest points of each pair, first to second, of any length.
    """

    centre: Array
    turn: Array
    distance: Array
    apart: Array

    def of(self, pairs: Indices) -> Known:
        """The distances of some of the pairs."""
        return Known(self.centre, self.turn, self.distance[:, pairs], self.apart[:, pairs])

    def and_also(self, more: Known) -> Known:
        """The distances of these poses, then those of the poses in `more`."""
        return Known(*(np.concatenate([getattr(self, f.name), getattr(more, f.name)]) for f in fields(self)))


class Spans:
    """Bounds of a robot's P pairs of shapes between poses."""

    def __init__(self, pairs: Indices, above: Array, half_m: Array, round_m: Array, sweep_m: Array) -> None:
        """Read which joints part each pair.

        Args:
            pairs: (P, 2) shapes.
            above: (geoms, J) 1 where a joint moves a shape.
            half_m: (geoms, 3) half edges of the boxes; of a capsule its half length along its axis.
            round_m: (geoms,) radii of capsules; 0 for boxes.
            sweep_m: (P, J) reach of each pair from each joint that parts it.
        """
        self._pairs, self._half_m, self._sweep_m = pairs, half_m, sweep_m
        self._radii_m = round_m[pairs].sum(1)
        a, b = pairs.T
        self._parting: Array = (above[a] != above[b]).astype(np.float64)
        beside = (above[None] == (above[a] * above[b])[:, None]).all(2)  # shapes fixed to what carries both
        self.known: NDArray[np.bool_] = np.asarray(beside.any(1), bool)
        """(P,) whether a shape of the pair is fixed to the last body that carries both; other pairs have no bound here."""
        self._carrier: Indices = (
            beside.argmax(1) if beside.size else np.zeros(len(pairs), np.intp)
        )  # a robot without shapes

    def bends_m(self, step_rad: Array, bend_rad: Array, moved_m: Array) -> Array:
        """(N - 2, P) A / 8 of a spline's segments.

        Args:
            step_rad: (N - 1, J) absolute first differences of the control points.
            bend_rad: (N - 2, J) absolute second differences of the control points.
            moved_m: (N - 2, P) largest speed of each pair in a segment, metres per segment.
        """
        turned = step_rad @ self._parting.T
        return (np.maximum(turned[:-1], turned[1:]) * moved_m + bend_rad @ self._sweep_m.T) / 8

    def least_m(self, known: Known, rows: Indices, at: Indices, pair: Indices) -> Array:
        """(K,) lower bounds of distances between two poses, A h^2 / 8 still to be taken off.

        Args:
            known: poses and pairs.
            rows: (2, K) indices of the two poses in `known`.
            at: (K,) indices of the pairs in `known`.
            pair: (K,) indices of the pairs among all pairs.
        """
        a, b = self._pairs[pair].T
        apart = known.apart[rows, at]  # (2, K, 3)
        apart = apart / np.maximum(np.sqrt(np.vecdot(apart, apart)), _LEAST_M)[..., None]
        # The mean direction, as the body that carries both sees it, turned back for each of the poses.
        turn = known.turn[rows, self._carrier[pair]].reshape(*rows.shape, 3, 3)
        seen = (apart[..., None, :] @ turn)[..., 0, :].sum(0)
        seen /= np.maximum(np.sqrt(np.vecdot(seen, seen)), _LEAST_M)[:, None]
        along = (turn @ seen[..., None])[..., 0]
        offset = known.centre[rows, b] - known.centre[rows, a]
        ends = self._half_along(known, rows, a, along) + self._half_along(known, rows, b, along)
        return (np.vecdot(along, offset) - ends).min(0) - self._radii_m[pair]

    def _half_along(self, known: Known, rows: Indices, of: Indices, along: Array) -> Array:
        """(2, K) extents of shapes from their centres along unit directions (2, K, 3), without the radii."""
        turn = known.turn[rows, of].reshape(*rows.shape, 3, 3)
        return np.vecdot(np.abs((along[..., None, :] @ turn)[..., 0, :]), self._half_m[of])
