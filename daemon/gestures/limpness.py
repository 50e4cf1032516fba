"""Sorts a robot's joints by the effect of a cut of the torque: they hang, fall, sink or stay. The robot file tells which.

A joint of the trunk or head that does not turn about the vertical carries what is above it: without torque that falls to a stop.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from retarget.robot.kinematics import Kinematics

_UPRIGHT_COSINE = float(np.cos(np.deg2rad(10)))
"""An axis within 10 degrees of the vertical counts as vertical."""


@dataclass(frozen=True)
class Limpness:
    """Joint names, by what a cut of the torque does to them in the park pose.

    Attributes:
        arms: they hang.
        falls: of the trunk: all that is above would fall.
        sinks: of the head: it sinks to its stop.
        stays: of trunk or head, about the vertical: nothing moves them.
    """

    arms: tuple[str, ...]
    falls: tuple[str, ...]
    sinks: tuple[str, ...]
    stays: tuple[str, ...]

    def in_words(self) -> list[str]:
        """A line for each kind that the robot has."""
        kinds = {
            "arms, to be led by hand": self.arms,
            "FALLS without torque, so hold or support the trunk": self.falls,
            "sinks to its stop": self.sinks,
            "turns freely, and falls nowhere": self.stays,
        }
        return [f"{kind}: {', '.join(names)}" for kind, names in kinds.items() if names]


def limpness_of(kinematics: Kinematics) -> Limpness:
    """Sort the joints of a robot that stands upright."""
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
