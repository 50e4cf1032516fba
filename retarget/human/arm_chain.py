"""One arm read from the robot description: its joints, their axes, and its bones in the zero pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.robot.kinematics import Kinematics, cross

Array = NDArray[np.float64]
_LEAST_SINE = 0.3
"""Least sine of the angle between neighbouring shoulder axes; an arm with more nearly parallel axes is refused."""
_SAME_M = 1e-6
"""Metres from the shoulder within which an axis counts as passing through the shoulder."""
_SHOULDER_PARTS = ("shoulder_pitch", "shoulder_roll", "shoulder_yaw")


@dataclass(frozen=True)
class ArmChain:
    """The joints of one arm from the chest to the elbow, in order, and its two bones, in base axes in the zero pose.

    Attributes:
        side: "left" or "right".
        joints: indices of one to three shoulder joints and of the elbow, if there is one.
        has_elbow: whether the last joint is an elbow; without an elbow the arm is one bone.
        axes: (n, 3) unit axes.
        low: (n,) lower position limits, radians.
        high: (n,) upper position limits, radians.
        upper_m: (3,) vector from shoulder to elbow.
        fore_m: (3,) vector from elbow to wrist; without an elbow that of the upper arm.
        beside_m: (n, 3) vector from the shoulder to each joint whose axis misses the shoulder; 0 for the other joints.
    """

    side: str
    joints: tuple[int, ...]
    has_elbow: bool
    axes: Array
    low: Array
    high: Array
    upper_m: Array
    fore_m: Array
    beside_m: Array

    @property
    def kind(self) -> tuple[int, bool, bool]:
        """Number of joints, whether there is an elbow, whether an axis misses the shoulder; equal kinds are solved together."""
        return len(self.joints), self.has_elbow, bool(self.beside_m.any())


def read_arm(kinematics: Kinematics, side: str) -> ArmChain:
    """The arm of one side of a robot.

    Raises:
        RobotFileError: roles are missing or in no usable order, or two neighbouring shoulder axes are nearly parallel.
    """
    robot = kinematics.robot
    points = {p.name: p for p in kinematics.key_points}
    found = {
        j for j in range(robot.n_joints) if robot.joints[j].role in {f"{side}_{p}" for p in (*_SHOULDER_PARTS, "elbow")}
    }
    allowed = f"joints with roles {side}_shoulder_pitch, _roll, _yaw, _elbow (two to four) and a site {side}_wrist"
    if f"{side}_wrist" not in points or f"{side}_shoulder" not in points:
        raise RobotFileError(robot.path, f"{side} arm", f"no site '{side}_wrist' or no shoulder joint", allowed)
    shoulder, wrist = points[f"{side}_shoulder"], points[f"{side}_wrist"]
    rows = [j for j in wrist.chain if j in found]
    elbow = robot.joint_with_role(f"{side}_elbow")
    n_shoulder = len(rows) - (elbow is not None)
    if len(rows) < 2 or not 1 <= n_shoulder <= 3 or found != set(rows):
        names = ", ".join(robot.joint_names[j] for j in rows) or "no joint"
        raise RobotFileError(robot.path, f"{side} arm", f"{names} on the way to the wrist", allowed)
    if elbow is not None and rows[-1] != elbow:
        raise RobotFileError(robot.path, f"{side} arm", "a shoulder joint beyond the elbow", "the elbow last")
    axes, anchors = kinematics.axes[rows], kinematics.anchors[rows]
    for a in range(n_shoulder - 1):
        if np.linalg.norm(cross(axes[a], axes[a + 1])) < _LEAST_SINE:
            pair = f"'{robot.joint_names[rows[a]]}' and '{robot.joint_names[rows[a + 1]]}' turn about nearly one axis"
            raise RobotFileError(robot.path, f"{side} arm", pair, "neighbouring shoulder axes well apart")
    end = wrist.zero_m if elbow is None else kinematics.anchors[elbow]
    upper_m = end - shoulder.zero_m
    fore_m = upper_m if elbow is None else wrist.zero_m - end
    for name, bone in (("upper arm", upper_m), ("forearm", fore_m)):
        if np.linalg.norm(bone) < _SAME_M:
            raise RobotFileError(robot.path, f"{side} {name}", "no length", f"joints and site {side}_wrist apart")
    below = np.array([j not in shoulder.chain for j in rows]) & (np.arange(len(rows)) < n_shoulder)
    lever = np.linalg.norm(cross(axes, anchors - shoulder.zero_m), axis=1)
    beside_m = np.where((below & (lever > _SAME_M))[:, None], anchors - shoulder.zero_m, 0.0)
    return ArmChain(
        side, tuple(rows), elbow is not None, axes, robot.position_min_rad[rows], robot.position_max_rad[rows],
        upper_m, fore_m, beside_m,
    )  # fmt: skip
