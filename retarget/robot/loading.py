"""Finds a robot by name or path and reads its file."""

from __future__ import annotations

from pathlib import Path

from retarget.errors import UnknownRobotError
from retarget.robot.robot import RobotModel
from retarget.robot.robot_file import read_robot_file

ROBOTS_DIR = Path(__file__).parents[1] / "robots"


def list_robots() -> list[str]:
    """Names of the packaged robots."""
    return sorted(p.parent.name for p in ROBOTS_DIR.glob("*/robot.toml"))


def load_robot(name_or_path: str, *, blanks: bool = False) -> RobotModel:
    """A packaged robot by its name, or the robot of a robot.toml.

    Args:
        name_or_path: name of a packaged robot, or path of a robot.toml or of its folder.
        blanks: whether to accept a file whose servo ids or models are still blank ("?"), for inspection; such a robot cannot run.

    Raises:
        UnknownRobotError: `name_or_path` is neither a packaged robot nor a path to a robot.toml.
        RobotFileError: the file has a wrong key, unit or value, or a blank.
    """
    path = ROBOTS_DIR / name_or_path / "robot.toml"
    if name_or_path not in list_robots():
        path = Path(name_or_path)
        if path.is_dir():
            path = path / "robot.toml"
        if not path.is_file():
            raise UnknownRobotError(name_or_path, list_robots())
    return read_robot_file(path, blanks)
