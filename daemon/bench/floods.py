"""Floods of a daemon's public sockets, each in a process of its own that ends with its parent.

`python -m daemon.bench.floods KIND ENDPOINT` floods until it is killed; it prints a line once the flood has begun.
"""

from __future__ import annotations

import contextlib
import itertools
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Generator
from urllib.parse import urlsplit

import zmq

from daemon.errors import DaemonError
from daemon.host.descriptors import die_with_parent, raise_descriptor_limit
from daemon.wire.codec import encode
from daemon.wire.requests import Capabilities, Reset, Status

N_PEERS = 4
"""Clients that flood `cmd` or `stream` together."""
N_TOPICS, TOPIC_BYTES = 200, 1000
"""Number of topics, and bytes of each, that the flood of `pub` subscribes to and unsubscribes from. Such a flood once delayed an
e-stop by 12 s."""
N_CONNECTIONS = 1000
"""Number of connections without any traffic. They once used up every descriptor of the daemon in 0.7 s."""
_RENEW_S = 1.0
"""Seconds after which idle connections are made anew, as the daemon closes those without a handshake."""
_FRAME_BYTES = 300
_MULTIPART_EVERY = 100
"""Number of frames of `stream`, of which one is a message of two parts."""


def flood_cmd(endpoint: str) -> None:
    """Send requests that need an answer, and invalid bytes, as fast as the socket takes them; read no answer."""
    peers = _peers(endpoint, zmq.DEALER)
    frames = (encode(Capabilities(id="flood")), b"x" * _FRAME_BYTES, b'{"type": ' * 100)
    for peer, frame in zip(itertools.cycle(peers), itertools.cycle(frames), strict=False):
        with contextlib.suppress(zmq.Again):
            peer.send(frame, zmq.DONTWAIT)


def flood_ctl(endpoint: str) -> None:
    """Request the state and resets, and send invalid bytes, as fast as the socket takes them; read no answer."""
    peers = _peers(endpoint, zmq.DEALER)
    frames = (encode(Status(id="flood")), encode(Reset(id="flood")), b"x" * _FRAME_BYTES, b'{"type": ' * 100)
    for peer, frame in zip(itertools.cycle(peers), itertools.cycle(frames), strict=False):
        with contextlib.suppress(zmq.Again):
            peer.send(frame, zmq.DONTWAIT)


def flood_stream(endpoint: str) -> None:
    """Send frames that are no targets, some of them in two parts."""
    peers = _peers(endpoint, zmq.PUB)
    for i, peer in enumerate(itertools.cycle(peers)):
        if i % _MULTIPART_EVERY:
            peer.send(b"x" * _FRAME_BYTES)
        else:
            peer.send_multipart([b"x", b"y"])


def flood_pub(endpoint: str) -> None:
    """Subscribe to long topics and unsubscribe again."""
    (peer,) = _peers(endpoint, zmq.SUB, 1)
    topics = [f"v1/{i:04d}".encode() + b"x" * TOPIC_BYTES for i in range(N_TOPICS)]
    while True:
        for option in (zmq.SUBSCRIBE, zmq.UNSUBSCRIBE):
            for topic in topics:
                peer.setsockopt(option, topic)


def idle_connections(endpoint: str) -> None:
    """Hold TCP connections without sending."""
    raise_descriptor_limit()
    parts = urlsplit(endpoint)
    held: list[socket.socket] = []
    for first in itertools.chain([True], itertools.repeat(False)):
        for one in held:
            one.close()
        held.clear()
        for _ in range(N_CONNECTIONS):
            with contextlib.suppress(OSError):
                held.append(socket.create_connection((parts.hostname or "", parts.port or 0), _RENEW_S))
        if first:
            _begun()
        time.sleep(_RENEW_S)


FLOODS: dict[str, Callable[[str], None]] = {
    "cmd": flood_cmd, "ctl": flood_ctl, "pub": flood_pub, "stream": flood_stream, "connections": idle_connections,
}  # fmt: skip


@contextlib.contextmanager
def flooded(kind: str, endpoint: str) -> Generator[None]:
    """Run a flood of `FLOODS`, which has begun when the block is entered.

    Raises:
        DaemonError: the flood's process ended before the flood began.
    """
    command = [sys.executable, "-m", "daemon.bench.floods", kind, endpoint]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        try:
            if process.stdout is None or not process.stdout.readline():
                raise DaemonError(f"the flood of {endpoint} ({kind}) ended before it began; its error stands above")
            yield
        finally:
            process.kill()


def _peers(endpoint: str, kind: int, n: int = N_PEERS) -> list[zmq.Socket[bytes]]:
    """Sockets connected to `endpoint`, never closed."""
    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()  # lives as long as its sockets
    peers = [context.socket(kind) for _ in range(n)]
    for peer in peers:
        peer.connect(endpoint)
    _begun()
    return peers


def _begun() -> None:
    sys.stdout.write("begun\n")
    sys.stdout.flush()


if __name__ == "__main__":
    die_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group and is the bench's to handle
    FLOODS[sys.argv[1]](sys.argv[2])
