"""Layers over motions and idle times: the gaze, and idle movements."""

from __future__ import annotations

import numpy as np

from daemon.poses.idle import looking
from daemon.poses.pose_sequence import PoseSequence
from retarget.robot.robot import RobotModel


class Layers:
    """Gaze and idle style, as set by requests.

    Attributes:
        idle_style: style of the idle movements; empty for none.
        gaze_deg: requested direction of the head, left and down; None leaves the head to the motion.
    """

    def __init__(self, idle_style: str) -> None:
        self.idle_style = "" if idle_style == "off" else idle_style
        self.gaze_deg: tuple[float, float] | None = None

    def over(self, p: PoseSequence) -> PoseSequence:
        """`p` with the layers applied."""
        if self.gaze_deg is None:
            return p
        yaw, pitch = np.deg2rad(self.gaze_deg)
        return looking(p, float(yaw), float(pitch), np.ones(len(p)))


def gaze_note(robot: RobotModel, yaw_deg: float, pitch_deg: float) -> str:
    """The part of a gaze that the robot's head cannot follow, in words; empty when it can follow all of it."""
    notes: list[str] = []
    for role, wanted_deg in (("head_yaw", yaw_deg), ("head_pitch", pitch_deg)):
        j = robot.joint_with_role(role)
        if j is None:
            if wanted_deg:
                notes.append(f"this robot has no {role}")
            continue
        reach_deg = np.rad2deg(max(abs(robot.position_min_rad[j]), abs(robot.position_max_rad[j])))
        if abs(wanted_deg) > reach_deg:
            notes.append(f"{role} reaches {reach_deg:.0f} deg")
    return "; ".join(notes)
