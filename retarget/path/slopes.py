"""Derivatives of the distances between a robot's shapes by its joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from retarget.path.distances import Array, Indices, Measured, PairDistances, Placed
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
        placed: the shapes in the poses.
        found: the distances that were measured.
    """

    pose: Indices
    room_m: Array
    grows: Callable[[Indices], Array]
    least_m: Array
    placed: Placed
    found: Measured


class PairSlopes(PairDistances):
    """Distances of pairs of shapes, and their derivatives by the joints."""

    def worst(self, q_rad: Array, aim_m: float, least_m: Array) -> tuple[Array, Array, Array]:
        """The worst pair of each pose (T, J) against its margin plus `aim_m`, given lower bounds (T, P) of distances.

        Returns:
            Metres that the worst pair lacks, (T,), 0 or less where every pair keeps its distance; derivatives of the pair's
            distance by each joint, (n, J), in the n poses that lack something; and the bounds with the measured distances
            entered, (T, P).
        """
        wanted_m = self._margin_m + aim_m
        near = least_m < wanted_m
        if not near.any():
            return np.zeros(len(q_rad)), np.zeros((0, q_rad.shape[1])), least_m
        placed, least_m = self._placed(q_rad, with_joints=True), least_m.copy()
        found = self._nearer(placed, least_m, near, wanted_m)
        missing = wanted_m - least_m
        worst = missing.argmax(1)
        lack = missing[np.arange(len(q_rad)), worst]
        some = np.flatnonzero(lack > 0)
        return lack, self._slopes(placed, found, self._index_in(found, some, worst[some])), least_m

    def nearest(self, q_rad: Array, of: Indices) -> tuple[Array, Array]:
        """Distance beyond its margin of the nearest of some pairs, (T,), and the derivatives by each joint, (T, J)."""
        placed = self._placed(q_rad, with_joints=True)
        found = self._of_all(placed, of)
        beyond = (found.distance_m - self._margin_m[found.pair]).reshape(len(q_rad), -1)
        rows, worst = np.arange(len(q_rad)), beyond.argmin(1)
        return beyond[rows, worst], self._slopes(placed, found, rows * len(of) + worst)

    def near(self, q_rad: Array, within_m: Array, least_m: Array) -> NearPairs:
        """Pairs with less than (T,) `within_m` beyond their margin in poses (T, J), given bounds (T, P) of distances."""
        enough_m = self._margin_m + within_m[:, None]
        placed, least_m = self._placed(q_rad, with_joints=True), least_m.copy()
        found = self._nearer(placed, least_m, least_m < enough_m, enough_m)
        room_m = found.distance_m - self._margin_m.take(found.pair)
        near = np.flatnonzero(room_m < within_m.take(found.pose))

        def grows(some: Indices) -> Array:
            return self._slopes(placed, found, near[some])

        return NearPairs(found.pose[near], room_m[near], grows, least_m, placed, found)

    def _index_in(self, found: Measured, pose: Indices, pair: Indices) -> Indices:
        """(n,) indices in `found` of pairs in poses, (n,) each."""
        n = len(self._margin_m)
        return np.searchsorted(found.pose * n + found.pair, pose * n + pair)

    def _slopes(self, placed: Placed, found: Measured, at: Indices) -> Array:
        """(n, J) derivatives by each joint of n of the distances `found`."""
        pose, way = found.pose[at], found.way[at]
        normal = way / np.maximum(np.sqrt(np.vecdot(way, way)), _LEAST_M)[:, None]
        # A joint moves a point r by axis x (r - anchor): along the normal, axis . (r x normal) - normal . (axis x anchor).
        screws = np.concatenate([placed.joint_axis, -cross(placed.joint_axis, placed.anchor)], -1)
        forces = np.concatenate([cross(found.point[at], normal), normal], -1)
        return (screws[pose] @ forces[..., None])[..., 0] * self._parted[found.pair[at]]
