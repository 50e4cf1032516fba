"""Control points of a spline: near given frames, while braking and holding, and after a start close to a position limit."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from retarget.path.bounded_poses import braking_points
from retarget.path.limit_path import SETTLED_RAD, Objective, limit_path
from retarget.path.limits import JointLimits, brake, limit_step, stopping_velocity_rad_s

Array = NDArray[np.float64]


def controls_near(frames: Array, before: Array) -> Array:
    """(T, J) control points whose spline passes near frames (T, J): the spline's own smoothing undone to fourth order.

    The path is at frame t half way between two control points, so these are for the times between frames; `before`
    (1, J) is the frame before the first.
    """
    more = np.concatenate([before, frames, frames[-1:], frames[-1:]])
    return (5 * (more[1:-2] + more[2:-1]) - more[:-3] - more[3:]) / 8


def held(control: Array, period: float, n: int, limits: JointLimits) -> Array:
    """At least `n` control points: `control`, brake, and hold."""
    points = list(control)
    while len(points) < n or not np.array_equal(points[-1], points[-2]):
        points.append(brake(points[-1], (points[-1] - points[-2]) / period, limits, period))
    return np.array(points)


def braking(control: Array, period: float, limits: JointLimits) -> Array:
    """(n, J) control points after `control` when every joint stops as fast as its acceleration allows."""
    return braking_points(control, limits.acceleration_rad_s2 * period**2)


def joined(
    wanted: Array, before: Array, position: Array, period: float, limits: JointLimits,
    objective_from: Callable[[int], Objective], settled_rad: float = SETTLED_RAD,
) -> Array:  # fmt: skip
    """(T + 1, J) control points from the second, `position`, on, near `wanted` (T, J).

    `objective_from` gives the objective from a frame on; `settled_rad` is that of `limit_path`. A joint that begins with just
    enough room to brake has its next control points at or beyond the position limit, although its path stays inside; until there
    is room for whole steps the joint brakes as hard as its path needs.
    """
    points = [before, position]
    for k in range(len(wanted)):
        velocity = (points[-1] - points[-2]) / period
        end = np.where(velocity > 0, limits.position_max_rad, limits.position_min_rad)
        toward = np.sign(velocity)
        room = stopping_velocity_rad_s(toward * (end - points[-1]), limits.acceleration_rad_s2, period)
        short = np.abs(velocity) - limits.acceleration_rad_s2 * period > room
        short |= toward * (points[-1] - end) > 0
        if not short.any():
            rest = limit_path(wanted[k:], points[-1], velocity, limits, period, partial(objective_from, k), settled_rad)
            return np.concatenate([points[1:], rest])
        gap = np.maximum(toward * (end - (points[-1] + points[-2]) / 2), 1e-12)
        braking_rad_s2 = np.minimum(velocity**2 / (2 * gap), limits.acceleration_rad_s2)
        inward = points[-1] + velocity * period - toward * braking_rad_s2 * period**2
        points.append(np.where(short, inward, limit_step(wanted[k], points[-1], velocity, limits, period)))
    return np.array(points[1:])


def hits_of_frames(hit: NDArray[np.bool_], n: int) -> NDArray[np.bool_]:
    """(n - 2,) touching segments of n control points; a contact while braking after them is assigned to the last segment."""
    of = hit[: n - 2].copy()
    of[-1] |= hit[n - 2 :].any()
    return of
