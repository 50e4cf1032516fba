"""Checks of a robot before its first run: missing values, contacts at rest, and doubts for its owner."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from retarget.pipeline import Retargeter
from retarget.robot.description import load_description, read_spec
from retarget.robot.robot import RobotModel
from retarget.robot.robot_file import MOST_RAD

_BEYOND_DEG = 0.51
"""Degrees by which a limit of the file may exceed the description's: limits may be rounded to whole degrees."""


@dataclass(frozen=True)
class Inspection:
    """Findings of the inspection of a robot.

    Attributes:
        missing: reasons why the robot cannot run or would touch itself, each with the remedy.
        doubts: facts that the description leaves open.
    """

    missing: tuple[str, ...]
    doubts: tuple[str, ...]


def inspect_robot(robot: RobotModel) -> Inspection:
    """Inspect a robot that was read with `blanks=True`.

    Raises:
        RobotFileError: the description cannot be used.
    """
    model = load_description(robot)
    missing = [f'{key} is blank ("?")' for key in robot.blanks]
    contact = Retargeter(robot).contact
    for name, q in (("rest", robot.rest_rad), ("park", robot.park_rad)):
        missing += [f"{name} pose: {a} touches {b}; change {name}_deg" for a, b in contact.pairs(q)]
    return Inspection(tuple(missing), (*_ranges(robot, model), *_shapes(robot, model)))


def _ranges(robot: RobotModel, model: Any) -> list[str]:
    doubts: list[str] = []
    for joint in robot.joints:
        own = np.rad2deg([joint.position_min_rad, joint.position_max_rad])
        if np.abs(own).max() <= MOST_RAD:
            doubts.append(
                f"{joint.name}: position_limit_deg [{own[0]:.4g}, {own[1]:.4g}] is hardly a movement; degrees, not radians?"
            )
        found = model.joint(joint.name)
        if not model.jnt_limited[found.id]:
            doubts.append(f"{joint.name}: the description has no range; position_limit_deg is all there is")
            continue
        low, high = np.rad2deg(found.range).tolist()
        if own[0] < low - _BEYOND_DEG or own[1] > high + _BEYOND_DEG:
            beyond = f"[{own[0]:.0f}, {own[1]:.0f}] is wider than the description's [{low:.0f}, {high:.0f}]"
            doubts.append(f"{joint.name}: position_limit_deg {beyond}")
    return doubts


def _shapes(robot: RobotModel, model: Any) -> list[str]:
    _, meshes = read_spec(robot.description_path)
    doubts = [f"no file of mesh {name}: its shape is not checked for contacts" for name in meshes]
    solid = {
        int(model.geom_bodyid[g]) for g in range(model.ngeom) if model.geom_contype[g] or model.geom_conaffinity[g]
    }
    for side in ("left", "right"):
        joints = [j.name for j in robot.joints if j.role.startswith(side)]
        if joints and not any(int(model.jnt_bodyid[model.joint(name).id]) in solid for name in joints):
            doubts.append(f"{side} arm: no shapes in the description, so its contacts cannot be seen")
    return doubts
