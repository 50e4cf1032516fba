"""A hand-made peer: speaks ZMTP 3.0 (RFC 23) byte by byte, so that it can send what no library would."""

from __future__ import annotations

import select
import socket
import struct
import time
from types import TracebackType
from typing import Self
from urllib.parse import urlsplit

TIMEOUT_S = 10.0
LOOK_EVERY_S = 0.1
_GREETING = b"\xff" + bytes(8) + b"\x7f\x03\x00" + b"NULL".ljust(20, b"\0") + bytes(32)
_MORE, _LONG, _COMMAND = 1, 2, 4


def connected(endpoint: str) -> socket.socket:
    """A connection to a tcp:// or ipc:// endpoint, without a word said."""
    if endpoint.startswith("ipc://"):
        peer = socket.socket(socket.AF_UNIX)
        try:
            peer.connect(endpoint.removeprefix("ipc://"))
        except OSError:
            peer.close()
            raise
        peer.settimeout(TIMEOUT_S)
        return peer
    parts = urlsplit(endpoint)
    return socket.create_connection((parts.hostname, parts.port or 0), TIMEOUT_S)


def frame(body: bytes, *, more: bool = False, command: bool = False) -> bytes:
    """A frame as it goes over the wire."""
    flags = _MORE * more | _COMMAND * command
    if len(body) > 255:
        return bytes([flags | _LONG]) + struct.pack(">Q", len(body)) + body
    return bytes([flags, len(body)]) + body


class RawPeer:
    """A connection that has shaken hands.

    Args:
        endpoint: of the daemon's socket.
        kind: type of socket that it says it is, for example "DEALER".
    """

    def __init__(self, endpoint: str, kind: str) -> None:
        self.socket = connected(endpoint)
        try:
            self._shake_hands(kind)
        except OSError:
            self.socket.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.socket.close()

    def send(self, data: bytes) -> bool:
        """Send bytes; False once the daemon has closed the connection, or has read nothing for `TIMEOUT_S`.

        The end of the connection is looked for, too: a sender that waits until the receiver has room again is not told of it.
        """
        rest, end_s = memoryview(data), time.monotonic() + TIMEOUT_S
        try:
            while rest and time.monotonic() < end_s:
                to_read, to_write, _ = select.select([self.socket], [self.socket], [], LOOK_EVERY_S)
                if to_read and not self.socket.recv(1, socket.MSG_PEEK):
                    return False
                if to_write:
                    rest = rest[self.socket.send(rest, socket.MSG_DONTWAIT) :]
        except OSError:
            return False
        return not rest

    def _shake_hands(self, kind: str) -> None:
        self.socket.sendall(_GREETING)
        self._read(64)
        name, value = b"Socket-Type", kind.encode()
        ready = b"\x05READY" + bytes([len(name)]) + name + struct.pack(">I", len(value)) + value
        self.socket.sendall(frame(ready, command=True))
        self._read(self._read(2)[1])

    def _read(self, n: int) -> bytes:
        data = b""
        while len(data) < n:
            more = self.socket.recv(n - len(data))
            if not more:
                raise ConnectionError("closed while shaking hands")
            data += more
        return data
