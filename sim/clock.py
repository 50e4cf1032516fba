"""Virtual time, which moves only when a caller waits. Its clock can be made to jump, as a machine's clock can; true time cannot."""

from __future__ import annotations


class VirtualClock:
    """A `Clock` whose sleep ends at once, at the requested time."""

    def __init__(self, start_s: float = 0.0) -> None:
        self.true_s = start_s
        """Seconds of true time, by which the servos run."""
        self._ahead_s = 0.0

    def now_s(self) -> float:
        """Seconds that the clock shows."""
        return self.true_s + self._ahead_s

    def sleep_until(self, t_s: float) -> None:
        """Advance to the moment at which the clock shows `t_s`."""
        self.true_s = max(self.true_s, t_s - self._ahead_s)

    def sleep_until_true(self, t_s: float) -> None:
        """Advance to a time `t_s` of the servos."""
        self.true_s = max(self.true_s, t_s)

    def jump(self, by_s: float) -> None:
        """Make the clock show `by_s` seconds more from now on."""
        self._ahead_s += by_s


class TrueTime:
    """The true time behind a virtual clock, by which the servos run: the clock may jump, true time does not."""

    def __init__(self, clock: VirtualClock) -> None:
        self._clock = clock

    def now_s(self) -> float:
        """Seconds."""
        return self._clock.true_s

    def sleep_until(self, t_s: float) -> None:
        """Advance to time `t_s`."""
        self._clock.sleep_until_true(t_s)
