"""Single ownership of a port: an advisory lock that also holds against root, and the owner's name.

The lock file is in a folder to which every user may write, so that another user may have put a file there under its name: only a
plain file with a single name is locked, and only a file of this user is written to.
"""

from __future__ import annotations

import fcntl
import os
import stat
import sys
import tempfile
from pathlib import Path


class LockFileError(OSError):
    """A file that is no lock file is in the place of a port's lock file."""

    def __init__(self, path: Path, found: str) -> None:
        self.path = path
        super().__init__(f"its lock file {path} {found}; somebody may have put it there")


class PortLock:
    """Holds a lock file for a device; the file names the owner.

    Raises:
        BlockingIOError: another process holds the lock; the text names it.
        LockFileError: the file under this name is no lock file.
    """

    def __init__(self, device: str) -> None:
        name = str(Path(device).resolve()).strip("/").replace("/", "-")
        self.path = Path(tempfile.gettempdir()) / f"mmmd-{name}.lock"
        self._fd, writable = self._open()
        try:
            fcntl.flock(self._fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            owner = os.read(self._fd, 500).decode("utf-8", "replace").strip()
            os.close(self._fd)
            raise BlockingIOError(owner or "another process") from None
        if writable:
            os.ftruncate(self._fd, 0)
            os.write(self._fd, f"process {os.getpid()} ({' '.join(sys.argv)[:300]})".encode())

    def _open(self) -> tuple[int, bool]:
        """The open lock file, and whether the owner's name can be written: not into a file that another user made."""
        how = os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK
        try:
            try:
                fd = os.open(self.path, os.O_RDWR | os.O_CREAT | how, 0o644)
            except PermissionError:
                fd = os.open(self.path, os.O_RDONLY | how)
        except OSError as error:
            raise LockFileError(self.path, f"cannot be opened ({error.strerror})") from error
        found = os.fstat(fd)
        if not stat.S_ISREG(found.st_mode) or found.st_nlink != 1:
            os.close(fd)
            raise LockFileError(self.path, "is no plain file of that one name")
        return fd, found.st_uid == os.geteuid()

    def release(self) -> None:
        """Release the lock; may be called twice."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1


def process_holding(device: str) -> str:
    """Name of the process that has the device open, as far as this user may see; "another process" when unknown."""
    target = os.path.realpath(device)
    for fd_dir in Path("/proc").glob("[0-9]*/fd"):
        pid = fd_dir.parent.name
        if int(pid) == os.getpid():
            continue
        try:
            if any(os.path.realpath(fd) == target for fd in fd_dir.iterdir()):
                command = (fd_dir.parent / "cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace")
                return f"process {pid} ({command.strip()[:300]})"
        except OSError:
            continue
    return "another process"
