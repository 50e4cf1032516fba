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

    def of(self, poses: Indices) -> Placed:
        """The shapes in some of the poses."""
        return Placed(self.centre[poses], self.axis[poses], self.turn[poses], self.joint_axis[:0], self.anchor[:0])


@dataclass(frozen=True)
class Measured:
    """Distances of n pairs in T poses, and their nearest points.

    Attributes:
        distance_m: (T, n) distances.
        along: two arrays (T, n), metres from the centre of each capsule of a pair, or of the capsule round a shape, along its axis.
        points_m: both nearest points in (6,), by pose and column, of the pairs that MuJoCo measured.
        others: poses and columns (R,), and approximate vectors between the shapes (R, 3), of the pairs with boxes.
    """

    distance_m: Array
    along: tuple[Array, Array]
    points_m: dict[tuple[int, int], Array]
    others: list[tuple[Indices, Indices, Array]]


class PairDistances:
    """Distances of pairs of shapes of one robot, and the margin that each pair keeps."""

    def __init__(self, robot: RobotModel, margin_m: float = MARGIN_M) -> None:
        self._model: Any = description_spec(robot).compile()
        self._data: Any = mujoco.MjData(self._model)
        joints = [self._model.joint(name) for name in robot.joint_names]
        self._address = np.array([j.qposadr[0] for j in joints])
        self._joint_ids = np.array([j.id for j in joints])
        self._shapes()
        self._above = self._joints_above()
        self._take(self._pairs_that_can_meet())
        resting = self.distances_m(robot.rest_rad[None])[0]
        self._take(self._pairs[resting > 0])
        # A pair that rests within the margin may stay there.
        self._margin_m = np.minimum(margin_m, resting[resting > 0] / 2)
        self._margin_m[resting[resting > 0] > margin_m] = margin_m

    def distances_m(self, q_rad: Array) -> Array:
        """(T, P) distance of each pair in each pose (T, J): exact where it is small, elsewhere a lower bound."""
        return self._distances(q_rad, self._placed(q_rad, with_joints=False), self._every).distance_m

    def _distances(self, q_rad: Array, placed: Placed, of: Indices, least_m: Array | None = None) -> Measured:
        """Distances (T, n) of n pairs; `least_m` (T, n) has known lower bounds."""
        # All inner products of centres and axes by one multiplication, then those of each pair.
        vectors = np.concatenate([placed.centre, placed.axis], 1)
        products: Array = (vectors @ vectors.transpose(0, 2, 1)).reshape(len(q_rad), vectors.shape[1] ** 2)
        of_pair: Array = products.take(self._products if of is self._every else self._products[:, of], 1)
        aa, bb, ab, cosine, axis_a, axis_ab, axis_ba, axis_b = of_pair.transpose(1, 0, 2)
        half1, half2 = self._half_lengths_m[:, of]
        squared, s, t = nearest_along(aa + bb - 2 * ab, cosine, axis_a - axis_ab, axis_ba - axis_b, half1, half2)
        distance = np.sqrt(squared) - self._radii_m[of]
        if least_m is not None:
            np.maximum(distance, least_m, out=distance)
        found = Measured(distance, (s, t), {}, [])
        if not self._all_exact:
            self._measure(q_rad, placed, of, found)
        return found

    def _measure(self, q_rad: Array, placed: Placed, of: Indices, found: Measured) -> None:
        """Make distances of pairs that are no capsules exact where they are small."""
        distance = found.distance_m
        small_m = self._margin_m[of] + MEASURED_M
        t, p = np.nonzero((distance < small_m) & ~self._exact[of])
        if not len(t):
            return
        pair = of[p]
        both = self._both_boxes[pair]
        if both.any():
            self._bound_boxes(placed, t[both], p[both], pair[both], found)
        deep = np.ones(len(t), bool)
        beside = self._box[pair] >= 0
        if beside.any():
            deep[beside] = self._beside_boxes(placed, t[beside], p[beside], pair[beside], found)
        left = deep & (distance[t, p] < small_m[p])
        at = -1
        for i, k, g in zip(t[left].tolist(), p[left].tolist(), pair[left].tolist(), strict=True):
            if i != at:
                self._place(q_rad[i])
                at = i
            distance[i, k], found.points_m[i, k] = self._measured(g)

    def _bound_boxes(self, placed: Placed, t: Indices, p: Indices, pair: Indices, found: Measured) -> None:
        """Write nearer bounds of the distances of boxes to boxes, `pair` (n,) in poses `t`, into `found` at (t, p)."""
        a, b = self._pairs[pair].T
        turn_a, turn_b = (placed.turn[t, g].reshape(-1, 3, 3) for g in (a, b))
        offset = placed.centre[t, b] - placed.centre[t, a]
        apart, way = box_to_box(offset, turn_a, self._box_half_m[a], turn_b, self._box_half_m[b])
        found.distance_m[t, p] = np.where(apart > 0, np.maximum(found.distance_m[t, p], apart), found.distance_m[t, p])
        found.others.append((t, p, way))

    def _beside_boxes(
        self, placed: Placed, t: Indices, p: Indices, pair: Indices, found: Measured
    ) -> NDArray[np.bool_]:
        """Write distances of capsules to boxes, as `_bound_boxes`; returns (n,) whether MuJoCo must still measure the pair.

        MuJoCo measures pairs in which an axis crosses the box, and cylinders, which are smaller than their capsules.
        """
        box, other = self._box[pair], self._round[pair]
        turn = placed.turn[t, box].reshape(-1, 3, 3)  # columns are the box's axes
        offset = (placed.centre[t, other] - placed.centre[t, box])[:, None] @ turn
        axis = placed.axis[t, other][:, None] @ turn
        apart, way = capsule_to_box(offset[:, 0], axis[:, 0], self._half_m[other], self._box_half_m[box])
        found.distance_m[t, p] = np.maximum(found.distance_m[t, p], apart - self._radius_m[other])
        way = np.where((box == self._pairs[pair, 0])[:, None], way, -way)  # from the first of the pair to the second
        found.others.append((t, p, (turn @ way[..., None])[..., 0]))
        return ~self._exact_geom[other] | (apart <= 0)

    def _apart(self, placed: Placed, of: Indices, found: Measured) -> Array:
        """(T, n, 3) approximate vectors between the nearest points of each of n pairs, from the first shape to the second."""
        (a, b), (s, t) = self._pairs[of].T, found.along
        apart = placed.centre[:, b] - placed.centre[:, a]
        apart += t[..., None] * placed.axis[:, b] - s[..., None] * placed.axis[:, a]
        for pose, column, way in found.others:
            some = (way != 0).any(1)
            apart[pose[some], column[some]] = way[some]
        for at, points in found.points_m.items():
            way = points[3:] - points[:3]
            if way.any():
                apart[at] = way
        return apart

    def _placed(self, q_rad: Array, *, with_joints: bool) -> Placed:
        """Capsules, and joints where asked for, in poses (T, J)."""
        model, data = self._model, self._data
        T = len(q_rad)
        place, turn = np.empty((T, model.ngeom, 3)), np.empty((T, model.ngeom, 9))
        n = T if with_joints else 0
        axis, anchor = np.empty((n, model.njnt, 3)), np.empty((n, model.njnt, 3))
        xpos, xmat, xaxis, xanchor, qpos = data.geom_xpos, data.geom_xmat, data.xaxis, data.xanchor, data.qpos
        address, kinematics = self._address, mujoco.mj_kinematics
        for i, q in enumerate(q_rad):
            qpos[address] = q
            kinematics(model, data)
            place[i], turn[i] = xpos, xmat
            if with_joints:
                axis[i], anchor[i] = xaxis, xanchor
        ids = self._joint_ids
        return Placed(place, turn[:, self._axis_rows, self._axis_columns], turn, axis[:, ids], anchor[:, ids])

    def _place(self, q_rad: Array) -> None:
        self._data.qpos[self._address] = q_rad
        mujoco.mj_kinematics(self._model, self._data)

    def _measured(self, pair: int) -> tuple[float, Array]:
        """MuJoCo's distance of a pair in the pose set, and the nearest points, both in (6,)."""
        (a, b), points = self._pair_list[pair], np.zeros(6)
        return float(mujoco.mj_geomDistance(self._model, self._data, a, b, _FARTHEST_M, points)), points

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
        self._half_lengths_m = self._half_m[pairs.T]
        boxes: NDArray[np.bool_] = np.asarray(self._model.geom_type == int(mujoco.mjtGeom.mjGEOM_BOX), bool)[pairs]
        self._both_boxes: NDArray[np.bool_] = boxes[:, 0] & boxes[:, 1]
        has_box = boxes[:, 0] != boxes[:, 1]
        self._box: Indices = np.asarray(np.where(boxes[:, 0], a, b), np.int64)
        self._box[~has_box] = -1
        self._round: Indices = np.where(boxes[:, 0], b, a)
        self._every = np.arange(len(pairs), dtype=np.int64)
        # Where the products of centres and axes of a pair stand among all: centres come first, then axes.
        g, n = self._model.ngeom, 2 * self._model.ngeom
        left, right = [a, b, a, g + a, g + a, g + a, g + b, g + b], [a, b, b, g + b, a, b, a, b]
        self._products: Indices = n * np.stack(left) + np.stack(right)
        self._margin_m = np.zeros(len(pairs))

    def _pairs_that_can_meet(self) -> Indices:
        """(P, 2) shapes that MuJoCo would check for contact, on bodies at least three steps of the tree and two joints apart."""
        model = self._model
        parent, body = model.body_parentid, model.geom_bodyid
        excluded = {int(s) for s in model.exclude_signature}
        plane = model.geom_type == int(mujoco.mjtGeom.mjGEOM_PLANE)
        found: list[tuple[int, int]] = []
        for g in range(model.ngeom):
            for h in range(g):
                a, b = sorted((int(body[g]), int(body[h])))
                touches = (
                    model.geom_contype[g] & model.geom_conaffinity[h]
                    or model.geom_contype[h] & model.geom_conaffinity[g]
                )
                beside = (
                    a == b
                    or parent[a] == parent[b]
                    or a in (parent[b], parent[parent[b]])
                    or b in (parent[a], parent[parent[a]])
                )
                fixed = np.abs(self._above[a] - self._above[b]).sum() <= 1
                if touches and not (beside or fixed or plane[g] or plane[h] or (a << 16) + b in excluded):
                    found.append((h, g))
        return np.array(found, np.int64).reshape(-1, 2)

    def _joints_above(self) -> Array:
        """(bodies, J) 1 where a joint moves a body."""
        above = np.zeros((self._model.nbody, len(self._joint_ids)))
        for b in range(1, self._model.nbody):
            above[b] = above[self._model.body_parentid[b]]
            above[b, self._model.jnt_bodyid[self._joint_ids] == b] = 1
        return above
