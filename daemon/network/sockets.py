"""Binds the daemon's sockets with limits, and sends through them without waiting."""

from __future__ import annotations

from typing import Any, cast

import zmq
import zmq.asyncio

from daemon.network.keys import KeyFolder, serve_curve
from daemon.network.probe import listening
from daemon.settings.config import EndpointInUseError, config_error

MAX_RECEIVE_BYTES = 256 << 10
"""Bytes of a frame at most. ZeroMQ drops the connection of a peer that sends more; a smaller frame gets an answer."""
RECEIVE_QUEUE = 8
RECEIVE_BUFFER_BYTES = 256 << 10
"""Bytes that the system buffers for each peer, besides ZeroMQ's queue."""
HANDSHAKE_MS = 3000
"""Milliseconds that a peer has for the handshake. ZeroMQ's 30 s let silent connections pile up."""


def bind(
    socket: zmq.Socket[Any],
    key: str,
    endpoint: str,
    keys: KeyFolder | None = None,
    *,
    most_bytes: int = MAX_RECEIVE_BYTES,
    queue: int = RECEIVE_QUEUE,
) -> None:
    """Bind a socket; over tcp it accepts only clients with an allowed key, if `keys` is given.

    Args:
        socket: the socket.
        key: name of the setting, for errors.
        endpoint: endpoint to bind.
        keys: keys of the clients that are accepted over tcp; None accepts all.
        most_bytes: bytes of a received frame at most.
        queue: messages that ZeroMQ keeps of each peer until they are received; further ones wait at the peer.

    Raises:
        ConfigError: the endpoint is taken or cannot be bound.
    """
    socket.setsockopt(zmq.LINGER, 0)
    socket.setsockopt(zmq.MAXMSGSIZE, most_bytes)
    socket.setsockopt(zmq.RCVHWM, queue)
    socket.setsockopt(zmq.RCVBUF, RECEIVE_BUFFER_BYTES)
    socket.setsockopt(zmq.HANDSHAKE_IVL, HANDSHAKE_MS)
    if keys is not None and endpoint.startswith("tcp://"):
        serve_curve(socket, keys)
    do = "stop the other daemon (`mmmd status` shows it), or choose another endpoint"
    if endpoint.startswith("ipc://") and listening(endpoint):  # ZeroMQ would take the path from its owner
        raise _in_use(key, endpoint, "Address already in use", do)
    try:
        socket.bind(endpoint)
    except zmq.ZMQError as error:
        if error.errno == zmq.EADDRINUSE:
            raise _in_use(key, endpoint, str(error), do) from error
        raise config_error(key, f"{endpoint}: {error}", "a free endpoint", do) from error


def _in_use(key: str, endpoint: str, why: str, do: str) -> EndpointInUseError:
    return EndpointInUseError(f"{key}: found {endpoint}: {why}; allowed: a free endpoint; {do}")


def send_now(socket: zmq.asyncio.Socket, frames: list[bytes]) -> bool:
    """Send without waiting; a peer that never reads loses its own messages and slows no other.

    The message goes through the asyncio socket: a send past it would swallow the edge that announces received frames.

    Returns:
        False when the receiver's queue is full; for a ROUTER only if it is `ROUTER_MANDATORY`.
    """
    sent = cast("Any", socket.send_multipart(frames, zmq.DONTWAIT))  # pyright: ignore[reportUnknownMemberType]
    assert sent.done(), "with DONTWAIT it is known at once"
    return not isinstance(sent.exception(), zmq.Again)


def publish_now(socket: zmq.asyncio.Socket, frames: list[bytes]) -> bool:
    """Send to all subscribers of an `XPUB_NODROP` socket without waiting; a subscriber whose queue is full loses the message.

    With that option a send fails as a whole when one queue is full, which reveals the loss; without it all other subscribers
    get the message. ZeroMQ then skips a subscriber whose queue was full until it reads again.

    Returns:
        False when a queue has become full: from this message on at least one subscriber loses messages.
    """
    if send_now(socket, frames):
        return True
    socket.setsockopt(zmq.XPUB_NODROP, 0)
    send_now(socket, frames)
    socket.setsockopt(zmq.XPUB_NODROP, 1)
    return False
