"""What a process has from the system: descriptors of sockets that ZeroMQ owns, memory, its parent's life. Linux."""

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
"""File descriptors that a process asks for at most; the shares of its sockets together are far below."""
_PR_SET_PDEATHSIG = 1
_BYTES_RECEIVED = 128
"""Offset of tcpi_bytes_received in `struct tcp_info` (linux/tcp.h)."""


class Held:
    """A socket by its descriptor, held open as a second one, so that it cannot become another meanwhile.

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
    """Every descriptor of this process that may be open."""
    try:
        return [int(name) for name in os.listdir("/proc/self/fd")]
    except OSError:  # none is left to list them with
        return list(range(resource.getrlimit(resource.RLIMIT_NOFILE)[0]))


def raise_descriptor_limit() -> None:
    """Let this process, and those that it starts, have as many file descriptors as the system allows."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = MOST_DESCRIPTORS if hard == resource.RLIM_INFINITY else min(hard, MOST_DESCRIPTORS)
    if soft != resource.RLIM_INFINITY and soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def bytes_received(connection: socket.socket) -> int:
    """Bytes that a TCP connection has received since it began; 0 where the system does not say."""
    info = connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, _BYTES_RECEIVED + 8)
    return struct.unpack_from("=Q", info, _BYTES_RECEIVED)[0] if len(info) == _BYTES_RECEIVED + 8 else 0


def resident_bytes() -> int:
    """Memory of this process."""
    with open("/proc/self/statm", encoding="ascii") as f:
        return int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def give_memory_back() -> None:
    """Return what was freed to the system, where the C library can (glibc)."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)


def die_with_parent() -> None:
    """Let the system kill the calling process when its parent ends, however that ends."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
