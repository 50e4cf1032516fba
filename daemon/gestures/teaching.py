"""A gesture from positions through which a hand led the limp arms: smoothed, cut, inside the limits. No I/O.

even -> arms that are kept -> smoothed -> still ends cut -> position limits -> velocity limits -> person -> the robot's own path.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from daemon.errors import ClipError
from daemon.poses.pose_sequence import PoseSequence, poses_of_joints
from mmm_core.motion.motion import FPS
from retarget.path.limits import JointLimits
from retarget.pipeline import Retargeter
from retarget.robot.kinematics import Kinematics
from retarget.robot.robot import RobotModel
from retarget.robot_to_human import joints_of_path

Array = NDArray[np.float64]
Sides = Literal["left", "right", "both"]

CUTOFF_HZ = 4.0
"""Movements of a led arm lie below it (our estimate: a quick wave has 2 to 3 Hz), steps of encoders and a shaking hand above."""
_ORDER = 2
STILL_RAD = float(np.deg2rad(2.0))
"""Radians that no joint exceeds, against its first or last angle, in an end that counts as still."""
KEPT_STILL_FRAMES = 4
"""Frames that are kept of a still end (0.2 s): a motion starts from rest."""
MOVED_RAD = float(np.deg2rad(5.0))
"""Radians of range beyond which a joint shows that its arm was led."""
_PLAY_DEG = 0.5
"""Degrees beyond a limit from which this is noted: less is play and rounding."""
POSE_S = 0.5
"""Seconds of positions whose mean is the pose; a pose is kept as a motion of one second."""
_LONGEST_GAP_S = 0.25
"""Seconds between two positions beyond which the pause is noted; a straight line bridges it."""


@dataclass(frozen=True)
class Taught:
    """A motion taught by hand.

    Attributes:
        posture: its poses, on a person.
        sides: the arms that were kept.
        notes: changes and observations, a sentence each.
    """

    posture: PoseSequence
    sides: Sides
    notes: tuple[str, ...]


def taught_gesture(retargeter: Retargeter, t_s: Sequence[float], q_rad: Array, sides: Sides | None = None) -> Taught:
    """The gesture in the measured positions.

    Args:
        retargeter: retargeter of the robot.
        t_s: (N,) times of the measurements, rising.
        q_rad: (N, J) measured joint angles.
        sides: the arms to keep; None for those that were led.

    Raises:
        ClipError: fewer than two measurements, nothing moved, or no free path leads through it.
    """
    q, notes = even(t_s, q_rad)
    sides = sides or sides_led(retargeter.robot, q)
    q = still_ends_cut(smoothed(arms_alone(retargeter.robot, q, sides)))
    return _checked(retargeter, q, sides, notes)


def taught_pose(retargeter: Retargeter, t_s: Sequence[float], q_rad: Array, sides: Sides | None = None) -> Taught:
    """The pose in which the arms were held at the end; arguments as of `taught_gesture`, but both arms when `sides` is None.

    Raises:
        ClipError: too few measurements, the arms moved, or the robot cannot be in that pose.
    """
    q, notes = even(t_s, q_rad)
    sides = sides or "both"
    held = arms_alone(retargeter.robot, q, sides)[-round(POSE_S * FPS) :]
    moved_deg = float(np.rad2deg(np.ptp(held, axis=0).max()))
    if moved_deg > np.rad2deg(MOVED_RAD):
        raise ClipError(
            f"pose: a joint moved by {moved_deg:.0f} degrees in the last {POSE_S:g} s; hold the arms still, then Enter"
        )
    return _checked(retargeter, np.repeat(held.mean(0)[None], int(FPS), 0), sides, notes)


def even(t_s: Sequence[float], q_rad: Array) -> tuple[Array, list[str]]:
    """Measurements (N, J) at times (N,) on an even grid of `FPS` frames a second, and a note of each long pause.

    Raises:
        ClipError: fewer than two measurements.
    """
    t = np.asarray(t_s, np.float64)
    if len(t) < 2 or t[-1] - t[0] < 1 / FPS:
        raise ClipError(f"{len(t)} positions were recorded; allowed: 0.1 s and more; teach it again")
    grid = np.arange(t[0], t[-1] + 1e-9, 1 / FPS)
    notes = [
        f"no position for {t[k + 1] - t[k]:.2f} s at {t[k] - t[0]:.1f} s: bridged by a straight line"
        for k in np.flatnonzero(np.diff(t) > _LONGEST_GAP_S)
    ]
    columns: list[Array] = [np.interp(grid, t, q_rad[:, j]) for j in range(q_rad.shape[1])]
    return np.stack(columns, 1), notes


def sides_led(robot: RobotModel, q_rad: Array) -> Sides:
    """The arms that were led in positions (T, J).

    Raises:
        ClipError: no arm was led.
    """
    ranges = np.ptp(q_rad, axis=0)
    led = [side for side in ("left", "right") if ranges[arm_joints(robot, side)].max(initial=0.0) > MOVED_RAD]
    if not led:
        raise ClipError(f"no arm was moved by more than {np.rad2deg(MOVED_RAD):.0f} degrees; nothing to keep")
    return "both" if len(led) == 2 else "left" if led == ["left"] else "right"


def arm_joints(robot: RobotModel, sides: Sides) -> list[int]:
    """Indices of the joints of these arms."""
    wanted = ("left_", "right_") if sides == "both" else (f"{sides}_",)
    return [j for j, joint in enumerate(robot.joints) if joint.role.startswith(wanted)]


def arms_alone(robot: RobotModel, q_rad: Array, sides: Sides) -> Array:
    """(T, J) positions with all joints but those of these arms at rest: the position of a limp head means nothing."""
    q = np.repeat(robot.rest_rad[None], len(q_rad), 0)
    arms = arm_joints(robot, sides)
    q[:, arms] = q_rad[:, arms]
    return q


def smoothed(q_rad: Array) -> Array:
    """(T, J) positions without movement faster than `CUTOFF_HZ`, without delay (filtered forward and backward, scipy)."""
    signal: Any = importlib.import_module("scipy.signal")  # it has no types, and takes half a second to import
    low_pass = signal.butter(_ORDER, CUTOFF_HZ, fs=FPS, output="sos")
    padding = min(3 * (2 * _ORDER + 1), len(q_rad) - 1)
    return np.asarray(signal.sosfiltfilt(low_pass, q_rad, axis=0, padlen=padding), np.float64)


def still_ends_cut(q_rad: Array) -> Array:
    """The frames of (T, J) in which some joint moves, and `KEPT_STILL_FRAMES` before and after.

    Raises:
        ClipError: no joint moves.
    """
    away = np.flatnonzero((np.abs(q_rad - q_rad[0]) > STILL_RAD).any(1))
    back = np.flatnonzero((np.abs(q_rad - q_rad[-1]) > STILL_RAD).any(1))
    if not len(away):
        raise ClipError(f"nothing moved by more than {np.rad2deg(STILL_RAD):.0f} degrees; nothing to keep")
    last = int(back[-1]) if len(back) else int(away[-1])  # the motion may end where it began
    return q_rad[max(0, int(away[0]) - KEPT_STILL_FRAMES) : max(last, int(away[-1])) + 1 + KEPT_STILL_FRAMES]


def inside_positions(q_rad: Array, limits: JointLimits, names: Sequence[str]) -> tuple[Array, list[str]]:
    """(T, J) positions clipped to the position limits, and a note for each joint that was led beyond its limits."""
    clipped = np.clip(q_rad, limits.position_min_rad, limits.position_max_rad)
    beyond_deg = np.rad2deg(np.abs(q_rad - clipped).max(0))
    return clipped, [
        f"{names[j]} was led {beyond_deg[j]:.1f} degrees beyond its limit: it is kept at the limit"
        for j in np.flatnonzero(beyond_deg > _PLAY_DEG).tolist()
    ]


def slowed(q_rad: Array, velocity_rad_s: Array) -> tuple[Array, float]:
    """The path (T, J), slowed down where a joint was faster than `velocity_rad_s` (J,), and the largest factor of slowing.

    Every frame lies on the straight lines between the given ones, so that none is nearer to contact than they are.
    """
    share = (np.abs(np.diff(q_rad, axis=0)) * FPS / velocity_rad_s).max(1, initial=0.0)
    times = np.concatenate([[0.0], np.cumsum(np.maximum(share, 1.0))])  # in frames
    n = int(np.ceil(times[-1] - 1e-9)) + 1
    frames = np.arange(len(q_rad), dtype=np.float64)
    at: Array = np.interp(np.linspace(0.0, float(times[-1]), n), times, frames)
    before = np.minimum(at.astype(np.intp), len(q_rad) - 2)
    return q_rad[before] + (at - before)[:, None] * (q_rad[before + 1] - q_rad[before]), float(max(share.max(), 1.0))


def on_a_person(kinematics: Kinematics, q_rad: Array) -> PoseSequence:
    """The poses of a person for a robot's positions (T, J): bones, head, and forearm twist where the robot has that joint."""
    joints_m, head_quat_wxyz = joints_of_path(kinematics, q_rad)
    points = {p.name: p.zero_m for p in kinematics.key_points}
    twist_rad = np.zeros((len(q_rad), 2))
    for i, side in enumerate(("left", "right")):
        joint = kinematics.robot.joint_with_role(f"{side}_forearm_yaw")
        if joint is not None:
            along = points[f"{side}_wrist"] - points[f"{side}_elbow"]
            twist_rad[:, i] = np.sign(kinematics.axes[joint] @ along) * q_rad[:, joint]
    return poses_of_joints(joints_m, head_quat_wxyz, twist_rad, FPS)


