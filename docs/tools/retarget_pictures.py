"""The pictures of docs/retargeting.md: where the direction error comes from.

    python -m docs.tools.retarget_pictures docs/pictures

draws them anew from the motions that `mmmd bench retarget` measures on.
"""

from __future__ import annotations

import importlib
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.bench.motions import bench_motions
from daemon.bench.retarget import causal_path, with_common_limits, wrist_speed_m_s
from mmm_core.motion.motion import FPS, Motion
from retarget.human.human import read_human
from retarget.path.collision import SelfContact
from retarget.pipeline import Retargeter
from retarget.robot.loading import list_robots, load_robot
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
_CLIPS = 21
_DPI = 80
_ROBOT = "reference"
_BLUE, _ORANGE, _GREY, _RED = "#3b6ea8", "#d98032", "#8a8a8a", "#b03a3a"


class _Untouchable(SelfContact):
    """A robot that may go through itself: what is left of the error then is reach and limits."""

    def __init__(self, robot: RobotModel) -> None:
        super().__init__(robot)
        self._margin_m = np.full_like(self._margin_m, -np.inf)


@dataclass(frozen=True)
class _Errors:
    """Direction errors of one clip in degrees, (4, T): poses alone, within limits in time, and all together; a causal clamp's."""

    reach: Array
    limited: Array
    whole: Array
    causal: Array
    wrist_m_s: float


def _errors(robot: RobotModel, motions: list[Motion]) -> list[_Errors]:
    retargeter, through_itself = Retargeter(robot), Retargeter(robot, contact=_Untouchable(robot))
    every: list[_Errors] = []
    for motion in motions:
        poses, T = retargeter.poses(read_human(motion)), len(motion.joints_m)
        limited, whole = (r.retarget(motion).q_rad[:T] for r in (through_itself, retargeter))
        of = [
            retargeter.direction_errors_deg(poses, q)
            for q in (poses.q_rad, limited, whole, causal_path(poses.q_rad, retargeter))
        ]
        every.append(_Errors(of[0], of[1], of[2], of[3], wrist_speed_m_s(motion)))
    return every


def draw(folder: Path) -> list[Path]:
    """Write the pictures into a folder."""
    plt: Any = importlib.import_module("matplotlib.pyplot")
    plt.switch_backend("Agg")
    folder.mkdir(parents=True, exist_ok=True)
    _, motions = bench_motions(_CLIPS, 0)
    of = {name: _errors(with_common_limits(load_robot(name)), motions) for name in list_robots()}
    made = {
        "error_sources.png": _sources(plt, of), "error_of_wrist_speed.png": _of_speed(plt, of[_ROBOT]),
        "error_in_time.png": _in_time(plt, of[_ROBOT]),
    }  # fmt: skip
    for name, figure in made.items():
        figure.savefig(folder / name, dpi=_DPI, bbox_inches="tight")
        plt.close(figure)
    return [folder / name for name in made]


def _sources(plt: Any, of: dict[str, list[_Errors]]) -> Any:
    """Bars for each robot: what it cannot reach, what limits in time add, what keeping off itself adds."""
    figure, axes = plt.subplots(figsize=(7, 2.8))
    left = np.zeros(len(of))
    parts = (
        ("beyond its reach", "reach", _GREY),
        ("speed and acceleration", "limited", _BLUE),
        ("self-contact", "whole", _RED),
    )
    for label, part, colour in parts:
        mean = np.array(
            [float(np.concatenate([getattr(e, part).ravel() for e in errors]).mean()) for errors in of.values()]
        )
        axes.barh(list(of), np.maximum(mean - left, 0), left=left, color=colour, label=label)
        left = np.maximum(mean, left)
    axes.invert_yaxis()
    axes.set_xlabel("mean direction error, degrees")
    axes.legend(frameon=False, fontsize=8)
    return figure


def _of_speed(plt: Any, errors: list[_Errors]) -> Any:
    """A dot for each clip: its mean error against how fast its wrists are."""
    figure, axes = plt.subplots(figsize=(4.6, 2.8))
    speed = [e.wrist_m_s for e in errors]
    axes.plot(speed, [float(e.causal.mean()) for e in errors], "x", color=_ORANGE, label="clamped frame by frame")
    axes.plot(speed, [float(e.whole.mean()) for e in errors], "o", ms=4, color=_BLUE, label="with look-ahead")
    axes.plot(speed, [float(e.reach.mean()) for e in errors], ".", color=_GREY, label="without limits")
    axes.set_xlabel("wrist speed, m/s (99 of 100 frames)")
    axes.set_ylabel("mean error, degrees")
    axes.legend(frameon=False, fontsize=8)
    return figure


def _in_time(plt: Any, errors: list[_Errors]) -> Any:
    """The error of the worst bone in each frame of the clip whose causal clamp errs most."""
    worst = max(errors, key=lambda e: float(e.causal.mean()))
    figure, axes = plt.subplots(figsize=(7, 2.4))
    t = np.arange(worst.whole.shape[1], dtype=np.float64) / FPS
    axes.plot(t, worst.causal.max(0), color=_ORANGE, lw=1, label="clamped frame by frame")
    axes.plot(t, worst.whole.max(0), color=_BLUE, lw=1.2, label="with look-ahead")
    axes.plot(t, worst.reach.max(0), color=_GREY, lw=1, label="without limits")
    axes.set_xlabel("seconds")
    axes.set_ylabel("worst bone, degrees")
    axes.legend(frameon=False, fontsize=8)
    return figure


if __name__ == "__main__":
    for path in draw(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")):
        sys.stdout.write(f"{path}\n")
