"""Self-contact: how near a robot comes to itself, along a whole path, and which way leads out.

Capsules and spheres are measured exactly by closed form, all pairs of all poses at once; another shape is first bounded
by a capsule round it and, when that comes near, measured: a capsule against a box here, others by MuJoCo. Pairs joined
by one or two joints, and pairs that touch in the rest pose, cannot be told apart by shapes this coarse and are left
out. Between two poses no distance changes by more than what the shapes move, which bounds it from below: a path found
free is free at every instant, not at samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.boxes import box_to_box, capsule_to_box
from retarget.capsules import nearest_along
from retarget.description import description_spec, mujoco
from retarget.kinematics import cross
from retarget.robot import RobotModel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
MARGIN_M = 0.010
"""Poses nearer to themselves than this count as touching; pairs that rest nearer may come half as near as they rest."""
_KEPT = 0.8
"""Share of the margin that is proved for every instant of a path."""
_FARTHEST_M = 1.0
_MEASURED_M = 0.007
"""Other shapes are measured exactly when their bounds come so near to the margin: more than poses are led round by."""
_DEEPEST = 8
"""Halvings of a segment after which it counts as touching; distances that near and movements that small do not occur."""
_CAPSULE_TYPES = (2, 3)  # mjGEOM_SPHERE, mjGEOM_CAPSULE


@dataclass(frozen=True)
class _Placed:
    """Shapes, (T, geoms, 3) centres and axes of their capsules, (T, geoms, 9) rotations, in T poses.

    Where asked for also joints, (T, J, 3) axes and anchors.
    """

    centre: Array
    axis: Array
    turn: Array
    joint_axis: Array
    anchor: Array


class SelfContact:
    """Distances of one robot to itself."""

    def __init__(self, robot: RobotModel, margin_m: float = MARGIN_M) -> None:
        self._model: Any = description_spec(robot).compile()
        self._data: Any = mujoco.MjData(self._model)
        self._points = np.zeros(6)
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
        """(T, P) distance of each pair in each pose (T, J): exact where small, else not more than the true one."""
        return self._distances(q_rad, self._placed(q_rad, with_joints=False), self._every)[0]

    def worst(self, q_rad: Array, aim_m: float) -> tuple[Array, Array]:
        """What the worst pair of each pose (T, J) lacks of its margin and `aim_m` more, (T,), and the way out, (T, J).

        The way out is how its distance grows with each joint.
        """
        beyond, way = self.nearest(q_rad, self._every)
        return aim_m - beyond, way

    def nearest(self, q_rad: Array, of: Indices) -> tuple[Array, Array]:
        """What lies between the nearest of some pairs beyond its margin, (T,), and how that grows with each joint, (T, J)."""
        placed = self._placed(q_rad, with_joints=True)
        distance, s, t = self._distances(q_rad, placed, of)
        beyond = distance - self._margin_m[of]
        rows, worst = np.arange(len(q_rad)), beyond.argmin(1)
        pair = of[worst]
        a, b = self._pairs[pair].T
        point1 = placed.centre[rows, a] + s[rows, worst, None] * placed.axis[rows, a]
        point2 = placed.centre[rows, b] + t[rows, worst, None] * placed.axis[rows, b]
        apart = point2 - point1  # of segments, which have a direction even where capsules overlap
        for i in np.flatnonzero(~self._exact[pair] & (beyond[rows, worst] < _MEASURED_M)):
            self._place(q_rad[i])
            overlap = self._measured(int(pair[i])) < 0
            point1[i], point2[i] = self._points[:3], self._points[3:]
            apart[i] = (point1[i] - point2[i]) if overlap else (point2[i] - point1[i])
        normal = apart / np.maximum(np.linalg.norm(apart, axis=1, keepdims=True), 1e-9)
        lever = ((point1 + point2) / 2)[:, None] - placed.anchor
        turned = np.einsum("tji,ti->tj", cross(placed.joint_axis, lever), normal)
        body = self._model.geom_bodyid
        return beyond.min(1), turned * (self._above[body[b]] - self._above[body[a]])

    def pairs_between(self, some: Indices, others: Indices) -> Indices:
        """Which pairs have one shape of `some` and one of `others`."""
        a, b = self._pairs.T
        crossed = (np.isin(a, some) & np.isin(b, others)) | (np.isin(a, others) & np.isin(b, some))
        return np.flatnonzero(crossed)

    def shapes_moved_by(self, some_of: list[int], none_of: list[int]) -> Indices:
        """Shapes that can touch, moved by a joint of `some_of` (any shape when empty) and by none of `none_of`."""
        model, above = self._model, self._above[self._model.geom_bodyid]
        solid = (model.geom_contype | model.geom_conaffinity) != 0
        solid &= model.geom_type != int(mujoco.mjtGeom.mjGEOM_PLANE)
        moved = above[:, some_of].any(1) if some_of else solid
        return np.flatnonzero(solid & moved & ~above[:, none_of].any(1))

    def _distances(self, q_rad: Array, placed: _Placed, of: Indices) -> tuple[Array, Array, Array]:
        """Distances (T, n) of n pairs, and for capsules where along each axis they are taken."""
        # All inner products of centres and axes by one multiplication, then those of each pair.
        vectors = np.concatenate([placed.centre, placed.axis], 1)
        products: Array = (vectors @ vectors.transpose(0, 2, 1)).reshape(len(q_rad), vectors.shape[1] ** 2)
        of_pair: list[Array] = [products.take(at, 1) for at in self._products[:, of]]
        aa, bb, ab, cosine, axis_a, axis_ab, axis_ba, axis_b = of_pair
        half1, half2 = self._half_lengths_m[:, of]
        squared, s, t = nearest_along(aa + bb - 2 * ab, cosine, axis_a - axis_ab, axis_ba - axis_b, half1, half2)
        distance = np.sqrt(squared) - self._radii_m[of]
        if not self._all_exact:
            self._measure(q_rad, placed, of, distance)
        return distance, s, t

    def _measure(self, q_rad: Array, placed: _Placed, of: Indices, distance: Array) -> None:
        """Make distances (T, n) of pairs that are no capsules exact where they are small."""
        small_m = self._margin_m[of] + _MEASURED_M
        t, p = np.nonzero((distance < small_m) & ~self._exact[of])
        if not len(t):
            return
        pair = of[p]
        both = self._both_boxes[pair]
        if both.any():
            self._bound_boxes(placed, t[both], p[both], pair[both], distance)
        deep = np.ones(len(t), bool)
        beside = self._box[pair] >= 0
        if beside.any():
            deep[beside] = self._beside_boxes(placed, t[beside], p[beside], pair[beside], distance)
        left = deep & (distance[t, p] < small_m[p])
        at = -1
        for i, k, g in zip(t[left].tolist(), p[left].tolist(), pair[left].tolist(), strict=True):
            if i != at:
                self._place(q_rad[i])
                at = i
            distance[i, k] = self._measured(g)

    def _bound_boxes(self, placed: _Placed, t: Indices, p: Indices, pair: Indices, distance: Array) -> None:
        """Write nearer bounds of the distances of boxes to boxes, `pair` (n,) in poses `t`, into `distance` at (t, p)."""
        a, b = self._pairs[pair].T
        turn_a, turn_b = (placed.turn[t, g].reshape(-1, 3, 3) for g in (a, b))
        offset = placed.centre[t, b] - placed.centre[t, a]
        apart = box_to_box(offset, turn_a, self._box_half_m[a], turn_b, self._box_half_m[b])
        distance[t, p] = np.where(apart > 0, np.maximum(distance[t, p], apart), distance[t, p])

    def _beside_boxes(
        self, placed: _Placed, t: Indices, p: Indices, pair: Indices, distance: Array
    ) -> NDArray[np.bool_]:
        """Write distances of capsules to boxes, as `_bound_boxes`; (n,) whether MuJoCo still knows better.

        It does where an axis goes through a box, and for a cylinder, which its capsule sticks out of.
        """
        box, other = self._box[pair], self._round[pair]
        turn = placed.turn[t, box].reshape(-1, 3, 3)  # columns are the box's axes
        offset = (placed.centre[t, other] - placed.centre[t, box])[:, None] @ turn
        axis = placed.axis[t, other][:, None] @ turn
        apart = capsule_to_box(offset[:, 0], axis[:, 0], self._half_m[other], self._box_half_m[box])
        distance[t, p] = np.maximum(distance[t, p], apart - self._radius_m[other])
        return ~self._exact_geom[other] | (apart <= 0)

    def frames(self, q_rad: Array, share: float = _KEPT) -> NDArray[np.bool_]:
        """(T,) whether each frame of (T, J) comes closer to itself than a share of the margin, what paths keep of it."""
        return np.asarray((self.distances_m(q_rad) < share * self._margin_m).any(1), bool)

    def clearance_m(self, q_rad: Array) -> Array:
        """(T,) smallest distance of each frame of (T, J)."""
        return self.distances_m(q_rad).min(1, initial=np.inf)

    def pairs(self, q_rad: Array) -> list[tuple[str, str]]:
        """Names of the bodies that touch in one pose (J,)."""
        touching = self._pairs[self.distances_m(q_rad[None])[0] < self._margin_m]
        bodies = self._model.geom_bodyid[touching]
        return sorted({(str(self._model.body(a).name), str(self._model.body(b).name)) for a, b in bodies})

    def along(self, control_rad: Array) -> NDArray[np.bool_]:
        """(N - 2,) whether the robot may touch itself in each segment of a quadratic spline of N control points."""
        border = self.distances_m((control_rad[:-1] + control_rad[1:]) / 2)
        touching = np.asarray((border < self._margin_m).any(1), bool)
        hit = touching[:-1] | touching[1:]
        step = np.abs(np.diff(control_rad, axis=0)) @ self._sweep_m.T  # (N - 1, P)
        first, last = border[:-1], border[1:]
        # Speed changes in a straight line, so a segment moves by no more than the mean of the speeds at its ends.
        kept_m = _KEPT * self._margin_m
        near = np.asarray(first + last - (step[:-1] + step[1:]) / 2 < 2 * kept_m, bool) & ~hit[:, None]
        segment, of = np.flatnonzero(near.any(1)), np.flatnonzero(near.any(0))
        if not len(segment):
            return hit
        # From here on only those pairs that may come near, each half of a segment moving by half of its fastest.
        first, last = first[segment][:, of], last[segment][:, of]
        moved = np.maximum(step[segment][:, of], step[segment + 1][:, of])
        u = np.tile((0.0, 1.0), (len(segment), 1))
        for _ in range(_DEEPEST):
            middle = u.mean(1)
            q = _spline(control_rad, segment, middle)
            between = self._distances(q, self._placed(q, with_joints=False), of)[0]
            hit[segment[(between < self._margin_m[of]).any(1)]] = True
            u = np.concatenate([np.stack([u[:, 0], middle], 1), np.stack([middle, u[:, 1]], 1)])
            first, last = np.concatenate([first, between]), np.concatenate([between, last])
            segment, moved = np.concatenate([segment, segment]), np.concatenate([moved, moved]) / 2
            unsure = np.asarray((first + last - moved < 2 * kept_m[of]).any(1), bool) & ~hit[segment]
            if not unsure.any():
                return hit
            segment, u, first, last, moved = segment[unsure], u[unsure], first[unsure], last[unsure], moved[unsure]
        hit[segment] = True
        return hit

    def _placed(self, q_rad: Array, *, with_joints: bool) -> _Placed:
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
        return _Placed(place, turn[:, self._axis_rows, self._axis_columns], turn, axis[:, ids], anchor[:, ids])

    def _place(self, q_rad: Array) -> None:
        self._data.qpos[self._address] = q_rad
        mujoco.mj_kinematics(self._model, self._data)

    def _measured(self, pair: int) -> float:
        """MuJoCo's distance of a pair in the pose set; the nearest points are left in `_points`."""
        a, b = self._pair_list[pair]
        return float(mujoco.mj_geomDistance(self._model, self._data, a, b, _FARTHEST_M, self._points))

    def _shapes(self) -> None:
        """A capsule for each shape: itself, or one round it."""
        model = self._model
        kinds, size = model.geom_type, model.geom_size
        self._half_m, radius, self._box_half_m = np.zeros(model.ngeom), model.geom_rbound.copy(), size
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
        """Look at these pairs of shapes, (P, 2), from now on."""
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
        self._sweep_m = self._sweeps()

    def _pairs_that_can_meet(self) -> Indices:
        """(P, 2) shapes that MuJoCo would check against each other, of bodies three steps of the tree and two joints apart."""
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

    def _sweeps(self) -> Array:
        """(P, J) metres that the shapes of each pair move against each other at most, per radian of each joint."""
        model = self._model
        reach = np.zeros((model.ngeom, len(self._joint_ids)))  # of each shape from each joint above it
        for g in range(model.ngeom):
            up = int(model.geom_bodyid[g])
            far = float(np.linalg.norm(model.geom_pos[g])) + self._half_m[g] + self._radius_m[g]
            while up:
                for j in np.flatnonzero(model.jnt_bodyid[self._joint_ids] == up):
                    reach[g, j] = far + float(np.linalg.norm(model.jnt_pos[self._joint_ids[j]]))
                far += float(np.linalg.norm(model.body_pos[up]))
                up = int(model.body_parentid[up])
        a, b = self._pairs.T
        both = self._above[model.geom_bodyid[a]] == self._above[model.geom_bodyid[b]]
        return np.where(both, 0.0, np.maximum(reach[a], reach[b]))


def _spline(control: Array, segment: Indices, u: Array) -> Array:
    """(n, J) places on segments of a quadratic spline."""
    c0, c1, c2 = control[segment], control[segment + 1], control[segment + 2]
    u = u[:, None]
    return (c0 + c1) / 2 + (c1 - c0) * u + (c2 - 2 * c1 + c0) * (u * u / 2)
