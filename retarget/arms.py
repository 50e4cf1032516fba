"""Arms in closed form: joint angles from the directions of upper arm and forearm.

For an arm whose first two axes are orthogonal (pitch and roll, in any order, any zero pose) the upper arm's direction
gives both angles in two ways; a third axis along the upper arm and the elbow then give the forearm's direction in two
ways (Paden-Kahan subproblem 2; Murray, Li, Sastry 1994, sec. 3.2). Arms without that third axis cannot reach both
directions: a few Gauss-Newton steps from each start find the least weighted error. Among the ways, dynamic programming
picks those that stay within the limits and move least.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.kinematics import Kinematics, cross, rotate, skew

Array = NDArray[np.float64]
UPPER_WEIGHT, FORE_WEIGHT = 1.0, 1.0
_GAUSS_NEWTON_STEPS = 6
_LIMIT_COST, _ERROR_COST = 1.0, 4.0
"""Per radian outside a limit and per radian of direction error, against per radian of joint motion."""


@dataclass(frozen=True)
class ArmSolution:
    """Angles (T, n) of the arm's joints up to the elbow, and how much each is seen, (T, n) in 0..1."""

    q_rad: Array
    seen: Array


class Arm:
    """One arm of a robot: `joints` are the indices of shoulder (two or three) and elbow joints in order."""

    def __init__(self, kinematics: Kinematics, side: str) -> None:
        robot = kinematics.robot
        elbow = robot.joint_with_role(f"{side}_elbow")
        points = {p.name: p for p in kinematics.key_points}
        if elbow is None or f"{side}_wrist" not in points:
            allowed = f"a joint with role {side}_elbow and a site {side}_wrist"
            raise RobotFileError(robot.path, f"{side} arm", "no elbow joint or no site for the wrist", allowed)
        roles = {f"{side}_{part}" for part in ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow")}
        self.joints = tuple(j for j in kinematics.chains[elbow] if robot.joints[j].role in roles)
        self.side = side
        self.axes = kinematics.axes[list(self.joints)]
        self.low = robot.position_min_rad[list(self.joints)]
        self.high = robot.position_max_rad[list(self.joints)]
        shoulder, wrist = points[f"{side}_shoulder"].zero_m, points[f"{side}_wrist"].zero_m
        elbow_m = kinematics.anchors[elbow]
        self.upper0 = _unit(elbow_m - shoulder)
        self.fore0 = _unit(wrist - elbow_m)
        self.has_yaw = len(self.joints) == 4
        if len(self.joints) not in (3, 4) or abs(self.axes[0] @ self.axes[1]) > 0.05:
            allowed = "two orthogonal shoulder axes, an optional axis along the upper arm, an elbow"
            raise RobotFileError(robot.path, f"{side} arm", f"{len(self.joints)} joints to the elbow", allowed)
        if self.has_yaw:  # the upper arm is taken along its own axis, so that the yaw does not move it
            self.upper0 = self.axes[2] * np.sign(self.axes[2] @ self.upper0)

    def solve(self, upper: Array, fore: Array, previous_rad: Array | None) -> ArmSolution:
        """Angles for unit directions `upper` and `fore` (T, 3) in the chest frame, first near `previous_rad` (n,)."""
        shoulder = [subproblem_2(self.axes[0], self.axes[1], self.upper0, upper, s) for s in (1.0, -1.0)]
        candidates: list[Array] = []
        if self.has_yaw:
            for q1, q2 in shoulder:
                local = rotate(self.axes[1], -q2, rotate(self.axes[0], -q1, fore))
                for s in (1.0, -1.0):
                    candidates.append(
                        np.stack([q1, q2, *subproblem_2(self.axes[2], self.axes[3], self.fore0, local, s)], -1)
                    )
        else:
            between = _unit(upper + fore)
            starts = shoulder + [subproblem_2(self.axes[0], self.axes[1], self.upper0, between, s) for s in (1.0, -1.0)]
            for q1, q2 in starts:
                local = rotate(self.axes[1], -q2, rotate(self.axes[0], -q1, fore))
                start = np.stack([q1, q2, angle_about(self.axes[2], self.fore0, local)], -1)
                candidates.append(self._refine(start, upper, fore))
        ways = self._nearest_turn(np.stack(candidates, 1))  # (T, C, n)
        q = self._choose(ways, upper, fore, previous_rad)
        return ArmSolution(q, self._seen(q))

    def directions(self, q: Array) -> tuple[Array, Array]:
        """Directions of upper arm and forearm, each (..., 3), for angles (..., n)."""
        upper = np.broadcast_to(self.upper0, (*q.shape[:-1], 3))
        fore = np.broadcast_to(self.fore0, (*q.shape[:-1], 3))
        for j in range(len(self.joints) - 1, -1, -1):
            fore = rotate(self.axes[j], q[..., j], fore)
            if j < 2:
                upper = rotate(self.axes[j], q[..., j], upper)
        return upper, fore

    def _refine(self, q: Array, upper: Array, fore: Array) -> Array:
        """Gauss-Newton on both direction errors, angles kept inside their limits."""
        for _ in range(_GAUSS_NEWTON_STEPS):
            q = np.clip(q, self.low, self.high)
            u, f = self.directions(q)
            axis1 = np.broadcast_to(self.axes[0], u.shape)
            axis2 = rotate(self.axes[0], q[:, 0], np.broadcast_to(self.axes[1], u.shape))
            axis3 = rotate(self.axes[0], q[:, 0], rotate(self.axes[1], q[:, 1], np.broadcast_to(self.axes[2], u.shape)))
            wu, wf = UPPER_WEIGHT**0.5, FORE_WEIGHT**0.5
            J = np.concatenate([
                wu * np.stack([cross(axis1, u), cross(axis2, u), np.zeros_like(u)], -1),
                wf * np.stack([cross(axis1, f), cross(axis2, f), cross(axis3, f)], -1),
            ], 1)  # (T, 6, 3)  # fmt: skip
            error = np.concatenate([wu * (upper - u), wf * (fore - f)], 1)
            normal = J.transpose(0, 2, 1) @ J + 1e-3 * np.eye(3)
            step = np.linalg.solve(normal, (J.transpose(0, 2, 1) @ error[..., None]))[..., 0]
            q = q + np.clip(step, -0.5, 0.5)
        return np.clip(q, self.low, self.high)

    def _nearest_turn(self, ways: Array) -> Array:
        """Whole turns added where that brings an angle into its limits."""
        middle = (self.low + self.high) / 2
        return ways - 2 * np.pi * np.round((ways - middle) / (2 * np.pi))

    def _choose(self, ways: Array, upper: Array, fore: Array, previous_rad: Array | None) -> Array:
        """Dynamic programming over the C ways of each frame: (T, C, n) -> (T, n) inside the limits."""
        T, C, _ = ways.shape
        inside = np.clip(ways, self.low, self.high)
        u, f = self.directions(inside)
        error = np.arccos(np.clip((u * upper[:, None]).sum(-1), -1, 1)) + np.arccos(
            np.clip((f * fore[:, None]).sum(-1), -1, 1)
        )
        own = _LIMIT_COST * np.abs(ways - inside).sum(-1) + _ERROR_COST * error  # (T, C)
        total = own[0].copy()
        if previous_rad is not None:
            total += np.abs(inside[0] - previous_rad).sum(-1)
        back = np.zeros((T, C), np.int64)
        move = np.abs(inside[1:, :, None] - inside[:-1, None, :]).sum(-1)  # (T-1, C to, C from)
        for t in range(1, T):
            via = total[None] + move[t - 1]
            back[t] = via.argmin(1)
            total = via[np.arange(C), back[t]] + own[t]
        way = np.zeros(T, np.int64)
        way[-1] = total.argmin()
        for t in range(T - 1, 0, -1):
            way[t - 1] = back[t, way[t]]
        return inside[np.arange(T), way]

    def _seen(self, q: Array) -> Array:
        """How much each joint's turning shows: the first not with the arm along its axis, the yaw not when straight."""
        upper, fore = self.directions(q)
        seen = np.ones_like(q)
        across_upper = np.linalg.norm(upper @ skew(self.axes[0]), axis=-1)
        across_fore = np.linalg.norm(fore @ skew(self.axes[0]), axis=-1)
        seen[:, 0] = np.maximum(across_upper, across_fore) ** 2
        if self.has_yaw:
            seen[:, 2] = np.linalg.norm(cross(upper, fore), axis=-1) ** 2
        return seen


def subproblem_2(axis1: Array, axis2: Array, p: Array, q: Array, sign: float) -> tuple[Array, Array]:
    """Angles (T,), (T,) with R(axis1) R(axis2) p = q for orthogonal unit axes; the nearest direction where none exists.

    `sign` (+1 or -1) picks one of the two ways.
    """
    along1, along2 = q @ axis1, float(p @ axis2)
    rest = 1 - along2**2 - along1**2
    along1 = np.where(rest < 0, np.clip(along1, -np.sqrt(1 - along2**2), np.sqrt(1 - along2**2)), along1)
    third = sign * np.sqrt(np.maximum(rest, 0.0))
    middle = along2 * axis2 + along1[..., None] * axis1 + third[..., None] * cross(axis1, axis2)
    return angle_about(axis1, middle, q), angle_about(axis2, p, middle)


def angle_about(axis: Array, a: Array, b: Array) -> Array:
    """(T,) angle about unit `axis` that turns `a` nearest to `b`; 0 where either lies along the axis."""
    a = a - (a @ axis)[..., None] * axis
    b = b - (b @ axis)[..., None] * axis
    sine, cosine = (a * (b @ skew(axis))).sum(-1), (a * b).sum(-1)
    return np.where(np.abs(sine) + np.abs(cosine) > 1e-9, np.arctan2(sine, cosine), 0.0)


def _unit(v: Array) -> Array:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)
