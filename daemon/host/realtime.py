"""Real-time rights: FIFO priority and locked memory, as far as the user's limits allow."""

from __future__ import annotations

import contextlib
import ctypes
import os

BUS_PRIORITY = 40
CONTROL_PRIORITY = 30
"""Priority of the thread that takes stop and e-stop: below the bus process, above everything else."""
_MCL_CURRENT_AND_FUTURE = 3


def take_fifo(priority: int) -> bool:
    """Give FIFO priority to the calling thread; return whether it was granted."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError):
        return False
    return True


def give_back_fifo() -> None:
    """Give the calling thread normal priority again."""
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def may_fifo(priority: int) -> bool:
    """Whether the user may have FIFO priority; the calling thread keeps its priority."""
    if not take_fifo(priority):
        return False
    give_back_fifo()
    return True


def lock_memory() -> bool:
    """Lock all memory of this process, so that no page is swapped out; return whether this was granted."""
    try:
        return ctypes.CDLL(None).mlockall(_MCL_CURRENT_AND_FUTURE) == 0
    except (OSError, AttributeError):
        return False
