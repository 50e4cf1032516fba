"""Lower bound of the distance of two shapes between two poses, to second order in the movement of the joints.

In the frame of the last body that carries both shapes take any fixed direction n. Along n they are apart by the least,
over their points, of n . (b - a), which is not more than their distance. Between two instants h apart the points'
accelerations are at most A, so that this keeps above its smaller value at both instants less A h^2 / 8. A point r from the axes of
joints that turn by w and are accelerated by w' has at most sum(w) sum(r w) + sum(r w'): its second derivatives by two
joints are a1 x (a2 x r), not longer than the reach of the outer one, which is the shorter reach of both.

A bound from first derivatives alone falls off with h; the second-order bound therefore saves most halvings of a segment.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Number = TypeVar("Number", np.float64, np.int64)
_LEAST_M = 1e-9


@dataclass(frozen=True)
class Sections:
    """K sections of a spline's segments, each with one pair of shapes that may come near on it.

    Attributes:
        segment: (K,) index of the segment.
        pair: (K,) index of the pair.
        u: (2, K) start and end of the section, 0 to 1 on the segment.
        ends: (2, K) indices of the poses at both.
        distance_m: (2, K) distance of the pair, or a lower bound, at both.
        way: (2, K, 3) approximate vectors between the nearest points at both, first shape to second, of any length.
        moved_m: (K,) largest movement of the pair on half the section, times 2.
        bent_m: (K,) A h^2 / 8.
    """

    segment: Indices
    pair: Indices
    u: Array
    ends: Indices
    distance_m: Array
    way: Array
    moved_m: Array
    bent_m: Array

    def of(self, some: NDArray[np.bool_]) -> Sections:
        """Some of the sections, selected by a mask (K,)."""
        at = np.flatnonzero(some)
        return Sections(
            self.segment[at], self.pair[at], self.u[:, at], self.ends[:, at], self.distance_m[:, at], self.way[:, at],
            self.moved_m[at], self.bent_m[at],
        )  # fmt: skip

    def halves(self, pose: Indices, distance_m: Array, way: Array) -> Sections:
        """(2 K) first and second halves, given index of the pose, distance (K,) and vector (K, 3) in the middle of each."""
        two = np.tile(np.arange(len(pose), dtype=np.int64), 2)
        return Sections(
            self.segment[two], self.pair[two], _split(self.u, self.u.mean(0)), _split(self.ends, pose),
            _split(self.distance_m, distance_m), _split(self.way, way), self.moved_m[two] / 2, self.bent_m[two] / 4,
        )  # fmt: skip


def _split(ends: NDArray[Number], middle: NDArray[Number]) -> NDArray[Number]:
    """(2, 2 K, ...) values at both ends of the halves of K sections, given values at the ends and in the middle."""
    return np.concatenate([np.stack([ends[0], middle]), np.stack([middle, ends[1]])], 1)


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

    def least_m(self, sections: Sections, centre: Array, turn: Array) -> Array:
        """(K,) lower bounds of distances on sections.

        Args:
            sections: sections of pairs with a bound.
            centre: (R, geoms, 3) centres of all shapes in the poses of the ends.
            turn: (R, geoms, 9) their rotations.
        """
        pair, rows = sections.pair, sections.ends
        a, b = self._pairs[pair].T
        apart = sections.way / np.maximum(np.sqrt(np.vecdot(sections.way, sections.way)), _LEAST_M)[..., None]
        # The mean direction, as the body that carries both sees it, turned back for each of the poses.
        carrier = turn[rows, self._carrier[pair]].reshape(*rows.shape, 3, 3)
        seen = (apart[..., None, :] @ carrier)[..., 0, :].sum(0)
        seen /= np.maximum(np.sqrt(np.vecdot(seen, seen)), _LEAST_M)[:, None]
        along = (carrier @ seen[..., None])[..., 0]
        apart_m = np.vecdot(along, centre[rows, b] - centre[rows, a])
        for shape in (a, b):
            turned = turn[rows, shape].reshape(*rows.shape, 3, 3)
            apart_m -= np.vecdot(np.abs((along[..., None, :] @ turned)[..., 0, :]), self._half_m[shape])
        return apart_m.min(0) - self._radii_m[pair] - sections.bent_m
