"""A log again: its goals through the same gate and bus loop, and whether the servos got the same ticks.

In virtual time for a simulated bus. Each stretch with torque on is replayed by itself: arm where the servos stand, go
slowly to the stretch's first goal, then one goal a cycle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from daemon.bus.servo_bus import ServoBus
from daemon.clock import Clock
from daemon.errors import LogError
from daemon.mcap_log import Log, LoggedCycle
from daemon.shared import N_SETPOINTS, BusLink, BusRequest, BusState, cycle_dtype
from daemon.streamer import Streamer
from retarget.robot import RobotModel

_LONGEST_APPROACH_S = 30.0


@dataclass(frozen=True)
class ReplayResult:
    """What came of a replay.

    Attributes:
        goals: sets of goals in the log while torque was on.
        same: how many of them were written again, tick for tick.
        first_difference: where they first differed, empty when they never did.
    """

    goals: int
    same: int
    first_difference: str

    @property
    def identical(self) -> bool:
        """Whether every goal was the same."""
        return self.same == self.goals and not self.first_difference


def stretches(log: Log) -> list[list[LoggedCycle]]:
    """The stretches of a log in which torque was on."""
    return [list(group) for on, group in groupby(log.cycles, key=lambda c: c.torque) if on]


def check_robot(log: Log, robot: RobotModel) -> None:
    """Refuse a log of another robot.

    Raises:
        LogError: joints, servos or rate differ.
    """
    found = (log.metadata.get("joints"), log.metadata.get("servo_ids"), log.metadata.get("rate_hz"))
    wanted = (",".join(robot.joint_names), ",".join(str(i) for i in robot.servo_ids), repr(robot.bus.rate_hz))
    if found != wanted:
        raise LogError(
            f"the log is of robot '{log.metadata.get('robot')}' with other joints, servos or rate than '{robot.name}'"
        )


def replay(
    log: Log,
    robot: RobotModel,
    bus: ServoBus,
    link: BusLink,
    clock: Clock,
    progress: Callable[[int], None] = lambda _n: None,
) -> ReplayResult:
    """Play every stretch of `log` on `bus` and compare the ticks written with those of the log.

    Raises:
        LogError: another robot's log, or the bus fails on the way.
    """
    check_robot(log, robot)
    player = _Player(robot, bus, link, clock)
    goals, same, first = 0, 0, ""
    for stretch in stretches(log):
        player.begin(stretch[0].goal_rad)
        for i, cycle in enumerate(stretch):
            written = player.play(cycle.goal_rad, i, last=i == len(stretch) - 1)
            goals += 1
            if tuple(written.tolist()) == cycle.goal_tick:
                same += 1
            elif not first:
                first = f"cycle {cycle.cycle}: log {cycle.goal_tick}, now {tuple(written.tolist())}"
            progress(goals)
        player.end()
    return ReplayResult(goals, same, first)


class _Player:
    """Drives a `Streamer` one cycle at a time."""

    def __init__(self, robot: RobotModel, bus: ServoBus, link: BusLink, clock: Clock) -> None:
        self._robot, self._link, self._clock = robot, link, clock
        self._streamer = Streamer(robot, bus, link, clock, watch_front=False)
        self._index = link.n_cycles
        self._fields = cycle_dtype(robot.n_joints, robot.n_joints)
        self._due_s = clock.now_s()

    def begin(self, first_rad: NDArray[np.float64]) -> None:
        """Arm, and go slowly to the first goal."""
        self._streamer.rest_rad = first_rad.copy()
        self._link.request(BusRequest.ARM)
        self._cycle()
        deadline_s = self._clock.now_s() + _LONGEST_APPROACH_S
        while self._streamer.state is BusState.ARMING and self._clock.now_s() < deadline_s:
            self._cycle()
        if self._streamer.state is not BusState.HOLDING:
            raise LogError(f"replay: the robot is {self._streamer.state.name.lower()}: {self._link.text}")

    def play(self, goal_rad: NDArray[np.float64], frame: int, *, last: bool) -> NDArray[np.int32]:
        """One goal, one cycle; (S,) ticks that were written."""
        assert self._link.queued_frames < N_SETPOINTS
        self._link.push(goal_rad[None], 1, frame, self._link.epoch, last=last)
        record = self._cycle()
        if self._streamer.state is BusState.FAULT:
            raise LogError(f"replay: fault: {self._link.text}")
        return np.array(record["goal_tick"])

    def end(self) -> None:
        """Come to rest and let go, as the log's stretch ended."""
        self._link.request(BusRequest.ESTOP)
        self._cycle()
        self._link.request(BusRequest.RESET)
        self._cycle()

    def _cycle(self) -> np.void:
        self._streamer.cycle()
        self._due_s = max(self._due_s + self._robot.bus.period_s, self._clock.now_s())
        self._clock.sleep_until(self._due_s)
        records, self._index, _ = self._link.cycles_since(self._index)
        return records[-1]
