"""A picture of a robot: its shapes from the front and from the left, in several poses. Drawn by matplotlib without a GPU."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retarget.robot.description import load_description, mujoco
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
_COLOURS = {"left": "#c0392b", "right": "#2471a3", "head": "#7d6608", "": "#7f8c8d"}
_ROUND = np.linspace(0, 2 * np.pi, 16, endpoint=False)


@dataclass(frozen=True)
class Pose:
    """A title and joint angles (J,)."""

    title: str
    q_rad: Array


def robot_picture(robot: RobotModel, poses: list[Pose], path: Path) -> None:
    """Draw every pose from the front (the robot's left on the right) above and from its left below, and save the picture."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    view = _View(robot)
    figure: Any = Figure(figsize=(2.1 * len(poses), 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(2, len(poses), squeeze=False)
    middle, size = view.extent(poses)
    for k, pose in enumerate(poses):
        view.place(pose.q_rad)
        for row, (across, depth, sign) in enumerate(((1, 0, 1.0), (0, 1, -1.0))):
            axis = axes[row][k]
            view.draw(axis, across, depth, sign)
            centre = sign * middle[across] if row else middle[across]
            axis.set_xlim(centre - size, centre + size)
            axis.set_ylim(middle[2] - size, middle[2] + size)
            axis.set_aspect("equal")
            axis.axis("off")
        axes[0][k].set_title(pose.title, fontsize=8)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130)


class _View:
    """The shapes of one robot, placed by MuJoCo."""

    def __init__(self, robot: RobotModel) -> None:
        self.model: Any = load_description(robot)
        self.data: Any = mujoco.MjData(self.model)
        self._address = [self.model.joint(name).qposadr[0] for name in robot.joint_names]
        self._part = self._parts(robot)

    def place(self, q_rad: Array) -> None:
        """Put the robot into a pose."""
        self.data.qpos[self._address] = q_rad
        mujoco.mj_kinematics(self.model, self.data)

    def extent(self, poses: list[Pose]) -> tuple[Array, float]:
        """Middle and half size of everything drawn: the parts that move and their supports."""
        seen: list[Array] = []
        for pose in poses:
            self.place(pose.q_rad)
            seen += [self._outline(g) for g in range(self.model.ngeom) if self._part[int(self.model.geom_bodyid[g])]]
            seen.append(np.array(self.data.site_xpos).reshape(-1, 3))
        points = np.concatenate([s for s in seen if len(s)])
        low, high = points.min(0), points.max(0)
        return (low + high) / 2, float((high - low).max()) * 0.56

    def draw(self, axis: Any, across: int, depth: int, sign: float) -> None:
        """Draw all shapes as filled outlines, the farthest first."""
        shapes = [(self._outline(g), self._part[int(self.model.geom_bodyid[g])]) for g in range(self.model.ngeom)]
        for points, part in sorted(
            shapes, key=lambda s: float(s[0][:, depth].mean()) * (1 if depth == 0 else sign * -1)
        ):
            hull = _hull(points[:, [across, 2]] * [sign if depth else 1.0, 1.0])
            axis.fill(hull[:, 0], hull[:, 1], color=_COLOURS[part], alpha=0.75, linewidth=0.6, edgecolor="#1b2631")

    def _parts(self, robot: RobotModel) -> list[str]:
        """The colour of each body: that of the nearest joint above it."""
        role = {int(self.model.jnt_bodyid[self.model.joint(j.name).id]): j.role.split("_")[0] for j in robot.joints}
        parts = [""] * self.model.nbody
        for body in range(1, self.model.nbody):
            parts[body] = role.get(body, parts[int(self.model.body_parentid[body])])
        return [p if p in _COLOURS else "" for p in parts]

    def _outline(self, geom: int) -> Array:
        """(N, 3) points whose convex hull is the shape."""
        kind, size = int(self.model.geom_type[geom]), self.model.geom_size[geom]
        sphere, capsule, cylinder = (
            int(getattr(mujoco.mjtGeom, f"mjGEOM_{k}")) for k in ("SPHERE", "CAPSULE", "CYLINDER")
        )
        if kind in (sphere, capsule, cylinder):
            long = 0.0 if kind == sphere else float(size[1])
            circles = (2,) if kind == cylinder else (0, 1, 2)
            points = [_circle(float(size[0]), normal, end) for end in (-long, long) for normal in circles]
            local = np.concatenate(points)
        else:
            box = self.model.geom_aabb[geom]
            corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
            local = box[:3] + corners * box[3:]
        return self.data.geom_xpos[geom] + local @ self.data.geom_xmat[geom].reshape(3, 3).T


def _circle(radius: float, normal: int, along: float) -> Array:
    """(16, 3) points of a circle, shifted along z by `along`."""
    points = np.zeros((len(_ROUND), 3))
    points[:, (normal + 1) % 3], points[:, (normal + 2) % 3] = radius * np.cos(_ROUND), radius * np.sin(_ROUND)
    points[:, 2] += along
    return points


def _hull(points: Array) -> Array:
    """(M, 2) convex hull of (N, 2) points, by Andrew's monotone chain."""
    ordered = np.unique(points, axis=0)
    chains: list[list[Array]] = []
    for row in (ordered, ordered[::-1]):
        chain: list[Array] = []
        for p in row:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return np.array(chains[0] + chains[1])


def _turn(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
