"""Files of shared memory: their folder, the lock of a running bus process, and the removal of files of killed daemons."""

from __future__ import annotations

import fcntl
import os
import tempfile
from contextlib import suppress
from pathlib import Path

_PREFIX = "mmmd-link-"


def create_file() -> Path:
    """Path of a new file, in /dev/shm where there is one; files that killed daemons left there are removed."""
    folder = "/dev/shm" if os.access("/dev/shm", os.W_OK) else tempfile.gettempdir()
    _remove_orphans(Path(folder))
    fd, name = tempfile.mkstemp(prefix=f"{_PREFIX}{os.getpid()}-", dir=folder)
    os.close(fd)
    return Path(name)


def hold(path: Path) -> int:
    """Lock a file to the end of this process; returns the descriptor that holds the lock."""
    fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    fcntl.flock(fd, fcntl.LOCK_EX)
    return fd


def is_held(path: Path) -> bool:
    """Whether a bus process holds the lock of a file."""
    try:
        fd = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        fcntl.flock(fd, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(fd)
    return False


def _remove_orphans(folder: Path) -> None:
    """Remove files whose owner, a process named in the file name, has ended."""
    for path in folder.glob(f"{_PREFIX}*-*"):
        owner = path.name.removeprefix(_PREFIX).partition("-")[0]
        if not owner.isdigit():
            continue
        try:
            os.kill(int(owner), 0)
        except ProcessLookupError:
            if is_held(path):  # its bus process still has the robot, and the ctl process detects that by this file
                continue
            with suppress(OSError):  # another user's
                path.unlink()
        except (PermissionError, OverflowError):
            continue
