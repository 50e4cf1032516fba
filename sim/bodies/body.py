"""The contract of a body, which the servos move, and the plain body, in which every shaft turns independently.

Angles are those of the servos' output shafts, in radians from tick 0, so that a body knows no registers. With the plain
body a servo carries nothing but its own rotor: without profile it follows a goal with about a first-order lag.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim.bodies.motors import Motor

Array = NDArray[np.float64]


class Body(Protocol):
    """Shafts that turn under the servos' torques."""

    position_rad: Array
    """(S,) angle of each shaft; write it only while nothing steps."""
    velocity_rad_s: Array
    """(S,) velocity of each shaft, rad/s."""

    @property
    def at_rest(self) -> bool:
        """Whether every shaft would stay where it is under unchanged torques."""
        ...

    @property
    def self_contacts(self) -> int:
        """Number of steps so far in which the robot touched itself."""
        ...

    def step(self, torque_nm: Array, blocked: NDArray[np.bool_], step_s: float) -> None:
        """Advance by `step_s` seconds under (S,) torques; a blocked shaft does not turn."""
        ...

    def place(self, shaft: int, position_rad: float) -> None:
        """Set one shaft to a position, at rest."""
        ...

    def push(self, joint: int | None, amount: float) -> None:
        """Set an external torque (N m) on one shaft, on all when None; it stays until the next call."""
        ...


class PlainBody:
    """Independent shafts, each with its rotor's inertia and friction."""

    self_contacts = 0

    def __init__(self, motors: Sequence[Motor], position_rad: Array) -> None:
        self.position_rad = np.array(position_rad, np.float64)
        self.velocity_rad_s: Array = np.zeros(len(motors))
        self._per_inertia: Array = 1.0 / np.array([m.inertia_kg_m2 for m in motors])
        self._friction_nm: Array = np.array([m.friction_nm for m in motors])
        self._damping: Array = np.array([m.damping_nm_s_per_rad for m in motors])
        self._push_nm: Array = np.zeros(len(motors))

    @property
    def at_rest(self) -> bool:
        """Whether no shaft turns and friction held all of them in the last step."""
        return not np.count_nonzero(self.velocity_rad_s)

    def step(self, torque_nm: Array, blocked: NDArray[np.bool_], step_s: float) -> None:
        """Integrate by semi-implicit Euler; friction may stop a shaft but never reverse it."""
        rate = self._per_inertia * step_s
        velocity = self.velocity_rad_s + (torque_nm + self._push_nm - self._damping * self.velocity_rad_s) * rate
        slowed = np.maximum(np.abs(velocity) - self._friction_nm * rate, 0.0)
        self.velocity_rad_s = np.copysign(slowed, velocity)
        if np.count_nonzero(blocked):
            self.velocity_rad_s[blocked] = 0.0
        self.position_rad = self.position_rad + self.velocity_rad_s * step_s

    def place(self, shaft: int, position_rad: float) -> None:
        """Set one shaft to a position, at rest."""
        self.position_rad[shaft] = position_rad
        self.velocity_rad_s[shaft] = 0.0

    def push(self, joint: int | None, amount: float) -> None:
        """Set an external torque in N m on one shaft, or on all."""
        self._push_nm[slice(None) if joint is None else joint] = amount
