"""Motion to joint path: the only file that knows the order of the steps.

human -> waist -> neck -> arms -> unseen joints rest -> limits -> self-contact -> spline.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion import Motion
from retarget.arms import Arm
from retarget.collision import SelfContact
from retarget.human import HumanPose, read_human
from retarget.kinematics import Kinematics
from retarget.limits import JointLimits, brake, limit_path
from retarget.paths import JointPath, JointState
from retarget.report import RetargetReport
from retarget.robot import RobotModel
from retarget.trunk import solve_neck, solve_waist

Array = NDArray[np.float64]
_REST_PULL = 0.02
"""Weight of smoothness against a fully seen joint's target: below a degree for any human motion, all for an unseen one."""
_YIELDS = (0.15, 0.3, 0.5, 0.75, 1.0)
"""Shares by which a clip is drawn towards the rest pose, one after another, until it touches nothing."""
_MAX_SETTLE_FRAMES = 80


class Retargeter:
    """Turns human motions into paths of one robot."""

    def __init__(self, robot: RobotModel) -> None:
        self.robot = robot
        self.kinematics = Kinematics(robot)
        self.limits = JointLimits.of(robot)
        self.arms = tuple(Arm(self.kinematics, side) for side in ("left", "right"))
        self.contact = SelfContact(robot)

    def retarget(self, motion: Motion, start: JointState | None = None, *, settle: bool = True) -> JointPath:
        """The robot's path for a motion.

        Args:
            motion: T frames at `motion.fps`.
            start: what the joints were last told; the path joins on to it. None: at rest in the first frame's pose.
            settle: end at rest, with a few more frames where braking needs them.

        Raises:
            MotionError: the motion is empty or has bones without length.
        """
        human = read_human(motion)
        wanted = self.solve(human, start)
        period = 1.0 / motion.fps
        path = self._limited(wanted, start, period, settle)
        interventions = 0
        for share in _YIELDS:
            hit = self._hits(path)
            if not hit.any():
                break
            interventions += 1
            weight = _spread(hit[1:-1][: len(wanted)], len(wanted)) * share
            eased = wanted + weight[:, None] * (self.robot.rest_rad - wanted)
            path = self._limited(eased, start, period, settle)
        else:
            if self._hits(path).any():  # even the way to rest touches: stay where the joints are
                state = start or JointState(self.robot.rest_rad, np.zeros(self.robot.n_joints))
                path = self._limited(state.position_rad[None], state, period, settle)
        return JointPath(path, self.robot.joint_names, motion.fps, self._report(human, wanted, path, motion.fps, interventions))

    def solve(self, human: HumanPose, start: JointState | None) -> Array:
        """(T, J) joint angles for each frame, before limits in time."""
        T = len(human.trunk_yaw_rad)
        q = np.tile(self.robot.rest_rad, (T, 1))
        solve_waist(self.kinematics, human, q)
        q = np.clip(q, self.limits.position_min_rad, self.limits.position_max_rad)
        solve_neck(self.kinematics, human, q)
        before = self.robot.rest_rad if start is None else start.position_rad
        for arm in self.arms:
            columns = list(arm.joints)
            solution = arm.solve(human.upper[arm.side], human.fore[arm.side], before[columns])
            q[:, columns] = _let_rest(solution.q_rad, solution.seen, before[columns])
            twist = self.robot.joint_with_role(f"{arm.side}_forearm_yaw")
            if twist is not None:
                along = self.kinematics.axes[twist] @ arm.fore0
                q[:, twist] = np.sign(along) * human.forearm_twist_rad[arm.side]
        return q

    def _limited(self, wanted: Array, start: JointState | None, period: float, settle: bool) -> Array:
        """Control points of a path that keeps every limit."""
        if start is None:
            first = np.clip(wanted[0], self.limits.position_min_rad, self.limits.position_max_rad)
            start = JointState(first, np.zeros_like(first))
        half = start.velocity_rad_s * (period / 2)
        before, position = start.position_rad - half, start.position_rad + half
        followed = limit_path(wanted, position, start.velocity_rad_s, self.limits, period)
        points = [before, position, *followed]
        if settle:
            for _ in range(_MAX_SETTLE_FRAMES):
                if np.array_equal(points[-1], points[-2]):
                    break
                points.append(brake(points[-1], (points[-1] - points[-2]) / period, self.limits, period))
            points.append(points[-1])
        return np.array(points)

    def _hits(self, control: Array) -> NDArray[np.bool_]:
        """(N,) control points whose neighbourhood on the path touches: checked at, and half way between, frames."""
        at = (control[:-1] + control[1:]) / 2  # path at frame borders
        middle = (control[:-2] + 6 * control[1:-1] + control[2:]) / 8  # and in the middle of each
        hit = np.zeros(len(control), bool)
        border, inner = self.contact.frames(at[1:]), self.contact.frames(middle)
        hit[1:-1] |= inner | border
        hit[2:] |= border
        return hit

    def _report(self, human: HumanPose, wanted: Array, path: Array, rate_hz: float, interventions: int) -> RetargetReport:
        """Compare the path with the human, frame by frame."""
        q = path[2 : 2 + len(wanted)]
        angles: dict[str, Array] = {}
        for arm in self.arms:
            upper, fore = arm.directions(q[:, list(arm.joints)])
            n = len(q)
            angles[f"{arm.side}_upper_arm"] = _angle_deg(upper, human.upper[arm.side][:n])
            angles[f"{arm.side}_forearm"] = _angle_deg(fore, human.fore[arm.side][:n])
        every = np.concatenate(list(angles.values()))
        outside = (wanted < self.limits.position_min_rad - 1e-9) | (wanted > self.limits.position_max_rad + 1e-9)
        changed = np.abs(q - wanted[: len(q)]) > np.deg2rad(1.0)
        speed = np.abs(np.diff(path, axis=0)).max(0) * rate_hz / self.limits.velocity_rad_s
        acceleration = np.abs(np.diff(path, n=2, axis=0)).max(0) * rate_hz**2 / self.limits.acceleration_rad_s2
        names = self.robot.joint_names
        return RetargetReport(
            direction_mean_deg=round(float(every.mean()), 3),
            direction_p95_deg=round(float(np.percentile(every, 95)), 3),
            direction_max_deg=round(float(every.max()), 3),
            bone_mean_deg={name: round(float(a.mean()), 3) for name, a in angles.items()},
            clipped_frames=int(outside.any(1).sum()),
            clipped_joints={names[j]: int(n) for j, n in enumerate(changed.sum(0)) if n},
            interventions=interventions,
            peak_speed_share=round(float(speed.max()), 4),
            peak_speed_joint=names[int(speed.argmax())],
            peak_acceleration_share=round(float(acceleration.max()), 4),
        )


