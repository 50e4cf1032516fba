"""What matters of poses, for the limiter: bone directions for arms, angles for the rest.

Directions are linearised around poses: the wish itself first, then where the limits led.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from retarget.human.arms import Arms
from retarget.path.limit_path import Angles, Importance

Array = NDArray[np.float64]
_LEAST = 1e-4
"""Weight of a joint's own angle, so that an unseen joint too has somewhere to go."""
_LED_WEIGHT = 3.0
_LED_RAD = 1e-6
"""Weight of the way in which a pose was led round a contact, against one radian of direction error; least such way."""


class ArmMatters:
    """What matters of the arms of one kind in T frames."""

    def __init__(self, arms: Arms, joints: NDArray[np.int64], q_rad: Array, led_rad: Array) -> None:
        """Take the wish.

        Args:
            arms: G arms.
            joints: (G, n) their joints.
            q_rad: (T, J) the poses wished for.
            led_rad: (T, J) how they were led round contacts.
        """
        self._arms, self._joints = arms, joints
        self._wish = q_rad[:, joints].transpose(1, 0, 2)
        self._bones = arms.bones(self._wish)
        led = led_rad[:, joints].transpose(1, 0, 2)
        self._angles = _LEAST * np.eye(arms.n_joints)  # weight of angles, or of each frame's
        length = np.linalg.norm(led, axis=-1, keepdims=True)
        if (length > _LED_RAD).any():
            way = np.where(length > _LED_RAD, led / np.maximum(length, _LED_RAD), 0.0)
            self._angles = self._angles + _LED_WEIGHT * way[..., None] * way[..., None, :]

    def around(self, first: int, q_rad: Array | None) -> Importance:
        """As `following.Matters`, of these arms."""
        if q_rad is None:
            frames = slice(first, None)
            hessian = self._bones.hessian()[:, frames] + self._of(frames)
            return Importance(self._joints, hessian, (hessian @ self._wish[:, frames, :, None])[..., 0])
        frames, at = slice(first, first + len(q_rad)), q_rad[:, self._joints].transpose(1, 0, 2)
        bones, angles = self._arms.bones(at), self._of(frames)
        seen = bones.hessian()
        linear = bones.towards(self._bones.upper[:, frames], self._bones.fore[:, frames])
        linear += ((seen @ at[..., None]) + angles @ self._wish[:, frames, :, None])[..., 0]
        return Importance(self._joints, seen + angles, linear)

    def _of(self, frames: slice) -> Array:
        return self._angles if self._angles.ndim == 2 else self._angles[:, frames]


class PoseMatters:
    """What matters of all joints of a robot."""

    def __init__(self, arms: Sequence[ArmMatters], others: Angles | None) -> None:
        self._arms, self._others = arms, others

    def around(self, first: int, q_rad: Array | None) -> Sequence[Importance]:
        """As `following.Matters`."""
        groups = [arms.around(first, q_rad) for arms in self._arms]
        return groups if self._others is None else [*groups, *self._others.around(first, q_rad)]
