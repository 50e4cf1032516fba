"""Keeps setpoints of the running trajectory in the bus process, and counts the frames pushed, played and still to come."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daemon.host.clock import REAL_CLOCK, Clock
from daemon.playback.trajectory import Trajectory
from daemon.playback.trajectory_statistics import TrajectoryStatistics
from daemon.poses.pose_sequence import PoseSequence, standing
from daemon.shared_memory.bus_link import N_SETPOINTS, BusLink
from daemon.state.bus_view import BusView
from retarget.path.paths import JointState
from retarget.robot.robot import RobotModel


class SetpointBuffer:
    """Holds the trajectories that are being pushed to the bus process, the newest last. For one thread.

    Args:
        robot: the robot.
        link: memory shared with the bus process.
        view: view of the bus process's newest cycle.
        queue_s: seconds of setpoints kept in the bus process.
        stream_queue_s: seconds of setpoints kept in the bus process for frames that are made on demand.
        clock: clock that the bus process reads too.
    """

    def __init__(
        self, robot: RobotModel, link: BusLink, view: BusView, queue_s: float, stream_queue_s: float = 0.03, *,
        clock: Clock = REAL_CLOCK,
    ) -> None:  # fmt: skip
        self.robot = robot
        self._link, self._view, self._clock = link, view, clock
        self.rate_hz = robot.bus.rate_hz
        self._queue_frames = max(2, math.ceil(queue_s * self.rate_hz))
        self._stream_frames = max(2, math.ceil(stream_queue_s * self.rate_hz))
        self._last_goal_tick: NDArray[np.int32] | None = None
        self._trajectories: list[Trajectory] = []
        self._last_id = 0
        self._posture: PoseSequence = standing()
        self._raw: PoseSequence = standing()

    @property
    def epoch(self) -> int:
        """Epoch of the link; it grows with each stop, e-stop and park, and a trajectory of an older epoch is never played."""
        return self._link.epoch

    @property
    def current(self) -> Trajectory | None:
        """The newest trajectory; None without one."""
        return self._trajectories[-1] if self._trajectories else None

    @property
    def running(self) -> bool:
        """Whether the current trajectory has frames that are not played yet."""
        return self.current is not None and self.current.epoch == self.epoch and not self.current.played

    @property
    def dry(self) -> bool:
        """Whether the bus process brakes because it has no frame left of a trajectory that has not ended."""
        return self.current is not None and self.current.ran_dry(self._link.setpoints.queued_frames)

    @property
    def ahead_s(self) -> float:
        """Seconds of the current trajectory that are made and not yet pushed."""
        return 0.0 if self.current is None else (self.current.n_frames - self.current.pushed) / self.rate_hz

    @property
    def at_rest(self) -> JointState:
        """The goals that the servos hold, without velocity."""
        return JointState(self._view.goal_rad.copy(), np.zeros(self.robot.n_joints))

    @property
    def posture_now(self) -> PoseSequence:
        """One frame of the person whose pose the robot shows."""
        return self._now(self._posture, raw=False)

    @property
    def raw_now(self) -> PoseSequence:
        """One frame of the person whose pose the robot shows, without layers."""
        return self._now(self._raw, raw=True)

    def _now(self, kept: PoseSequence, *, raw: bool) -> PoseSequence:
        plan = self.current
        return kept if plan is None else plan.posture_from(max(0, plan.statistics.last_frame), 1, raw=raw)

    def new_plan_id(self) -> int:
        """The number of the next trajectory."""
        self._last_id += 1
        return self._last_id

    def statistics(self, plan_id: int, t_received_ns: int) -> TrajectoryStatistics:
        """Statistics of a trajectory that begins now, for a request received at `t_received_ns` (monotonic)."""
        return TrajectoryStatistics(self.robot, plan_id, t_received_ns, self._last_goal_tick)

    def next_frame(self, plan: Trajectory) -> int:
        """The frame of the newest trajectory that the bus process takes next."""
        return plan.pushed - min(self._link.setpoints.queued_frames, plan.pushed)

    def frame_within(self, plan: Trajectory, ahead_s: float) -> int:
        """The last frame of the newest trajectory that the bus process takes within `ahead_s` seconds from now; -1 for none."""
        since_s = (self._clock.now_s() - self._view.goals_s) % (1.0 / self.rate_hz)  # since the last one was taken
        cycles = math.floor((since_s + ahead_s) * self.rate_hz)
        before = self._waiting + max(0, self._link.setpoints.queued_frames - plan.pushed)
        return self.next_frame(plan) - 1 + max(0, cycles - before)

    @property
    def _waiting(self) -> int:
        """Frames of earlier trajectories that are not pushed yet."""
        return sum(p.limit - p.pushed for p in self._trajectories[:-1])

    def end_after(self, frame: int | None) -> int:
        """Take back the frames of the running trajectory after `frame` (None takes back none).

        Returns:
            Number of the taken frames that the bus process has already reached.
        """
        plan = self.current
        if plan is None or frame is None or plan.epoch != self.epoch:
            return 0
        plan.end = frame + 1
        beyond = self._link.setpoints.take_back(plan.pushed - plan.end) if plan.pushed > plan.end else 0
        plan.pushed = min(plan.pushed, plan.end)
        return beyond

    def follow_with(self, plan: Trajectory) -> None:
        """Append a trajectory to those that still have frames to push."""
        self._trajectories = [p for p in self._trajectories if p.pushed < p.limit]
        self._trajectories.append(plan)

    def drop(self) -> None:
        """Forget all trajectories, after a stop or when the bus process has nothing left to play."""
        if self.current is not None:
            self._posture, self._raw = self.posture_now, self.raw_now
        self._trajectories = []

    def stand(self) -> None:
        """Forget all trajectories and take the pose of a standing person, for a robot that is limp or being armed."""
        self.drop()
        self._posture = self._raw = standing()

    def pump(self) -> None:
        """Push setpoints until the bus process has enough."""
        for plan in self._trajectories:
            queued = self._link.setpoints.queued_frames
            room = min(self._queue_frames - queued, plan.limit - plan.pushed, N_SETPOINTS - queued)
            if room > 0:
                self._push(plan, room)
            if plan.pushed < plan.limit:
                return

    def stream_on(self) -> None:
        """Make and push the due frames of a trajectory whose frames are made on demand. Call this after `read_cycles`."""
        plan = self.current
        if plan is None or plan.end is not None or plan.epoch != self.epoch:
            return
        stands = self._view.at_rest and not self._link.setpoints.queued_frames
        if plan.resume(self._view.goal_rad, stands=stands):
            plan.extend(plan.pushed + self._stream_frames - self._link.setpoints.queued_frames - self._waiting)
            self.pump()

    def read_cycles(self) -> None:
        """Read the bus process's new cycles into the view and the trajectory's statistics."""
        records, lost = self._view.update()
        if self.current is not None:
            self.current.statistics.feed(records, lost)
        if len(records):
            self._last_goal_tick = np.array(records["goal_tick"][-1])

    def _push(self, plan: Trajectory, count: int) -> None:
        if plan.epoch != self._link.epoch:
            return
        frames = plan.frames(plan.pushed, plan.pushed + count)
        last = plan.ends_here and plan.pushed + len(frames) >= plan.n_frames
        plan.pushed += self._link.setpoints.push(frames, plan.plan_id, plan.pushed, plan.epoch, last=last)
