"""The frames to draw: a generated motion with the robot that performs it, or a recorded run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daemon.errors import DaemonError
from daemon.recording.mcap_reading import Log, read_log
from mmm_core.motion.motion import Motion, load_npz
from mmm_core.motion.skeleton import matrix_from_quat
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]
RUN_FPS = 20.0
"""Frames a second at which a run is sampled for a film; a generated motion has the same rate."""


@dataclass(frozen=True)
class Performance:
    """T frames at `fps` a second.

    Attributes:
        robot: the robot that the angles belong to.
        fps: frames per second.
        robot_rad: (T, J) the robot's joint angles: measured ones of a run, planned ones of a motion.
        goal_rad: (T, J) the goals that were sent in a run; None for a motion.
        person_m: (T, 22, 3) the generated person's joints; None for a run.
        head_faces: (T, 3) unit vectors to where the person's head faces; None for a run.
        captions: (T) text of the command performed in each frame.
        problem: what is wrong with the log of a run that ends early or is damaged; empty where nothing is.
    """

    robot: RobotModel
    fps: float
    robot_rad: Array
    captions: tuple[str, ...]
    goal_rad: Array | None = None
    person_m: Array | None = None
    head_faces: Array | None = None
    problem: str = ""

    def __len__(self) -> int:
        return len(self.robot_rad)

    @property
    def duration_s(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) / self.fps


def read_performance(file: Path, robot: str | None, *, fps: float, from_s: float, to_s: float | None) -> Performance:
    """The performance in an .npz of `mmmd generate` or an .mcap of `mmmd run --log`.

    Args:
        file: the motion or the run.
        robot: name or robot.toml; `reference` for a motion and the run's own robot if None.
        fps: frames per second at which a run is sampled; a motion keeps its own.
        from_s: seconds that are left out at the start.
        to_s: second to end at; the end of the file if None.

    Raises:
        DaemonError: no frame lies between `from_s` and `to_s`.
        LogError, MotionFileError, RobotFileError: the file or the robot cannot be read.
    """
    if file.suffix == ".mcap":
        log = read_log(file)
        whole = of_run(log, load_robot(robot or log.metadata["robot"]), fps)
    else:
        motion = load_npz(file)
        whole = of_motion(motion, load_robot(robot or "reference"), motion.text or file.name)
    end = len(whole) if to_s is None else min(len(whole), round(to_s * whole.fps) + 1)
    start = max(0, round(from_s * whole.fps))
    if start >= end:
        asked = f"{from_s:g} to {'the end' if to_s is None else f'{to_s:g}'} s"
        raise DaemonError(f"{file}: no frame from {asked}; it lasts {whole.duration_s:.1f} s")
    return cut(whole, start, end)


def of_motion(motion: Motion, robot: RobotModel, title: str, robot_rad: Array | None = None) -> Performance:
    """A generated motion and the robot that follows it: the first T frames for angles (T, J), retargeted if None."""
    angles_rad = Retargeter(robot).retarget(motion).q_rad if robot_rad is None else robot_rad
    n = min(len(motion.joints_m), len(angles_rad))
    faces = np.asarray(matrix_from_quat(motion.head_quat_wxyz[:n].astype(np.float64))[..., 2], np.float64)
    person_m = motion.joints_m[:n].astype(np.float64)
    return Performance(robot, motion.fps, angles_rad[:n], (title,) * n, person_m=person_m, head_faces=faces)


def of_run(log: Log, robot: RobotModel, fps: float) -> Performance:
    """A recorded run, sampled at `fps`: each frame shows the last bus cycle before its time."""
    cycle_s = np.array([c.t_mono_ns for c in log.cycles]) * 1e-9
    cycle_s = cycle_s - cycle_s[0]
    frame_s = np.arange(0.0, cycle_s[-1] + 1e-9, 1.0 / fps)
    last_before: list[int] = (np.searchsorted(cycle_s, frame_s, "right") - 1).tolist()
    cycles = [log.cycles[i] for i in last_before]
    measured_rad = JointServoMap(robot).tick_to_rad(np.array([c.present_tick for c in cycles]))
    captions = tuple(log.plan_texts.get(c.plan_id, "") or c.state for c in cycles)
    goal_rad = np.array([c.goal_rad for c in cycles])
    return Performance(robot, fps, measured_rad, captions, goal_rad, problem=log.problem)


def cut(whole: Performance, start: int, end: int | None = None) -> Performance:
    """Frames `start` to `end` of a performance."""
    arrays = {
        name: None if (values := getattr(whole, name)) is None else values[start:end]
        for name in ("robot_rad", "goal_rad", "person_m", "head_faces")
    }
    return replace(whole, captions=whole.captions[start:end], **arrays)
