"""A core for the bus process: it keeps to it, and the front keeps off it.

The bus process has real-time priority and works in every cycle. On the core where the front makes a path it takes a third of the
time from it, in pieces, so that nobody can tell when the path is ready. The kernel leaves both where they are. Of several
daemons on one machine each needs a core of its own, and one core is left to all; who comes too late goes without.
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
"""Where this process may run, as whoever started it wants."""


class CoreClaim:
    """One core, claimed until `close` or the end of the process.

    Attributes:
        core: its number; None where there is none to spare.
    """

    def __init__(self, cores: frozenset[int] = _ALL, folder: Path = _FOLDER) -> None:
        self.core: int | None = None
        self._cores = cores
        self._fd = -1
        for core in sorted(cores, reverse=True)[: max(0, len(cores) - 1)]:
            with contextlib.suppress(OSError):  # no such folder, another user's link, or claimed
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
        """The calling thread, and the threads it starts from now on, leave the core alone."""
        if self.core is not None:
            with contextlib.suppress(OSError):  # a core that was taken away meanwhile
                os.sched_setaffinity(0, self._cores - {self.core})

    def close(self) -> None:
        """Leave the core to others."""
        if self._fd >= 0:
            os.close(self._fd)
        self.core, self._fd = None, -1


def keep_to(core: int) -> bool:
    """Keep the calling thread on one core; whether it is there."""
    try:
        os.sched_setaffinity(0, {core})
    except (OSError, AttributeError):
        return False
    return True


class _Starting(threading.local):
    """What a thread is starting.

    Attributes:
        n: blocks of `on_all_cores` that are open.
        own: the thread's cores outside of them.
    """

    n = 0
    own: frozenset[int] | set[int] = frozenset()


_starting = _Starting()


@contextlib.contextmanager
def on_all_cores() -> Generator[None]:
    """What the calling thread starts meanwhile may run wherever this process might when it began.

    An event loop may start several processes at a time: the thread goes back to its own cores at the end of the last block.
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
