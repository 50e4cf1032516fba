"""Waist and neck: maps the orientation of trunk and head to the joints that a robot has.

The waist takes the rotation of the chest against the pelvis. The neck takes the rotation of the head that remains above the
robot's own chest, so a robot without a waist bows with its head.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.robot.kinematics import Kinematics

Array = NDArray[np.float64]
_WAIST = ("waist_yaw", "waist_pitch", "waist_roll")
_NECK = ("head_yaw", "head_pitch", "head_roll")
_AXES = np.array([[0.0, 0, 1], [0, 1, 0], [1, 0, 0]])
"""Axes up, left, forward: positive yaw turns to the left, positive pitch bends forward, positive roll leans to the right."""


class Trunk:
    """The waist and neck joints of one robot."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._kinematics = kinematics
        self._waist, self._neck = self._joints(_WAIST), self._joints(_NECK)
        chain = [joint for _, joint, _ in self._waist]
        self._waist_chain = tuple(sorted(chain, key=lambda j: len(kinematics.chains[j])))

    def _joints(self, roles: tuple[str, ...]) -> list[tuple[int, int, float]]:
        """(index of the angle, index of the joint, sense 1 or -1) for each of `roles` that the robot has."""
        found: list[tuple[int, int, float]] = []
        for i, role in enumerate(roles):
            joint = self._kinematics.robot.joint_with_role(role)
            if joint is not None:
                found.append((i, joint, 1.0 if self._kinematics.axes[joint] @ _AXES[i] >= 0 else -1.0))
        return found

    @property
    def has_waist(self) -> bool:
        """Whether the chest moves against the base."""
        return bool(self._waist)

    def solve_waist(self, chest_rotation: Array, q_rad: Array) -> None:
        """Write the waist joints of `q_rad` (T, J) for the chest against the pelvis (T, 3, 3)."""
        self._write(self._waist, chest_rotation, q_rad)

    def solve_neck(self, head_rotation: Array, q_rad: Array) -> None:
        """Write the neck joints of `q_rad` (T, J), whose waist joints are final, for the head against the pelvis (T, 3, 3)."""
        self._write(self._neck, self.into_chest(q_rad) @ head_rotation, q_rad)

    def into_chest(self, q_rad: Array) -> Array:
        """(T, 3, 3) rotations from the robot's base to its chest; (3, 3) for a robot without a waist."""
        turned: Array = np.eye(3)
        for j in self._waist_chain:
            K = self._kinematics.skews[j]
            sine, versine = np.sin(q_rad[:, j])[:, None, None], (1 - np.cos(q_rad[:, j]))[:, None, None]
            turned = turned @ (np.eye(3) + sine * K + versine * (K @ K))
        return np.swapaxes(turned, -1, -2)

    @staticmethod
    def _write(joints: list[tuple[int, int, float]], R: Array, q_rad: Array) -> None:
        """Write yaw, pitch and roll of rotations (T, 3, 3), composed in this order."""
        if not joints:
            return
        yaw = np.arctan2(R[:, 1, 0], R[:, 0, 0])
        pitch = np.arcsin(np.minimum(np.maximum(-R[:, 2, 0], -1.0), 1.0))
        roll = np.arctan2(R[:, 2, 1], R[:, 2, 2])
        for i, joint, sense in joints:
            q_rad[:, joint] = sense * (np.unwrap(yaw) if i == 0 else (yaw, pitch, roll)[i])
