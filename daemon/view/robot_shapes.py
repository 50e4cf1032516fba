"""A robot for drawing on a web page: a tree of bodies with their joints, and each body's triangles.

The page places the bodies itself from joint angles, so that only angles are sent while the robot moves. Shapes are those of the
robot's description: capsules, boxes, spheres, cylinders, and meshes where their files exist.
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from daemon.pictures.person import hand_share, radii_m
from daemon.pictures.scene import COLOURS, limb_of_bodies, lowest_m, person_stand, shoulder_and_arm
from mmm_core.motion.skeleton import JOINT_NAMES, PARENTS
from retarget.robot.description import load_description, mujoco
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
_AROUND = 14
"""Number of corners of the circles in round shapes."""
_Mesh = tuple[Array, Array, NDArray[np.int64]]
"""Vertices (V, 3) in metres, their normals (V, 3), zero for a flat face's own, and triangles (F, 3) of vertex indices."""


def robot_shapes(robot: RobotModel) -> bytes:
    """The robot as one message: length of the JSON (u32), the JSON padded to four bytes, vertices (V, 6) f32, indices u32.

    The JSON names `joints` with their limits, `bodies` (parent, place in the parent, joints, colour, and where their triangles
    begin) and where a person stands beside the robot. Lengths are metres, x forward, y left, z up.

    Raises:
        RobotFileError: the description cannot be read.
    """
    model = load_description(robot)
    meshes = [_mesh_of_body(model, body) for body in range(model.nbody)]
    limbs = limb_of_bodies(model, robot)
    of_joint = {model.joint(name).id: j for j, name in enumerate(robot.joint_names)}
    bodies: list[dict[str, Any]] = []
    first = 0
    for body, (_, _, triangles) in enumerate(meshes):
        ours = [j for j in range(model.njnt) if model.jnt_bodyid[j] == body and j in of_joint]
        bodies.append({
            "parent": int(model.body_parentid[body]) if body else -1,
            "pos": model.body_pos[body].tolist(),
            "quat": model.body_quat[body].tolist(),
            "joints": [
                {
                    "index": of_joint[j], "axis": model.jnt_axis[j].tolist(), "anchor": model.jnt_pos[j].tolist(),
                    "zero_rad": float(model.qpos0[model.jnt_qposadr[j]]),
                }
                for j in ours
            ],
            "colour": COLOURS.get(limbs[body], COLOURS[""]),
            "first": first,
            "count": int(triangles.size),
        })  # fmt: skip
        first += int(triangles.size)
    vertices, indices = _joined(meshes)
    shoulder_m, arm_m = shoulder_and_arm(robot)
    stand, floor_m = person_stand(shoulder_m, arm_m)
    head = {
        "robot": robot.name,
        "joints": [
            {
                "name": j.name, "min_rad": j.position_min_rad, "max_rad": j.position_max_rad,
                "velocity_rad_s": j.velocity_limit_rad_s, "rest_rad": j.rest_rad, "park_rad": j.park_rad,
            }
            for j in robot.joints
        ],
        "bodies": bodies,
        "n_vertices": len(vertices),
        "arm_m": arm_m,
        "shoulder_m": shoulder_m.tolist(),
        "floor_m": floor_m,
        "stand_m": max(floor_m, lowest_m(robot)),
        "person": {
            "parents": PARENTS,
            "limbs": [name.partition("_")[0] if "_" in name else "" for name in JOINT_NAMES],
            "colours": COLOURS,
            "shoulder_m": stand.shoulders_m.tolist(),
            "scale": stand.scale,
            "radii_m": radii_m(),
            "hand_share": hand_share(),
        },
    }  # fmt: skip
    text = msgspec.json.encode(head)
    text += b" " * (-len(text) % 4)
    return len(text).to_bytes(4, "little") + text + vertices.astype("<f4").tobytes() + indices.astype("<u4").tobytes()


def _joined(meshes: list[_Mesh]) -> tuple[Array, NDArray[np.int64]]:
    """Vertices and normals of all meshes (V, 6), and the indices of their triangles in these."""
    starts = np.cumsum([0, *(len(points) for points, _, _ in meshes)])
    vertices = np.concatenate([np.concatenate([points, normals], 1) for points, normals, _ in meshes])
    indices = [triangles.ravel() + start for (_, _, triangles), start in zip(meshes, starts, strict=False)]
    return vertices, np.concatenate(indices)


