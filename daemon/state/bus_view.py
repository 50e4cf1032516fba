"""The bus process as the front sees it: the newest cycle, and the robot's state in it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.control.derating import DeratedBy
from daemon.dynamixel.health import Health
from daemon.dynamixel.reading import UNKNOWN
from daemon.dynamixel.registers.models import MODELS
from daemon.host.clock import REAL_CLOCK, Clock
from daemon.shared_memory.bus_link import BusLink, BusState
from daemon.wire.status import ServoHealth
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap

Array = NDArray[np.float64]


class BusView:
    """Reads the cycles of the bus process. `update` belongs to one thread; the rest may be read from any.

    Attributes:
        state: state of the bus process; LIMP before its first cycle.
        goal_rad: (J,) last goals sent to the servos, radians.
        goals_s: monotonic time at which these goals were sent, seconds; 0 before the first cycle.
        present_rad: (J,) last measured joint angles, radians.
        valid: (S,) whether each servo's last reading is from the newest cycle.
        error: (S,) error bits of each servo's last reply.
        effort: (S,) current of each servo in mA, or load in percent for a servo that measures no current; `health` names the unit.
        at_rest: whether the last cycle moved no goal.
        torque: whether the servos had torque in the last cycle.
        silent_s: age of the newest cycle at the last update, seconds; before the first cycle, time since the first update. The
            age now would be wrong: a front that was held up between update and judgement would count its own pause.
        passed: states in the cycles of the last update, in order, each run of equal states once.
        index: number of cycles read so far, lost ones included.
        lost: number of cycles that were overwritten before they were read.
    """

    def __init__(self, link: BusLink, robot: RobotModel, clock: Clock = REAL_CLOCK) -> None:
        self._link, self._robot, self._clock = link, robot, clock
        self._servo_map = JointServoMap(robot)
        self.index = 0
        self.at_rest, self.torque = True, False
        self.goals_s = self.silent_s = 0.0
        self._last_cycle_s: float | None = None
        self.state = BusState.LIMP
        self.passed: list[BusState] = []
        self.goal_rad: Array = robot.park_rad.copy()
        self.present_rad: Array = robot.park_rad.copy()
        self.valid = np.zeros(robot.n_servos, bool)
        self.error = np.zeros(robot.n_servos, np.uint8)
        self.effort: Array = np.zeros(robot.n_servos)
        models = [
            MODELS.get(servo.model.model_number) for servo in robot.servos
        ]  # the bus process refuses unknown ones
        efforts = [model.table[model.effort_item] if model else None for model in models]
        self._effort_scale = np.array([item.scale if item else 1.0 for item in efforts])
        self._effort_units = [item.unit if item else "" for item in efforts]
        self.lost = 0
        self.underruns = 0

    def update(self) -> tuple[NDArray[Any], int]:
        """Read the cycles since the last call; returns them, and how many were lost before they could be read."""
        looked_s = self._clock.now_s()
        records, self.index, lost = self._link.cycles.since(self.index)
        self.lost += lost
        if len(records) or self._last_cycle_s is None:  # None: the bus process is ready, and no cycle has come yet
            self._last_cycle_s = self._clock.now_s()
        self.silent_s = max(0.0, looked_s - self._last_cycle_s)
        if len(records):
            last = records[-1]
            self.goal_rad, self.goals_s = np.array(last["goal_rad"]), int(last["t_mono_ns"]) * 1e-9
            self.present_rad = self._servo_map.tick_to_rad(last["present_tick"])
            self.valid, self.error = last["valid"] != 0, np.array(last["error"])
            self.effort = last["present_current_raw"] * self._effort_scale
            self.underruns += int((records["underrun"] != 0).sum())
            self.at_rest, self.torque = not np.any(last["velocity_rad_s"]), bool(last["torque"])
            self.state = BusState(int(last["state"]))
        states = [int(state) for state in records["state"]]
        self.passed = [BusState(s) for i, s in enumerate(states) if i == 0 or s != states[i - 1]]
        return records, lost

    def begin(self, state: BusState = BusState.LIMP) -> None:
        """Count silence from now on, because the bus process has just reported that it is ready, in `state`."""
        self.update()  # skip the cycles of an earlier bus process
        self.state, self.at_rest = state, True
        self.silent_s, self._last_cycle_s = 0.0, self._clock.now_s()

    def health(self) -> list[ServoHealth]:
        """Health of each servo as the bus process sees it now; empty before its first cycle."""
        if not self._link.cycles.count:
            return []
        return [
            ServoHealth(
                s.servo_id,
                s.joint_name,
                Health(state).name.lower(),
                *counts,
                temperature_c=None if temperature_c == UNKNOWN else temperature_c,
                effort=round(float(effort), 1),
                effort_unit=unit,
            )
            for s, (state, _, temperature_c, *counts), effort, unit in zip(
                self._robot.servos, self._link.health.tolist(), self.effort, self._effort_units, strict=True
            )
        ]

    @property
    def message(self) -> str:
        """The bus process's own text of its fault."""
        return self._link.text

    def counters(self) -> dict[str, Any]:
        """Figures of the bus process for `status`."""
        share, by, servo_id = self._link.derating
        fifo, locked = self._link.has_realtime
        invalid = [self._robot.servo_ids[i] for i in np.flatnonzero(~self.valid)] if self.index else []
        alerts = [self._robot.servo_ids[i] for i in np.flatnonzero(self.error)]
        return {
            "bus_state": self.state.name.lower(),
            "cycles": self.index,
            "cycles_lost": self.lost,
            "underruns": self.underruns,
            "silent_ms": round(1e3 * self.silent_s, 1),
            "fifo_priority": fifo,
            "locked_memory": locked,
            "servos_not_answering": invalid,
            "servos_with_error": alerts,
            "speed_share": share,
            "derated_by": f"{DeratedBy(by).name.lower()} of servo {servo_id}" if by else "",
        }
