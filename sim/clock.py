"""Virtual time: moves only when somebody waits. Its clock may be made to jump, as a machine's can; its time cannot."""

from __future__ import annotations


class VirtualClock:
    """A `Clock` that jumps to where it is told to sleep."""

    def __init__(self, start_s: float = 0.0) -> None:
        self.true_s = start_s
        """Time as the servos have it."""
        self._ahead_s = 0.0

    def now_s(self) -> float:
        """What the clock shows."""
        return self.true_s + self._ahead_s

    def sleep_until(self, t_s: float) -> None:
        """Jump to when the clock shows `t_s`."""
        self.true_s = max(self.true_s, t_s - self._ahead_s)

    def sleep_until_true(self, t_s: float) -> None:
        """Jump to a time of the servos."""
        self.true_s = max(self.true_s, t_s)

    def jump(self, by_s: float) -> None:
        """From now on the clock shows `by_s` more."""
        self._ahead_s += by_s


class TrueTime:
    """The time that a virtual clock's servos have: what the clock shows may jump, time does not."""

    def __init__(self, clock: VirtualClock) -> None:
        self._clock = clock

    def now_s(self) -> float:
        """Seconds."""
        return self._clock.true_s

    def sleep_until(self, t_s: float) -> None:
        """Let time go on to `t_s`."""
        self._clock.sleep_until_true(t_s)
