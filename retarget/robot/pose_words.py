"""A robot's pose in words: directions of arms, head and trunk, for a person who brings the robot into the pose by hand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from retarget.robot.kinematics import Kinematics
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
ONE_WAY_SHARE = 0.94
"""Cosine of the angle to an axis, 20 degrees, within which a direction is named by this axis alone."""
_SECOND_SHARE = 0.34
"""Component of a unit direction along a second axis from which the second axis is named too: 20 degrees off the first."""
_SHORTEST_M = 0.01


def pose_in_words(robot: RobotModel, q_rad: Array) -> list[str]:
    """One sentence for each arm, for head and trunk; sides are the robot's own.

    Args:
        robot: the robot.
        q_rad: (J,) joint angles.
    """
    kinematics = Kinematics(robot)
    at = {p.name: kinematics.place(p, q_rad[None])[0] for p in kinematics.key_points}
    lines: list[str] = []
    for side in ("left", "right"):
        bones = [(a, b) for a, b in (("shoulder", "elbow"), ("elbow", "wrist"), ("shoulder", "wrist"))
                 if f"{side}_{a}" in at and f"{side}_{b}" in at]  # fmt: skip
        ways = {f"{a} to {b}": at[f"{side}_{b}"] - at[f"{side}_{a}"] for a, b in bones}
        named = {name: _way(way, side) for name, way in ways.items() if np.linalg.norm(way) > _SHORTEST_M}
        upper, lower = named.get("shoulder to elbow"), named.get("elbow to wrist")
        if upper and upper == lower:
            lines.append(f"{side} arm straight, pointing {upper}")
        elif upper and lower:
            lines.append(f"{side} upper arm pointing {upper}, forearm pointing {lower}")
        elif named:
            lines.append(f"{side} arm pointing {next(reversed(named.values()))}")
    lines += _turned(robot, q_rad)
    return lines


def _turned(robot: RobotModel, q_rad: Array) -> list[str]:
    """Sentences on head and trunk: straight ahead, or the degrees by which each joint is off."""
    lines: list[str] = []
    for part, straight in (("head", "head looking straight ahead"), ("waist", "trunk upright, facing ahead")):
        joints = [i for i, j in enumerate(robot.joints) if j.role.startswith(f"{part}_")]
        off = [
            f"{robot.joints[i].name} {np.rad2deg(q_rad[i]):+.0f} deg" for i in joints if abs(np.rad2deg(q_rad[i])) >= 1
        ]
        if joints:
            lines.append(f"{part}: {', '.join(off)}" if off else straight)
    return lines


def _way(way: Array, side: str) -> str:
    """A direction (x ahead, y to the robot's left, z up) of a limb of `side` in words."""
    share = way / np.linalg.norm(way)
    out, across = "out to the side", f"across to the robot's {'right' if side == 'left' else 'left'}"
    names = (("back", "ahead"), (across, out) if side == "left" else (out, across), ("down", "up"))
    order = [int(i) for i in np.argsort(-np.abs(share))]
    words = [names[i][int(share[i] > 0)] for i in order]
    if abs(share[order[0]]) >= ONE_WAY_SHARE:
        return f"straight {words[0]}" if order[0] != 1 else words[0]
    named = [w for w, i in zip(words, order, strict=True) if abs(share[i]) >= _SECOND_SHARE]
    return " and ".join(named)
