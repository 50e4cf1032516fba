"""Bounds the resources that peers of a process's ZeroMQ sockets may use: connections, and bytes that never become a message.

ZeroMQ bounds neither. It accepts connections until the process has no file descriptor left (over ipc it then aborts), and it keeps
the parts of a message that has not ended, however many there are, beside every high-water mark. A thread therefore reads the
descriptors of the process (/proc/self/fd, Linux), finds the connections of the guarded sockets by their local address, and shuts
down those that are too many or bring too much; ZeroMQ takes that for the end of the peer and frees what it kept.
"""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import stat
import threading
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isinf
from typing import Any, Literal, cast

import zmq

from daemon.host.descriptors import (
    Held,
    bytes_received,
    descriptors,
    give_memory_back,
    raise_descriptor_limit,
    resident_bytes,
)

log = logging.getLogger(__name__)

LOOK_EVERY_S = 0.05
MOST_UNREAD_BYTES = 3 << 20
"""Bytes of one connection at most since the last message received through it; its queue and the system's buffer hold less."""
MOST_UNREAD_TOGETHER_BYTES = 12 << 20
"""Unread bytes of all connections together beyond which the one with most is shut down. A byte may take 20 bytes of memory."""
MOST_GROWTH_BYTES = 256 << 20
"""Bytes by which a process may grow before silent ipc connections are shut down, because their bytes cannot be counted."""
TELL_EVERY_S = 1.0
NO_MESSAGE = "bytes that are no whole message"


@dataclass(frozen=True)
class Share:
    """Bounds for all peers of one socket together.

    Attributes:
        connections: number of connections at a time at most.
        gives_way: which connections are shut down when there are more: the newest, so that the others are served on, or the oldest,
            so that a newcomer always gets in.
        most_unread_bytes: see `MOST_UNREAD_BYTES`; infinite for a socket whose owner does not call `ConnectionGuard.received`.
    """

    connections: int
    gives_way: Literal["newest", "oldest"] = "newest"
    most_unread_bytes: float = MOST_UNREAD_BYTES


@dataclass
class _Connection:
    """A descriptor of this process that is a socket; `place` is None when it is no connection of a guarded socket."""

    fd: int
    inode: int
    place: str | None
    tcp: bool
    read_up_to: int = 0
    unread: int = 0
    is_shut: bool = False


