"""Real-time rights: FIFO priority and locked memory, as far as this user may."""

from __future__ import annotations

import contextlib
import ctypes
import os

BUS_PRIORITY = 40
CONTROL_PRIORITY = 30
"""Below the bus process, above everything else: the thread that takes stop and e-stop."""
_MCL_CURRENT_AND_FUTURE = 3


def take_fifo(priority: int) -> bool:
    """FIFO priority for the calling thread; whether it was granted."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError):
        return False
    return True


def give_back_fifo() -> None:
    """Normal priority for the calling thread, where it may ever have had another."""
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def may_fifo(priority: int) -> bool:
    """Whether this user may have FIFO priority; the calling thread stays as it is."""
    if not take_fifo(priority):
        return False
    give_back_fifo()
    return True


def lock_memory() -> bool:
    """Keep all memory of this process out of swap; whether it was granted."""
    try:
        return ctypes.CDLL(None).mlockall(_MCL_CURRENT_AND_FUTURE) == 0
    except (OSError, AttributeError):
        return False
