"""Arms in closed form: joint angles from the directions of upper arm and forearm.

Families by the joints from chest to elbow, found in the description, with any axes, signs, order and zero pose:

- three shoulder axes and an elbow (arms of 4 to 7 joints): the angle between the bones gives the elbow, two ways; the
  shoulder's rotation then follows from both directions and splits into its three angles, two ways (Paden-Kahan
  subproblems; Murray, Li, Sastry 1994, sec. 3.2). Any pair of directions is reached, in up to four ways.
- two shoulder axes and an elbow (3 joints), one and an elbow, or two without an elbow (2 joints): most pairs cannot be
  reached. From several closed-form starts Gauss-Newton steps within the limits find the least weighted error.

`branches` picks among the ways. Where axes do not meet or bones lie beside them, the directions follow the true points
and a few damped steps take up what the closed form left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.kinematics import Kinematics, cross, rotate, skew

Array = NDArray[np.float64]
UPPER_WEIGHT, FORE_WEIGHT = 1.0, 1.0
_LEAST_ERROR_STEPS, _OFFSET_STEPS = 7, 3
_DAMPING = 1e-3
_LARGEST_STEP_RAD = 0.6
_LIMIT_COST, _ERROR_COST = 1.0, 4.0
"""Per radian outside a limit and per radian of direction error, against per radian of joint motion."""
_LEAST_SINE = 0.3
"""Sine of the angle between neighbouring shoulder axes below which one of them is of no use."""
_SAME_M = 1e-6
"""An axis so near the shoulder passes through it."""
_SEEN_ACROSS, _SEEN_BENT = 0.15, 0.05
"""Squared sines from which on the first and the third shoulder joint count as fully seen."""
_SPREAD = {2: 21, 3: 9}
"""Poses for each joint among which a start for the least error is looked for, by number of joints."""
_STRAIGHT = 1e-6
"""Sine below which two directions count as parallel."""


@dataclass(frozen=True)
class Bones:
    """Directions of both bones for angles (..., n), and how they change.

    Attributes:
        upper, fore: (..., 3) unit directions.
        upper_jacobian, fore_jacobian: (..., n, 3) change of each per radian of each joint.
    """

    upper: Array
    fore: Array
    upper_jacobian: Array
    fore_jacobian: Array


class Arm:
    """One arm of a robot: `joints` are the indices of its joints from the chest to the elbow, in order."""

    def __init__(self, kinematics: Kinematics, side: str) -> None:
        robot = kinematics.robot
        points = {p.name: p for p in kinematics.key_points}
        roles = {f"{side}_{part}" for part in ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow")}
        found = [j for j in range(robot.n_joints) if robot.joints[j].role in roles]
        allowed = f"joints with roles {side}_shoulder_pitch, _roll, _yaw, _elbow (two to four) and a site {side}_wrist"
        if f"{side}_wrist" not in points or f"{side}_shoulder" not in points:
            raise RobotFileError(robot.path, f"{side} arm", f"no site '{side}_wrist' or no shoulder joint", allowed)
        wrist = points[f"{side}_wrist"]
        self.joints = tuple(j for j in wrist.chain if j in found)
        self.side = side
        elbow = robot.joint_with_role(f"{side}_elbow")
        self.has_elbow = elbow is not None
        n_shoulder = len(self.joints) - self.has_elbow
        if not (1 <= n_shoulder <= 3 and len(self.joints) >= 2) or set(found) != set(self.joints):
            names = ", ".join(robot.joint_names[j] for j in found) or "no joints"
            raise RobotFileError(robot.path, f"{side} arm", f"{names} on the way to the wrist", allowed)
        if self.has_elbow and self.joints[-1] != elbow:
            raise RobotFileError(robot.path, f"{side} arm", "a shoulder joint beyond the elbow", "the elbow as last")
        rows = list(self.joints)
        self.axes, self._anchors = kinematics.axes[rows], kinematics.anchors[rows]
        self.low, self.high = robot.position_min_rad[rows], robot.position_max_rad[rows]
        self._middle = (self.low + self.high) / 2
        shoulder = points[f"{side}_shoulder"]
        self._shoulder_m, self._wrist_m = shoulder.zero_m, wrist.zero_m
        self._elbow_m = self._wrist_m if elbow is None else kinematics.anchors[elbow]
        below = np.array([j not in shoulder.chain for j in self.joints])
        self.upper0 = _unit(self._elbow_m - self._shoulder_m)
        self.fore0 = self.upper0 if elbow is None else _unit(self._wrist_m - self._elbow_m)
        self.upper_m = float(np.linalg.norm(self._elbow_m - self._shoulder_m))
        self.fore_m = float(np.linalg.norm(self._wrist_m - self._elbow_m)) if self.has_elbow else 0.0
        for a in range(n_shoulder - 1):
            if np.linalg.norm(cross(self.axes[a], self.axes[a + 1])) < _LEAST_SINE:
                pair = (
                    f"'{robot.joint_names[rows[a]]}' and '{robot.joint_names[rows[a + 1]]}' turn about nearly one axis"
                )
                raise RobotFileError(robot.path, f"{side} arm", pair, "neighbouring shoulder axes well apart")
        self.reaches_all = n_shoulder == 3 and self.has_elbow
        self._n_shoulder = n_shoulder
        self._skews = np.array([skew(a) for a in self.axes])
        self._skews_squared = self._skews @ self._skews
        last = self.axes[n_shoulder - 1]
        self._across3 = _unit(cross(last, np.eye(3)[np.abs(last).argmin()]))
        # A joint between shoulder and elbow whose axis misses the shoulder moves the elbow other than by turning the bone.
        lever = np.linalg.norm(cross(self.axes, self._anchors - self._shoulder_m), axis=1)
        self._offset = below & (np.arange(len(rows)) < n_shoulder) & (lever > _SAME_M)
        self._has_offsets = bool(self._offset.any())
        if not self.reaches_all:
            steps = _SPREAD[len(rows)]
            ranges = [np.linspace(a, b, steps) for a, b in zip(self.low, self.high, strict=True)]
            self._spread_rad = np.stack(np.meshgrid(*ranges), -1).reshape(-1, len(rows))
            upper, fore = self.directions(self._spread_rad)
            self._spread_upper, self._spread_fore = UPPER_WEIGHT * upper.T, FORE_WEIGHT * fore.T

    def ways(self, upper: Array, fore: Array) -> Array:
        """(T, C, n) angles in C ways for unit directions (T, 3) in the chest frame; those of arms that reach all may pass limits."""
        if not self.reaches_all:
            return self._refine(self._starts(upper, fore), upper, fore, _LEAST_ERROR_STEPS)
        ways = self._every_pair(upper, fore)
        if self._has_offsets:
            ways = self._refine(ways, upper, fore, _OFFSET_STEPS)
        return self._nearest_turn(ways)

    def within_limits(self, q: Array, upper: Array, fore: Array) -> Array:
        """(T, n) angles within the limits; where one is cut off, the other joints make up for it as far as they can."""
        inside = np.clip(q, self.low, self.high)
        cut = (inside != q).any(1)
        if cut.any():
            inside[cut] = self._refine(q[cut][:, None], upper[cut], fore[cut], _LEAST_ERROR_STEPS)[:, 0]
        return inside

    def own_cost(self, ways: Array, upper: Array, fore: Array, seen: Array) -> Array:
        """(T, C) what each way costs by itself, in radians of movement: what lies outside limits, directions missed."""
        outside = np.abs(ways - np.clip(ways, self.low, self.high))
        cost = (_LIMIT_COST + _ERROR_COST) * (outside * seen).sum(-1)
        if not self.reaches_all or self._has_offsets:
            u, f = self.directions(ways)
            for found, wanted in ((u, upper), (f, fore)):
                cost = cost + _ERROR_COST * np.linalg.norm(found - wanted[:, None], axis=-1)
        return cost

    def seen(self, ways: Array, upper: Array, fore: Array) -> Array:
        """(T, C, n) how much the turning of each joint shows, 0 to 1.

        With the third axis along the first, only their sum shows; with the arm straight, the third does not.
        """
        seen = np.ones(ways.shape)
        if self.reaches_all:
            a1, a2, a3 = self.axes[:3]
            across = 1 - (rotate(a2, ways[..., 1], a3) @ a1) ** 2
            bent = 1 - (upper * fore).sum(-1) ** 2
            seen[..., 0] = np.minimum(across / _SEEN_ACROSS, 1)
            seen[..., 2] = seen[..., 0] * np.minimum(bent / _SEEN_BENT, 1)[:, None]
        return seen

    def directions(self, q: Array) -> tuple[Array, Array]:
        """Unit directions of upper arm and forearm, each (..., 3), for angles (..., n)."""
        turned = np.eye(3)
        upper = self.upper0
        R = self._rotations(q)
        for j in range(self._n_shoulder):
            turned = turned @ R[..., j, :, :]
        upper = _unit(self._upper_vector(R)[0]) if self._has_offsets else turned @ self.upper0
        if self.has_elbow:
            return upper, turned @ R[..., -1, :, :] @ self.fore0
        return upper, upper

    def bones(self, q: Array) -> Bones:
        """Directions of both bones for angles (..., n), with their Jacobians."""
        R = self._rotations(q)
        turned = np.broadcast_to(np.eye(3), R.shape[:-3] + (3, 3))
        axes = np.empty((*q.shape, 3))
        upper = np.empty((*q.shape[:-1], 3))
        for j in range(len(self.joints)):
            if j == self._n_shoulder:
                upper = turned @ self.upper0
            axes[..., j, :] = turned @ self.axes[j]
            turned = turned @ R[..., j, :, :]
        fore = turned @ self.fore0
        if not self.has_elbow:
            upper = fore
        upper_jacobian = cross(axes, upper[..., None, :])
        if self._has_offsets:
            upper, upper_jacobian = self._upper_with_offsets(R, axes)
        upper_jacobian[..., self._n_shoulder :, :] = 0.0
        return Bones(upper, fore, upper_jacobian, cross(axes, fore[..., None, :]))

    def _rotations(self, q: Array) -> Array:
        """(..., n, 3, 3) rotation of each joint."""
        sine, versine = np.sin(q)[..., None, None], (1 - np.cos(q))[..., None, None]
        return np.eye(3) + sine * self._skews + versine * self._skews_squared

    def _upper_vector(self, R: Array) -> tuple[Array, list[Array]]:
        """(..., 3) shoulder to elbow, and for each shoulder joint the vector from what it turns about to the elbow."""
        n = self._n_shoulder
        levers: list[Array] = []
        v = np.broadcast_to(self._elbow_m - self._shoulder_m, (*R.shape[:-3], 3))
        for j in range(n - 1, -1, -1):
            # The joint's axis misses the shoulder by `beside`; about all others the bone itself turns.
            beside = self._anchors[j] - self._shoulder_m if self._offset[j] else np.zeros(3)
            lever = (R[..., j, :, :] @ (v - beside)[..., None])[..., 0]
            levers = [(R[..., j, :, :] @ w[..., None])[..., 0] for w in levers]
            levers.insert(0, lever)
            v = lever + beside
        return v, levers

    def _upper_with_offsets(self, R: Array, axes: Array) -> tuple[Array, Array]:
        v, levers = self._upper_vector(R)
        length = np.linalg.norm(v, axis=-1, keepdims=True)
        upper = v / length
        jacobian = np.zeros((*axes.shape[:-2], len(self.joints), 3))
        for j, lever in enumerate(levers):
            moved = cross(axes[..., j, :], lever)
            jacobian[..., j, :] = (moved - (moved * upper).sum(-1, keepdims=True) * upper) / length
        return upper, jacobian

    def _every_pair(self, upper: Array, fore: Array) -> Array:
        """(T, 4, 4) the four ways of a shoulder of three axes and an elbow, where bones turn about the shoulder."""
        a1, a2, a3, elbow_axis = self.axes
        middle, spread = _turns_to(elbow_axis, self.fore0, self.upper0, (upper * fore).sum(-1))
        elbow = np.stack([middle - spread, middle + spread], 1)  # (T, 2)
        bent = rotate(elbow_axis, elbow, self.fore0)  # (T, 2, 3) forearm in the upper arm's zero frame
        R = _frame(upper, fore)[:, None] @ np.swapaxes(_frame(self.upper0, bent), -1, -2)  # (T, 2, 3, 3)
        middle, spread = _turns_to(a2, a3, a1, (R @ a3) @ a1)
        q2 = np.stack([middle - spread, middle + spread], 2)  # (T, 2, 2)
        R = R[:, :, None]
        q1 = angle_about(a1, rotate(a2, q2, a3), R @ a3)
        back = rotate(a2, -q2, rotate(a1, -q1, R @ self._across3))
        q3 = angle_about(a3, self._across3, back)
        ways = np.stack([q1, q2, q3, np.broadcast_to(elbow[:, :, None], q1.shape)], -1)
        return ways.reshape(len(upper), 4, 4)

    def _starts(self, upper: Array, fore: Array) -> Array:
        """(T, C, n) angles from which to look for the least error: each bone by itself, and between both."""
        between = _unit(upper + fore)
        starts: list[Array] = []
        for aim in (upper, between) if self.has_elbow else (between,):
            if self._n_shoulder == 1:
                shoulders = [(angle_about(self.axes[0], self.upper0, aim),)]
            else:
                shoulders = [subproblem_2(self.axes[0], self.axes[1], self.upper0, aim, s) for s in (1.0, -1.0)]
            for shoulder in shoulders:
                if not self.has_elbow:
                    starts.append(np.stack(shoulder, -1))
                    continue
                local = fore
                for axis, q in zip(self.axes, shoulder, strict=False):
                    local = rotate(axis, -q, local)
                starts.append(np.stack([*shoulder, angle_about(self.axes[-1], self.fore0, local)], -1))
        # The nearest of poses spread over the range: limits make valleys that the others may miss.
        nearest = (upper @ self._spread_upper + fore @ self._spread_fore).argmax(1)
        return np.stack([*starts, self._spread_rad[nearest]], 1)

    def _refine(self, q: Array, upper: Array, fore: Array, steps: int) -> Array:
        """Gauss-Newton on both direction errors from angles (T, C, n), kept inside their limits."""
        q = np.clip(self._nearest_turn(q), self.low, self.high)
        upper, fore = upper[:, None], fore[:, None]
        damping = _DAMPING * np.eye(q.shape[-1])
        for _ in range(steps):
            b = self.bones(q)
            slope = UPPER_WEIGHT * (b.upper_jacobian @ (upper - b.upper)[..., None]) + FORE_WEIGHT * (
                b.fore_jacobian @ (fore - b.fore)[..., None]
            )  # (T, C, n, 1)
            # A joint at its limit that is pushed further out stays; the others make up for it.
            stuck = ((q <= self.low) & (slope[..., 0] < 0)) | ((q >= self.high) & (slope[..., 0] > 0))
            free = ~stuck[..., None]
            ju, jf = b.upper_jacobian * free, b.fore_jacobian * free
            normal = UPPER_WEIGHT * ju @ np.swapaxes(ju, -1, -2) + FORE_WEIGHT * jf @ np.swapaxes(jf, -1, -2)
            step = np.linalg.solve(normal + damping, slope * free)[..., 0]
            q = np.clip(q + np.clip(step, -_LARGEST_STEP_RAD, _LARGEST_STEP_RAD), self.low, self.high)
        return q

    def _nearest_turn(self, ways: Array) -> Array:
        """Whole turns added where that brings an angle into its limits."""
        middle = (self.low + self.high) / 2
        return ways - 2 * np.pi * np.round((ways - middle) / (2 * np.pi))


def subproblem_2(axis1: Array, axis2: Array, p: Array, q: Array, sign: float) -> tuple[Array, Array]:
    """Angles (T,), (T,) with R(axis1) R(axis2) p = q for unit vectors; the nearest direction where none exists.

    `sign` (+1 or -1) picks one of the two ways.
    """
    middle, spread = _turns_to(axis2, p, axis1, q @ axis1)
    angle2 = middle + sign * spread
    return angle_about(axis1, rotate(axis2, angle2, p), q), angle2


def angle_about(axis: Array, a: Array, b: Array) -> Array:
    """(...,) angle about unit `axis` that turns `a` nearest to `b`; 0 where either lies along the axis."""
    a = a - (a @ axis)[..., None] * axis
    sine, cosine = (a * (b @ skew(axis))).sum(-1), (a * b).sum(-1)
    return np.where(np.abs(sine) + np.abs(cosine) > _STRAIGHT, np.arctan2(sine, cosine), 0.0)


def _turns_to(axis: Array, v: Array, onto: Array, height: Array) -> tuple[Array, Array]:
    """Angles m, s (...,): turned by m + s or m - s about `axis`, `v` has the component `height` (...,) along `onto`.

    Where no angle gives that much or that little, s is 0 or pi and the component as near as can be.
    """
    still = float(axis @ onto) * float(axis @ v)
    cosine, sine = float(onto @ v) - still, float(onto @ cross(axis, v))
    reach = max(float(np.hypot(cosine, sine)), 1e-9)
    return np.full(height.shape, np.arctan2(sine, cosine)), np.arccos(np.clip((height - still) / reach, -1, 1))


def _frame(a: Array, b: Array) -> Array:
    """(..., 3, 3) rotations whose columns are `a`, what is across both, and what is across that; any such when parallel."""
    a, b = np.broadcast_arrays(a, b)
    across = cross(a, b)
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    if (length < _STRAIGHT).any():
        least = np.eye(3)[np.abs(a).argmin(-1)]
        other = cross(a, least)
        across = np.where(length < _STRAIGHT, other, across)
        length = np.linalg.norm(across, axis=-1, keepdims=True)
    across = across / length
    return np.stack([a, across, cross(a, across)], -1)


def _unit(v: Array) -> Array:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)
