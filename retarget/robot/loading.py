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
    """The packaged robot of that name, or the one of a robot.toml (or its folder).

    Args:
        name_or_path: which.
        blanks: take a file whose servo ids or models are still blank ("?"), for looking at; it cannot be run.

    Raises:
        UnknownRobotError: neither.
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
