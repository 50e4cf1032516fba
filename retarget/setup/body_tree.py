"""A robot description as a tree of bodies and hinge joints, rotated to standard axes, with queries on the tree."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.robot.description import compiled, followers, mujoco, read_spec, rotation_to_standard
from retarget.robot.robot import DIRECTIONS

Array = NDArray[np.float64]
_LEFT = re.compile(r"(^|[_\W])l(eft)?([_\W]|$)", re.IGNORECASE)
_RIGHT = re.compile(r"(^|[_\W])r(ight)?([_\W]|$)", re.IGNORECASE)
_OFF_CENTRE = 0.02
"""Share of the robot's size within which a part counts as lying on the mirror plane."""


@dataclass(frozen=True)
class FoundPoint:
    """A point on a body, in the body's own axes."""

    body: str
    offset_m: tuple[float, float, float]


class BodyTree:
    """Bodies and hinge joints of a description in its zero pose: x forward, y left, z up.

    Attributes:
        joints: MuJoCo's ids of the hinge joints.
        name, body, axis, anchor: name, body, axis and anchor by joint id.
        forward, up: the description's own axes that point ahead and up.
        middle: y coordinate of the mirror plane, metres.
        notes: decisions, with their reasons.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.spec, self.missing = read_spec(path)
        self.model: Any = compiled(path, self.spec)
        self.data: Any = mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, self.data)
        self.notes: list[str] = []
        hinge = mujoco.mjtJoint.mjJNT_HINGE
        self.joints = [j for j in range(self.model.njnt) if self.model.jnt_type[j] == hinge]
        self.name = {j: str(self.model.joint(j).name) for j in self.joints}
        self.body = {j: int(self.model.jnt_bodyid[j]) for j in self.joints}
        self._leave_out_drives()
        self.R, self.forward, self.up = self._frame()
        self.axis = {j: self.R @ self.data.xaxis[j] for j in self.joints}
        self.anchor = {j: self.R @ self.data.xanchor[j] for j in self.joints}
        self.middle = self._lateral_middle()

    def _leave_out_drives(self) -> None:
        """Drop joints that only turn another joint and carry no body: such a gear belongs to the servo."""
        leaders = {f.leader for f in followers(self.spec)}
        parents = {int(p) for p in self.model.body_parentid}
        self.joints = [j for j in self.joints if self.name[j] not in leaders or self.body[j] in parents]

    def _frame(self) -> tuple[Array, str, str]:
        """Rotation to standard axes, and the description's axes that point forward and up."""
        gravity = np.array(self.model.opt.gravity)
        up = np.array([0.0, 0, 1]) if np.abs(gravity).max() < 1e-6 else -gravity / np.linalg.norm(gravity)
        up_key = max(DIRECTIONS, key=lambda k: float(np.dot(DIRECTIONS[k], up)))
        sides = np.zeros(3)
        for j in self.joints:
            left, right = bool(_LEFT.search(self.name[j])), bool(_RIGHT.search(self.name[j]))
            if left != right:
                sides += (1 if left else -1) * np.array(self.data.xanchor[j])
        sides -= (sides @ np.array(DIRECTIONS[up_key])) * np.array(DIRECTIONS[up_key])
        if np.linalg.norm(sides) > 1e-3:
            left_key = max(DIRECTIONS, key=lambda k: float(np.dot(DIRECTIONS[k], sides)))
            forward = np.cross(DIRECTIONS[left_key], DIRECTIONS[up_key])
            forward_key = max(DIRECTIONS, key=lambda k: float(np.dot(DIRECTIONS[k], forward)))
            self.notes.append(f"forward is {forward_key}: joints named left stand on the {left_key} side")
        else:
            forward_key = self._forward_of_spread(up_key)
            self.notes.append(
                f"forward is taken as {forward_key}: no joint is named left, right, l or r, so left and right may be swapped; see"
                f" `mmmd robot show`, and where they are, rename the joints in the description (`left_...`, `right_...`)"
            )
        return rotation_to_standard(forward_key, up_key), forward_key, up_key

    def _forward_of_spread(self, up_key: str) -> str:
        """The level axis across the one along which the joints lie farthest apart: two arms stand side by side."""
        places = np.array([self.data.xanchor[j] for j in self.joints]).reshape(-1, 3)
        level = [k for k in ("x", "y", "z") if k != up_key[-1]]
        spread = {k: float(np.ptp(places @ np.array(DIRECTIONS[k]))) if len(places) else 0.0 for k in level}
        return min(level, key=lambda k: spread[k])

    def _lateral_middle(self) -> float:
        """Lateral position (y) of the mirror plane: half way between the outermost joints, since limbs come in pairs."""
        lateral = [float(a[1]) for a in self.anchor.values()]
        if not lateral:
            raise RobotFileError(self.path, "description", "no hinge joint", "a robot with arms")
        return (min(lateral) + max(lateral)) / 2

    def side(self, j: int) -> float:
        """1 for a joint that carries parts on the left only, -1 for one with parts on the right only, else 0."""
        lateral = self.carried(self.body[j])[:, 1] - self.middle
        edge = _OFF_CENTRE * self.size()
        if lateral.min() > -edge and lateral.mean() > edge:
            return 1.0
        return -1.0 if lateral.max() < edge and lateral.mean() < -edge else 0.0

    def longest(self, body: int) -> int:
        """Largest number of joints on a chain outwards from a body, its own joints included."""
        own = sum(self.body[j] == body for j in self.joints)
        return own + max(
            (self.longest(c) for c in range(1, self.model.nbody) if self.model.body_parentid[c] == body), default=0
        )

    def nearest_on_axis(self, j: int, twist: int | None) -> Array:
        """The point of a joint's axis nearest to the axis of the forearm's twist; its anchor without one."""
        if twist is None:
            return self.anchor[j]
        a, b = self.axis[j], self.axis[twist]
        gap = self.anchor[twist] - self.anchor[j]
        along = (a @ gap - (a @ b) * (b @ gap)) / max(1 - float(a @ b) ** 2, 1e-9)
        return self.anchor[j] + a * along

    def point(self, body: int, place: Array) -> FoundPoint:
        """A position (3,) as a point fixed to a body."""
        local = self.data.xmat[body].reshape(3, 3).T @ (self.R.T @ place - self.data.xpos[body])
        x, y, z = (round(float(v), 4) + 0.0 for v in local)
        return FoundPoint(str(self.model.body(body).name), (x, y, z))

    def bodies_above(self, body: int) -> list[int]:
        """A body and all bodies that carry it, the world last."""
        above = [body]
        while body:
            body = int(self.model.body_parentid[body])
            above.append(body)
        return above

    def bodies_below(self, body: int) -> list[int]:
        """A body and all bodies that it carries."""
        return [b for b in range(1, self.model.nbody) if body in self.bodies_above(b)]

    def depth(self, body: int) -> int:
        """Number of bodies from a body to the world."""
        return len(self.bodies_above(body))

    def joints_above(self, body: int, but: int) -> list[int]:
        """Joints that move a body, without the joint `but`."""
        above = set(self.bodies_above(body))
        return [j for j in self.joints if self.body[j] in above and j != but]

    def carried(self, body: int) -> Array:
        """(N, 3) positions of the shapes of a body and of the bodies on it; without shapes, centres of mass of the bodies."""
        below = self.bodies_below(body)
        shapes = [g for g in range(self.model.ngeom) if int(self.model.geom_bodyid[g]) in below]
        places = [self.data.geom_xpos[g] for g in shapes] or [self.data.xipos[b] for b in below]
        return np.array(places) @ self.R.T

    def farthest(self, body: int, from_m: Array) -> Array:
        """The point (3,) of a body and the bodies on it that is farthest from `from_m`."""
        best = self.R @ self.data.xipos[body]
        below = self.bodies_below(body)
        for b in below:
            best = max(best, self.R @ self.data.xpos[b], key=lambda p: float(np.linalg.norm(p - from_m)))
        for g in range(self.model.ngeom):
            if int(self.model.geom_bodyid[g]) in below:
                turn = self.R @ self.data.geom_xmat[g].reshape(3, 3)
                box = self.model.geom_aabb[g]
                middle = self.R @ self.data.geom_xpos[g] + turn @ box[:3]
                side = np.sign((middle - from_m) @ turn)
                best = max(
                    best, middle + turn @ (side * _thin(box[3:])), key=lambda p: float(np.linalg.norm(p - from_m))
                )
        return best

    def size(self) -> float:
        """Diagonal of the box round all joint anchors, metres."""
        places = np.array(list(self.anchor.values()))
        return float(np.linalg.norm(np.ptp(places, axis=0)))


def _thin(half: Array) -> Array:
    """The half sizes of a box without its two short ones: the middle of its far end, not a corner."""
    return np.where(np.arange(3) == int(half.argmax()), half, 0.0)
