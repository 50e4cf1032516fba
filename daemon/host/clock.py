"""Clocks of the daemon: real here, virtual in the simulator; and the name of a clock, for messages between machines."""

from __future__ import annotations

import asyncio
import functools
import hashlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

BOOT_ID = Path("/proc/sys/kernel/random/boot_id")
"""File with an id that Linux draws at each start of the machine (proc(5))."""
TIME_NAMESPACE = Path("/proc/self/ns/time")
"""File that names the time namespace: a container may have a monotonic clock of its own (time_namespaces(7))."""
TICK_S = 0.005
"""Seconds between two checks of a condition that an event loop waits for."""


@functools.cache
def clock_id() -> str:
    """Name of this process's monotonic clock: equal for all processes that read the same clock, empty where unknown."""
    try:
        boot = BOOT_ID.read_text("ascii").strip()
    except OSError:
        return ""
    try:
        namespace = os.readlink(TIME_NAMESPACE)
    except OSError:  # Linux before 5.6 has one clock for all processes
        namespace = ""
    return hashlib.sha256(f"{boot} {namespace}".encode()).hexdigest()[:16]


class Clock(Protocol):
    """Monotonic seconds, and waiting for them."""

    def now_s(self) -> float:
        """Seconds since some fixed time; the value never decreases."""
        ...

    def sleep_until(self, t_s: float) -> None:
        """Return at `t_s`, or at once if that time is past."""
        ...


class RealClock:
    """The machine's monotonic clock."""

    def now_s(self) -> float:
        """Seconds of CLOCK_MONOTONIC."""
        return time.monotonic()

    def sleep_until(self, t_s: float) -> None:
        """Sleep to an absolute time."""
        left = t_s - time.monotonic()
        if left > 0:
            time.sleep(left)

    async def sleep(self, seconds: float) -> None:
        """Let other tasks of the event loop run for `seconds`."""
        await asyncio.sleep(seconds)


REAL_CLOCK = RealClock()


class LoopClock(Clock, Protocol):
    """A clock for code that runs in an event loop."""

    async def sleep(self, seconds: float) -> None:
        """Let other tasks of the event loop run until `seconds` have passed."""
        ...


async def sleep_while(clock: LoopClock, condition: Callable[[], bool], at_most_s: float) -> None:
    """Let other tasks of the event loop run as long as the condition holds, `at_most_s` at most."""
    end_s = clock.now_s() + at_most_s
    while condition() and clock.now_s() < end_s:
        await clock.sleep(TICK_S)
