"""The daemon's sockets: bound with limits, sent to without waiting."""

from __future__ import annotations

from typing import Any, cast

import zmq
import zmq.asyncio

from daemon.network.keys import KeyFolder, serve_curve
from daemon.network.probe import listening
from daemon.settings.config import EndpointInUseError, config_error

MAX_RECEIVE_BYTES = 256 << 10
"""Bytes of a frame. ZeroMQ drops the connection of a peer that sends more; below it the peer is told what is allowed."""
RECEIVE_QUEUE = 8
RECEIVE_BUFFER_BYTES = 256 << 10
"""Bytes that the system keeps of each peer besides."""
HANDSHAKE_MS = 3000
"""Milliseconds that a peer has to shake hands. ZeroMQ's 30 s let silent connections pile up."""


def bind(
    socket: zmq.Socket[Any],
    key: str,
    endpoint: str,
    keys: KeyFolder | None = None,
    *,
    most_bytes: int = MAX_RECEIVE_BYTES,
    queue: int = RECEIVE_QUEUE,
) -> None:
    """Bind a socket; one that machines can reach takes only allowed `keys`, where there are any.

    Args:
        socket: the socket.
        key: names the setting, for errors.
        endpoint: where to bind it.
        keys: of the clients that are let in over tcp; None lets all in.
        most_bytes: of a frame that it receives.
        queue: messages that ZeroMQ keeps of each peer until they are received; more wait at the peer.

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
    if endpoint.startswith("ipc://") and listening(endpoint):  # ZeroMQ would take the path from it
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
    """Send without waiting; a peer that never reads loses its own messages and slows nobody.

    Through the asyncio socket: a send past it would swallow the edge that tells of received frames.

    Returns:
        False when the queue of who should have it is full, of a ROUTER only if it is `ROUTER_MANDATORY`.
    """
    sent = cast("Any", socket.send_multipart(frames, zmq.DONTWAIT))  # pyright: ignore[reportUnknownMemberType]
    assert sent.done(), "with DONTWAIT it is known at once"
    return not isinstance(sent.exception(), zmq.Again)


def publish_now(socket: zmq.asyncio.Socket, frames: list[bytes]) -> bool:
    """Send to all subscribers of an XPUB that is `XPUB_NODROP`, without waiting; one whose queue is full does without.

    With that option a send fails as a whole when one queue is full, which is how a loss is noticed; without it all but
    the full ones get the message. ZeroMQ then passes over a subscriber whose queue was full until it reads again.

    Returns:
        False when a queue has become full: from this message on one subscriber or more loses messages.
    """
    if send_now(socket, frames):
        return True
    socket.setsockopt(zmq.XPUB_NODROP, 0)
    send_now(socket, frames)
    socket.setsockopt(zmq.XPUB_NODROP, 1)
    return False
