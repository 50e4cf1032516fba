"""Reads a robot's description, MJCF or URDF, with MuJoCo, for kinematics and contacts.

Meshes are optional: a mesh without its file is left out, and its shape is then not checked for contacts. Masses and inertias are
not used. Joints that only follow another joint and loops of bodies lie outside the tree on which angles are computed, so a
description in which they would give wrong angles is refused.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.errors import RobotFileError
from retarget.robot.robot import DIRECTIONS, RobotModel

mujoco: Any = importlib.import_module("mujoco")  # without type stubs: declared Any here, once, instead of at each use
_SMALL = 1e-9
_ALLOWED = "MJCF or URDF that MuJoCo reads"


@dataclass(frozen=True)
class Follower:
    """A joint that turns with another: a mimic joint of a URDF or a joint equality of an MJCF."""

    name: str
    leader: str


def read_spec(path: Path) -> tuple[Any, tuple[str, ...]]:
    """A description as an editable MuJoCo specification whose bodies all have names, and the meshes left out of it.

    Raises:
        RobotFileError: MuJoCo cannot read it.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except ValueError as error:
        raise RobotFileError(path, "description", _first_line(error), _ALLOWED) from error
    for i, body in enumerate(spec.bodies):
        body.name = body.name or f"body_{i}"
    spec.compiler.fusestatic = False  # fixed links of a URDF keep their names
    spec.compiler.balanceinertia = True
    spec.compiler.boundmass, spec.compiler.boundinertia = _SMALL, _SMALL
    missing = tuple(mesh.name for mesh in spec.meshes if mesh.file and not _mesh_file(path, spec, mesh.file).is_file())
    for geom in list(spec.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH and geom.meshname in missing:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        if mesh.name in missing:
            spec.delete(mesh)
    return spec, missing


def description_spec(robot: RobotModel) -> Any:
    """The robot's description turned to x forward and z up, with the points of the robot file as sites.

    Raises:
        RobotFileError: MuJoCo cannot read it, or it has a loop or a follower where the robot file needs a joint.
    """
    spec, _ = read_spec(robot.description_path)
    refuse_unseen_motion(robot, spec)
    if (robot.forward, robot.up) != ("x", "z"):
        _turn(spec, robot.forward, robot.up)
    for name, point in robot.points:
        body = spec.body(point.body)
        if body is None:
            known = ", ".join(b.name for b in spec.bodies)
            raise RobotFileError(robot.path, f"points.{name}.body", f"'{point.body}' is not in the description", known)
        old = spec.site(name)
        if old is not None:
            spec.delete(old)
        body.add_site(name=name, pos=point.offset_m)
    return spec


def load_description(robot: RobotModel) -> Any:
    """The robot's description as a MuJoCo model.

    Raises:
        RobotFileError: MuJoCo cannot read it, or it has a loop or a follower where the robot file needs a joint.
    """
    return compiled(robot.description_path, description_spec(robot))


def compiled(path: Path, spec: Any) -> Any:
    """A specification as a model.

    Raises:
        RobotFileError: MuJoCo cannot compile it.
    """
    try:
        return spec.compile()
    except ValueError as error:
        raise RobotFileError(path, "description", _first_line(error), _ALLOWED) from error


def followers(spec: Any) -> list[Follower]:
    """Joints of a specification that only follow another joint."""
    joint_equality = mujoco.mjtEq.mjEQ_JOINT
    return [Follower(e.name1, e.name2) for e in spec.equalities if e.type == joint_equality and e.name1 and e.name2]


def loops(spec: Any) -> list[tuple[str, str]]:
    """Pairs of bodies (or sites) that a constraint ties together besides the tree."""
    tied = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)
    return [(e.name1, e.name2 or "world") for e in spec.equalities if e.type in tied]


def refuse_unseen_motion(robot: RobotModel, spec: Any) -> None:
    """Refuse followers and loops that would move a listed joint or a point off the place that the tree gives.

    Raises:
        RobotFileError: there is such a follower or loop; the message has the remedy.
    """
    listed = set(robot.joint_names)
    needed = _needed_bodies(robot, spec)
    parent = {body.name: body.parent.name for body in spec.bodies if body.parent is not None}
    for follower in followers(spec):
        if follower.name in listed and follower.leader in listed:
            found = f"'{follower.name}' follows '{follower.leader}'; both are listed"
            raise RobotFileError(robot.path, "joint name", found, "one of the two; the other has no servo of its own")
        joint = spec.joint(follower.name)
        if follower.leader in listed and joint is not None and joint.parent.name in _above(needed, parent):
            found = f"'{follower.leader}' drives '{follower.name}', which moves what the robot file names"
            remedy = f"list '{follower.name}' instead, with the gear between them as its servo's gear_ratio"
            raise RobotFileError(robot.path, "joint name", found, remedy)
    for a, b in loops(spec):
        if {a, b} & _above(needed, parent):
            found = f"a constraint ties '{a}' to '{b}': a closed loop"
            remedy = "a tree; take the rods out of the description and give the servo a linkage table instead"
            raise RobotFileError(robot.description_path, "description", found, remedy)


def _needed_bodies(robot: RobotModel, spec: Any) -> set[str]:
    """Names of the bodies with a listed joint or a point."""
    needed = {joint.parent.name for joint in spec.joints if joint.name in robot.joint_names}
    needed |= {point.body for _, point in robot.points}
    return needed | {
        site.parent.name for site in spec.sites if site.name in ("left_wrist", "right_wrist", "head", "chest")
    }


def _above(bodies: set[str], parent: dict[str, str]) -> set[str]:
    """The bodies and all bodies that carry them, without the world."""
    found: set[str] = set()
    for body in bodies:
        name = body
        while name in parent and name not in found:
            found.add(name)
            name = parent[name]
    return found


def rotation_to_standard(forward: str, up: str) -> NDArray[np.float64]:
    """(3, 3) rotation from a description's axes to x forward, y left, z up."""
    x, z = np.array(DIRECTIONS[forward]), np.array(DIRECTIONS[up])
    return np.stack([x, np.cross(z, x), z])


def _turn(spec: Any, forward: str, up: str) -> None:
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, rotation_to_standard(forward, up).ravel())
    frame = spec.worldbody.add_frame(quat=quat)
    for element in [*spec.worldbody.bodies, *spec.worldbody.geoms, *spec.worldbody.sites]:
        element.set_frame(frame)


def _mesh_file(path: Path, spec: Any, file: str) -> Path:
    return path.parent / (spec.meshdir or "") / file.removeprefix("file://")


def _first_line(error: Exception) -> str:
    return str(error).splitlines()[0]
