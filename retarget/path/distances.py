"""Distances between a robot's shapes, all pairs that can meet in all poses at once.

A closed form gives the exact distances of capsules and spheres. Other shapes are first bounded by a capsule round them and, when it
comes near, measured: a capsule against a box here, other pairs by MuJoCo. Bodies joined by one or two joints, and pairs that touch
in the rest pose, are left out, because their coarse shapes overlap.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.path.boxes import box_to_box, capsule_to_box
from retarget.path.capsules import nearest_along
from retarget.path.shape_pairs import joints_above, pairs_that_can_meet
from retarget.robot.description import description_spec, mujoco
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
MARGIN_M = 0.010
"""Metres of distance below which a pair counts as touching; a pair nearer at rest has half its distance at rest as margin."""
_FARTHEST_M = 1.0
MEASURED_M = 0.007
"""Metres beyond the margin below which shapes are measured exactly, not bounded: more than the reserve of pushed poses."""
_CAPSULE_TYPES = (2, 3)  # mjGEOM_SPHERE, mjGEOM_CAPSULE


@dataclass(frozen=True)
class Placed:
    """Shapes in T poses: centres and axes (T, geoms, 3) of their capsules, and rotations (T, geoms, 9).

    Axes and anchors of the joints are (T, J, 3), or empty if they were not requested.
    """

    centre: Array
    axis: Array
    turn: Array
    joint_axis: Array
    anchor: Array

    def and_also(self, more: Placed) -> Placed:
        """The shapes in these poses, then in those of `more`, without joints."""
        none = self.joint_axis[:0], self.anchor[:0]
        centre, axis = np.concatenate([self.centre, more.centre]), np.concatenate([self.axis, more.axis])
        return Placed(centre, axis, np.concatenate([self.turn, more.turn]), *none)


@dataclass(frozen=True)
class Measured:
    """Distances of K pairs of shapes, each in one pose, and the lines through their nearest points.

    Attributes:
        pose: (K,) index of the pose.
        pair: (K,) index of the pair.
        distance_m: (K,) distance.
        point: (K, 3) point on the line through the nearest points of the pair, or of the capsules round its shapes.
        way: (K, 3) vector along this line from the first shape to the second, of any length.
    """

    pose: Indices
    pair: Indices
    distance_m: Array
    point: Array
    way: Array


class PairDistances:
    """Distances of pairs of shapes of one robot, and the margin that each pair keeps."""

    def __init__(self, robot: RobotModel, margin_m: float = MARGIN_M) -> None:
        self._model: Any = description_spec(robot).compile()
        self._data: Any = mujoco.MjData(self._model)
        joints = [self._model.joint(name) for name in robot.joint_names]
        self._address = np.array([j.qposadr[0] for j in joints])
        self._joint_ids = np.array([j.id for j in joints])
        self._shapes()
        self._above = joints_above(self._model, self._joint_ids)
        self._take(pairs_that_can_meet(self._model, self._above))
        resting = self.distances_m(robot.rest_rad[None])[0]
        self._take(self._pairs[resting > 0])
        # A pair that rests within the margin may stay there.
        resting = resting[resting > 0]
        self._keep(np.where(resting > margin_m, margin_m, np.minimum(margin_m, resting / 2)))

    def distances_m(self, q_rad: Array) -> Array:
        """(T, P) distance of each pair in each pose (T, J): exact where it is small, elsewhere a lower bound."""
        return self._of_all(self._placed(q_rad, with_joints=False), self._every).distance_m.reshape(len(q_rad), -1)

    def _of_all(self, placed: Placed, of: Indices) -> Measured:
        """Distances of pairs `of` (n,) in all T poses, pose by pose."""
        T = len(placed.centre)
        return self._measure(placed, np.repeat(np.arange(T, dtype=np.int64), len(of)), np.tile(of, T))

    def _nearer(self, placed: Placed, least_m: Array, near: NDArray[np.bool_], enough_m: Array) -> Measured:
        """Distances of those of the pairs `near` (T, P) whose bounding spheres are nearer than `enough_m`, a shape like (T, P).

        `least_m` (T, P) has known lower bounds of distances; the new distances and bounds are written into it.
        """
        at = np.flatnonzero(near)
        pose, pair = np.divmod(at, near.shape[1])
        centre: Array = placed.centre.reshape(-1, 3)
        known: Array = least_m.reshape(-1)
        a, b = self._rows(placed, pose, pair)
        first = centre.take(a, 0)
        between = centre.take(b, 0) - first
        spheres = np.sqrt(np.vecdot(between, between)) - self._reach_m.take(pair)
        known[at] = np.maximum(known.take(at), spheres)
        some = np.flatnonzero(spheres < np.broadcast_to(enough_m, near.shape)[pose, pair])
        found = self._measure(placed, pose.take(some), pair.take(some), known.take(at.take(some)))
        known[at.take(some)] = found.distance_m
        return found

    def _measure(self, placed: Placed, pose: Indices, pair: Indices, least_m: Array | None = None) -> Measured:
        """Distances of K pairs, each in one pose; `least_m` (K,) has known lower bounds."""
        a, b = self._rows(placed, pose, pair)
        centre, axis = placed.centre.reshape(-1, 3), placed.axis.reshape(-1, 3)
        first, axis1, axis2 = centre.take(a, 0), axis.take(a, 0), axis.take(b, 0)
        between = centre.take(b, 0) - first
        half1, half2 = self._half_lengths_m.take(pair, 1)
        squared, s, t = nearest_along(
            np.vecdot(between, between), np.vecdot(axis1, axis2),
            -np.vecdot(axis1, between), -np.vecdot(axis2, between), half1, half2,
        )  # fmt: skip
        distance = np.sqrt(squared) - self._radii_m.take(pair)
        if least_m is not None:
            np.maximum(distance, least_m, out=distance)
        along = s[:, None] * axis1
        found = Measured(pose, pair, distance, first + along, between + t[:, None] * axis2 - along)
        if not self._all_exact:
            self._measure_others(placed, found)
        return found

    def _rows(self, placed: Placed, pose: Indices, pair: Indices) -> tuple[Indices, Indices]:
        """(K,) rows of the first and of the second shapes of pairs in poses, with all poses one below the other."""
        first: Indices = self._shape[0].take(pair) + placed.centre.shape[1] * pose
        return first, first + self._second_after.take(pair)

    def _measure_others(self, placed: Placed, found: Measured) -> None:
        """Make distances of pairs that are no capsules exact where they are small."""
        distance, small_m = found.distance_m, self._small_m.take(found.pair)
        left = np.flatnonzero((distance < small_m) & ~self._exact.take(found.pair))
        if not len(left):
            return
        pair = found.pair.take(left)
        both, beside = self._both_boxes.take(pair), self._box.take(pair) >= 0
        deep = np.ones(len(left), bool)
        if both.any():
            self._bound_boxes(placed, left[both], found)
        if beside.any():
            deep[beside] = self._beside_boxes(placed, left[beside], found)
        left = left[deep & (distance.take(left) < small_m.take(left))]
        if len(left):
            self._measure_by_mujoco(placed, left, found)

    def _bound_boxes(self, placed: Placed, at: Indices, found: Measured) -> None:
        """Write nearer bounds of the distances of boxes to boxes into the elements `at` (n,) of `found`."""
        pair = found.pair.take(at)
        first, second = self._rows(placed, found.pose.take(at), pair)
        turns: Array = placed.turn.reshape(-1, 3, 3)
        centres: Array = placed.centre.reshape(-1, 3)
        a: Indices = self._shape[0].take(pair)
        b: Indices = self._shape[1].take(pair)
        apart, way = box_to_box(
            centres.take(second, 0) - centres.take(first, 0),
            turns.take(first, 0), self._box_half_m.take(a, 0), turns.take(second, 0), self._box_half_m.take(b, 0),
        )  # fmt: skip
        some = at[apart > 0]
        found.distance_m[some] = np.maximum(found.distance_m[some], apart[apart > 0])
        found.way[some] = way[apart > 0]

    def _beside_boxes(self, placed: Placed, at: Indices, found: Measured) -> NDArray[np.bool_]:
        """Write distances of capsules to boxes, as `_bound_boxes`; returns (n,) whether MuJoCo must still measure the pair.

        MuJoCo measures pairs in which an axis crosses the box, and cylinders, which are smaller than their capsules.
        """
        pair = found.pair.take(at)
        box, other = self._box.take(pair), self._round.take(pair)
        before: Indices = placed.centre.shape[1] * found.pose.take(at)
        box_row, row = before + box, before + other
        centres: Array = placed.centre.reshape(-1, 3)
        turn: Array = placed.turn.reshape(-1, 3, 3).take(box_row, 0)  # columns are the box's axes
        centre: Array = centres.take(row, 0)
        axis: Array = placed.axis.reshape(-1, 3).take(row, 0)
        offset = np.einsum("ni,nij->jn", centre - centres.take(box_row, 0), turn)
        apart, way, nearest = capsule_to_box(
            offset, np.einsum("ni,nij->jn", axis, turn), self._half_m.take(other), self._box_half_m.T.take(box, 1)
        )
        distance = found.distance_m
        distance[at] = np.maximum(distance.take(at), apart - self._radius_m.take(other))
        some = np.flatnonzero(apart)
        to = at.take(some)
        # From the first of the pair to the second.
        outward = np.einsum("nij,jn->ni", turn.take(some, 0), way.take(some, 1))
        found.way[to] = np.where(self._box_is_first.take(pair.take(some))[:, None], outward, -outward)
        found.point[to] = centre.take(some, 0) + nearest.take(some)[:, None] * axis.take(some, 0)
        return ~self._exact_geom.take(other) | (apart == 0)

    def _measure_by_mujoco(self, placed: Placed, at: Indices, found: Measured) -> None:
        """Write MuJoCo's distances, as `_bound_boxes`."""
        model, data, measure = self._model, self._data, mujoco.mj_geomDistance
        points, metres, before = np.zeros((len(at), 6)), list[float](), -1
        place, turn, pairs = data.geom_xpos, data.geom_xmat, self._pair_list
        for row, pose, pair in zip(points, found.pose[at].tolist(), found.pair[at].tolist(), strict=True):
            if pose != before:  # a distance depends on nothing but the places of the shapes
                place[:], turn[:] = placed.centre[pose], placed.turn[pose]
                before = pose
            metres.append(measure(model, data, *pairs[pair], _FARTHEST_M, row))
        found.distance_m[at] = metres
        way = points[:, 3:] - points[:, :3]
        some = way.any(1)
        found.way[at[some]] = np.where(found.distance_m[at[some], None] < 0, -way[some], way[some])
        found.point[at[some]] = points[some, :3]

    def _placed(self, q_rad: Array, *, with_joints: bool) -> Placed:
        """Capsules, and joints where asked for, in poses (T, J)."""
        model, data = self._model, self._data
        T = len(q_rad)
        place, turn = np.empty((T, model.ngeom, 3)), np.empty((T, model.ngeom, 9))
        n = T if with_joints else 0
        axis, anchor = np.empty((n, model.njnt, 3)), np.empty((n, model.njnt, 3))
        xpos, xmat, xaxis, xanchor, qpos = data.geom_xpos, data.geom_xmat, data.xaxis, data.xanchor, data.qpos
        kinematics = mujoco.mj_kinematics
        angles = np.repeat(model.qpos0[None], T, 0)
        angles[:, self._address] = q_rad
        for i, q in enumerate(angles):
            qpos[:] = q
            kinematics(model, data)
            place[i], turn[i] = xpos, xmat
            if with_joints:
                axis[i], anchor[i] = xaxis, xanchor
        ids = self._joint_ids
        return Placed(place, turn[:, self._axis_rows, self._axis_columns], turn, axis[:, ids], anchor[:, ids])

    def _shapes(self) -> None:
        """Compute a capsule for each shape: the shape itself, or a capsule round it."""
        model = self._model
        kinds, size = model.geom_type, model.geom_size
        self._half_m, radius = np.zeros(model.ngeom), model.geom_rbound.copy()
        self._box_half_m: Array = np.asarray(size, np.float64)
        along = np.full(model.ngeom, 2)
        exact = np.isin(kinds, _CAPSULE_TYPES)
        for g in range(model.ngeom):
            name = mujoco.mjtGeom(kinds[g])
            if name in (mujoco.mjtGeom.mjGEOM_CAPSULE, mujoco.mjtGeom.mjGEOM_CYLINDER):
                radius[g], self._half_m[g] = size[g, 0], size[g, 1]
            elif name == mujoco.mjtGeom.mjGEOM_SPHERE:
                radius[g] = size[g, 0]
            elif name == mujoco.mjtGeom.mjGEOM_BOX:
                along[g] = int(size[g].argmax())
                self._half_m[g] = size[g].max()
                radius[g] = float(np.hypot(*np.delete(size[g], along[g])))
        self._radius_m, self._exact_geom = radius, exact
        self._axis_rows: Indices = np.arange(model.ngeom)[:, None]
        self._axis_columns = along[:, None] + np.array([0, 3, 6])

    def _take(self, pairs: Indices) -> None:
        """Measure these pairs of shapes, (P, 2), from now on."""
        self._pairs, self._pair_list = pairs, [(int(a), int(b)) for a, b in pairs]
        a, b = pairs.T
        self._exact = self._exact_geom[a] & self._exact_geom[b]
        self._all_exact = bool(self._exact.all())
        self._radii_m = self._radius_m[a] + self._radius_m[b]
        self._shape: Indices = np.ascontiguousarray(pairs.T)
        self._second_after: Indices = self._shape[1] - self._shape[0]
        self._half_lengths_m = self._half_m[self._shape]
        self._reach_m = self._radii_m + self._half_lengths_m.sum(0)
        above = self._above[self._model.geom_bodyid]
        self._parted: Array = above[b] - above[a]
        boxes: NDArray[np.bool_] = np.asarray(self._model.geom_type == int(mujoco.mjtGeom.mjGEOM_BOX), bool)[pairs]
        self._both_boxes: NDArray[np.bool_] = boxes[:, 0] & boxes[:, 1]
        has_box = boxes[:, 0] != boxes[:, 1]
        self._box: Indices = np.asarray(np.where(boxes[:, 0], a, b), np.int64)
        self._box[~has_box] = -1
        self._round: Indices = np.where(boxes[:, 0], b, a)
        self._box_is_first: NDArray[np.bool_] = boxes[:, 0]
        self._every = np.arange(len(pairs), dtype=np.int64)
        self._keep(np.zeros(len(pairs)))

    def _keep(self, margin_m: Array) -> None:
        """Keep these margins (P,) from now on."""
        self._margin_m, self._small_m = margin_m, margin_m + MEASURED_M
