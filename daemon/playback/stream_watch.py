"""A lease while it is played: its frames made in time, its holder told what holds it, its figures."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.playback.sources.stream_source import SELF_COLLISION
from daemon.playback.stream_trajectory import StreamTrajectory
from daemon.state.ledger import Entry, Ledger
from daemon.wire.events import Progress

TOLD_EVERY_S = 0.5
"""What changes more often than that is told of less often; `status` always knows."""


class StreamWatch:
    """Looks after one lease at a time."""

    def __init__(self, planner: SetpointBuffer, ledger: Ledger) -> None:
        self._planner, self._ledger = planner, ledger
        self._told = ""
        self._told_s = float("-inf")

    def begin(self, entry: Entry, plan_id: int) -> None:
        """Targets move the robot from now on."""
        self._told, self._told_s = "", float("-inf")
        self._ledger.emit(entry, Progress(plan_id=plan_id, stage="leased"))
        self._planner.stream_on()

    def take(self, plan: StreamTrajectory, q_rad: NDArray[np.float64]) -> bool:
        """A checked target (J,); what it moves goes out at once. False when the lease takes none any more."""
        if not plan.score.take(q_rad, time.monotonic()):
            return False
        if plan.score.targets == 1:
            now_ns = time.monotonic_ns()
            plan.first_target_s = now_ns * 1e-9
            plan.statistics.count_from(now_ns)
        self._planner.stream_on()
        return True

    def look(self, plan: StreamTrajectory, entry: Entry) -> None:
        """Once a tick."""
        now_s, score = time.monotonic(), plan.score
        score.clock.look(now_s)
        self._planner.stream_on()
        held_by = score.held_by
        if held_by == self._told or now_s - self._told_s < TOLD_EVERY_S:
            return
        self._told, self._told_s = held_by, now_s
        if held_by == SELF_COLLISION:
            where = score.touching() or "the robot itself, on the way to the target"
            progress = Progress(plan_id=plan.plan_id, stage="held", reason=f"self-collision: {where}")
        elif held_by:
            reason = f"no target for {score.clock.silence_s:g} s: braking, then holding"
            progress = Progress(plan_id=plan.plan_id, stage="silent", reason=reason)
        else:
            progress = Progress(plan_id=plan.plan_id, stage="streaming")
        self._ledger.emit(entry, progress)

    def end(self, plan: StreamTrajectory) -> None:
        """Figures for its last event."""
        plan.statistics.take_changes(plan.score.clipped, plan.score.holds)
