"""Turns for files of tests in real time: as many at once as there are processors.

`make test` has more workers than processors, because such tests mostly wait. But each runs several processes with real-time
priority. Four sets of these on two processors kept simulated servos silent for 0.2 s now and then, which is a fault, as on a robot.
"""

from __future__ import annotations

import contextlib
import os
import socket
import time

LOOK_S = 0.05


class RealtimeTurn:
    """One of several turns, shared by the processes of one run of tests; that of a process that ends is free again.

    Args:
        run: name of the run, the same in all of its processes.
        n: number of turns.
    """

    def __init__(self, run: str, n: int) -> None:
        self._names = [
            f"\0mmmd test turn {k} of {run}" for k in range(n)
        ]  # of Linux's abstract sockets, which leave no file
        self._held: socket.socket | None = None

    def take(self) -> None:
        """Wait for a turn, unless this process has one."""
        while self._held is None:
            for name in self._names:
                place = socket.socket(socket.AF_UNIX)
                with contextlib.suppress(OSError):
                    place.bind(name)
                    self._held = place
                    return
                place.close()
            time.sleep(LOOK_S)

    def give_back(self) -> None:
        """Let another process have the turn; does nothing without one."""
        if self._held is not None:
            self._held.close()
            self._held = None


def processors() -> int:
    """Number of processors that this process may use."""
    return len(os.sched_getaffinity(0))