def _mesh_of_body(model: Any, body: int) -> _Mesh:
    """All shapes of a body in the body's axes."""
    found: list[_Mesh] = []
    for geom in np.flatnonzero(model.geom_bodyid == body):
        points, normals, triangles = _mesh_of_geom(model, int(geom))
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        R_body_geom = turn.reshape(3, 3)
        found.append((points @ R_body_geom.T + model.geom_pos[geom], normals @ R_body_geom.T, triangles))
    if not found:
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    starts = np.cumsum([0, *(len(points) for points, _, _ in found)])
    return (
        np.concatenate([points for points, _, _ in found]),
        np.concatenate([normals for _, normals, _ in found]),
        np.concatenate([triangles + start for (_, _, triangles), start in zip(found, starts, strict=False)]),
    )


def _mesh_of_geom(model: Any, geom: int) -> _Mesh:
    """One shape in the body's axes; a plane, which is scenery, has no triangles."""
    kinds = {getattr(mujoco.mjtGeom, f"mjGEOM_{kind}").value: kind for kind in _KINDS}
    kind, size = kinds.get(int(model.geom_type[geom]), ""), model.geom_size[geom]
    if kind == "MESH":
        return _mesh_of_file(model, int(model.geom_dataid[geom]))
    if kind == "SPHERE":
        return _round(np.array([size[0]] * 3), 0.0)
    if kind == "ELLIPSOID":
        return _round(np.array(size), 0.0)
    if kind == "CAPSULE":
        return _round(np.array([size[0]] * 3), float(size[1]))
    if kind == "CYLINDER":
        return _cylinder(float(size[0]), float(size[1]))
    if kind == "BOX":
        return _box(np.array(size))
    return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3), np.int64)


_KINDS = ("MESH", "SPHERE", "ELLIPSOID", "CAPSULE", "CYLINDER", "BOX")


def _mesh_of_file(model: Any, mesh: int) -> _Mesh:
    points = model.mesh_vert[model.mesh_vertadr[mesh] :][: model.mesh_vertnum[mesh]].astype(np.float64)
    triangles = model.mesh_face[model.mesh_faceadr[mesh] :][: model.mesh_facenum[mesh]].astype(np.int64)
    return points, np.zeros_like(points), triangles


def _round(radii_m: Array, half_length_m: float) -> _Mesh:
    """An ellipsoid, extended along z by `half_length_m` on both sides as a capsule is."""
    rings = np.concatenate([np.linspace(-np.pi / 2, 0, _AROUND // 2), np.linspace(0, np.pi / 2, _AROUND // 2)])
    turns = np.linspace(0, 2 * np.pi, _AROUND + 1)
    latitude, longitude = np.meshgrid(rings, turns, indexing="ij")
    unit = np.stack([
        np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude),
    ], -1)  # fmt: skip
    points = unit * radii_m
    points[: _AROUND // 2, :, 2] -= half_length_m
    points[_AROUND // 2 :, :, 2] += half_length_m
    normals = unit / radii_m
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return points.reshape(-1, 3), normals.reshape(-1, 3), _grid(len(rings), len(turns))


def _cylinder(radius_m: float, half_length_m: float) -> _Mesh:
    turns = np.linspace(0, 2 * np.pi, _AROUND + 1)
    circle = np.stack([np.cos(turns), np.sin(turns), 0 * turns], -1)
    down = np.array([0.0, 0.0, half_length_m])
    rows = [circle * 0 - down, radius_m * circle - down, radius_m * circle - down, radius_m * circle + down]
    rows += [radius_m * circle + down, circle * 0 + down]
    flat = np.tile([0.0, 0.0, 1.0], (len(circle), 1))
    points, normals = np.concatenate(rows), np.concatenate([-flat, -flat, circle, circle, flat, flat])
    return points, normals, _grid(len(rows), len(turns))


def _box(half_m: Array) -> _Mesh:
    points: list[Array] = []
    normals: list[Array] = []
    triangles: list[list[int]] = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            u, v = np.roll(np.eye(3), 1, 0)[axis], np.roll(np.eye(3), 2, 0)[axis]
            corners = [(normal + a * u + b * v) * half_m for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            triangles += [[len(points) + k for k in (0, *pair)] for pair in ((1, 2), (2, 3))]
            points += corners
            normals += [normal] * 4
    return np.array(points), np.array(normals), np.array(triangles)


def _grid(rows: int, columns: int) -> NDArray[np.int64]:
    """Triangles between neighbouring rows of vertices."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    lower = np.stack([corner, corner + 1, corner + columns + 1], -1)
    return np.concatenate([lower, np.stack([corner, corner + columns + 1, corner + columns], -1)])
