"""Self-contact: which frames of a path would make the robot touch itself.

MuJoCo's narrow phase on the description's own shapes, with a margin. Pairs that are joined by one or two joints, or
touch in the rest pose, cannot be told apart by shapes this coarse and are left out.
"""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from retarget.kinematics import load_description
from retarget.robot import RobotModel

MARGIN_M = 0.004


class SelfContact:
    """Checks joint positions of one robot."""

    def __init__(self, robot: RobotModel, margin_m: float = MARGIN_M) -> None:
        self._model = load_description(robot)
        self._data = mujoco.MjData(self._model)
        self._address = np.array([self._model.joint(name).qposadr[0] for name in robot.joint_names])
        self._model.geom_margin[:] = margin_m / 2
        self._margin_m = margin_m
        self._ignored = np.zeros((self._model.nbody, self._model.nbody), bool)
        for a, b in self._near_pairs() | set(self._touching(robot.rest_rad)):
            self._ignored[a, b] = self._ignored[b, a] = True

    def frames(self, q_rad: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(T,) whether each frame of (T, J) comes closer to itself than the margin."""
        return np.array([bool(self._touching(q)) for q in q_rad], bool)

    def pairs(self, q_rad: NDArray[np.float64]) -> list[tuple[str, str]]:
        """Names of the bodies that touch in one pose (J,)."""
        return sorted((str(self._model.body(a).name), str(self._model.body(b).name)) for a, b in self._touching(q_rad))

    def _touching(self, q_rad: NDArray[np.float64]) -> list[tuple[int, int]]:
        """Pairs of bodies nearer than the margin, ignored ones left out."""
        data = self._data
        data.qpos[self._address] = q_rad
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_collision(self._model, data)
        if not data.ncon:
            return []
        bodies = self._model.geom_bodyid[data.contact.geom]
        near = (data.contact.dist < self._margin_m) & ~self._ignored[bodies[:, 0], bodies[:, 1]]
        return [(int(a), int(b)) for a, b in bodies[near]]

    def _near_pairs(self) -> set[tuple[int, int]]:
        """Bodies within two steps of the tree."""
        parent = self._model.body_parentid
        near: set[tuple[int, int]] = set()
        for b in range(1, self._model.nbody):
            for above in (parent[b], parent[parent[b]]):
                near |= {(int(b), int(above)), (int(above), int(b))}
            for c in range(1, self._model.nbody):
                if c != b and parent[c] == parent[b]:
                    near.add((b, c))
        return near
