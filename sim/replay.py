"""Replays a log on simulated servos and compares their positions with the logged ones.

The goals of the log are sent by the daemon's own bus driver at the log's times, in either protocol, to servos that start where the
logged servos stood when torque came on. The positions read back are compared, and for each servo also the lag: the delay of the
goals that explains its positions best, in the log and in the simulation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.dynamixel.servo_bus import ServoBus
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.options import world_of
from sim.port import SimPort

Array = NDArray[np.float64]

_LAGS_MS = np.arange(0.0, 200.0, 2.0)
_BEFORE_S = 0.05
"""Seconds from torque on to the first goal of the log."""
_LEAST_TRAVEL_TICK = 20.0
"""Ticks of travel below which a servo gets no lag."""


@dataclass(frozen=True)
class Stretch:
    """A stretch of a log in which torque was on.

    Attributes:
        t_s: (T,) seconds from its start.
        goal_tick, present_tick: (T, S) goals that were sent, and positions that the servos reported.
    """

    t_s: Array
    goal_tick: NDArray[np.int64]
    present_tick: NDArray[np.int64]


@dataclass(frozen=True)
class ServoComparison:
    """Difference between simulation and log for one servo.

    Attributes:
        servo_id, joint_name: the servo.
        rms_deg, max_deg: difference of the positions, at the servo's shaft.
        lag_logged_ms, lag_simulated_ms: behind the goals; None where it hardly moved.
    """

    servo_id: int
    joint_name: str
    rms_deg: float
    max_deg: float
    lag_logged_ms: float | None
    lag_simulated_ms: float | None


@dataclass(frozen=True)
class Comparison:
    """Result of replaying a log in the simulator."""

    seconds: float
    stretches: int
    refused_goals: int
    servos: tuple[ServoComparison, ...]

    @property
    def rms_deg(self) -> float:
        """Root mean square of the difference in degrees, over all servos."""
        return float(np.sqrt(np.mean([s.rms_deg**2 for s in self.servos])))

    @property
    def worst(self) -> ServoComparison:
        """The servo with the largest difference."""
        return max(self.servos, key=lambda s: s.rms_deg)


def compare(stretches: Sequence[Stretch], robot: RobotModel, body: str = "plain") -> Comparison:
    """Replay every stretch on simulated servos and compare their positions with the logged ones."""
    refused = 0
    simulated: list[Array] = []
    for stretch in stretches:
        positions, n = _played(stretch, robot, body)
        simulated.append(positions)
        refused += n
    rows = tuple(_compared(i, robot, stretches, simulated) for i in range(len(robot.servos)))
    return Comparison(float(sum(s.t_s[-1] for s in stretches)), len(stretches), refused, rows)


def _played(stretch: Stretch, robot: RobotModel, body: str) -> tuple[Array, int]:
    """(T, S) positions read from the simulated servos, and the number of goals that they refused."""
    start_rad = JointServoMap(robot).tick_to_rad(stretch.present_tick[0])
    bus = SimBus(robot, world=world_of(robot, None, body, start_rad=start_rad.tolist()))
    clock = VirtualClock()
    driver = ServoBus.on_port(SimPort(bus, clock), robot.servos, clock)
    driver.verify()
    driver.exchange(stretch.present_tick[0].astype(np.int32))
    for servo in bus.servos.values():
        item = servo.items["torque_enable"]
        servo.write(item.address, b"\1")
    start_s = clock.now_s() + _BEFORE_S
    positions: list[NDArray[np.int32]] = []
    for t_s, goal in zip(stretch.t_s.tolist(), stretch.goal_tick.astype(np.int32), strict=True):
        clock.sleep_until(start_s + t_s)
        positions.append(driver.exchange(goal).position_tick.copy())
    return np.array(positions, np.float64), bus.audit.violations["refused_goal"]


def _compared(i: int, robot: RobotModel, stretches: Sequence[Stretch], simulated: Sequence[Array]) -> ServoComparison:
    servo = robot.servos[i]
    degrees = 360.0 / servo.model.ticks_per_turn
    logged = [s.present_tick[:, i].astype(np.float64) for s in stretches]
    here = [x[:, i] for x in simulated]
    apart: Array = np.concatenate(here) - np.concatenate(logged)
    moves = max(int(np.ptp(s.goal_tick[:, i])) for s in stretches) >= _LEAST_TRAVEL_TICK
    return ServoComparison(
        servo.servo_id,
        servo.joint_name,
        float(np.sqrt(np.mean(apart**2))) * degrees,
        float(np.abs(apart).max()) * degrees,
        _lag_ms(i, stretches, logged) if moves else None,
        _lag_ms(i, stretches, here) if moves else None,
    )


def _lag_ms(i: int, stretches: Sequence[Stretch], positions: Sequence[Array]) -> float:
    """Milliseconds of delay with which the goals fit the positions best."""
    errors = np.zeros(len(_LAGS_MS))
    for stretch, position in zip(stretches, positions, strict=True):
        goal = stretch.goal_tick[:, i].astype(np.float64)
        for k, lag_ms in enumerate(_LAGS_MS.tolist()):
            delayed = np.interp(stretch.t_s - lag_ms * 1e-3, stretch.t_s, goal)
            errors[k] += float(((delayed - position) ** 2).sum())
    return float(_LAGS_MS[int(np.argmin(errors))])
