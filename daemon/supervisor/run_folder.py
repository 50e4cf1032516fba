"""The folder of a running daemon for its processes' sockets: removed at the end, or after a kill by the next daemon."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
import time
from pathlib import Path

_PREFIX = "mmmd-run-"
_OWNED = "owned"
"""Name of the file that the daemon keeps locked; a lock ends with its process, and works where process ids are not shared."""
_BEGINS_S = 60.0
"""Seconds in which a new folder may exist without its lock."""


class RunFolder:
    """A folder that only this user can enter, for the life of this process."""

    def __init__(self) -> None:
        _remove_orphans(Path(tempfile.gettempdir()))
        self.path = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self._fd = os.open(self.path / _OWNED, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        fcntl.flock(self._fd, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def close(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.path, ignore_errors=True)
        os.close(self._fd)


def _remove_orphans(folder: Path) -> None:
    """Remove folders that killed daemons of this user left behind."""
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
