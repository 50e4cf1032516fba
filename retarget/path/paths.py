"""Paths of joints in time: a quadratic spline whose limits are those of its control points.

A uniform quadratic B-spline stays within its control points, its velocity is their difference quotient interpolated
linearly and its acceleration their second difference: a row of control points that keeps position, velocity and
acceleration bounds gives a path that keeps them at every instant, so at every bus rate.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from retarget.path.limits import within
from retarget.path.report import Comparison, RetargetReport
from retarget.path.spline_places import on_spline

Array = NDArray[np.float64]
_ROUNDING_RAD = 1e-10


@dataclass(frozen=True)
class JointState:
    """Commanded state of the joints: (J,) position and velocity."""

    position_rad: Array
    velocity_rad_s: Array


@dataclass(frozen=True)
class JointPath:
    """A path of J joints.

    Attributes:
        control_rad: (N, J) control points, one each `1 / rate_hz`; the path runs from the middle of the first two to
            the middle of the last two.
        joint_names: J names.
        rate_hz: control points per second.
        comparison: the demands of the motion, for the report.
        ends_rad: (J,) position limits, which rounding never exceeds; a path that starts outside may lie outside.
    """

    control_rad: Array
    joint_names: tuple[str, ...]
    rate_hz: float
    comparison: Comparison
    ends_rad: tuple[Array, Array] | None = None

    @cached_property
    def report(self) -> RetargetReport:
        """The changes that retargeting made, computed on first access."""
        return self.comparison.report()

    @property
    def duration_s(self) -> float:
        """Seconds from start to end."""
        return (len(self.control_rad) - 2) / self.rate_hz

    @cached_property
    def q_rad(self) -> Array:
        """(T, J) positions at `rate_hz`, the first one period after the start."""
        return (self.control_rad[1:-1] + self.control_rad[2:]) / 2

    def at_rate(self, rate_hz: float) -> Array:
        """(T, J) positions at `rate_hz`; the first is one period after the start.

        The last is just after the end when the path ends at rest, else just before it.
        """
        rests = np.array_equal(self.control_rad[-1], self.control_rad[-2])
        n = int(np.ceil(self.duration_s * rate_hz - 1e-9) if rests else np.floor(self.duration_s * rate_hz + 1e-9))
        return self.at(np.minimum(np.arange(1, n + 1) / rate_hz, self.duration_s))

    def at(self, times_s: Array) -> Array:
        """(T, J) positions at `times_s` (T,) since the start."""
        k, u = self._segment(times_s)
        c0, c1, c2 = self.control_rad[k], self.control_rad[k + 1], self.control_rad[k + 2]
        place = on_spline(self.control_rad, k, u[:, 0])
        # Rounding must not carry a path that runs along a position limit beyond it.
        place = within(place, np.minimum(np.minimum(c0, c1), c2), np.maximum(np.maximum(c0, c1), c2))
        if self.ends_rad is None:
            return place
        end = within(place, *self.ends_rad)
        return np.where(np.abs(place - end) < _ROUNDING_RAD, end, place)

    def velocity_at(self, times_s: Array) -> Array:
        """(T, J) velocities at `times_s`."""
        k, u = self._segment(times_s)
        c0, c1, c2 = self.control_rad[k], self.control_rad[k + 1], self.control_rad[k + 2]
        return ((c1 - c0) + (c2 - 2 * c1 + c0) * u) * self.rate_hz

    def _segment(self, times_s: Array) -> tuple[NDArray[np.int64], Array]:
        at = np.clip(times_s, 0, self.duration_s) * self.rate_hz
        k = np.clip(np.floor(at), 0, len(self.control_rad) - 3).astype(np.int64)
        return k, (at - k)[:, None]