class ConnectionGuard:
    """Guards the bound sockets of one process from a thread of its own.

    Args:
        sockets: the guarded sockets, already bound, and their shares, by name.
        most_growth_bytes: see `MOST_GROWTH_BYTES`; infinite for a process that needs more memory itself.

    Attributes:
        shut: number of connections shut down so far, by reason.
    """

    def __init__(
        self,
        sockets: Mapping[str, tuple[zmq.Socket[Any], Share]],
        most_growth_bytes: float = MOST_GROWTH_BYTES,
    ) -> None:
        self._most_growth_bytes = most_growth_bytes
        self._places: dict[object, str] = {}
        self._shares = {name: share for name, (_, share) in sockets.items()}
        for name, (bound, _) in sockets.items():
            self._places[_place(cast("bytes", bound.getsockopt(zmq.LAST_ENDPOINT)))] = name
        self.shut: Counter[str] = Counter()
        self._known: dict[int, _Connection] = {}
        self._delivered: set[int] = set()
        self._calm_bytes = resident_bytes()
        self._told: dict[str, tuple[float, int]] = {}
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="connections", daemon=True)

    def start(self) -> None:
        """Raise the process's limit of descriptors, and begin to guard."""
        raise_descriptor_limit()
        self._thread.start()

    def close(self) -> None:
        self._stopping.set()
        if self._thread.ident is not None:
            self._thread.join(2.0)

    def received(self, fd: int) -> None:
        """Note that a whole message was received through a connection; may be called from any thread."""
        self._delivered.add(fd)

    def shut_down(self, fd: int, reason: str, found: str) -> None:
        """Shut down a connection by its descriptor; does nothing when it is no connection of a guarded socket any more."""
        connection = self._look_at(fd)
        if connection is not None and connection.place is not None:
            self._known[fd] = connection
            self._shut(connection, reason, found)

    def look(self) -> None:
        """Read all connections once, and shut down those beyond the bounds."""
        found: dict[int, _Connection] = {}
        for fd in descriptors():
            connection = self._look_at(fd)
            if connection is not None:
                found[connection.fd] = connection
        self._known = found
        guarded = [c for c in found.values() if c.place is not None]
        self._bound_number(guarded)
        self._bound_unread(guarded)

    def _run(self) -> None:
        while not self._stopping.wait(LOOK_EVERY_S):
            try:
                self.look()
            except Exception:
                log.exception("connections could not be looked at")

    def _look_at(self, fd: int) -> _Connection | None:
        """The connection of a descriptor; None when it is no socket."""
        try:
            status = os.fstat(fd)
        except OSError:  # closed meanwhile
            return None
        if not stat.S_ISSOCK(status.st_mode):
            return None
        known = self._known.get(fd)
        return known if known is not None and known.inode == status.st_ino else self._new(fd, status.st_ino)

    def _new(self, fd: int, inode: int) -> _Connection | None:
        with Held(fd, inode) as held:
            if held is None:
                return None
            if held.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
                return _Connection(fd, inode, None, tcp=False)
            name = held.getsockname()
            tcp = held.family in (socket.AF_INET, socket.AF_INET6)
            return _Connection(fd, inode, self._places.get(name[1] if tcp else name), tcp)

    def _bound_number(self, guarded: Sequence[_Connection]) -> None:
        for name, share in self._shares.items():
            mine = sorted((c for c in guarded if c.place == name), key=lambda c: c.inode)  # inodes rise with time
            excess = len(mine) - share.connections
            if excess > 0:
                found = f"{len(mine)}; allowed: {share.connections}"
                for connection in mine[-excess:] if share.gives_way == "newest" else mine[:excess]:
                    self._shut(connection, "too many", found)

    def _bound_unread(self, guarded: Sequence[_Connection]) -> None:
        delivered, self._delivered = self._delivered, set()
        together = 0
        counted = [c for c in guarded if not isinf(self._most_unread(c))]
        for connection in (c for c in counted if c.tcp):
            most = self._most_unread(connection)
            with Held(connection.fd, connection.inode) as held:
                received = bytes_received(held) if held is not None else 0
            if connection.fd in delivered:
                connection.read_up_to = received
            connection.unread = received - connection.read_up_to
            together += connection.unread
            if connection.unread > most:
                self._shut(connection, NO_MESSAGE, f"{connection.unread} bytes; allowed: {most:g}")
        if together > MOST_UNREAD_TOGETHER_BYTES:
            largest = max(counted, key=lambda c: c.unread)
            found = f"{together} bytes of all together; allowed: {MOST_UNREAD_TOGETHER_BYTES}"
            self._shut(largest, NO_MESSAGE, found)
        grown = resident_bytes() - self._calm_bytes
        if grown > self._most_growth_bytes:
            for connection in counted:
                if not connection.tcp and connection.fd not in delivered:
                    self._shut(connection, NO_MESSAGE, f"{grown >> 20} MiB of memory more")
            give_memory_back()
            self._calm_bytes = resident_bytes()

    def _most_unread(self, connection: _Connection) -> float:
        return self._shares[connection.place or ""].most_unread_bytes

    def _shut(self, connection: _Connection, reason: str, found: str) -> None:
        if connection.is_shut:  # ZeroMQ has not closed it yet
            return
        with Held(connection.fd, connection.inode) as held, contextlib.suppress(OSError):
            if held is not None:
                held.shutdown(socket.SHUT_RDWR)
        connection.is_shut = True
        kind = f"{connection.place}: {reason}"
        self.shut[kind] += 1
        told_s, told = self._told.get(kind, (float("-inf"), 0))
        if time.monotonic() - told_s > TELL_EVERY_S:
            self._told[kind] = (time.monotonic(), self.shut[kind])
            log.warning("shut down %d connections to %s (%s)", self.shut[kind] - told, kind, found)


def connection_of(frame: zmq.Frame) -> int:
    """Descriptor of the connection through which a frame came; -1 for a frame that ZeroMQ made itself."""
    try:
        return frame.get(zmq.SRCFD)
    except zmq.ZMQError:
        return -1


def _place(last_endpoint: bytes) -> int | str:
    """The mark of a bound socket's connections: its TCP port, or its path."""
    endpoint = last_endpoint.decode().rstrip("\0")
    return endpoint.removeprefix("ipc://") if endpoint.startswith("ipc://") else int(endpoint.rpartition(":")[2])
