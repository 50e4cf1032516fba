"""Self-contact by MuJoCo's own pipeline on a separate model: an independent check of the retargeter."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.robot.robot import RobotModel

mujoco: Any = importlib.import_module("mujoco")


class ContactCheck:
    """Counts frames in which bodies of a robot touch.

    Bodies two joints apart, or side by side on one parent, overlap by design in shapes this coarse and do not count;
    nor do bodies that touch in the rest pose.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._model = mujoco.MjModel.from_xml_path(str(robot.description_path))
        self._data = mujoco.MjData(self._model)
        self._address = [self._model.joint(name).qposadr[0] for name in robot.joint_names]
        self._resting = self.touching(robot.rest_rad)

    def frames(self, q_rad: NDArray[np.float64]) -> int:
        """Number of poses (T, J) in self-contact."""
        return sum(bool(self.touching(q) - self._resting) for q in q_rad)

    def touching(self, q_rad: NDArray[np.float64]) -> set[tuple[int, int]]:
        """Pairs of bodies that touch in the pose (J,)."""
        self._data.qpos[self._address] = q_rad
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        found: set[tuple[int, int]] = set()
        for contact in self._data.contact:
            if contact.dist < 0:
                a, b = sorted(int(self._model.geom_bodyid[g]) for g in contact.geom)
                if not self._near(a, b):
                    found.add((a, b))
        return found

    def _near(self, a: int, b: int) -> bool:
        parent = self._model.body_parentid
        above_a, above_b = {int(parent[a]), int(parent[parent[a]])}, {int(parent[b]), int(parent[parent[b]])}
        return a in above_b or b in above_a or int(parent[a]) == int(parent[b])
