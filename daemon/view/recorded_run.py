"""A recorded run as one message for the web page."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path

import msgspec
import numpy as np

from daemon.pictures.performance import RUN_FPS, read_performance
from retarget.robot.robot import RobotModel


def recorded_run(file: Path, robot: str | None) -> tuple[RobotModel, bytes]:
    """The robot of a log, and the run as one message: length of the JSON (u32), the JSON, goal and measured angles (T, J) f32.

    Args:
        file: .mcap of `mmmd run --log`.
        robot: name or robot.toml; the run's own robot if None.

    Raises:
        LogError, RobotFileError: the log or the robot cannot be read.
    """
    run = read_performance(file, robot, fps=RUN_FPS, from_s=0.0, to_s=None)
    assert run.goal_rad is not None, "a log has goals"
    spans: list[dict[str, object]] = []
    first = 0
    for caption, frames in groupby(run.captions):
        n = len(list(frames))
        spans.append({"text": caption, "first": first, "end": first + n})
        first += n
    head = {"file": file.name, "robot": run.robot.name, "fps": run.fps, "frames": len(run), "spans": spans}
    text = msgspec.json.encode(head)
    text += b" " * (-len(text) % 4)
    angles = np.concatenate([run.goal_rad.ravel(), run.robot_rad.ravel()]).astype("<f4")
    return run.robot, len(text).to_bytes(4, "little") + text + angles.tobytes()
