"""Joints to servo ticks and back: direction, gear, zero, resolution, linkages, differentials, several servos on a joint.

Sums over few terms are used, not matrix products, so that equal joints give equal bits in a batch and alone.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]


class JointServoMap:
    """The map of a robot's J joints to its S servos' position ticks, with the limits in servo space.

    Attributes:
        zero_tick: (S,) ticks of the servos where their joints are at 0 (before any linkage).
        position_range_rad: (J,) and (J,) ends of the range in which rounding to the nearest tick never leaves the joints'
            limits. A joint with servos of its own ends at whole ticks; a joint of a differential ends half a tick of each
            servo before its limits.
        position_min_tick, position_max_tick: (S,) ticks of this range.
        velocity_limit_tick_s, acceleration_limit_tick_s2: (S,) servo limits if all joints move at their limits at once.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._robot = robot
        self.zero_tick: Array = np.array([s.zero_tick for s in robot.servos], np.float64)
        self.ticks_per_rad: Array = np.array([s.ticks_per_rad for s in robot.servos])
        self._linkages = [(i, s.linkage) for i, s in enumerate(robot.servos) if s.linkage is not None]
        forward = [list(s.couplings) for s in robot.servos]
        self._joint, self._coupling = _padded(forward)
        self._servo, self._share = _padded(_inverse(forward, robot.n_joints))
        self._straight = forward == [[(j, 1.0)] for j in range(robot.n_joints)]  # servo j on joint j: nothing to sum
        self.position_range_rad = self._range_rad()
        corners = self._extremes_tick(*self.position_range_rad)
        self.position_min_tick: NDArray[np.int32] = np.rint(corners[0]).astype(np.int32)
        self.position_max_tick: NDArray[np.int32] = np.rint(corners[1]).astype(np.int32)

    def to_ticks(self, q_rad: Array) -> Array:
        """(..., J) radians -> (..., S) ticks, not rounded."""
        angle = q_rad.copy() if self._straight else (q_rad[..., self._joint] * self._coupling).sum(-1)
        for i, linkage in self._linkages:
            angle[..., i] = linkage.to_servo(angle[..., i])
        return angle * self.ticks_per_rad + self.zero_tick

    def rad_to_tick(self, q_rad: Array) -> NDArray[np.int32]:
        """(..., J) radians -> (..., S) nearest ticks, never beyond the last whole tick inside a position limit."""
        ticks = np.rint(self.to_ticks(q_rad)).astype(np.int32)
        return np.clip(ticks, self.position_min_tick, self.position_max_tick, dtype=np.int32)

    def tick_to_rad(self, ticks: NDArray[np.integer] | Array) -> Array:
        """(..., S) ticks -> (..., J) radians; where several servos drive a joint, the mean of their angles."""
        angle = (ticks - self.zero_tick) / self.ticks_per_rad
        for i, linkage in self._linkages:
            angle[..., i] = linkage.to_joint(angle[..., i])
        return angle if self._straight else (angle[..., self._servo] * self._share).sum(-1)

    @cached_property
    def velocity_limit_tick_s(self) -> Array:
        """(S,) largest speed of each servo while all its joints move at their limits."""
        steepest = self._of_linkage("steepest", 1.0)
        joints = self._robot.velocity_limit_rad_s[self._joint]
        return (joints * np.abs(self._coupling)).sum(-1) * steepest * np.abs(self.ticks_per_rad)

    @cached_property
    def acceleration_limit_tick_s2(self) -> Array:
        """(S,) largest acceleration of each servo; a linkage adds its curvature times the speed squared."""
        coupling = np.abs(self._coupling)
        speed = (self._robot.velocity_limit_rad_s[self._joint] * coupling).sum(-1)
        acceleration = (self._robot.acceleration_limit_rad_s2[self._joint] * coupling).sum(-1)
        bent = acceleration * self._of_linkage("steepest", 1.0) + self._of_linkage("curvature", 0.0) * speed**2
        return bent * np.abs(self.ticks_per_rad)

    def _of_linkage(self, name: str, plain: float) -> Array:
        values = np.full(len(self.zero_tick), plain)
        for i, linkage in self._linkages:
            values[i] = getattr(linkage, name)
        return values

    def _range_rad(self) -> tuple[Array, Array]:
        robot = self._robot
        low, high = robot.position_min_rad.copy(), robot.position_max_rad.copy()
        half_tick_rad = 0.5 / np.abs(self.ticks_per_rad)
        ends = np.stack(self._extremes_tick(low, high))
        whole = self._joint_angle(np.stack([np.ceil(ends[0] - _WHOLE), np.floor(ends[1] + _WHOLE)]))  # (2, S) of servos
        for j in range(robot.n_joints):
            servos = [(int(i), float(c)) for i, c in zip(self._servo[j], self._share[j], strict=True) if c != 0]
            if all(len(robot.servos[i].couplings) == 1 for i, _ in servos):
                low[j] = max(whole[:, i].min() for i, _ in servos)
                high[j] = min(whole[:, i].max() for i, _ in servos)
            else:
                lost = sum(abs(c) * half_tick_rad[i] for i, c in servos)
                low[j], high[j] = low[j] + lost, high[j] - lost
        return low, high

    def _joint_angle(self, ticks: Array) -> Array:
        """(..., S) angle of its own joint, in radians, for the ticks of each servo alone."""
        angle = (ticks - self.zero_tick) / self.ticks_per_rad
        for i, linkage in self._linkages:
            angle[..., i] = linkage.to_joint(angle[..., i])
        return angle

    def _extremes_tick(self, low_rad: Array, high_rad: Array) -> tuple[Array, Array]:
        """(S,) least and most ticks over a box of poses."""
        ends = np.stack([low_rad[self._joint] * self._coupling, high_rad[self._joint] * self._coupling])
        angle = np.stack([ends.min(0).sum(-1), ends.max(0).sum(-1)])
        for i, linkage in self._linkages:
            angle[:, i] = linkage.to_servo(angle[:, i])
        ticks = angle * self.ticks_per_rad + self.zero_tick
        return ticks.min(0), ticks.max(0)


_WHOLE = 1e-9
"""Ticks of rounding within which a limit counts as lying on a whole tick."""
_Terms = list[list[tuple[int, float]]]


def _padded(terms: _Terms) -> tuple[NDArray[np.intp], Array]:
    """(N, K) indices and coefficients of sums of at most K terms; missing ones have coefficient 0."""
    most = max(len(row) for row in terms)
    index, coefficient = np.zeros((len(terms), most), np.intp), np.zeros((len(terms), most))
    for n, row in enumerate(terms):
        for k, (i, c) in enumerate(row):
            index[n, k], coefficient[n, k] = i, c
    return index, coefficient


def _inverse(forward: _Terms, n_joints: int) -> _Terms:
    """For each joint its angle as a sum over servos: the least-squares inverse of each group of coupled joints and servos."""
    matrix = np.zeros((len(forward), n_joints))
    for s, row in enumerate(forward):
        for j, c in row:
            matrix[s, j] = c
    terms: _Terms = []
    for j in range(n_joints):
        joints = sorted({i for row in forward if any(i == j for i, _ in row) for i, _ in row})
        servos = [s for s, row in enumerate(forward) if any(i in joints for i, _ in row)]
        if len(joints) == 1:
            terms.append([(s, 1.0 / (len(servos) * matrix[s, j])) for s in servos])
            continue
        inverse = np.linalg.inv(matrix[np.ix_(servos, joints)])[joints.index(j)]
        terms.append([(s, float(c)) for s, c in zip(servos, inverse, strict=True) if abs(c) > 1e-12])
    return terms