def _let_rest(q: Array, seen: Array, before: Array) -> Array:
    """Smooth each joint as far as its turning is unseen: least squares on targets weighted by `seen` and on steps.

    (T, n) -> (T, n); the tridiagonal systems of all joints are solved together (Thomas algorithm).
    """
    T = len(q)
    lower_pull = _REST_PULL
    weight = seen + 1e-4
    diagonal = weight + lower_pull * np.where((np.arange(T) < T - 1)[:, None], 2.0, 1.0)
    right = weight * q
    right[0] += lower_pull * before
    gain = np.empty_like(q)
    value = np.empty_like(q)
    gain[0], value[0] = -lower_pull / diagonal[0], right[0] / diagonal[0]
    for t in range(1, T):
        pivot = diagonal[t] + lower_pull * gain[t - 1]
        gain[t] = -lower_pull / pivot
        value[t] = (right[t] + lower_pull * value[t - 1]) / pivot
    for t in range(T - 2, -1, -1):
        value[t] -= gain[t] * value[t + 1]
    return value


def _spread(hit: NDArray[np.bool_], n: int) -> Array:
    """(n,) 1 at frames that touch, falling to 0 over half a second around them."""
    full = np.zeros(n, bool)
    full[: len(hit)] = hit
    if not full.any():  # only the settling frames touch: ease the end
        full[-1] = True
    distance = np.abs(np.arange(n)[:, None] - np.flatnonzero(full)[None]).min(1)
    return np.clip(1 - (distance - 2) / 10, 0.0, 1.0)


def _angle_deg(a: Array, b: Array) -> Array:
    return np.rad2deg(np.arccos(np.clip((a * b).sum(-1), -1, 1)))
