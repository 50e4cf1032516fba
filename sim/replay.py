"""A run from its log again: what the simulated servos do with its goals, beside what the log says the servos did.

The goals of the log go out as packets at the log's times, to servos that stand where those of the log stood when torque came
on. Compared are the positions read back. For each servo also the lag: the delay of the goals that explains its positions
best, in the log and here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.bus import packet
from daemon.bus.models import MODELS
from retarget.robot import RobotModel
from retarget.ticks import JointServoMap
from sim.bus import SimBus
from sim.options import world_of

Array = NDArray[np.float64]

_LAGS_MS = np.arange(0.0, 200.0, 2.0)
_BEFORE_S = 0.05
"""From torque on to the first goal of the log."""
_LEAST_TRAVEL_TICK = 20.0
"""A servo that moved less has no lag to speak of."""


@dataclass(frozen=True)
class Stretch:
    """A stretch of a log in which torque was on.

    Attributes:
        t_s: (T,) seconds from its start.
        goal_tick, present_tick: (T, S) what the servos were told, and where they said they were.
    """

    t_s: Array
    goal_tick: NDArray[np.int64]
    present_tick: NDArray[np.int64]


@dataclass(frozen=True)
class ServoComparison:
    """One servo: how far simulation and log are apart.

    Attributes:
        servo_id, joint_name: which.
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
    """What came of a log in the simulator."""

    seconds: float
    stretches: int
    refused_goals: int
    servos: tuple[ServoComparison, ...]

    @property
    def rms_deg(self) -> float:
        """Over all servos."""
        return float(np.sqrt(np.mean([s.rms_deg**2 for s in self.servos])))

    @property
    def worst(self) -> ServoComparison:
        """The servo that differs most."""
        return max(self.servos, key=lambda s: s.rms_deg)


def compare(stretches: Sequence[Stretch], robot: RobotModel, body: str = "plain") -> Comparison:
    """Feed every stretch to simulated servos, and look how far they come from what was logged."""
    refused = 0
    simulated: list[Array] = []
    for stretch in stretches:
        positions, n = _played(stretch, robot, body)
        simulated.append(positions)
        refused += n
    rows = tuple(_compared(i, robot, stretches, simulated) for i in range(robot.n_joints))
    return Comparison(float(sum(s.t_s[-1] for s in stretches)), len(stretches), refused, rows)


def _played(stretch: Stretch, robot: RobotModel, body: str) -> tuple[Array, int]:
    """(T, S) positions read from the simulated servos, and goals they refused."""
    start_rad = JointServoMap(robot).tick_to_rad(stretch.present_tick[0])
    bus = SimBus(robot, world=world_of(robot, None, body, start_rad=start_rad.tolist()))
    client = _Client(bus, robot)
    client.torque_on(stretch.present_tick[0].tolist())
    goals: list[list[int]] = stretch.goal_tick.tolist()
    times: list[float] = stretch.t_s.tolist()
    positions = [client.cycle(t_s, ticks) for t_s, ticks in zip(times, goals, strict=True)]
    return np.array(positions, np.float64), bus.audit.violations["refused_goal"]


class _Client:
    """Writes goals and reads positions, in the log's own time."""

    def __init__(self, bus: SimBus, robot: RobotModel) -> None:
        self._bus, self._ids, self._baud = bus, robot.servo_ids, robot.bus.baud
        table = MODELS[robot.servos[0].model.model_number].table
        self._goal, self._present = table["goal_position"], table["present_position"]
        self._last = [0] * len(self._ids)

    def torque_on(self, ticks: Sequence[int]) -> None:
        """Torque over goals where the servos stand."""
        self._last = list(ticks)
        self._send(0.0, ticks)
        self._bus.wire.clear()
        for servo in self._bus.servos.values():
            item = servo.items["torque_enable"]
            servo.write(item.address, b"\1")

    def cycle(self, t_s: float, ticks: Sequence[int]) -> list[int]:
        """One cycle of the log; the positions that come back."""
        t_s += _BEFORE_S
        self._send(t_s, ticks)
        by_id: dict[int, int] = {}
        while (ready_s := self._bus.wire.ready_s()) is not None:
            for p in self._decoder.feed(self._bus.wire.take(max(ready_s, t_s))):
                if len(p.parameters) == self._present.size:
                    by_id[p.servo_id] = self._present.decode(p.parameters)
        self._last = [by_id.get(i, last) for i, last in zip(self._ids, self._last, strict=True)]
        return self._last

    def _send(self, t_s: float, ticks: Sequence[int]) -> None:
        self._decoder = packet.PacketDecoder()
        rows = [(i, self._goal.encode(tick)) for i, tick in zip(self._ids, ticks, strict=True)]
        data = packet.sync_write(self._goal.address, self._goal.size, rows)
        data += packet.sync_read(self._present.address, self._present.size, self._ids)
        self._bus.receive(data, t_s, self._baud)


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
    """The delay of the goals that comes nearest to the positions."""
    errors = np.zeros(len(_LAGS_MS))
    for stretch, position in zip(stretches, positions, strict=True):
        goal = stretch.goal_tick[:, i].astype(np.float64)
        for k, lag_ms in enumerate(_LAGS_MS.tolist()):
            delayed = np.interp(stretch.t_s - lag_ms * 1e-3, stretch.t_s, goal)
            errors[k] += float(((delayed - position) ** 2).sum())
    return float(_LAGS_MS[int(np.argmin(errors))])
