"""System resources of a process: descriptors of sockets that ZeroMQ owns, memory, the parent's life. Linux."""

from __future__ import annotations

import contextlib
import ctypes
import errno
import os
import resource
import signal
import socket
import struct

MOST_DESCRIPTORS = 65536
"""Number of file descriptors that a process requests at most; its sockets together use far fewer."""
_PR_SET_PDEATHSIG = 1
_BYTES_RECEIVED = 128
"""Offset of tcpi_bytes_received in `struct tcp_info` (linux/tcp.h)."""


class Held:
    """A socket given by its descriptor, held open by a duplicate, so that the descriptor cannot become another socket meanwhile.

    In the context it is None when the descriptor is no socket, or already another one. A process that has no descriptor left
    uses the first one itself.
    """

    def __init__(self, fd: int, inode: int) -> None:
        self._fd, self._inode = fd, inode
        self._socket: socket.socket | None = None
        self._is_copy = True

    def __enter__(self) -> socket.socket | None:
        with contextlib.suppress(OSError):
            try:
                held = os.dup(self._fd)
            except OSError as error:
                if error.errno != errno.EMFILE:
                    return None
                held, self._is_copy = self._fd, False
            try:
                self._socket = socket.socket(fileno=held)
            except OSError:
                if self._is_copy:
                    os.close(held)
                return None
            return self._socket if os.fstat(held).st_ino == self._inode else None
        return None

    def __exit__(self, *_: object) -> None:
        if self._socket is not None:
            if self._is_copy:
                self._socket.close()
            else:
                self._socket.detach()


def descriptors() -> list[int]:
    """All descriptors of this process that may be open."""
    try:
        return [int(name) for name in os.listdir("/proc/self/fd")]
    except OSError:  # no descriptor is left for listing them
        return list(range(resource.getrlimit(resource.RLIMIT_NOFILE)[0]))


def raise_descriptor_limit() -> None:
    """Raise the limit of file descriptors of this process and its children as far as the system allows."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = MOST_DESCRIPTORS if hard == resource.RLIM_INFINITY else min(hard, MOST_DESCRIPTORS)
    if soft != resource.RLIM_INFINITY and soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def bytes_received(connection: socket.socket) -> int:
    """Bytes that a TCP connection has received since its begin; 0 where the system does not report this."""
    info = connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, _BYTES_RECEIVED + 8)
    return struct.unpack_from("=Q", info, _BYTES_RECEIVED)[0] if len(info) == _BYTES_RECEIVED + 8 else 0


def resident_bytes() -> int:
    """Bytes of memory that this process uses."""
    with open("/proc/self/statm", encoding="ascii") as f:
        return int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def give_memory_back() -> None:
    """Return what was freed to the system, where the C library can (glibc)."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)


def die_with_parent() -> None:
    """Let the system kill the calling process when its parent ends for any reason."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
