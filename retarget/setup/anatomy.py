"""Joints and points of a robot description with the roles that were found for them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from retarget.setup.body_tree import FoundPoint


@dataclass(frozen=True)
class FoundJoint:
    """A joint with a role.

    Attributes:
        axis: unit axis in the zero pose, x forward, y left, z up.
        range_deg: range of the joint; None where the description has no range.
        sign: 1 if the positive sense is the usual one (raises the arm forward or sideways, bends the elbow, turns to the
            left, nods down), -1 if it is the opposite, 0 if the zero pose does not decide.
        gear: (turns of the servo for one of the joint, direction) where another joint of the description drives it.
    """

    name: str
    role: str
    axis: tuple[float, float, float]
    range_deg: tuple[float, float] | None
    sign: int
    gear: tuple[float, int] | None = None


@dataclass(frozen=True)
class Anatomy:
    """The parts of a humanoid that were found in a robot description.

    Attributes:
        path: the description.
        forward: axis of the description that points ahead.
        up: axis of the description that points up.
        joints: joints with a role.
        points: points that retargeting needs and the description has no site for.
        reach_m: metres from the shoulder over the elbow to the wrist.
        notes: decisions and omissions, with their reasons.
    """

    path: Path
    forward: str
    up: str
    joints: tuple[FoundJoint, ...]
    points: dict[str, FoundPoint]
    reach_m: float
    notes: tuple[str, ...]
