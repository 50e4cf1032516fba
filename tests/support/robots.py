"""Packaged robots and what tests compute from them, each made once in a process and not before a test needs it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import TypeVar

from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel

T = TypeVar("T")


@cache
def packaged(name: str) -> RobotModel:
    """The packaged robot of that name; reading its file takes as long as some cycles of its simulated bus."""
    return load_robot(name)


@cache
def slow(name: str = "reference") -> RobotModel:
    """A packaged robot at half the cycles per second: a second of its simulated bus takes half the processor time."""
    robot = packaged(name)
    return replace(robot, bus=replace(robot.bus, rate_hz=robot.bus.rate_hz / 2))


class ByName(Mapping[str, T]):
    """A value for each name, made when it is first read: every process of the suite collects every test file.

    Args:
        names: in order.
        make: the value of a name.
    """

    def __init__(self, names: Iterable[str], make: Callable[[str], T]) -> None:
        self._names = dict.fromkeys(names)
        self._make = cache(make)

    def __getitem__(self, name: str) -> T:
        if name not in self._names:
            raise KeyError(name)
        return self._make(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)
