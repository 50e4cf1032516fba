"""Statistics of a trajectory at the bus, from the bus process's cycle records."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daemon.wire.events import Done
from retarget.path.paths import JointPath
from retarget.robot.robot import RobotModel

SAMPLED_HZ = 20.0
LONGEST_SAMPLED_S = 20.0


class TrajectoryStatistics:
    """Gathers the cycle records of one trajectory.

    Args:
        robot: robot whose limits the speeds are compared with.
        plan_id: number that the trajectory's records carry.
        t_received_ns: monotonic time at which the request arrived, nanoseconds.
        goal_tick: (S,) goals of the servos before the trajectory, ticks; None when unknown.
    """

    def __init__(
        self, robot: RobotModel, plan_id: int, t_received_ns: int, goal_tick: NDArray[np.int32] | None = None
    ) -> None:
        self._robot = robot
        self._plan_id = plan_id
        self._t_received_ns = t_received_ns
        self._goal_tick = goal_tick
        self._t_first_ns: int | None = None
        self._t_last_ns = 0
        self._peak_share = np.zeros(robot.n_joints)
        self.first_motion_ns: int | None = None
        self.last_frame = -1
        self.cycles = 0
        self.gate_clipped = 0
        self.underruns = 0
        self.last_underrun_frame = -1
        self.dropped = 0
        self._frames = 0
        self._direction_deg_frames = 0.0
        self._clipped = self._interventions = 0
        self._goals_rad: list[NDArray[np.float64]] = []
        self._not_compared: deque[tuple[JointPath, int]] = deque()

    @property
    def first_motion_ms(self) -> float | None:
        """Milliseconds from the request's arrival to the first cycle in which a servo's goal changed; None before."""
        return None if self.first_motion_ns is None else (self.first_motion_ns - self._t_received_ns) / 1e6

    def count_from(self, t_received_ns: int) -> None:
        """Count latency from this monotonic time, at which a stream's first target arrived, nanoseconds."""
        self._t_received_ns = t_received_ns

    def take_changes(self, clipped_frames: int, interventions: int) -> None:
        """Set how many frames of a stream were clipped, and how often it was held, so far."""
        self._clipped, self._interventions = clipped_frames, interventions

    def take_path(self, path: JointPath, frames: int) -> None:
        """Add the report of retargeting for a path of `frames` bus frames.

        The comparison with the poses takes 0.7 ms, which would delay the first frame; it is made once the bus process plays.
        """
        self._not_compared.append((path, frames))

    def _compare_oldest(self) -> None:
        path, frames = self._not_compared.popleft()
        report = path.report
        self._frames += frames
        self._direction_deg_frames += report.direction_mean_deg * frames
        self._clipped += report.clipped_frames
        self._interventions += report.interventions

    @property
    def goals_rad(self) -> NDArray[np.float64]:
        """(T, J) goals of the joints so far, radians, at `SAMPLED_HZ`, from the first `LONGEST_SAMPLED_S` seconds."""
        return np.array(self._goals_rad).reshape(-1, self._robot.n_joints)

    def feed(self, records: NDArray[Any], dropped: int = 0) -> None:
        """Take new records, of this trajectory and of others, in order."""
        self.dropped += dropped
        if len(records) == 0:
            return
        if self._not_compared and self.first_motion_ns is not None:
            self._compare_oldest()
        mine = np.flatnonzero(records["plan_id"] == self._plan_id)
        if len(mine):
            self._take(records[mine], records["goal_tick"][mine[0] - 1] if mine[0] > 0 else self._goal_tick)
        self._goal_tick = records["goal_tick"][-1].copy()

    def _take(self, records: NDArray[Any], before_tick: NDArray[np.int32] | None) -> None:
        times = records["t_mono_ns"]
        if self._t_first_ns is None:
            self._t_first_ns = int(times[0])
        self._t_last_ns = int(times[-1])
        if self.first_motion_ns is None:
            ticks = records["goal_tick"]
            before = ticks[:1] if before_tick is None else before_tick[None]
            moved = np.flatnonzero((np.concatenate([before, ticks[:-1]]) != ticks).any(1))
            if len(moved):
                self.first_motion_ns = int(times[moved[0]])
        self._sample(records)
        shares = np.abs(records["velocity_rad_s"]).max(0) / self._robot.velocity_limit_rad_s
        self._peak_share = np.maximum(self._peak_share, shares)
        self.last_frame = max(self.last_frame, int(records["frame"].max()))
        self.cycles += len(records)
        self.gate_clipped += int(records["clipped"].any(1).sum())
        late = records["frame"][records["underrun"] != 0]
        if len(late):
            self.underruns += len(late)
            self.last_underrun_frame = int(late.max())

    def _sample(self, records: NDArray[Any]) -> None:
        """Keep the goals of every frame in which a new sample is due."""
        if len(self._goals_rad) >= LONGEST_SAMPLED_S * SAMPLED_HZ:
            return
        sample = np.floor(records["frame"] * SAMPLED_HZ / self._robot.bus.rate_hz)
        for i in np.flatnonzero(np.diff(sample, prepend=len(self._goals_rad) - 1) > 0).tolist():
            self._goals_rad.append(records["goal_rad"][i].astype(np.float64))

    def done(self, frames: int, shown: str = "", seen: str = "", missing: str = "") -> Done:
        """The event that ends the command, with the judgement whether the robot showed its motion."""
        while self._not_compared:
            self._compare_oldest()
        j = int(self._peak_share.argmax())
        limit = float(self._robot.velocity_limit_rad_s[j])
        span_ns = 0 if self._t_first_ns is None else self._t_last_ns - self._t_first_ns
        first = self.first_motion_ms
        return Done(
            plan_id=self._plan_id,
            first_motion_ms=None if first is None else round(first, 2),
            duration_s=round(span_ns / 1e9 + self._robot.bus.period_s, 3),
            frames=frames,
            peak_speed_share=round(float(self._peak_share[j]), 4),
            peak_speed_joint=self._robot.joint_names[j],
            peak_speed_rad_s=round(float(self._peak_share[j]) * limit, 4),
            peak_speed_limit_rad_s=round(limit, 4),
            clipped_frames=self._clipped,
            gate_clipped_frames=self.gate_clipped,
            underruns=self.underruns,
            direction_error_deg=round(self._direction_deg_frames / max(1, self._frames), 3),
            interventions=self._interventions,
            log_dropped=self.dropped,
            shown=shown,
            seen=seen,
            missing=missing,
        )
