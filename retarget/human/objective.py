"""The objective of poses for the limiter: bone directions for arms, angles for the other joints.

Directions are linearised around poses: first around the wanted poses, then around the solutions inside the limits.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from retarget.human.arms import Arms
from retarget.path.limit_path import Angles, QuadraticCost

Array = NDArray[np.float64]
_LEAST = 1e-4
"""Weight of a joint's own angle, so that an unobservable joint has a target too."""
_LED_WEIGHT = 3.0
_LED_RAD = 1e-6
"""Weight of the displacement by which a pose was pushed out of a contact, against one radian of direction error; and the least
displacement in radians that counts."""


class ArmObjective:
    """The objective of the arms of one kind in T frames."""

    def __init__(self, arms: Arms, joints: NDArray[np.int64], q_rad: Array, led_rad: Array) -> None:
        """Linearise the directions around the wanted poses.

        Args:
            arms: G arms.
            joints: (G, n) indices of their joints.
            q_rad: (T, J) wanted poses.
            led_rad: (T, J) displacements by which the poses were pushed out of contacts.
        """
        self._arms, self._joints = arms, joints
        self._target_rad = q_rad[:, joints].transpose(1, 0, 2)
        self._bones = arms.bones(self._target_rad)
        led = led_rad[:, joints].transpose(1, 0, 2)
        self._angles = _LEAST * np.eye(arms.n_joints)  # (n, n), or (G, T, n, n) with pushes
        length = np.linalg.norm(led, axis=-1, keepdims=True)
        if (length > _LED_RAD).any():
            way = np.where(length > _LED_RAD, led / np.maximum(length, _LED_RAD), 0.0)
            self._angles = self._angles + _LED_WEIGHT * way[..., None] * way[..., None, :]

    def around(self, first: int, q_rad: Array | None) -> QuadraticCost:
        """The cost of these arms; see `Objective`."""
        if q_rad is None:
            frames = slice(first, None)
            hessian = self._bones.hessian()[:, frames] + self._of(frames)
            return QuadraticCost(self._joints, hessian, (hessian @ self._target_rad[:, frames, :, None])[..., 0])
        frames, at = slice(first, first + len(q_rad)), q_rad[:, self._joints].transpose(1, 0, 2)
        bones, angles = self._arms.bones(at), self._of(frames)
        curvature = bones.hessian()
        linear = bones.towards(self._bones.upper[:, frames], self._bones.fore[:, frames])
        linear += ((curvature @ at[..., None]) + angles @ self._target_rad[:, frames, :, None])[..., 0]
        return QuadraticCost(self._joints, curvature + angles, linear)

    def _of(self, frames: slice) -> Array:
        return self._angles if self._angles.ndim == 2 else self._angles[:, frames]


class PoseObjective:
    """The objective of all joints of a robot."""

    def __init__(self, arms: Sequence[ArmObjective], others: Angles | None) -> None:
        self._arms, self._others = arms, others

    def around(self, first: int, q_rad: Array | None) -> Sequence[QuadraticCost]:
        """The costs of all groups; see `Objective`."""
        groups = [arms.around(first, q_rad) for arms in self._arms]
        return groups if self._others is None else [*groups, *self._others.around(first, q_rad)]
