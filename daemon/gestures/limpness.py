"""Sorts a robot's joints by the effect of torque off: they hang, fall, sink or stay. Computed from the robot file.

A joint of the trunk or head whose axis is not vertical carries the parts above it: without torque these fall to a stop.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from retarget.robot.kinematics import Kinematics

_UPRIGHT_COSINE = float(np.cos(np.deg2rad(10)))
"""Cosine of 10 degrees, the angle to the vertical up to which an axis counts as vertical."""


@dataclass(frozen=True)
class Limpness:
    """Joint names, sorted by the effect of torque off in the park pose.

    Attributes:
        arms: joints of the arms, which hang.
        falls: joints of the trunk; all parts above them would fall.
        sinks: joints of the head, which sinks to its stop.
        stays: joints of trunk or head with a vertical axis; gravity does not move them.
    """

    arms: tuple[str, ...]
    falls: tuple[str, ...]
    sinks: tuple[str, ...]
    stays: tuple[str, ...]

    def in_words(self) -> list[str]:
        """A line for each group that has joints."""
        kinds = {
            "arms, to be led by hand": self.arms,
            "FALLS without torque, so hold or support the trunk": self.falls,
            "sinks to its stop": self.sinks,
            "turns freely, and falls nowhere": self.stays,
        }
        return [f"{kind}: {', '.join(names)}" for kind, names in kinds.items() if names]


def limpness_of(kinematics: Kinematics) -> Limpness:
    """The sorted joints of a robot that stands upright."""
    robot = kinematics.robot
    found: dict[str, list[str]] = {"arms": [], "falls": [], "sinks": [], "stays": []}
    for j, joint in enumerate(robot.joints):
        axis = kinematics.turn(kinematics.chains[j], robot.park_rad[None], kinematics.axes[j])[0]
        if joint.role.startswith(("left_", "right_")):
            what = "arms"
        elif abs(axis[2]) >= _UPRIGHT_COSINE:
            what = "stays"
        else:
            what = "falls" if joint.role.startswith("waist_") else "sinks"
        found[what].append(joint.name)
    return Limpness(**{what: tuple(names) for what, names in found.items()})
