"""`mmmd render`: pictures of a motion or a run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro


def render(file: Annotated[Path, tyro.conf.Positional], out: Path, robot: str | None = None) -> int:
    """Draw an .npz motion as a contact sheet of human and robot, or an .mcap run as joint angles over time.

    Example: mmmd render wave.npz --robot op3 --out wave.png
    or: mmmd render run.mcap --out joints.png

    Args:
        file: an .npz of `mmmd generate`, or an .mcap of `mmmd run --log`.
        out: the PNG to write.
        robot: name or robot.toml; reference for motions and the log's own robot for runs when not given.
    """
    import numpy as np
    from rich.console import Console

    from daemon.recording.mcap_log import read_log
    from daemon.render import Shown, contact_sheet, joint_plot
    from mmm_core.motion import load_npz
    from retarget.pipeline import Retargeter
    from retarget.robot import load_robot
    from retarget.ticks import JointServoMap

    if file.suffix == ".mcap":
        log = read_log(file)
        model = load_robot(robot or log.metadata["robot"])
        times_s = np.array([c.t_mono_ns for c in log.cycles]) * 1e-9
        present_rad = JointServoMap(model).tick_to_rad(np.array([c.present_tick for c in log.cycles]))
        goal_rad = np.array([c.goal_rad for c in log.cycles])
        joint_plot(times_s - times_s[0], goal_rad, present_rad, model, out)
    else:
        model = load_robot(robot or "reference")
        motion = load_npz(file)
        path = Retargeter(model).retarget(motion)
        contact_sheet([Shown(motion.text or file.name, motion.joints_m.astype(np.float64), path.q_rad)], model, out)
    Console(soft_wrap=True).print(f"{out}: drawn", highlight=False)
    return 0
