"""Packaged robots, each read once in a process: reading its file takes as long as some cycles of its simulated bus."""

from __future__ import annotations

from functools import cache

from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel


@cache
def packaged(name: str) -> RobotModel:
    """The packaged robot of that name."""
    return load_robot(name)
