"""Joints to servo ticks and back: direction, gear, zero, resolution."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from retarget.robot import RobotModel


class JointServoMap:
    """The linear map of a robot's joints to its servos' position ticks, with the limits in servo space."""

    def __init__(self, robot: RobotModel) -> None:
        scale = [s.direction * s.gear_ratio * s.model.ticks_per_turn / (2 * math.pi) for s in robot.servos]
        self.ticks_per_rad: NDArray[np.float64] = np.array(scale)
        self.zero_tick: NDArray[np.float64] = np.array([s.zero_tick for s in robot.servos], np.float64)
        ends = np.stack([self.to_ticks(robot.position_min_rad), self.to_ticks(robot.position_max_rad)])
        self.position_min_tick: NDArray[np.int32] = np.ceil(ends.min(0)).astype(np.int32)
        self.position_max_tick: NDArray[np.int32] = np.floor(ends.max(0)).astype(np.int32)
        self.velocity_limit_tick_s = robot.velocity_limit_rad_s * np.abs(self.ticks_per_rad)
        self.acceleration_limit_tick_s2 = robot.acceleration_limit_rad_s2 * np.abs(self.ticks_per_rad)

    def to_ticks(self, q_rad: NDArray[np.float64]) -> NDArray[np.float64]:
        """(..., J) radians -> (..., S) ticks, not rounded."""
        return q_rad * self.ticks_per_rad + self.zero_tick

    def rad_to_tick(self, q_rad: NDArray[np.float64]) -> NDArray[np.int32]:
        """(..., J) radians -> (..., S) nearest ticks, never beyond the last whole tick inside a position limit."""
        ticks = np.rint(self.to_ticks(q_rad)).astype(np.int32)
        return np.clip(ticks, self.position_min_tick, self.position_max_tick, dtype=np.int32)

    def tick_to_rad(self, ticks: NDArray[np.integer]) -> NDArray[np.float64]:
        """(..., S) ticks -> (..., J) radians."""
        return (ticks - self.zero_tick) / self.ticks_per_rad
