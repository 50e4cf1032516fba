"""Whether another process has stopped to beat, judged by one's own steps: who was held up as well has missed no beat."""

from __future__ import annotations


class HeartbeatWatch:
    """Counts the steps in which a beat stood still.

    The clock alone would not do: a machine that stands still for a second holds up both sides.

    Args:
        limit_s: seconds of steps after which the other side is lost.
        step_s: seconds that a step takes.
    """

    def __init__(self, limit_s: float, step_s: float) -> None:
        self._most_steps = limit_s / step_s
        self._steps: int = 0
        self._beat: int = 0

    def lasts(self, beat: int) -> bool:
        """One more step: whether the other side is lost. A beat of 0 has not begun, and is waited for."""
        stands_still = beat == self._beat and beat != 0
        self._steps = self._steps + 1 if stands_still else 0
        self._beat = beat
        return self._steps >= self._most_steps