def _checked(retargeter: Retargeter, q_rad: Array, sides: Sides, notes: list[str]) -> Taught:
    """Positions as a gesture that this robot can show, with notes on the changes.

    Raises:
        ClipError: the robot's path for the gesture has self-contact.
    """
    limits = retargeter.limits
    q, beyond = inside_positions(q_rad, limits, retargeter.robot.joint_names)
    q, times = slowed(q, limits.velocity_rad_s)
    if times > 1:
        beyond.append(
            f"a hand was {times:.2f} times as fast as a joint may be: slower there, {len(q) / FPS:.1f} s in all"
        )
    near = np.flatnonzero(retargeter.contact.frames(q))
    if len(near):
        pairs = ", ".join(f"{a} and {b}" for a, b in retargeter.contact.pairs(q[near[0]])[:3])
        beyond.append(
            f"from {near[0] / FPS:.1f} to {near[-1] / FPS:.1f} s the robot was led nearer to itself than it goes by itself"
            f"{f' ({pairs})' if pairs else ''}: it keeps its distance there"
        )
    posture = on_a_person(retargeter.kinematics, q)
    path = retargeter.retarget(posture.motion())
    if retargeter.contact.along(path.control_rad).any():
        raise ClipError("no path leads through it that keeps the robot off itself; teach it with the arms further out")
    report = path.report
    shown = f"played back, the arms point within {report.direction_mean_deg:.1f} degrees of what was taught on average"
    return Taught(posture, sides, (*notes, *beyond, f"{shown}, {report.direction_max_deg:.1f} at most"))
