"""Slow point-to-point moves: from where the robot stands to rest, and to park. Jerk-limited, by ruckig."""

from __future__ import annotations

# ruckig is a compiled module without types:
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
import numpy as np
from numpy.typing import NDArray
from ruckig import InputParameter, Result, Ruckig, Trajectory

from retarget.limits import JointLimits

Array = NDArray[np.float64]
SPEED_RAD_S = 0.9
ACCELERATION_RAD_S2 = 3.0
JERK_RAD_S3 = 20.0


class Approach:
    """A move of all joints at once, each slower than its own limits, arriving together."""

    def __init__(self, start_rad: Array, goal_rad: Array, limits: JointLimits) -> None:
        n = len(start_rad)
        request = InputParameter(n)
        request.current_position, request.target_position = start_rad.tolist(), goal_rad.tolist()
        request.max_velocity = np.minimum(SPEED_RAD_S, 0.5 * limits.velocity_rad_s).tolist()
        request.max_acceleration = np.minimum(ACCELERATION_RAD_S2, 0.5 * limits.acceleration_rad_s2).tolist()
        request.max_jerk = [JERK_RAD_S3] * n
        self._trajectory = Trajectory(n)
        result = Ruckig(n).calculate(request, self._trajectory)
        if result not in (Result.Working, Result.Finished):
            raise ValueError(f"no way from {start_rad} to {goal_rad}: {result}")

    @property
    def duration_s(self) -> float:
        """Time the move takes."""
        return float(self._trajectory.duration)

    def at(self, t_s: float) -> Array:
        """(J,) position at `t_s` since its start."""
        position, _, _ = self._trajectory.at_time(min(t_s, self.duration_s))
        return np.array(position)
