"""Linkage of rods between a servo and its joint: the servo's angle as a smooth function of the joint's, with its inverse.

A monotone cubic (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980) joins the few rows of a table and is sampled finely once.
Both directions interpolate linearly between these samples, so each is the inverse of the other up to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_SAMPLES_PER_ROW = 64


@dataclass(frozen=True)
class Linkage:
    """Strictly monotone samples (N,) of joint and servo angle."""

    joint_rad: Array
    servo_rad: Array

    @classmethod
    def of_table(cls, joint_rad: Array, servo_rad: Array) -> Linkage:
        """The smooth curve through a table: joint angles rising, servo angles strictly monotone, at least 3 rows."""
        step = np.diff(joint_rad)
        slope = np.diff(servo_rad) / step
        tangent = np.concatenate([slope[:1], (slope[1:] + slope[:-1]) / 2, slope[-1:]])
        # Within three times either neighbouring slope the cubic stays monotone.
        bound = 3 * np.minimum(np.abs(np.append(slope[:1], slope)), np.abs(np.append(slope, slope[-1:])))
        tangent = np.sign(slope[0]) * np.minimum(np.abs(tangent), bound)
        u = np.linspace(0, 1, _SAMPLES_PER_ROW, endpoint=False)
        joint = joint_rad[:-1, None] + step[:, None] * u
        servo = (
            (1 + 2 * u) * (1 - u) ** 2 * servo_rad[:-1, None]
            + u * (1 - u) ** 2 * step[:, None] * tangent[:-1, None]
            + u**2 * (3 - 2 * u) * servo_rad[1:, None]
            + u**2 * (u - 1) * step[:, None] * tangent[1:, None]
        )
        return cls(np.append(joint.ravel(), joint_rad[-1]), np.append(servo.ravel(), servo_rad[-1]))

    def to_servo(self, joint_rad: Array) -> Array:
        """Servo angles for joint angles; beyond the table the curve continues in a straight line."""
        return _straight_on(joint_rad, self.joint_rad, self.servo_rad)

    def to_joint(self, servo_rad: Array) -> Array:
        """Joint angles for servo angles; beyond the table the curve continues in a straight line.

        A servo found beyond the table therefore has a joint angle of its own, from which the motion starts. Clipped to the end of
        the table, the servo would jump there with its first goal.
        """
        if self.servo_rad[0] > self.servo_rad[-1]:
            return _straight_on(servo_rad, self.servo_rad[::-1], self.joint_rad[::-1])
        return _straight_on(servo_rad, self.servo_rad, self.joint_rad)

    @property
    def steepest(self) -> float:
        """Largest speed of the servo for a unit speed of the joint."""
        return float(np.abs(self._slope()).max())

    @property
    def curvature(self) -> float:
        """Largest second derivative of the servo's angle by the joint's angle."""
        middle = (self.joint_rad[1:] + self.joint_rad[:-1]) / 2
        return float(np.abs(np.diff(self._slope()) / np.diff(middle)).max())

    def _slope(self) -> Array:
        return np.diff(self.servo_rad) / np.diff(self.joint_rad)


def _straight_on(x: Array, xs: Array, ys: Array) -> Array:
    """Values at `x` between the samples (N,) of a curve, and on straight lines beyond them; `xs` rises."""
    first, last = (ys[1] - ys[0]) / (xs[1] - xs[0]), (ys[-1] - ys[-2]) / (xs[-1] - xs[-2])
    return np.interp(x, xs, ys) + first * np.minimum(x - xs[0], 0.0) + last * np.maximum(x - xs[-1], 0.0)
