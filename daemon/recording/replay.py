"""Replays a log: its goals pass the same gate and bus loop, and the ticks sent to the servos are compared with the log's.

A simulated bus runs in virtual time. Each stretch with torque on and no missing cycle is replayed by itself: arm where the servos
stand, move slowly to the stretch's first goal, then one goal a cycle, then park. Compared with the log are the ticks decoded
from the bytes sent to the port, and the angles, bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daemon.control.control_loop import ControlLoop
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import DaemonError, LogError
from daemon.host.clock import Clock
from daemon.recording.mcap_reading import Log, LoggedCycle
from daemon.recording.wiretap import Wiretap
from daemon.shared_memory.bus_link import N_SETPOINTS, BusLink, BusRequest, BusState
from retarget.robot.robot import RobotModel

_LONGEST_APPROACH_S = 30.0


class ReplayFaultError(DaemonError):
    """The robot went into fault during a replay, or did not reach a state in time; it is limp now."""

    exit_status = 3


@dataclass(frozen=True)
class ReplayResult:
    """Result of a replay.

    Attributes:
        goals: number of sets of goals in the log while torque was on.
        same: number of these that were written again, tick for tick and bit for bit.
        first_difference: description of the first difference; empty when there is none.
        stretches: number of stretches, each with an arming of its own.
        missing_cycles: number of cycles that the log itself lost; the robot starts anew after each gap.
    """

    goals: int
    same: int
    first_difference: str
    stretches: int = 1
    missing_cycles: int = 0

    @property
    def identical(self) -> bool:
        """Whether every goal was written as in the log."""
        return self.same == self.goals and not self.first_difference


def stretches(log: Log) -> list[list[LoggedCycle]]:
    """The stretches of a log in which torque was on and no cycle is missing.

    Raises:
        LogError: torque was never on.
    """
    found: list[list[LoggedCycle]] = []
    before: LoggedCycle | None = None
    for cycle in log.cycles:
        if cycle.torque:
            if before is None or not before.torque or cycle.cycle != before.cycle + 1:
                found.append([])
            found[-1].append(cycle)
        before = cycle
    if not found:
        raise LogError(f"the robot was limp in all {len(log.cycles)} cycles of the log; there is nothing to replay")
    return found


def missing_cycles(log: Log) -> int:
    """Number of cycles that the recorder lost, from the gaps in their numbers."""
    return sum(b.cycle - a.cycle - 1 for a, b in pairwise(log.cycles) if b.cycle > a.cycle)


def check_robot(log: Log, robot: RobotModel) -> None:
    """Refuse a log of another robot.

    Raises:
        LogError: joints, servos or rate differ.
    """
    found = (log.metadata.get("joints"), log.metadata.get("servo_ids"), log.metadata.get("rate_hz"))
    wanted = (",".join(robot.joint_names), ",".join(str(i) for i in robot.servo_ids), repr(robot.bus.rate_hz))
    if found != wanted:
        raise LogError(
            f"the log is of robot '{log.metadata.get('robot')}' with other joints, servos or rate than '{robot.name}': "
            f"{_first_difference(found, wanted)}; choose the robot of the log with --robot"
        )


def _first_difference(found: tuple[str | None, ...], wanted: tuple[str, ...]) -> str:
    what = ("joints", "servo ids", "rate")
    return next(f"{w} {f} there, {m} here" for w, f, m in zip(what, found, wanted, strict=True) if f != m)


def robot_changed(log: Log, robot: RobotModel) -> str:
    """A warning when the robot's file has changed since the log; empty when it has not."""
    if robot.path.read_text("utf-8") == log.metadata.get("robot_toml"):
        return ""
    return f"{robot.path} is not what it was when the log was written; goals and ticks may differ"


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
        LogError: another robot's log, or one in which the robot was always limp.
        ReplayFaultError: the robot went into fault during the replay.
    """
    check_robot(log, robot)
    found = stretches(log)
    player = _Player(robot, bus, link, clock)
    goals, same, first = 0, 0, ""
    try:
        for stretch in found:
            player.begin(stretch[0].goal_rad)
            for i, cycle in enumerate(stretch):
                difference = player.play(cycle, i, last=i == len(stretch) - 1)
                goals += 1
                same += not difference
                first = first or difference
                progress(goals)
            player.end()
    finally:  # also after Ctrl-C: no torque without a program that watches the robot
        player.let_go()
    return ReplayResult(goals, same, first, len(found), missing_cycles(log))


class _Player:
    """Drives a `ControlLoop` one cycle at a time."""

    def __init__(self, robot: RobotModel, bus: ServoBus, link: BusLink, clock: Clock) -> None:
        self._robot, self._link, self._clock = robot, link, clock
        goals = [m.table["goal_position"] for m in bus.models]
        driver = bus.chains[0].link
        self._tap = driver.port = Wiretap(driver.port, robot.servo_ids, {(g.address, g.size) for g in goals})
        self._streamer = ControlLoop(robot, bus, link, clock, watch_front=False)
        self._index = link.cycles.count
        self._due_s = clock.now_s()

    def begin(self, first_rad: NDArray[np.float64]) -> None:
        """Arm, and move slowly to the first goal (J,), radians."""
        self._streamer.rest_rad = first_rad.copy()
        self._link.request(BusRequest.ARM)
        self._cycle()
        self._cycle_until(BusState.HOLDING)

    def play(self, cycle: LoggedCycle, frame: int, *, last: bool) -> str:
        """Play one goal in one cycle; returns the difference to the log, empty for none."""
        assert self._link.setpoints.queued_frames < N_SETPOINTS
        writes = self._tap.writes
        self._link.setpoints.push(cycle.goal_rad[None], 1, frame, self._link.epoch, last=last)
        record = self._cycle()
        if self._streamer.state is BusState.FAULT or self._tap.writes != writes + 1:
            raise ReplayFaultError(f"replay: at cycle {cycle.cycle} of the log: {self._reason()}")
        logged = np.array(cycle.goal_tick)
        rows = np.flatnonzero(self._tap.goal_tick != logged)
        if len(rows):
            row = int(rows[0])
            servo = f"servo {self._robot.servo_ids[row]} ({self._robot.servos[row].joint_name})"
            return f"cycle {cycle.cycle}, {servo}: log {logged[row]}, now {self._tap.goal_tick[row]} ticks"
        if record["goal_rad"].tobytes() != cycle.goal_rad.tobytes():
            joint = int(np.flatnonzero(record["goal_rad"] != cycle.goal_rad)[0])
            now, then = float(record["goal_rad"][joint]), float(cycle.goal_rad[joint])
            return f"cycle {cycle.cycle}, joint {self._robot.joint_names[joint]}: log {then!r}, now {now!r} rad"
        return ""

    def end(self) -> None:
        """Come to rest, park slowly, let go."""
        self._link.request(BusRequest.PARK)
        self._cycle()
        self._cycle_until(BusState.LIMP)

    def let_go(self) -> None:
        """Cut torque if any is left."""
        if self._streamer.state is not BusState.LIMP:
            self._link.request(BusRequest.ESTOP)
            self._cycle()

    def _cycle_until(self, state: BusState) -> None:
        deadline_s = self._clock.now_s() + _LONGEST_APPROACH_S
        while self._streamer.state not in (state, BusState.FAULT) and self._clock.now_s() < deadline_s:
            self._cycle()
        if self._streamer.state is not state:
            raise ReplayFaultError(f"replay: the robot did not get {state.name.lower()}: {self._reason()}")

    def _reason(self) -> str:
        return f"{self._streamer.state.name.lower()}: {self._link.text or 'too slow'}"

    def _cycle(self) -> np.void:
        self._streamer.cycle()
        self._due_s = max(self._due_s + self._robot.bus.period_s, self._clock.now_s())
        self._clock.sleep_until(self._due_s)
        records, self._index, _ = self._link.cycles.since(self._index)
        return records[-1]
