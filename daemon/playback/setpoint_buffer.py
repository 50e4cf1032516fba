"""Motions to setpoints: the plan that is played, what takes over from it, and how much the bus process has in hand.

A new path starts from a frame of the running plan that is not yet played, with its position and velocity, so that the
joints go over without a jump; its first frames of posture grow out of those that would have followed. Without a running
plan it starts at rest from the goal the servos hold.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daemon.playback.latency_estimate import LatencyEstimate
from daemon.playback.sources.stream_source import StreamSource
from daemon.playback.stream_trajectory import StreamTrajectory
from daemon.playback.trajectory import Chunk, Trajectory
from daemon.playback.trajectory_statistics import TrajectoryStatistics
from daemon.poses.pose_sequence import PoseSequence, joined, poses_of_joints, standing
from daemon.shared_memory.bus_link import N_SETPOINTS, BusLink
from daemon.state.bus_view import BusView
from mmm_core.motion.motion import FPS
from retarget.human.human import read_human
from retarget.path.paths import JointState
from retarget.pipeline import BLOCK_FRAMES, Retargeter
from retarget.robot.robot import RobotModel
from retarget.robot_to_human import joints_of_path

FIRST_RETARGET_S = 0.03
"""Assumed time until the first piece of the first path is there; later ones are measured."""
RETRY_MARGIN = 1.2
"""The hand-over frame is so much later than an attempt took that came too late."""
FADE_FRAMES = 8
"""Frames of posture (0.4 s) over which a motion grows out of what came before it."""


@dataclass(frozen=True)
class SplicePoint:
    """Where a new path begins.

    Attributes:
        state: of the joints.
        before: the posture that would have followed.
        frame: of the running plan, after which the new one comes; None at rest.
    """

    state: JointState
    before: PoseSequence
    frame: int | None


class SetpointBuffer:
    """Keeps about `queue_s` of setpoints in the bus process. For one thread."""

    def __init__(
        self, robot: RobotModel, link: BusLink, view: BusView, queue_s: float, stream_queue_s: float = 0.03
    ) -> None:
        self.robot = robot
        self._link, self._view = link, view
        self._retargeter = Retargeter(robot)
        self._rate_hz = robot.bus.rate_hz
        self._queue_frames = max(2, math.ceil(queue_s * self._rate_hz))
        self._stream_frames = max(2, math.ceil(stream_queue_s * self._rate_hz))
        self._from_rest = False
        self._handing_over: int | None = None
        self._lead = LatencyEstimate(FIRST_RETARGET_S)
        self._handed_over_s = time.monotonic()
        self._last_goal_tick: NDArray[np.int32] | None = None
        self._plans: list[Trajectory] = []
        self._last_id = 0
        self._posture: PoseSequence = standing()
        self._raw: PoseSequence = standing()

    @property
    def epoch(self) -> int:
        """Grows with each stop, e-stop and park; a plan of a text that came before is never played."""
        return self._link.epoch

    def hand_over(self, *, took_s: float = 0.0) -> SplicePoint:
        """Where a new path must start; `commit`, `go_on_otherwise` or `give_up` must follow.

        That is a frame of the running plan so far ahead that the first piece of the path will be there in time; the plan
        goes on beyond it meanwhile, and if the piece is late it is tried again.

        Args:
            took_s: that piece of an attempt before.
        """
        plan, self._from_rest, self._handing_over = self.current, False, None
        self._handed_over_s = time.monotonic()
        if took_s:
            self._lead.took(took_s)
        if isinstance(plan, StreamTrajectory) and self.running and self._ran_dry(plan):
            plan.end, self._from_rest = plan.pushed, True  # nothing moves until `commit`, or `give_up`
            at_rest = JointState(self._view.goal_rad.copy(), np.zeros(self.robot.n_joints))
            return SplicePoint(at_rest, plan.posture_from(plan.n_frames - 1, FADE_FRAMES), None)
        if plan is None or not self.running or self._ran_dry(plan):
            self.drop()
            at_rest = JointState(self._view.goal_rad.copy(), np.zeros(self.robot.n_joints))
            return SplicePoint(at_rest, self._posture, None)
        ahead_s = max(self._lead.seconds, RETRY_MARGIN * took_s)
        frame = self._frame_within(plan, ahead_s)
        if isinstance(plan, StreamTrajectory):
            plan.extend(frame + 1)
        frame = max(0, min(frame, plan.n_frames - 1))
        self._handing_over = frame
        return SplicePoint(plan.state_at(frame), plan.posture_from(frame, FADE_FRAMES), frame)

    def hand_over_at_once(self) -> SplicePoint:
        """The same after the last frame pushed, with the difference quotient as velocity; `commit_stream` must follow."""
        plan = self.current
        if plan is None or not self.running or self._ran_dry(plan):
            return self.hand_over()
        if isinstance(plan, StreamTrajectory):
            plan.extend(plan.pushed)
        self._from_rest, frame = False, max(0, min(plan.pushed, plan.n_frames) - 1)
        self._handing_over = frame
        return SplicePoint(plan.step_at(frame), plan.posture_from(frame, FADE_FRAMES), frame)

    def pieces(self, posture: PoseSequence, raw: PoseSequence, start: JointState, *, complete: bool) -> Iterator[Chunk]:
        """The path of a posture from `start`, piece by piece as it is made; each may be asked for in a worker thread.

        Args:
            posture: as it is played.
            raw: the same without layers.
            start: of the joints.
            complete: whether the plan ends with it, at rest.

        Raises:
            MotionError: the motion cannot be retargeted.
        """
        first, frames = 0, BLOCK_FRAMES / posture.fps * self._rate_hz
        if abs(frames - round(frames)) < 1e-9:
            paths = self._retargeter.pieces(posture, start, settle=complete)
        else:  # a piece would end between two frames of the bus
            paths = iter([(self._retargeter.retarget(posture, start, settle=complete), len(posture))])
        for path, n in paths:
            is_last = first + n >= len(posture)
            yield Chunk(path, posture[first:], raw[first:], is_last, is_last and complete)
            first += n

    @property
    def hand_over_missed(self) -> bool:
        """Whether the bus process has come beyond the frame of the hand-over, or ran dry, before the new path was ready."""
        plan, frame = self.current, self._handing_over
        if plan is None or self._from_rest or frame is None or plan.epoch != self.epoch:
            return False
        if self._ran_dry(plan):
            return True
        return self._next_frame(plan) > frame + 1 and not (plan.complete and frame == plan.n_frames - 1)

    def new_plan_id(self) -> int:
        """The number of a plan to come."""
        self._last_id += 1
        return self._last_id

    def commit(self, piece: Chunk, plan_id: int, command_id: str, epoch: int, t_received_ns: int) -> Trajectory:
        """Make a path the current plan; its frames follow those of the plan before it.

        So many of those as the bus process takes beyond the hand-over meanwhile, which begin as the new ones do, are left
        out of the new ones.
        """
        statistics = TrajectoryStatistics(self.robot, plan_id, t_received_ns, self._last_goal_tick)
        plan = Trajectory(plan_id, command_id, epoch, self._rate_hz, statistics)
        plan.append(piece)
        self._lead.took(time.monotonic() - self._handed_over_s)
        plan.pushed = min(self._succeed(plan), plan.n_frames - 1)
        self.pump()
        return plan

    def commit_stream(self, score: StreamSource, plan_id: int, command_id: str, epoch: int, t_received_ns: int) -> None:
        """Make a lease that has begun the current plan."""
        statistics = TrajectoryStatistics(self.robot, plan_id, t_received_ns, self._last_goal_tick)
        self._succeed(StreamTrajectory(plan_id, command_id, epoch, self._rate_hz, statistics, score, self._shown))

    def stream_on(self) -> None:
        """Make the frames of a lease that are due, and push them; call it after `read_cycles`."""
        plan = self.current
        if not isinstance(plan, StreamTrajectory) or plan.end is not None or plan.epoch != self.epoch:
            return
        plan.check_lost()
        if plan.lost or plan.resting:
            stands = plan.all_played and self._view.at_rest and not self._link.queued_frames
            if plan.lost and not stands:
                return
            moved = stands and not np.array_equal(self._view.goal_rad, plan.score.state.position_rad)
            if plan.lost or moved:
                plan.go_on(self._view.goal_rad)
        waiting = sum(p.limit - p.pushed for p in self._plans[:-1])
        plan.extend(plan.pushed + self._stream_frames - self._link.queued_frames - waiting)
        self.pump()

    def gaze_rad(self, posture: PoseSequence) -> dict[int, float]:
        """Angles of the head's joints, by index, that show the head of a posture of one frame."""
        q_rad = self._retargeter.solve(read_human(posture))[0]
        return {j: float(q_rad[j]) for j, joint in enumerate(self.robot.joints) if joint.role.startswith("head")}

    def give_up(self) -> None:
        """Nothing takes over: the running plan plays to its end."""
        self._handing_over = None
        if self.current is not None:
            self.current.end = None

    def go_on_otherwise(self, piece: Chunk) -> None:
        """What follows the frame of the hand-over is another path of the same plan, of which this is the first piece."""
        plan, frame = self.current, self._handing_over
        assert plan is not None and frame is not None, "after a hand-over that is not from rest"
        beyond = self._end_at_hand_over()
        plan.cut(frame)
        plan.append(piece)
        self._lead.took(time.monotonic() - self._handed_over_s)
        plan.end, plan.pushed = None, min(plan.pushed + beyond, plan.n_frames - 1)
        self.pump()

    def drop(self) -> None:
        """Forget what was planned; the bus process has been told to stop, or has nothing left to play."""
        if self.current is not None:
            self._posture, self._raw = self.posture_now, self.raw_now
        self._plans = []

    @property
    def posture_now(self) -> PoseSequence:
        """One frame: how the person is held that the robot shows."""
        plan = self.current
        return self._posture if plan is None else plan.posture_from(max(0, plan.statistics.last_frame), 1)

    @property
    def raw_now(self) -> PoseSequence:
        """The same without layers."""
        plan = self.current
        return self._raw if plan is None else plan.posture_from(max(0, plan.statistics.last_frame), 1, raw=True)

    def committed(self, n: int, ahead_s: float) -> PoseSequence:
        """`n` frames of posture at 20 fps as they are played, up to about where a motion that takes `ahead_s` takes over."""
        plan = self.current
        if plan is None or not self.running:
            return replace(self.posture_now.at(np.zeros(n, np.intp)), fps=FPS)
        last = min(self._frame_within(plan, ahead_s + self._lead.seconds), plan.n_frames - 1)
        places = [last - round(k * self._rate_hz / FPS) for k in reversed(range(n))]
        return replace(joined([plan.posture_from(place, 1) for place in places]), fps=FPS)

    @property
    def dry(self) -> bool:
        """Whether the bus process has none of the plan's frames left though more were to come: it brakes."""
        return self.current is not None and self._ran_dry(self.current)

    def stand(self) -> None:
        """The robot has been led to its rest pose: a person who stands."""
        self.drop()
        self._posture = self._raw = standing()

    @property
    def current(self) -> Trajectory | None:
        """The newest plan."""
        return self._plans[-1] if self._plans else None

    @property
    def running(self) -> bool:
        """Whether the current plan has frames that are not played yet."""
        return self.current is not None and self.current.epoch == self.epoch and not self.current.played

    @property
    def ahead_s(self) -> float:
        """Seconds of the current plan that are made and not pushed."""
        return 0.0 if self.current is None else (self.current.n_frames - self.current.pushed) / self._rate_hz

    def pump(self) -> None:
        """Push setpoints until enough are in hand."""
        for plan in self._plans:
            queued = self._link.queued_frames
            room = min(self._queue_frames - queued, plan.limit - plan.pushed, N_SETPOINTS - queued)
            if room > 0:
                self._push(plan, room)
            if plan.pushed < plan.limit:
                return

    def read_cycles(self) -> None:
        """Take the bus process's new cycles into the view and the plan's statistics."""
        records, lost = self._view.update()
        if self.current is not None:
            self.current.statistics.feed(records, lost)
        if len(records):
            self._last_goal_tick = np.array(records["goal_tick"][-1])

    def _next_frame(self, plan: Trajectory) -> int:
        """The frame of the newest plan that the bus process takes next."""
        return plan.pushed - min(self._link.queued_frames, plan.pushed)

    def _frame_within(self, plan: Trajectory, ahead_s: float) -> int:
        """The last frame of the newest plan that the bus process takes until `ahead_s` from now; -1: none yet."""
        since_s = (time.monotonic() - self._view.goals_s) % (1.0 / self._rate_hz)  # since it took the last one
        cycles = math.floor((since_s + ahead_s) * self._rate_hz)
        waiting = sum(p.limit - p.pushed for p in self._plans[:-1])  # of plans before, and what the bus has of them
        before = waiting + max(0, self._link.queued_frames - plan.pushed)
        return self._next_frame(plan) - 1 + max(0, cycles - before)

    def _end_at_hand_over(self) -> int:
        """Take back what of the running plan comes after the frame of the hand-over; how much of it is played already."""
        plan, frame, self._handing_over = self.current, self._handing_over, None
        if plan is None or frame is None or plan.epoch != self.epoch:
            return 0
        plan.end = frame + 1
        beyond = self._link.take_back(plan.pushed - plan.end) if plan.pushed > plan.end else 0
        plan.pushed = min(plan.pushed, plan.end)
        return beyond

    def _succeed(self, plan: Trajectory) -> int:
        """Let a plan follow the current one; how many frames beyond the hand-over are played already."""
        beyond = self._end_at_hand_over()
        self._plans = [p for p in self._plans if p.pushed < p.limit]
        self._plans.append(plan)
        return beyond

    def _shown(self, q_rad: NDArray[np.float64]) -> PoseSequence:
        """One frame: a person held as the robot in a pose (J,)."""
        joints, head = joints_of_path(self._retargeter.kinematics, q_rad[None])
        return poses_of_joints(joints, head, np.zeros((1, 2)), FPS)

    def _push(self, plan: Trajectory, count: int) -> None:
        if plan.epoch != self._link.epoch:
            return
        frames = plan.frames(plan.pushed, plan.pushed + count)
        last = plan.ends_here and plan.pushed + len(frames) >= plan.n_frames
        plan.pushed += self._link.push(frames, plan.plan_id, plan.pushed, plan.epoch, last=last)

    def _ran_dry(self, plan: Trajectory) -> bool:
        """Whether the bus process has none of the plan's frames in hand though more were to come."""
        if isinstance(plan, StreamTrajectory) and plan.end is None and not plan.resting:
            return plan.lost  # else more is made in a moment
        return 0 < plan.pushed and not plan.all_pushed and plan.pushed >= plan.limit and self._link.queued_frames == 0
