"""A core for the bus process: the bus process stays on it, and the front keeps off it.

The bus process has real-time priority and works in every cycle. On a core where the front retargets it would take a third of the
front's time at unpredictable moments, so that the end of retargeting could not be predicted; the kernel does not separate the two.
Of several daemons on one machine each needs a core of its own, and one core is left to all; a daemon that starts when no core is
left gets none.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import threading
from collections.abc import Generator
from pathlib import Path

_FOLDER = Path("/dev/shm")
_ALL: frozenset[int] = frozenset(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else frozenset()
"""Cores on which this process may run, as its parent set them."""


class CoreClaim:
    """One core, claimed until `close` or the end of the process.

    Attributes:
        core: number of the core; None where none is left.
    """

    def __init__(self, cores: frozenset[int] = _ALL, folder: Path = _FOLDER) -> None:
        self.core: int | None = None
        self._cores = cores
        self._fd = -1
        for core in sorted(cores, reverse=True)[: max(0, len(cores) - 1)]:
            with contextlib.suppress(OSError):  # no such folder, another user's link, or a claimed core
                fd = os.open(
                    folder / f"mmmd-core-{core}",
                    os.O_RDONLY | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC,
                    0o644,
                )
                try:
                    fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except OSError:
                    os.close(fd)
                    continue
                self.core, self._fd = core, fd
                return

    def keep_off(self) -> None:
        """Keep the calling thread, and threads that it starts from now on, off the core."""
        if self.core is not None:
            with contextlib.suppress(OSError):  # the core may have been taken from the process meanwhile
                os.sched_setaffinity(0, self._cores - {self.core})

    def close(self) -> None:
        """Release the core."""
        if self._fd >= 0:
            os.close(self._fd)
        self.core, self._fd = None, -1


def keep_to(core: int) -> bool:
    """Keep the calling thread on one core; return whether this succeeded."""
    try:
        os.sched_setaffinity(0, {core})
    except (OSError, AttributeError):
        return False
    return True


class _Starting(threading.local):
    """The open `on_all_cores` blocks of one thread.

    Attributes:
        n: blocks of `on_all_cores` that are open.
        own: the thread's cores outside of them.
    """

    n = 0
    own: frozenset[int] | set[int] = frozenset()


_starting = _Starting()


@contextlib.contextmanager
def on_all_cores() -> Generator[None]:
    """Let processes started inside the block run on every core that this process had at its start.

    An event loop may start several processes at a time: the thread returns to its own cores at the end of the last block.
    """
    if not _ALL:
        yield
        return
    if not _starting.n:
        _starting.own = os.sched_getaffinity(0)
        with contextlib.suppress(OSError):
            os.sched_setaffinity(0, _ALL)
    _starting.n += 1
    try:
        yield
    finally:
        _starting.n -= 1
        if not _starting.n:
            with contextlib.suppress(OSError):
                os.sched_setaffinity(0, _starting.own)
