"""Detects a missing heartbeat of another process, counted in one's own steps: a watcher that was held up itself counts no miss."""

from __future__ import annotations


class HeartbeatWatch:
    """Counts the steps in which a heartbeat did not change.

    The clock alone does not suffice: a machine that stands still for a second holds up both sides.

    Args:
        limit_s: seconds of steps without a heartbeat after which the other process is lost.
        step_s: seconds that a step takes.
    """

    def __init__(self, limit_s: float, step_s: float) -> None:
        self._most_steps = limit_s / step_s
        self._steps: int = 0
        self._beat: int = 0

    def lasts(self, beat: int) -> bool:
        """Whether the other process is lost. Call once a step; a beat of 0 has not begun yet and is waited for."""
        stands_still = beat == self._beat and beat != 0
        self._steps = self._steps + 1 if stands_still else 0
        self._beat = beat
        return self._steps >= self._most_steps
