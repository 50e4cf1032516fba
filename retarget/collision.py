"""Self-contact: whether the robot touches itself, along a whole path, and the nearest pose in which it does not.

Distances are MuJoCo's, between the description's own shapes. Pairs joined by one or two joints, and pairs that touch
in the rest pose, cannot be told apart by shapes this coarse and are left out. Between two poses no distance changes by
more than what the shapes move, which bounds it from below: a path found free is free at every instant, not at samples.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.description import description_spec, mujoco
from retarget.kinematics import cross
from retarget.robot import RobotModel

Array = NDArray[np.float64]
MARGIN_M = 0.004
"""Poses nearer to themselves than this count as touching."""
_SURE_M = 0.001
"""Least distance proved for the time between two poses."""
_SEEN_M = 0.05
"""Distances above this are not told apart."""
_MOST_PUSHED_RAD = 0.15
_ROUNDS, _PUSHES = 4, 3


class SelfContact:
    """Distances of one robot to itself."""

    def __init__(self, robot: RobotModel, margin_m: float = MARGIN_M) -> None:
        self._margin_m = margin_m
        self._load(robot, [])
        near = self._near_pairs() | {self._names(a, b) for a, b in self._touching(robot.rest_rad, margin_m)}
        self._load(robot, sorted(near))
        self._above = self._joints_above()
        self._sweep_m = self._sweeps()

    def _load(self, robot: RobotModel, ignored: list[tuple[str, str]]) -> None:
        spec = description_spec(robot)
        for a, b in ignored:
            spec.add_exclude(bodyname1=a, bodyname2=b)
        self._model: Any = spec.compile()
        self._data: Any = mujoco.MjData(self._model)
        self._model.geom_margin[:] = _SEEN_M
        joints = [self._model.joint(name) for name in robot.joint_names]
        self._address = np.array([j.qposadr[0] for j in joints])
        self._joint_ids = np.array([j.id for j in joints])

    def frames(self, q_rad: Array) -> NDArray[np.bool_]:
        """(T,) whether each frame of (T, J) comes closer to itself than the margin."""
        return self.clearance_m(q_rad) < self._margin_m

    def clearance_m(self, q_rad: Array) -> Array:
        """(T,) smallest distance of each frame of (T, J), at most 0.05 m."""
        clearance = np.full(len(q_rad), _SEEN_M)
        for i, q in enumerate(q_rad):
            if self._place(q):
                clearance[i] = min(_SEEN_M, float(self._data.contact.dist.min()))
        return clearance

    def pairs(self, q_rad: Array) -> list[tuple[str, str]]:
        """Names of the bodies that touch in one pose (J,)."""
        return sorted({self._names(a, b) for a, b in self._touching(q_rad, self._margin_m)})

    def along(self, control_rad: Array) -> NDArray[np.bool_]:
        """(N - 2,) whether the robot may touch itself in each segment of a quadratic spline of N control points."""
        border = self.clearance_m((control_rad[:-1] + control_rad[1:]) / 2)
        step = np.abs(np.diff(control_rad, axis=0))
        moved = (np.maximum(step[:-1], step[1:]) @ self._sweep_m.T).max(1, initial=0.0)
        hit = np.zeros(len(control_rad) - 2, bool)
        segment, u = np.arange(len(hit)), np.zeros((len(hit), 2))
        u[:, 1] = 1.0
        d = np.stack([border[:-1], border[1:]], 1)
        while len(segment):
            hit[segment] |= d.min(1) < self._margin_m
            unsure = ((d.sum(1) - moved) / 2 < _SURE_M) & ~hit[segment]
            segment, u, d, moved = segment[unsure], u[unsure], d[unsure], moved[unsure] / 2
            middle = u.mean(1)
            between = self.clearance_m(_spline(control_rad, segment, middle))
            u = np.concatenate([np.stack([u[:, 0], middle], 1), np.stack([middle, u[:, 1]], 1)])
            d = np.concatenate([np.stack([d[:, 0], between], 1), np.stack([between, d[:, 1]], 1)])
            segment, moved = np.concatenate([segment, segment]), np.concatenate([moved, moved])
        return hit

    def lead_round(
        self, target_rad: Array, start_rad: Array, aim_m: float, mobility: Array, low: Array, high: Array
    ) -> Array:
        """(J,) pose near `target_rad` that keeps `aim_m`, reached from `start_rad` on its own side; best effort.

        Args:
            target_rad: (J,) the pose that touches.
            start_rad: (J,) a pose that does not, such as the one before.
            aim_m: distance to keep.
            mobility: (J,) how readily each joint gives way, 0 for never.
            low: (J,) position limits.
            high: (J,) position limits.
        """
        q = start_rad
        for _ in range(_ROUNDS):
            q = q + np.clip(target_rad - q, -_MOST_PUSHED_RAD * 2, _MOST_PUSHED_RAD * 2)
            for _ in range(_PUSHES):
                if not self._place(q):
                    break
                lack: Array = aim_m - self._data.contact.dist
                close = lack > 0
                if not close.any():
                    break
                A: Array = self._gradients()[close] * mobility
                push = np.asarray(np.linalg.solve(A @ A.T + 1e-5 * np.eye(len(A)), lack[close]), np.float64)
                q = np.clip(q + np.clip(mobility * (push @ A), -_MOST_PUSHED_RAD, _MOST_PUSHED_RAD), low, high)
        return q

    def _place(self, q_rad: Array) -> int:
        """Put the robot into a pose; the number of pairs near each other."""
        self._data.qpos[self._address] = q_rad
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        return int(self._data.ncon)

    def _gradients(self) -> Array:
        """(contacts, J) how each distance grows with each joint."""
        contact = self._data.contact
        body = self._model.geom_bodyid[contact.geom]
        lever = contact.pos[:, None] - self._data.xanchor[self._joint_ids]
        axis = self._data.xaxis[self._joint_ids]
        along = np.einsum("cjk,ck->cj", cross(axis[None], lever), contact.frame[:, :3])
        return along * (self._above[body[:, 1]] - self._above[body[:, 0]])

    def _touching(self, q_rad: Array, margin_m: float) -> list[tuple[int, int]]:
        if not self._place(q_rad):
            return []
        bodies = self._model.geom_bodyid[self._data.contact.geom]
        return [(int(a), int(b)) for a, b in bodies[self._data.contact.dist < margin_m]]

    def _names(self, a: int, b: int) -> tuple[str, str]:
        return str(self._model.body(a).name), str(self._model.body(b).name)

    def _near_pairs(self) -> set[tuple[str, str]]:
        """Bodies within two steps of the tree."""
        parent = self._model.body_parentid
        near: set[tuple[str, str]] = set()
        for b in range(1, self._model.nbody):
            for other in (int(o) for o in (parent[b], parent[parent[b]], *np.flatnonzero(parent == parent[b]))):
                if other != b and self._names(other, b) not in near:
                    near.add(self._names(b, other))
        return near

    def _joints_above(self) -> Array:
        """(bodies, J) 1 where a joint moves a body."""
        above = np.zeros((self._model.nbody, len(self._joint_ids)))
        for b in range(1, self._model.nbody):
            above[b] = above[self._model.body_parentid[b]]
            above[b, self._model.jnt_bodyid[self._joint_ids] == b] = 1
        return above

    def _sweeps(self) -> Array:
        """(pairs, J) metres that two bodies' shapes move against each other at most, per radian of each joint."""
        model = self._model
        reach = np.zeros((model.nbody, len(self._joint_ids)))  # of each body's shapes from each joint above it
        for b in range(1, model.nbody):
            geoms = np.flatnonzero(model.geom_bodyid == b)
            if not len(geoms):
                continue
            own = max(float(np.linalg.norm(model.geom_pos[g]) + model.geom_rbound[g]) for g in geoms)
            up, far = b, own
            while up:
                for j in np.flatnonzero(model.jnt_bodyid[self._joint_ids] == up):
                    reach[b, j] = far + float(np.linalg.norm(model.jnt_pos[self._joint_ids[j]]))
                far += float(np.linalg.norm(model.body_pos[up]))
                up = int(model.body_parentid[up])
        shaped = np.unique(model.geom_bodyid)
        rows = [
            np.where(self._above[a] == self._above[b], 0.0, np.maximum(reach[a], reach[b]))
            for i, a in enumerate(shaped) for b in shaped[:i]
        ]  # fmt: skip
        return np.unique(np.array(rows).reshape(-1, len(self._joint_ids)), axis=0)


def _spline(control: Array, segment: NDArray[np.int64], u: Array) -> Array:
    """(n, J) places on segments of a quadratic spline."""
    c0, c1, c2 = control[segment], control[segment + 1], control[segment + 2]
    u = u[:, None]
    return (c0 + c1) / 2 + (c1 - c0) * u + (c2 - 2 * c1 + c0) * (u * u / 2)
