"""Pictures while a model trains: a row of small figures for each motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mmm_core.motion.skeleton import JOINT_NAMES, PARENTS

INSTANTS = 8
_COLOURS = {"left": "#c0392b", "right": "#2471a3"}


def draw_rows(path: Path, motions: dict[str, NDArray[np.floating]]) -> None:
    """Draw each motion (T, 22, 3) at eight instants under its title, from the front: the person's left on the right."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(1.5 * INSTANTS, 1.75 * len(motions)))
    FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=1 - 0.15 / len(motions), wspace=0, hspace=0.12)
    axes = figure.subplots(len(motions), INSTANTS, squeeze=False)
    for row, (title, joints) in zip(axes, motions.items(), strict=True):
        for axis, t in zip(row, np.linspace(0, len(joints) - 1, INSTANTS).round().astype(int), strict=True):
            pose = joints[t] - joints[t, 0] * np.array([1, 0, 1])
            for joint, parent in enumerate(PARENTS[1:], 1):
                colour = _COLOURS.get(JOINT_NAMES[joint].partition("_")[0], "#444444")
                axis.plot(pose[[parent, joint], 0], pose[[parent, joint], 1], color=colour, linewidth=1.2)
            axis.set(xlim=(-1, 1), ylim=(-0.1, 2.1), aspect="equal")
            axis.axis("off")
        row[0].set_title(title[:60], fontsize=7, loc="left")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80)
