"""Motion to joint path: the only file that knows the order of the steps.

human -> waist -> neck -> arms -> unseen joints rest -> limits -> self-contact -> spline.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion import Motion
from retarget.arms import Arm
from retarget.avoidance import STRENGTHS, Avoidance, stretches
from retarget.collision import SelfContact
from retarget.following import limit_path
from retarget.human import HumanPose, read_human
from retarget.kinematics import Kinematics
from retarget.limits import JointLimits, brake, limit_step, stopping_velocity_rad_s
from retarget.paths import JointPath, JointState
from retarget.posing import Poser
from retarget.report import RetargetReport
from retarget.robot import RobotModel

Array = NDArray[np.float64]
_SETTLE_FRAMES = 16
"""Time given to reach the last pose; what then still moves, brakes."""
_STILL_RAD = 1e-5


class Retargeter:
    """Turns human motions into paths of one robot."""

    def __init__(self, robot: RobotModel) -> None:
        self.robot = robot
        self.kinematics = Kinematics(robot)
        self.limits = JointLimits.of(robot)
        self._poser = Poser(self.kinematics, self.limits)
        self.arms = self._poser.arms
        self.contact = SelfContact(robot)
        self._avoidance = Avoidance(robot, self.contact, self.limits)

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
        begin = self._begin(wanted, start)
        eased, interventions = self._avoidance.lead_round(wanted, begin.position_rad)
        path = self._limited(eased, wanted, begin, period, settle)
        hit = self.contact.along(path)
        for strength in STRENGTHS:
            if not hit.any():
                break
            interventions += stretches(hit)
            eased = self._avoidance.push(eased, path, hit, strength)
            path = self._limited(eased, wanted, begin, period, settle)
            hit = self.contact.along(path)
        if hit.any():
            path = self._stop_before_contact(path, hit, period)
        report = self._report(human, wanted, path, motion.fps, interventions)
        ends = self.limits.position_min_rad, self.limits.position_max_rad
        return JointPath(path, self.robot.joint_names, motion.fps, report, ends)

    def _begin(self, wanted: Array, start: JointState | None) -> JointState:
        """The given start, or at rest in the first frame's pose, led round contacts."""
        if start is not None:
            return start
        first = np.clip(wanted[:1], self.limits.position_min_rad, self.limits.position_max_rad)
        return JointState(self._avoidance.lead_round(first, self.robot.rest_rad)[0][0], np.zeros(self.robot.n_joints))

    def _stop_before_contact(self, path: Array, hit: NDArray[np.bool_], period: float) -> Array:
        """The path up to where it can brake before it first touches, then held; the last resort."""
        first = int(hit.argmax())
        back = 1
        while True:
            kept = max(2, first + 2 - back)
            stopped = self._held(path[:kept], period, len(path))
            if kept == 2 or not self.contact.along(stopped).any():
                return stopped
            back *= 2

    def _held(self, control: Array, period: float, n: int) -> Array:
        """At least `n` control points: `control`, brake, and hold."""
        points = list(control)
        while len(points) < n or not np.array_equal(points[-1], points[-2]):
            points.append(brake(points[-1], (points[-1] - points[-2]) / period, self.limits, period))
        return np.array(points)

    def solve(self, human: HumanPose, start: JointState | None) -> Array:
        """(T, J) joint angles for each frame within the position limits, before limits in time and contacts."""
        return self._poser.solve(human, None if start is None else start.position_rad)

    def arm(self, side: str) -> Arm:
        """The arm of a side."""
        return next(arm for arm in self.arms if arm.side == side)

    def direction_errors_deg(self, human: HumanPose, q_rad: Array) -> Array:
        """(4, T) angle between human and robot bone: left upper arm, left forearm, right upper arm, right forearm."""
        rows: list[Array] = []
        for arm in self.arms:
            upper, fore = arm.directions(q_rad[:, list(arm.joints)])
            rows += [_angle_deg(upper, human.upper[arm.side]), _angle_deg(fore, human.fore[arm.side])]
        return np.stack(rows)

    def _limited(self, eased: Array, posed: Array, start: JointState, period: float, settle: bool) -> Array:
        """Control points of a path near `eased` (T, J) that keeps every limit; what differs from `posed` matters most.

        When settling, the last pose is held until reached.
        """
        wanted, led = _controls(eased), eased - posed
        half = start.velocity_rad_s * (period / 2)
        before, position = start.position_rad - half, start.position_rad + half
        if settle:
            wanted, led = (np.concatenate([x, np.repeat(x[-1:], _SETTLE_FRAMES, 0)]) for x in (wanted, led))
        points = np.concatenate([[before], self._joined(wanted, led, before, position, period)])
        if not settle:
            return points
        n = len(points)
        moving = np.flatnonzero((np.abs(np.diff(points, axis=0)) > _STILL_RAD).any(1))
        last = max(n - _SETTLE_FRAMES, int(moving[-1]) + 2 if len(moving) else 0)
        return self._held(points[:last], period, last + 1)

    def _joined(self, wanted: Array, led: Array, before: Array, position: Array, period: float) -> Array:
        """(T + 1, J) control points from the second, `position`, on.

        A joint that the start leaves just enough room to brake has its next control points at or beyond the position
        limit, though its path is not: until there is room for whole steps it brakes as hard as the path needs.
        """
        limits = self.limits
        points = [before, position]
        for k in range(len(wanted)):
            velocity = (points[-1] - points[-2]) / period
            end = np.where(velocity > 0, limits.position_max_rad, limits.position_min_rad)
            toward = np.sign(velocity)
            room = stopping_velocity_rad_s(toward * (end - points[-1]), limits.acceleration_rad_s2, period)
            short = np.abs(velocity) - limits.acceleration_rad_s2 * period > room
            short |= toward * (points[-1] - end) > 0
            if not short.any():
                part, away = wanted[k:], led[k:]
                rest = limit_path(
                    part, points[-1], velocity, limits, period, lambda: self._poser.importance(part, away)
                )
                return np.concatenate([points[1:], rest])
            gap = np.maximum(toward * (end - (points[-1] + points[-2]) / 2), 1e-12)
            braking = np.minimum(velocity**2 / (2 * gap), limits.acceleration_rad_s2)
            inward = points[-1] + velocity * period - toward * braking * period**2
            points.append(np.where(short, inward, limit_step(wanted[k], points[-1], velocity, limits, period)))
        return np.array(points[1:])

    def _report(
        self, human: HumanPose, wanted: Array, path: Array, rate_hz: float, interventions: int
    ) -> RetargetReport:
        """Compare the path with the human, frame by frame."""
        q = ((path[1:-1] + path[2:]) / 2)[: len(wanted)]
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


def _controls(frames: Array) -> Array:
    """(T, J) control points whose spline passes near frames (T, J): the spline's own smoothing undone to fourth order.

    The path is at frame t half way between two control points, so these are for the times between frames.
    """
    more = np.concatenate([frames[:1], frames, frames[-1:], frames[-1:]])
    return (5 * (more[1:-2] + more[2:-1]) - more[:-3] - more[3:]) / 8


def _angle_deg(a: Array, b: Array) -> Array:
    return np.rad2deg(np.arccos(np.clip((a * b).sum(-1), -1, 1)))
