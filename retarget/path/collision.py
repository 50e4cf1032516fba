"""Self-contact: distances between a robot's shapes along a whole path, and the directions that increase them.

Between two poses no distance changes by more than the shapes move. This bounds the distances between samples from below: a path
that is found free is free at every instant.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.path.continuous_bounds import Sections, Spans
from retarget.path.distances import MARGIN_M, Array, Indices, Placed
from retarget.path.least_distances import LeastDistances
from retarget.path.slopes import PairSlopes
from retarget.path.spline_distances import Seen, SplineDistances
from retarget.path.spline_places import on_spline
from retarget.robot.description import mujoco
from retarget.robot.robot import RobotModel

KEPT = 0.8
"""Share of the margin that is proved for every instant of a path."""
_FROM_WITHIN = 0.1
"""Share of the margin by which a path that begins within the margin may come nearer while it turns away."""
_SURELY_M = 0.02
"""Metres beyond the margin below which distances in given poses are measured, for bounds in other poses."""
_DEEPEST = 8
"""Halvings of a segment after which it counts as touching; distances this near the bound do not occur in practice."""
_ROUNDING_M = 1e-6
Allowed = tuple[Array, Array]
"""(P,) metres of distance that each pair keeps at the borders of segments, and (P,) metres that it keeps at every instant."""


class SelfContact(PairSlopes):
    """Distances between the shapes of one robot, and proofs that paths keep them."""

    def __init__(self, robot: RobotModel, margin_m: float = MARGIN_M) -> None:
        super().__init__(robot, margin_m)
        self._sweep_m = self._sweeps()
        above = self._above[self._model.geom_bodyid]
        self._spans = Spans(self._pairs, above, *self._extents_m(), self._sweep_m)
        self._bounded = self._spans.known

    def frames(self, q_rad: Array, share: float = KEPT) -> NDArray[np.bool_]:
        """(T,) whether a pair is nearer than `share` of its margin in each pose of (T, J); paths keep the default share."""
        return np.asarray((self.distances_m(q_rad) < share * self._margin_m).any(1), bool)

    def least(self, q_rad: Array) -> LeastDistances:
        """Lower bounds of all distances in poses (T, J), exact below the margin."""
        placed = self._placed(q_rad, with_joints=False)
        return LeastDistances(q_rad, self._nearest_m(placed, self._margin_m + _SURELY_M), self._sweep_m)

    def touching(self, least: LeastDistances) -> NDArray[np.bool_]:
        """(T,) whether a pair is nearer than its margin in each frame of `least`."""
        return np.asarray((least.least_m < self._margin_m).any(1), bool)

    def clearance_m(self, q_rad: Array) -> Array:
        """(T,) smallest distance of all pairs in each pose of (T, J)."""
        return self.distances_m(q_rad).min(1, initial=np.inf)

    def slacks_m(self, q_rad: Array, share: float = KEPT) -> Array:
        """(T, P) distance of each pair less `share` of its margin, in each pose of (T, J); paths keep the default share."""
        return self.distances_m(q_rad) - share * self._margin_m

    def slack_m(self, q_rad: Array, share: float = KEPT) -> Array:
        """(P,) distance of each pair less `share` of its margin, in one pose (J,)."""
        return self.slacks_m(q_rad[None], share)[0]

    def within_slack(self, slack_m: Array, moved_rad: Array) -> bool:
        """Whether the slacks (P,) of a pose stay positive in every pose that differs by at most `moved_rad` (J,)."""
        return bool((slack_m > self._sweep_m @ moved_rad).all())

    def pairs(self, q_rad: Array) -> list[tuple[str, str]]:
        """Names of the bodies that touch in a pose (J,), in pairs."""
        touching = self._pairs[self.distances_m(q_rad[None])[0] < self._margin_m]
        bodies = self._model.geom_bodyid[touching]
        return sorted({(str(self._model.body(a).name), str(self._model.body(b).name)) for a, b in bodies})

    def pairs_between(self, some: Indices, others: Indices) -> Indices:
        """Indices of the pairs of one shape of `some` and one of `others`."""
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

    def allowed_from(self, distance_m: Array) -> Allowed | None:
        """Distances that a path must keep from a pose with distances (P,), of `least`; None if the pose keeps all margins."""
        within = distance_m < self._margin_m
        if not within.any():
            return None
        least_m = np.minimum(KEPT * self._margin_m, distance_m - _FROM_WITHIN * self._margin_m)
        return np.where(within, distance_m - _ROUNDING_M, self._margin_m), np.where(
            within, least_m, KEPT * self._margin_m
        )

    def along(self, control_rad: Array, allowed: Allowed | None = None) -> NDArray[np.bool_]:
        """(N - 2,) whether the robot may touch itself in each segment of a quadratic spline of N control points.

        `allowed` holds the distances for a path that begins within a margin; without them no path could leave such a pose.
        """
        return self.along_near(control_rad, allowed, None)[0]

    def along_near(
        self, control_rad: Array, allowed: Allowed | None, least: LeastDistances | None, seen: Seen | None = None
    ) -> tuple[NDArray[np.bool_], LeastDistances]:
        """`along`, given lower bounds of the distances in nearby frames; also returns bounds from the second border on.

        `seen` has distances on a spline that may share its first segments with this one; `least` is then needed.
        """
        margin_m, kept_m = (self._margin_m, KEPT * self._margin_m) if allowed is None else allowed
        q_rad = (control_rad[:-1] + control_rad[1:]) / 2
        known = self._known(q_rad, control_rad, margin_m, least, seen)
        border, least_m = known.border, known.least_m[known.border]
        step_rad = np.abs(control_rad[1:] - control_rad[:-1])
        # The speed is linear in time, so a segment moves by no more than the mean of the speeds at its ends.
        step = step_rad @ self._sweep_m.T  # (N - 1, P)
        moves = (step[:-1] + step[1:]) / 2
        unsure = least_m < margin_m
        near = least_m[:-1] + least_m[1:] - moves < 2 * kept_m
        unsure[:-1] |= near
        unsure[1:] |= near
        # A pair that is this far at both ends of a segment is clear on it.
        enough_m, wanted = np.zeros_like(known.least_m), np.zeros_like(known.measured)
        enough_m[border[:-1]] = kept_m + moves / 2
        enough_m[border[1:]] = np.maximum(enough_m[border[1:]], kept_m + moves / 2)
        wanted[border] = unsure & ~known.measured[border]
        known.enter(self._nearer(known.placed, known.least_m, wanted, np.maximum(enough_m, margin_m)))
        least_m = known.least_m[border]
        touching = np.asarray((least_m < margin_m).any(1), bool)
        hit = touching[:-1] | touching[1:]
        near = (least_m[:-1] + least_m[1:] - moves < 2 * kept_m) & ~hit[:, None]
        segment, pair = np.nonzero(near)
        if len(segment):
            # Half a segment moves by at most half of its largest speed.
            moved = np.maximum(step[:-1], step[1:])
            bend_rad = np.abs(control_rad[2:] - 2 * control_rad[1:-1] + control_rad[:-2])
            bent = self._spans.bends_m(step_rad, bend_rad, moved)
            ends = border[np.stack([segment, segment + 1])]
            sections = Sections(
                segment, pair, np.repeat([[0.0], [1.0]], len(pair), 1), ends, known.least_m[ends, pair],
                known.way[ends, pair], moved[segment, pair], bent[segment, pair],
            )  # fmt: skip
            self._halve(sections, known, control_rad, margin_m, kept_m, hit)
        return hit, LeastDistances(q_rad[1:], least_m[1:], self._sweep_m)

    def _known(
        self, q_rad: Array, control_rad: Array, margin_m: Array, least: LeastDistances | None, seen: Seen | None
    ) -> SplineDistances:
        """Gives the known bounds of distances at the borders (B, J) and in the middles of a spline's segments."""
        if seen is None or least is None:
            placed = self._placed(q_rad, with_joints=False)
            least_m = self._nearest_m(placed, margin_m) if least is None else least.at(q_rad, -1)
            return SplineDistances.at_borders(placed, least_m)
        shared = seen.shared(control_rad)
        others = np.concatenate([[0], np.arange(shared + 1, len(q_rad))])
        placed = self._placed(q_rad[others], with_joints=False)
        return SplineDistances.after(seen, shared, placed, least.at(q_rad, -1)[others])

    def _halve(
        self, sections: Sections, known: SplineDistances, control_rad: Array, margin_m: Array, kept_m: Array,
        hit: NDArray[np.bool_],
    ) -> None:  # fmt: skip
        """Halve sections until each is known to be clear; write true into `hit` (N - 2,) for segments in which one is not."""
        centre, turn, seen = known.placed.centre, known.placed.turn, known.middle
        for _ in range(_DEEPEST):
            near = ~hit[sections.segment]
            bounded = near & self._bounded[sections.pair]
            at = np.flatnonzero(bounded)
            near[at] = self._spans.least_m(sections.of(bounded), centre, turn) < kept_m[sections.pair[at]]
            if not near.any():
                return
            sections = sections.of(near)
            pose = seen[sections.segment]
            distance_m, way = known.least_m[pose, sections.pair], known.way[pose, sections.pair]
            new = np.flatnonzero(pose < 0)
            if len(new):
                # No two sections but those of different pairs begin in the same pose.
                _, one, of = np.unique(sections.ends[0, new], return_index=True, return_inverse=True)
                q_rad = on_spline(control_rad, sections.segment[new[one]], sections.u[:, new[one]].mean(0))
                between = self._placed(q_rad, with_joints=False)
                found = self._measure(between, of, sections.pair[new])
                pose[new], distance_m[new], way[new] = len(centre) + of, found.distance_m, found.way
                centre, turn = np.concatenate([centre, between.centre]), np.concatenate([turn, between.turn])
            hit[sections.segment[distance_m < margin_m[sections.pair]]] = True
            sections = sections.halves(pose, distance_m, way)
            sections = sections.of(sections.distance_m.sum(0) - sections.moved_m < 2 * kept_m[sections.pair])
            seen = np.full_like(seen, -1)  # of the first halves no middle is known
        hit[sections.segment] = True

    def clear_along(self, way_rad: Array, share: float = KEPT, first_slack_m: Array | None = None) -> bool:
        """Whether straight lines from pose to pose of (N, J) keep a share of every margin at every instant.

        A pair with slacks a and b at the ends of a segment, which moves by m on it, has at least the slack (a + b - m) / 2;
        segments on which this bound is negative are halved. `first_slack_m` (P,) is the slack at the first pose; None computes it.
        """
        gone = np.zeros_like(way_rad)  # (N, J) total movement of each joint up to each pose
        np.cumsum(np.abs(np.diff(way_rad, axis=0)), 0, out=gone[1:])
        kept_m, of, sweep_m = share * self._margin_m, self._every, self._sweep_m
        first = (self.slack_m(way_rad[0], share) if first_slack_m is None else first_slack_m)[None]
        last = self.slacks_m(way_rad[-1:], share)
        if (first <= 0).any() or (last <= 0).any():
            return False
        u = np.array([[0.0, len(way_rad) - 1.0]])
        for _ in range(_DEEPEST + len(way_rad).bit_length()):
            moved = (_on_lines(gone, u[:, 1]) - _on_lines(gone, u[:, 0])) @ sweep_m.T
            unsure = np.asarray(first + last <= moved, bool)
            if not unsure.any():
                return True
            segment, pairs = np.flatnonzero(unsure.any(1)), np.flatnonzero(unsure.any(0))
            of, sweep_m = of[pairs], sweep_m[pairs]
            u, first, last = u[segment], first[segment][:, pairs], last[segment][:, pairs]
            middle = u.mean(1)
            q = _on_lines(way_rad, middle)
            between = self._of_all(self._placed(q, with_joints=False), of).distance_m.reshape(len(q), -1) - kept_m[of]
            if (between <= 0).any():
                return False
            u = np.concatenate([np.stack([u[:, 0], middle], 1), np.stack([middle, u[:, 1]], 1)])
            first, last = np.concatenate([first, between]), np.concatenate([between, last])
        return False

    def _nearest_m(self, placed: Placed, enough_m: Array) -> Array:
        """(T, P) lower bounds of all distances in T poses, exact where less than `enough_m` (P,) and small."""
        least_m = np.full((len(placed.centre), len(self._margin_m)), -np.inf)
        self._nearer(placed, least_m, np.ones(least_m.shape, bool), enough_m)
        return least_m

    def _extents_m(self) -> tuple[Array, Array]:
        """(geoms, 3) half edges of boxes and half lengths of capsules, and (geoms,) radii, 0 for boxes."""
        box: NDArray[np.bool_] = np.asarray(self._model.geom_type == int(mujoco.mjtGeom.mjGEOM_BOX), bool)[:, None]
        along_axis = np.zeros_like(self._box_half_m)
        along_axis[:, 2] = self._half_m
        return np.where(box, self._box_half_m, along_axis), np.where(box[:, 0], 0.0, self._radius_m)

    def _sweeps(self) -> Array:
        """(P, J) largest relative movement of the shapes of each pair, metres per radian of each joint."""
        model = self._model
        reach = np.zeros((model.ngeom, len(self._joint_ids)))  # of each shape from each joint above it
        for g in range(model.ngeom):
            up = int(model.geom_bodyid[g])
            far = float(np.linalg.norm(model.geom_pos[g])) + self._half_m[g] + self._radius_m[g]
            while up:
                moved_by = np.flatnonzero(model.jnt_bodyid[self._joint_ids] == up)
                anchors_m = np.linalg.norm(model.jnt_pos[self._joint_ids[moved_by]], axis=1)
                reach[g, moved_by] = far + anchors_m.max(initial=0.0)  # of joints in one place none reaches further
                far += float(np.linalg.norm(model.body_pos[up]))
                up = int(model.body_parentid[up])
        a, b = self._pairs.T
        both = self._above[model.geom_bodyid[a]] == self._above[model.geom_bodyid[b]]
        return np.where(both, 0.0, np.maximum(reach[a], reach[b]))


def _on_lines(points: Array, u: Array) -> Array:
    """(n, J) places on the lines between (N, J) points, `u` counting points."""
    at = np.minimum(u.astype(np.int64), len(points) - 2)
    return points[at] + (u - at)[:, None] * (points[at + 1] - points[at])
