"""Figures of a recorded run, as a notebook would begin: `python docs/examples/log_figures.py run.mcap`, from `mmmd run --log`.

The log only names its robot, so a robot of your own is given by its file: `log_figures.py run.mcap my_robot.toml`.
The arrays are plain NumPy: `pandas.DataFrame(goal_deg, columns=robot.joint_names, index=time_s)` goes on from here.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from daemon.recording.mcap_reading import read_log
from retarget.robot.loading import load_robot
from retarget.robot.ticks import JointServoMap


def main(file: Path, robot_file: str = "") -> None:
    """Print how far, how fast and how well each joint moved. `robot_file` is needed where the robot is not a packaged one."""
    log = read_log(file)
    robot = load_robot(robot_file or log.metadata["robot"])
    time_s = np.array([c.t_mono_ns for c in log.cycles]) * 1e-9
    goal_deg = np.rad2deg([c.goal_rad for c in log.cycles])
    measured_deg = np.rad2deg(JointServoMap(robot).tick_to_rad(np.array([c.present_tick for c in log.cycles])))
    print(f"{robot.name}, {time_s[-1] - time_s[0]:.1f} s, {len(time_s)} cycles: {', '.join(log.plan_texts.values())}")
    print(f"{'joint':<24}{'range':>8}{'fastest':>10}{'limit':>8}{'off goal':>10}   (degrees, degrees/s)")
    speed_deg_s = np.abs(np.diff(goal_deg, axis=0) / np.diff(time_s)[:, None])
    for j, joint in enumerate(robot.joints):
        off_deg = np.abs(goal_deg[:, j] - measured_deg[:, j]).mean()
        limit_deg_s = np.rad2deg(joint.velocity_limit_rad_s)
        print(
            f"{joint.name:<24}{np.ptp(goal_deg[:, j]):8.1f}{speed_deg_s[:, j].max():10.1f}{limit_deg_s:8.0f}{off_deg:10.2f}"
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:3])
