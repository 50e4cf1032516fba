"""Derivatives of the distances between a robot's shapes by its joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from retarget.path.distances import MEASURED_M, Array, Indices, Measured, PairDistances, Placed
from retarget.robot.kinematics import cross

_LEAST_M = 1e-9


@dataclass(frozen=True)
class NearPairs:
    """Pairs of shapes that are near each other in some poses.

    Attributes:
        pose: (R,) index of the pose.
        room_m: (R,) metres between them beyond their margin.
        grows: gives for r of the R pairs the derivatives (r, J) of their room by each joint, metres per radian.
        least_m: (T, P) lower bounds of all distances in the poses.
    """

    pose: Indices
    room_m: Array
    grows: Callable[[Indices], Array]
    least_m: Array


class PairSlopes(PairDistances):
    """Distances of pairs of shapes, and their derivatives by the joints."""

    def worst(self, q_rad: Array, aim_m: float, least_m: Array) -> tuple[Array, Array, Array]:
        """The worst pair of each pose (T, J) against its margin plus `aim_m`, given lower bounds (T, P) of distances.

        Returns:
            Metres that the worst pair lacks, (T,), 0 or less where every pair keeps its distance; derivatives of the pair's
            distance by each joint, (T, J); and the bounds with the measured distances entered, (T, P).
        """
        of = np.flatnonzero((least_m < self._margin_m + aim_m).any(0))
        if not len(of):
            return np.zeros(len(q_rad)), np.zeros_like(q_rad), least_m
        placed = self._placed(q_rad, with_joints=True)
        found = self._distances(q_rad, placed, of, least_m[:, of])
        lack = self._margin_m[of] + aim_m - found.distance_m
        rows, worst = np.arange(len(q_rad)), lack.argmax(1)
        least_m = least_m.copy()
        least_m[:, of] = found.distance_m
        return lack[rows, worst], self._slopes(q_rad, placed, found, of, rows, worst), least_m

    def nearest(self, q_rad: Array, of: Indices) -> tuple[Array, Array]:
        """Distance beyond its margin of the nearest of some pairs, (T,), and the derivatives by each joint, (T, J)."""
        placed = self._placed(q_rad, with_joints=True)
        found = self._distances(q_rad, placed, of)
        beyond = found.distance_m - self._margin_m[of]
        rows, worst = np.arange(len(q_rad)), beyond.argmin(1)
        return beyond[rows, worst], self._slopes(q_rad, placed, found, of, rows, worst)

    def near(self, q_rad: Array, within_m: Array, least_m: Array) -> NearPairs:
        """Pairs with less than (T,) `within_m` beyond their margin in poses (T, J), given bounds (T, P) of distances."""
        within_m = within_m[:, None]
        of = np.flatnonzero((least_m - self._margin_m < within_m).any(0))
        placed = self._placed(q_rad, with_joints=True)
        found = self._distances(q_rad, placed, of, least_m[:, of])
        beyond = found.distance_m - self._margin_m[of]
        pose, column = np.nonzero(beyond < within_m)
        least_m = least_m.copy()
        least_m[:, of] = found.distance_m

        def grows(some: Indices) -> Array:
            return self._slopes(q_rad, placed, found, of, pose[some], column[some])

        return NearPairs(pose, beyond[pose, column], grows, least_m)

    def _slopes(
        self, q_rad: Array, placed: Placed, found: Measured, of: Indices, pose: Indices, column: Indices
    ) -> Array:
        """(R, J) derivatives by each joint of R of the distances `found` of pairs `of`, selected by pose and column."""
        pair = of[column]
        s, t = (x[pose, column, None] for x in found.along)
        a, b = self._pairs[pair].T
        point1 = placed.centre[pose, a] + s * placed.axis[pose, a]
        point2 = placed.centre[pose, b] + t * placed.axis[pose, b]
        apart = point2 - point1  # of segments, which have a direction even where capsules overlap
        small = found.distance_m[pose, column] - self._margin_m[pair] < MEASURED_M
        for i in np.flatnonzero(small & ~self._exact[pair]):
            at = int(pose[i]), int(column[i])
            points = found.points_m.get(at)
            if points is None:
                self._place(q_rad[at[0]])
                points = self._measured(int(pair[i]))[1]
            point1[i], point2[i] = points[:3], points[3:]
            apart[i] = point2[i] - point1[i] if found.distance_m[at] >= 0 else point1[i] - point2[i]
        normal = apart / np.maximum(np.sqrt(np.vecdot(apart, apart)), _LEAST_M)[:, None]
        # A joint moves a point r by axis x (r - anchor): along the normal, axis . (r x normal) - normal . (axis x anchor).
        screws = np.concatenate([placed.joint_axis, -cross(placed.joint_axis, placed.anchor)], -1)
        forces = np.concatenate([cross((point1 + point2) / 2, normal), normal], -1)
        body = self._model.geom_bodyid
        turned: Array = (screws[pose] @ forces[..., None])[..., 0]
        return turned * (self._above[body[b]] - self._above[body[a]])
