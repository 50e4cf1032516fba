"""Slow moves along straight lines in joint space: from the present pose to rest, and to park. Jerk-limited, by ruckig."""

from __future__ import annotations

# ruckig is a compiled module without types:
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownParameterType=false
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from ruckig import InputParameter, Result, Ruckig, Synchronization, Trajectory

from retarget.path.limits import JointLimits

Array = NDArray[np.float64]
SPEED_RAD_S = 0.9
ACCELERATION_RAD_S2 = 3.0
JERK_RAD_S3 = 20.0


class PtpTrajectory:
    """A move of all joints at once along straight lines, at rest at the end of each; every joint keeps below its limits.

    Args:
        way_rad: poses (J,) to pass through; the first is the present one.
        limits: limits of the joints.

    Raises:
        ValueError: ruckig finds no trajectory, e.g. for a pose that is not finite.
    """

    def __init__(self, way_rad: Sequence[Array], limits: JointLimits) -> None:
        self._lines = [_line(a, b, limits) for a, b in pairwise(way_rad)]

    @property
    def duration_s(self) -> float:
        """Seconds that the move takes."""
        return float(sum(line.duration for line in self._lines))

    def at(self, t_s: float) -> Array:
        """(J,) position at `t_s` since its start."""
        for line in self._lines[:-1]:
            if t_s <= line.duration:
                break
            t_s -= line.duration
        else:
            line = self._lines[-1]
        position, _, _ = line.at_time(min(t_s, line.duration))
        return np.array(position)


def _line(start_rad: Array, goal_rad: Array, limits: JointLimits) -> Trajectory:
    n = len(start_rad)
    request = InputParameter(n)
    request.synchronization = Synchronization.Phase  # joints in step: the path is straight
    request.current_position, request.target_position = start_rad.tolist(), goal_rad.tolist()
    request.max_velocity = np.minimum(SPEED_RAD_S, 0.5 * limits.velocity_rad_s).tolist()
    request.max_acceleration = np.minimum(ACCELERATION_RAD_S2, 0.5 * limits.acceleration_rad_s2).tolist()
    request.max_jerk = [JERK_RAD_S3] * n
    trajectory = Trajectory(n)
    result = Ruckig(n).calculate(request, trajectory)
    if result not in (Result.Working, Result.Finished):
        raise ValueError(f"no way from {start_rad} to {goal_rad}: {result}")
    return trajectory
