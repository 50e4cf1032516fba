"""`mmmd plot`: goal and measured angle of each joint over a recorded run, with limits, commands and seams."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.recording.mcap_reading import Log
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]

QUIET_DEG = 2.0
"""Degrees of range over the whole run below which a joint's panel is small."""
_TALL_IN, _SMALL_IN, _STRIP_IN = 1.3, 0.45, 0.35
_GOAL, _MEASURED, _LIMIT, _SEAM = "#2471a3", "#c0392b", "#8d6e63", "#9aa0a6"
_BANDS = ("#e8f0fe", "#fef3e0")


@dataclass(frozen=True)
class Span:
    """Begin and end of one plan in seconds, and its text."""

    start_s: float
    end_s: float
    text: str


def spans(log: Log) -> list[Span]:
    """The plans of a run in order; a plan that begins at another's end marks a seam."""
    found: list[Span] = []
    start_ns, plan_id = log.cycles[0].t_mono_ns, 0
    started = start_ns
    for cycle in (*log.cycles, None):
        now = log.cycles[-1].t_mono_ns if cycle is None else cycle.t_mono_ns
        new = 0 if cycle is None else cycle.plan_id
        if new != plan_id:
            if plan_id:
                text = log.plan_texts.get(plan_id, f"plan {plan_id}")
                found.append(Span((started - start_ns) * 1e-9, (now - start_ns) * 1e-9, text))
            plan_id, started = new, now
    return found


def joint_plot(log: Log, robot: RobotModel, path: Path) -> None:
    """Draw one panel for each joint, moving joints tall and quiet ones small, and save the picture.

    Each panel's title gives the joint's headroom: the fewest degrees between any goal and a limit.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    time_s = np.array([c.t_mono_ns for c in log.cycles]) * 1e-9
    time_s = time_s - time_s[0]
    goal_deg = np.rad2deg([c.goal_rad for c in log.cycles])
    measured_deg = np.rad2deg(JointServoMap(robot).tick_to_rad(np.array([c.present_tick for c in log.cycles])))
    quiet = np.ptp(goal_deg, axis=0) < QUIET_DEG
    order = [*np.flatnonzero(~quiet), *np.flatnonzero(quiet)]
    heights = [_STRIP_IN, *(_SMALL_IN if quiet[j] else _TALL_IN for j in order)]
    figure: Any = Figure(figsize=(12.0, sum(heights) + 0.12 * len(heights) + 0.5), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(len(heights), 1, sharex=True, gridspec_kw={"height_ratios": heights})
    plans = spans(log)
    _strip(axes[0], plans)
    for axis, j in zip(axes[1:], order, strict=True):
        _bands(axis, plans)
        low_deg, high_deg = np.rad2deg([robot.position_min_rad[j], robot.position_max_rad[j]])
        axis.plot(time_s, goal_deg[:, j], color=_GOAL, linewidth=1.0, label="goal")
        axis.plot(time_s, measured_deg[:, j], color=_MEASURED, linewidth=0.8, label="measured")
        bottom, top = _range(goal_deg[:, j], measured_deg[:, j])
        for limit_deg in (low_deg, high_deg):
            if bottom < limit_deg < top:
                axis.axhline(limit_deg, color=_LIMIT, linewidth=1.0, linestyle="--", label="limit")
        axis.set_ylim(bottom, top)
        headroom_deg = min(float((goal_deg[:, j] - low_deg).min()), float((high_deg - goal_deg[:, j]).min()))
        name = f"{robot.joint_names[j]}: limits {low_deg:.0f} to {high_deg:.0f}°, headroom {headroom_deg:.1f}°"
        axis.set_title(name, fontsize=6 if quiet[j] else 8, loc="left", pad=2)
        axis.set_ylabel("" if quiet[j] else "degrees", fontsize=7)
        axis.tick_params(labelsize=5 if quiet[j] else 7)
    axes[-1].set_xlabel("seconds since the start of the log; dashed grey: seam between two commands", fontsize=8)
    labels, handles = _all_labels(axes[1:])
    first = dict(zip(labels, handles, strict=True))
    figure.legend(list(first.values()), list(first), fontsize=8, loc="outside upper right", ncols=3, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings():  # a sign that the font lacks, as an emoji in a text, is drawn as a box
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        figure.savefig(path, dpi=110)


def _strip(axis: Any, plans: list[Span]) -> None:
    """Draw the commands over time."""
    _bands(axis, plans)
    for plan in plans:
        axis.text(plan.start_s, 0.5, f" {plan.text}", fontsize=7, va="center", clip_on=True)
    axis.set_ylim(0, 1)
    axis.set_yticks([])
    axis.set_title("command", fontsize=8, loc="left", pad=2)


def _bands(axis: Any, plans: list[Span]) -> None:
    for k, plan in enumerate(plans):
        axis.axvspan(plan.start_s, plan.end_s, color=_BANDS[k % 2], linewidth=0, zorder=0)
        if k and abs(plan.start_s - plans[k - 1].end_s) < 1e-6:
            axis.axvline(plan.start_s, color=_SEAM, linewidth=0.8, linestyle="--")


def _range(*values_deg: Array) -> tuple[float, float]:
    """Lowest and highest degree of the panel, with a margin."""
    low, high = min(float(v.min()) for v in values_deg), max(float(v.max()) for v in values_deg)
    margin = 0.12 * max(high - low, QUIET_DEG)
    return low - margin, high + margin


def _all_labels(axes: Any) -> tuple[list[str], list[Any]]:
    pairs = [axis.get_legend_handles_labels() for axis in axes]
    return [label for _, labels in pairs for label in labels], [handle for handles, _ in pairs for handle in handles]
