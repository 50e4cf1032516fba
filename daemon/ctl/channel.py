"""Between the process that serves `ctl` and the front: one message a packet, never waited for by either side."""

from __future__ import annotations

import socket
from contextlib import suppress

import msgspec

MOST_BYTES = 1 << 17
"""More than a request (64 kB) or an event has."""

FRONT_SERVES_S, FRONT_ANSWERS_S = 2.0, 3.0
"""Seconds: the front serves no request that is older, and after the second one its sender is told that nobody has served it."""


class Ready(msgspec.Struct, tag="ready"):
    """From `ctl`, first of all.

    Attributes:
        failed: why it does not serve; empty when it does.
        in_use: whether that is because another has the endpoint.
    """

    failed: str = ""
    in_use: bool = False


class Handed(msgspec.Struct, tag="handed"):
    """From `ctl`: a request. A stop or an e-stop is asked of the bus process already; the others are for the front to decide.

    Attributes:
        number: of the request, as in `daemon.shared_memory.request_words`.
        frame: as it came.
    """

    number: int
    frame: bytes


class Told(msgspec.Struct, tag="told"):
    """From `ctl`: an event that it has sent by itself, for those who watch.

    Attributes:
        event: its bytes.
    """

    event: bytes


class Answered(msgspec.Struct, tag="answered"):
    """From the front: a request of that number is served.

    Attributes:
        number: as handed over.
        event: the bytes of what answers it; empty for a stop or an e-stop, which `ctl` answers itself.
    """

    number: int
    event: bytes = b""


_ENCODER = msgspec.msgpack.Encoder()
_DECODER = msgspec.msgpack.Decoder(Ready | Handed | Told | Answered)


class Channel:
    """One end. Not for several threads.

    Args:
        end: of a `pair`, which it owns from now on.
    """

    def __init__(self, end: socket.socket) -> None:
        self._socket = end
        self._socket.setblocking(False)
        self.closed = False

    def fileno(self) -> int:
        """For polling; -1 once closed."""
        return self._socket.fileno()

    def send(self, message: Ready | Handed | Told | Answered) -> bool:
        """Hand over a message; false when there is no room for it now. To an end that is gone it is lost."""
        try:
            self._socket.send(_ENCODER.encode(message))
        except BlockingIOError:
            return False
        except OSError:
            self.closed = True
        return True

    def receive(self) -> Ready | Handed | Told | Answered | None:
        """The next message that is there, else None; `closed` tells when none will come any more."""
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
    """Two ends; packets keep their bounds, in order."""
    return socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
