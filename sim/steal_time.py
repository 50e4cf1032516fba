"""Time of a machine without the pauses that its host imposed: for simulated servos no time passed during these.

A virtual machine stands still while its host runs others, for half a second on a busy host. Real servos go on meanwhile, their bus
watchdogs run out, and the robot is rightly in fault. Simulated servos stand still with the machine; a watchdog that ran out would
describe the host and not the robot. A process that is stopped or starved on a running machine is another matter: the host took no
time from the machine, and the servos' time goes on.
"""

from __future__ import annotations

import functools
import re
import threading
from pathlib import Path

from daemon.host.clock import Clock, RealClock

STAT = Path("/proc/stat")
"""File whose eighth figure in each `cpu` line is the time that the host took since the start, in 1/100 s (proc_stat(5))."""
_STOLEN = re.compile(r"^cpu\d+(?: +\d+){7} +(\d+)", re.MULTILINE)
_STOLEN_UNIT_S = 0.01
_TINY_S = 1e-6
LEAST_PAUSE_S = 0.03
"""Seconds of the shortest pause that is taken off; a shorter one trips no watchdog."""
LOOK_EVERY_S = 0.1
"""Seconds between two readings of `STAT`, so that the figure from before a pause is at most this old."""


class MachineTime:
    """Seconds of a real clock less the pauses of the whole machine; must be read often; safe for several threads.

    Attributes:
        taken_s: sum of those pauses.
    """

    def __init__(self, clock: Clock, stat: Path = STAT) -> None:
        self.taken_s = 0.0
        self._clock, self._stat = clock, stat
        self._lock = threading.Lock()
        self._asked_s = self._looked_s = clock.now_s()
        self._stolen_s = stolen_s(self._stat)

    def now_s(self) -> float:
        """Seconds; the value never decreases."""
        with self._lock:
            now_s = self._clock.now_s()
            pause_s = now_s - self._asked_s
            self._asked_s = now_s
            if pause_s >= LEAST_PAUSE_S or now_s - self._looked_s >= LOOK_EVERY_S:
                before_s, self._stolen_s, self._looked_s = self._stolen_s, stolen_s(self._stat), now_s
                if pause_s >= LEAST_PAUSE_S:
                    most_s = max((s - b for s, b in zip(self._stolen_s, before_s, strict=False)), default=0.0)
                    self.taken_s += min(pause_s, most_s)
            return now_s - self.taken_s

    def sleep_until(self, t_s: float) -> None:
        """Return when `now_s` shows `t_s`."""
        while self.now_s() < t_s - _TINY_S:
            self._clock.sleep_until(t_s + self.taken_s)


def stolen_s(stat: Path = STAT) -> list[float]:
    """Seconds that the host took from each processor since the machine's start; empty where `stat` cannot be read."""
    try:
        text = stat.read_text("ascii")
    except OSError:
        return []
    return [int(ticks) * _STOLEN_UNIT_S for ticks in _STOLEN.findall(text)]


@functools.cache
def machine_time() -> MachineTime:
    """The machine time of this process, one for all ports of a robot."""
    return MachineTime(RealClock())
