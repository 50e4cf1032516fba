"""The folder of a running daemon for what its processes share: removed at the end, and by the next daemon after a kill."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
import time
from pathlib import Path

_PREFIX = "mmmd-run-"
_OWNED = "owned"
"""File in it on which its daemon holds a lock: a lock ends with its process, also where others see other process ids."""
_BEGINS_S = 60.0
"""Seconds in which a folder may be new and its lock not taken yet."""


class RunFolder:
    """A folder that only this user can enter, while this process lives."""

    def __init__(self) -> None:
        _remove_orphans(Path(tempfile.gettempdir()))
        self.path = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self._fd = os.open(self.path / _OWNED, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        fcntl.flock(self._fd, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def close(self) -> None:
        """Remove it."""
        shutil.rmtree(self.path, ignore_errors=True)
        os.close(self._fd)


def _remove_orphans(folder: Path) -> None:
    """Remove what daemons of this user that were killed left behind."""
    for path in folder.glob(f"{_PREFIX}*"):
        try:
            found = path.lstat()
            if found.st_uid != os.geteuid() or time.time() - found.st_mtime < _BEGINS_S:
                continue
            fd = os.open(path / _OWNED, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
        except OSError:  # a link, a file, somebody else's: not ours to remove
            continue
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(path, ignore_errors=True)
        except BlockingIOError:
            pass  # its daemon lives
        finally:
            os.close(fd)
