"""Whether the machine stood still: a virtual one does while its host runs others, for a second on a busy one.

A test of processes in real time says nothing of them when one of the processors stood still for a tenth of a second meanwhile:
servos' watchdogs ran out, answers came late, as they would on a robot. `make test` gives what failed a second run, alone, with
`--void-when-held-up`: a `realtime` test then waits for a still moment, and if it fails again and the machine was measured to have
stood still meanwhile it is void: skipped, with the reason. Where the machine ran it fails; one without a host is never held up.
"""

from __future__ import annotations

import threading
import time
from pathlib import Path

from sim.steal_time import STAT, stolen_s

LOOK_S = 0.02
LEAST_S = 0.1
"""As long may a robot's daemon be held up without harm: half of what a servo's watchdog allows."""
_IN_ONE_PIECE = 0.8
"""Of the time since the last look, to be one hold-up and not many short ones."""
STILL_S, WAIT_S, WAIT_IN_ALL_S = 3.0, 20.0, 300.0
"""So long without a hold-up is a still moment; so long it is waited for, each time and in all."""


class HostWatch:
    """Remembers hold-ups of the machine; `look` is to be called often."""

    def __init__(self, stat: Path = STAT) -> None:
        self._stat = stat
        self._pauses: list[tuple[float, float]] = []
        self._waited_s = 0.0
        self._looked_s, self._stolen = time.monotonic(), stolen_s(self._stat)

    def start(self) -> HostWatch:
        """Look from a thread of its own until the process ends."""
        threading.Thread(target=self._watch, daemon=True).start()
        return self

    def look(self) -> None:
        """Note what was taken since the last look."""
        now_s, stolen = time.monotonic(), stolen_s(self._stat)
        since_s = now_s - self._looked_s
        taken_s = max((now - then for now, then in zip(stolen, self._stolen, strict=False)), default=0.0)
        if taken_s >= max(LEAST_S, _IN_ONE_PIECE * since_s):
            self._pauses.append((now_s, taken_s))
        self._looked_s, self._stolen = now_s, stolen

    def longest_s(self, since_s: float) -> float:
        """The longest hold-up that ended after `since_s` of the monotonic clock; 0.0 for none of a tenth of a second."""
        return max((taken_s for end_s, taken_s in self._pauses if end_s >= since_s), default=0.0)

    def wait_until_still(self) -> None:
        """Return when there was no hold-up for a while, or when that does not come."""
        began_s = now_s = time.monotonic()
        longest_s = min(WAIT_S, WAIT_IN_ALL_S - self._waited_s)
        while now_s < began_s + longest_s and self.longest_s(now_s - STILL_S):
            time.sleep(LOOK_S)
            now_s = time.monotonic()
        self._waited_s += now_s - began_s

    def _watch(self) -> None:
        while True:
            time.sleep(LOOK_S)
            self.look()
