"""Pictures of what happened: a contact sheet of human and robot, and joint angles over time."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mmm_core.skeleton import JOINT_NAMES, PARENTS
from retarget.kinematics import Kinematics
from retarget.robot import RobotModel

Array = NDArray[np.float64]
N_INSTANTS = 8
_COLOURS = {"left": "#c0392b", "right": "#2471a3", "": "#444444"}
_ROBOT_BONES = [
    ("chest", "left_shoulder"), ("left_shoulder", "left_elbow"), ("left_elbow", "left_wrist"), ("chest", "head"),
    ("chest", "right_shoulder"), ("right_shoulder", "right_elbow"), ("right_elbow", "right_wrist"),
]  # fmt: skip


@dataclass(frozen=True)
class Shown:
    """One motion of a contact sheet: a title, (T, 22, 3) human joints and (T, J) robot angles."""

    title: str
    human_m: Array
    robot_rad: Array


def contact_sheet(rows: list[Shown], robot: RobotModel, path: Path) -> None:
    """Draw human above and robot below at eight instants of each motion; seen from the front, their left on the right."""
    figure, axes = _figure(2 * len(rows), N_INSTANTS, 1.6)
    kinematics = Kinematics(robot)
    for i, row in enumerate(rows):
        places = kinematics.places(row.robot_rad)
        size = float(np.ptp(kinematics.places(np.zeros((1, robot.n_joints))), axis=1).max()) * 0.75
        for k in range(N_INSTANTS):
            share = k / (N_INSTANTS - 1)
            human_axis, robot_axis = axes[2 * i][k], axes[2 * i + 1][k]
            frame = round(share * (len(row.human_m) - 1))
            _draw_human(human_axis, row.human_m[frame])
            at = round(share * (len(places) - 1))
            _draw_robot(robot_axis, {p.name: places[at, n] for n, p in enumerate(kinematics.key_points)}, size)
            human_axis.set_title(f"{frame / 20:.1f} s", fontsize=6, pad=1)
        axes[2 * i][0].text(0, 1.25, row.title, transform=axes[2 * i][0].transAxes, fontsize=8)
    _save(figure, path)


def joint_plot(t_s: Array, goal_rad: Array, present_rad: Array, robot: RobotModel, path: Path) -> None:
    """Draw goal and measured angle of every joint over time, with its limits."""
    n = robot.n_joints
    figure, axes = _figure((n + 1) // 2, 2, 1.1, width=4.5)
    for j in range(n):
        axis = axes[j // 2][j % 2]
        axis.plot(t_s, np.rad2deg(goal_rad[:, j]), color="#2471a3", linewidth=0.8, label="goal")
        axis.plot(t_s, np.rad2deg(present_rad[:, j]), color="#c0392b", linewidth=0.6, label="measured")
        for limit in (robot.position_min_rad[j], robot.position_max_rad[j]):
            axis.axhline(np.rad2deg(limit), color="#999999", linewidth=0.5, linestyle=":")
        axis.set_ylabel(f"{robot.joint_names[j]}\ndeg", fontsize=6)
        axis.tick_params(labelsize=5)
    axes[0][0].legend(fontsize=5, loc="upper right")
    _save(figure, path)


def _figure(rows: int, columns: int, height: float, width: float = 1.5) -> tuple[Any, Any]:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(columns * width, rows * height + 0.3), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False)


def _save(figure: Any, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)


def _draw_human(axis: Any, joints_m: Array) -> None:
    centre = joints_m[0] * [1, 0, 1]
    for j, parent in enumerate(PARENTS):
        if parent >= 0:
            a, b = joints_m[parent] - centre, joints_m[j] - centre
            colour = _COLOURS[side if (side := JOINT_NAMES[j].split("_")[0]) in _COLOURS else ""]
            axis.plot([a[0], b[0]], [a[1], b[1]], color=colour, linewidth=1.2)
    axis.set_xlim(-0.75, 0.75)
    axis.set_ylim(0.0, 2.1)
    axis.set_aspect("equal")
    axis.axis("off")


def _draw_robot(axis: Any, points: dict[str, Array], size_m: float) -> None:
    for a, b in _ROBOT_BONES:
        if a in points and b in points:
            colour = _COLOURS[side if (side := b.split("_")[0]) in _COLOURS else ""]
            axis.plot([points[a][1], points[b][1]], [points[a][2], points[b][2]], color=colour, linewidth=2)
    middle = points["chest"][2] if "chest" in points else 0.0
    axis.set_xlim(-size_m, size_m)
    axis.set_ylim(middle - size_m, middle + size_m)
    axis.set_aspect("equal")
    axis.axis("off")
