"""The channel between ctl process and front: one message a packet; neither side ever waits for the other."""

from __future__ import annotations

import socket
from contextlib import suppress

import msgspec

MOST_BYTES = 1 << 17
"""Bytes of a message at most: more than a request (64 kB) or an event has."""

FRONT_SERVES_S, FRONT_ANSWERS_S = 2.0, 3.0
"""Seconds: the front serves no request older than the first, and after the second its sender receives `front_silent`."""


class Ready(msgspec.Struct, tag="ready"):
    """From the ctl process, before any other message.

    Attributes:
        failed: reason why it does not serve; empty when it serves.
        in_use: whether the reason is that another process has the endpoint.
    """

    failed: str = ""
    in_use: bool = False


class Handed(msgspec.Struct, tag="handed"):
    """From the ctl process: a request. The bus process already has a stop or an e-stop; the front decides on the others.

    Attributes:
        number: number of the request, as in `daemon.shared_memory.request_words`.
        frame: the request as received.
    """

    number: int
    frame: bytes


class Told(msgspec.Struct, tag="told"):
    """From the ctl process: an event that it has sent itself, for the front to publish.

    Attributes:
        event: the encoded event.
    """

    event: bytes


class Answered(msgspec.Struct, tag="answered"):
    """From the front: a request is served.

    Attributes:
        number: number of the request.
        event: the encoded answer; empty for a stop or an e-stop, which the ctl process answers itself.
    """

    number: int
    event: bytes = b""


_ENCODER = msgspec.msgpack.Encoder()
_DECODER = msgspec.msgpack.Decoder(Ready | Handed | Told | Answered)


class Channel:
    """One end of the channel. Not for several threads.

    Args:
        end: socket of a `pair`, which the channel owns from now on.
    """

    def __init__(self, end: socket.socket) -> None:
        self._socket = end
        self._socket.setblocking(False)
        self.closed = False

    def fileno(self) -> int:
        """Descriptor for polling; -1 once closed."""
        return self._socket.fileno()

    def send(self, message: Ready | Handed | Told | Answered) -> bool:
        """Send a message; returns false when there is no room for it now. A message to an end that is gone is lost."""
        try:
            self._socket.send(_ENCODER.encode(message))
        except BlockingIOError:
            return False
        except OSError:
            self.closed = True
        return True

    def receive(self) -> Ready | Handed | Told | Answered | None:
        """The next message that has arrived, else None; `closed` says whether no more will come."""
        try:
            packet = self._socket.recv(MOST_BYTES)
        except BlockingIOError:
            return None
        except OSError:
            packet = b""
        if not packet:
            self.closed = True
            return None
        return _DECODER.decode(packet)

    def close(self) -> None:
        """Close this end."""
        self.closed = True
        with suppress(OSError):
            self._socket.close()


def pair() -> tuple[socket.socket, socket.socket]:
    """Two connected sockets, which keep the bounds and the order of packets."""
    return socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
