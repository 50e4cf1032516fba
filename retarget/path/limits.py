"""Position, velocity and acceleration limits, kept exactly, one step at a time.

Bounds are meant as finite differences at the step period: |q[k] - q[k-1]| <= v dt and |q[k] - 2 q[k-1] + q[k-2]| <=
a dt^2, with q always inside its range. To stay inside, a joint must also always be able to brake in time: with velocity
v = (n + s) a dt it needs dt (v + (v - a dt) + ...) to stop, so the largest velocity towards a limit at distance g is

    n = floor((sqrt(1 + 8 g / (a dt^2)) - 1) / 2),    v_max = (g / dt + a dt n (n + 1) / 2) / (n + 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]
SLACK = 1e-9
"""Relative slack within which a step counts as inside its bounds: rounding of sums, far below a tick."""
_ROUNDING_RAD = 1e-12
"""Radians outside a position limit within which the end of a step was meant to be on it."""


@dataclass(frozen=True)
class JointLimits:
    """(J,) bounds of each joint; positions end at the last whole tick inside the robot's limits."""

    position_min_rad: Array
    position_max_rad: Array
    velocity_rad_s: Array
    acceleration_rad_s2: Array

    @classmethod
    def of(cls, robot: RobotModel) -> JointLimits:
        """The limits of a robot."""
        low, high = JointServoMap(robot).position_range_rad
        return cls(low, high, robot.velocity_limit_rad_s, robot.acceleration_limit_rad_s2)


def stopping_velocity_rad_s(gap_rad: Array, acceleration_rad_s2: Array, period_s: float) -> Array:
    """Largest velocity of the next step from which a joint can stop within `gap_rad`; see the module's formula."""
    gap = np.maximum(gap_rad, 0.0)
    step = acceleration_rad_s2 * period_s  # velocity lost in one period of braking
    n = np.floor((np.sqrt(1.0 + 8.0 * gap / (step * period_s)) - 1.0) / 2.0)
    return (gap / period_s + step * n * (n + 1.0) / 2.0) / (n + 1.0)


def limit_step(
    target_rad: Array,
    position_rad: Array,
    velocity_rad_s: Array,
    limits: JointLimits,
    period_s: float,
    target_velocity_rad_s: Array | None = None,
) -> Array:
    """(J,) next position: `target_rad` where it can be reached in this step, else the nearest the limits allow.

    A target inside every bound is returned bit for bit; one outside the range counts as the end of the range. One
    further away is approached as fast as allowed, slow enough to stop there (or to meet it at `target_velocity_rad_s`).
    A joint outside its range moves back at full braking.

    Args:
        target_rad: target position after this step.
        position_rad: last commanded position.
        velocity_rad_s: the last step divided by the period.
        limits: bounds.
        period_s: step period.
        target_velocity_rad_s: velocity of the target after this step; None for a target at rest.
    """
    a, v_max = limits.acceleration_rad_s2, limits.velocity_rad_s
    ends = limits.position_min_rad, limits.position_max_rad
    target_rad = within(target_rad, *ends)
    gap = target_rad - position_rad
    follow = None if target_velocity_rad_s is None else np.clip(target_velocity_rad_s, -v_max, v_max)
    error = gap if follow is None else gap - follow * period_s
    gaps = np.array([limits.position_max_rad - position_rad, position_rad - limits.position_min_rad, np.abs(error)])
    up, down, catch_up = stopping_velocity_rad_s(gaps, a, period_s)
    high = np.minimum(np.minimum(velocity_rad_s + a * period_s, v_max), up)
    low = np.maximum(np.maximum(velocity_rad_s - a * period_s, -v_max), -down)
    # A start that no braking can keep inside (too fast, or outside): brake as hard as the acceleration allows.
    high = np.maximum(high, velocity_rad_s - a * period_s)
    low = np.minimum(low, velocity_rad_s + a * period_s)
    direct = gap / period_s
    slack = SLACK * (v_max + a * period_s)
    reached = (direct <= high + slack) & (direct >= low - slack)
    wanted = np.sign(error) * np.minimum(catch_up, np.abs(error) / period_s)
    if follow is not None:
        wanted += follow
        reached &= np.abs(direct - follow) <= a * period_s
    following = position_rad + within(wanted, low, high) * period_s
    end = within(following, *ends)
    following = np.where(np.abs(following - end) < _ROUNDING_RAD, end, following)
    return np.where(reached, target_rad, following)


def within(values: Array, low: Array | float, high: Array | float) -> Array:
    """The result of `np.clip`, computed three times as fast for the few joints of a robot."""
    return np.minimum(np.maximum(values, low), high)


def keeps(
    target_rad: Array,
    position_rad: Array,
    velocity_rad_s: Array,
    limits: JointLimits,
    period_s: float,
    target_velocity_rad_s: Array,
) -> NDArray[np.bool_]:
    """(...) whether `limit_step` with these arguments reaches the target."""
    a, v_max = limits.acceleration_rad_s2 * period_s, limits.velocity_rad_s
    low_end, high_end = limits.position_min_rad, limits.position_max_rad
    gaps = np.stack([high_end - position_rad, position_rad - low_end])
    up, down = stopping_velocity_rad_s(gaps, limits.acceleration_rad_s2, period_s)
    slower, faster = velocity_rad_s - a, velocity_rad_s + a
    high = np.maximum(np.minimum(np.minimum(faster, v_max), up), slower)
    low = np.minimum(np.maximum(np.maximum(slower, -v_max), -down), faster)
    direct, slack = (target_rad - position_rad) / period_s, SLACK * (v_max + a)
    follow = within(target_velocity_rad_s, -v_max, v_max)
    kept = (direct <= high + slack) & (direct >= low - slack) & (np.abs(direct - follow) <= a)
    return kept & (target_rad >= low_end) & (target_rad <= high_end)


def brake(position_rad: Array, velocity_rad_s: Array, limits: JointLimits, period_s: float) -> Array:
    """(J,) next position when stopping as fast as the acceleration allows."""
    loss = limits.acceleration_rad_s2 * period_s
    slower = np.sign(velocity_rad_s) * np.maximum(np.abs(velocity_rad_s) - loss, 0.0)
    return limit_step(position_rad + slower * period_s, position_rad, velocity_rad_s, limits, period_s)
