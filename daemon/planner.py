"""Motions to setpoints: the plan that is played, what takes over from it, and how much the bus process has in hand.

A new path starts from a frame of the running plan that is not yet pushed, with its position and velocity, so that the
joints go over without a jump. Without a running plan it starts at rest from the goal the servos hold.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daemon.bus_view import BusView
from daemon.plan_statistics import PlanStatistics
from daemon.shared import N_SETPOINTS, BusLink
from mmm_core.motion import Motion
from retarget.paths import JointPath, JointState
from retarget.pipeline import Retargeter
from retarget.robot import RobotModel

FIRST_RETARGET_S = 0.06
"""Assumed time of the first retargeting; later ones are measured."""
RETARGET_MARGIN = 1.5
"""The hand-over frame is so much later than retargeting is expected to take."""


@dataclass
class Plan:
    """A path on its way to the bus.

    Attributes:
        plan_id: number in the log.
        command_id: the command that it carries out.
        path: the joint path.
        q_rad: (N, J) setpoints at bus rate.
        epoch: the link's epoch when its text arrived; setpoints of an older epoch are thrown away.
        statistics: what it did at the bus.
        end: frames that may be pushed: N, or fewer once another plan takes over.
        pushed: frames pushed so far.
    """

    plan_id: int
    command_id: str
    path: JointPath
    q_rad: NDArray[np.float64]
    epoch: int
    statistics: PlanStatistics
    end: int
    pushed: int = 0

    @property
    def all_pushed(self) -> bool:
        """Whether the bus process has the last frame."""
        return self.pushed >= len(self.q_rad)

    @property
    def played(self) -> bool:
        """Whether the bus process has played the last frame."""
        return self.statistics.last_frame >= len(self.q_rad) - 1

    def state_at(self, frame: int, rate_hz: float) -> JointState:
        """Position and velocity at a frame."""
        t_s = min((frame + 1) / rate_hz, self.path.duration_s)
        return JointState(self.q_rad[frame].copy(), self.path.velocity_at(np.array([t_s]))[0])


class Planner:
    """Keeps about `queue_s` of setpoints in the bus process. For one thread."""

    def __init__(self, robot: RobotModel, link: BusLink, view: BusView, queue_s: float) -> None:
        self.robot = robot
        self._link, self._view = link, view
        self._retargeter = Retargeter(robot)
        self._rate_hz = robot.bus.rate_hz
        self._queue_frames = max(2, math.ceil(queue_s * self._rate_hz))
        self._retarget_s = FIRST_RETARGET_S
        self._last_goal_tick: NDArray[np.int32] | None = None
        self._plans: list[Plan] = []
        self._last_id = 0

    @property
    def epoch(self) -> int:
        """Grows with each stop, e-stop and park; a plan of a text that came before is never played."""
        return self._link.epoch

    def hand_over(self) -> JointState:
        """The state from which a new path must start; `commit` or `give_up` must follow.

        The running plan goes on up to the frame at which the new one takes over.
        """
        plan = self.current
        if plan is None or not self.running or self._ran_dry(plan):
            self.drop()
            return JointState(self._view.goal_rad.copy(), np.zeros(self.robot.n_joints))
        lead = math.ceil(RETARGET_MARGIN * self._retarget_s * self._rate_hz) - self._link.queued_frames
        lead -= sum(p.end - p.pushed for p in self._plans[:-1])
        frame = max(0, min(plan.pushed + max(0, lead), len(plan.q_rad)) - 1)
        plan.end = frame + 1
        return plan.state_at(frame, self._rate_hz)

    def retarget(self, motion: Motion, start: JointState) -> JointPath:
        """The path of a motion from `start`; may run in a worker thread.

        Raises:
            MotionError: the motion cannot be retargeted.
        """
        began = time.perf_counter()
        path = self._retargeter.retarget(motion, start, settle=True)
        self._retarget_s += 0.3 * (time.perf_counter() - began - self._retarget_s)
        return path

    @property
    def hand_over_missed(self) -> bool:
        """Whether the bus process ran dry before the new path was ready: it brakes, so the path starts elsewhere."""
        plan = self.current
        return plan is not None and not plan.all_pushed and self._ran_dry(plan)

    def new_plan_id(self) -> int:
        """The number of a plan to come."""
        self._last_id += 1
        return self._last_id

    def commit(self, path: JointPath, plan_id: int, command_id: str, epoch: int, t_received_ns: int) -> Plan:
        """Make a path the current plan; its frames follow those of the plan before it."""
        q_rad = path.at_rate(self._rate_hz)
        statistics = PlanStatistics(self.robot, plan_id, t_received_ns, self._last_goal_tick)
        plan = Plan(plan_id, command_id, path, q_rad, epoch, statistics, len(q_rad))
        self._plans = [p for p in self._plans if p.pushed < p.end]
        self._plans.append(plan)
        self.pump()
        return plan

    def give_up(self) -> None:
        """Nothing takes over: the running plan plays to its end."""
        if self.current is not None:
            self.current.end = len(self.current.q_rad)

    def drop(self) -> None:
        """Forget what was planned; the bus process has been told to stop."""
        self._plans = []

    @property
    def current(self) -> Plan | None:
        """The newest plan."""
        return self._plans[-1] if self._plans else None

    @property
    def running(self) -> bool:
        """Whether the current plan has frames that are not played yet."""
        return self.current is not None and self.current.epoch == self.epoch and not self.current.played

    def pump(self) -> None:
        """Push setpoints until enough are in hand."""
        for plan in self._plans:
            queued = self._link.queued_frames
            room = min(self._queue_frames - queued, plan.end - plan.pushed, N_SETPOINTS - queued)
            if room > 0:
                self._push(plan, room)
            if plan.pushed < plan.end:
                return

    def read_cycles(self) -> None:
        """Take the bus process's new cycles into the view and the plan's statistics."""
        records, lost = self._view.update()
        if self.current is not None:
            self.current.statistics.feed(records, lost)
        if len(records):
            self._last_goal_tick = np.array(records["goal_tick"][-1])

    def _push(self, plan: Plan, count: int) -> None:
        if plan.epoch != self._link.epoch:
            return
        frames = plan.q_rad[plan.pushed : plan.pushed + count]
        last = plan.pushed + len(frames) >= len(plan.q_rad)
        plan.pushed += self._link.push(frames, plan.plan_id, plan.pushed, plan.epoch, last=last)

    def _ran_dry(self, plan: Plan) -> bool:
        """Whether the bus process has none of the plan's frames in hand though more were to come."""
        return 0 < plan.pushed < len(plan.q_rad) and plan.pushed >= plan.end and self._link.queued_frames == 0
