"""Sockets of a client of the front, for frames that no client of ours sends."""

from __future__ import annotations

import zmq

from daemon.client.errors import stamp
from daemon.wire import codec as wire
from daemon.wire import requests

OPEN: list[zmq.Socket] = []
"""Sockets of the running test: they must not be collected before their context closes them."""


def dealer(context: zmq.Context, endpoint: str, kind: int = zmq.DEALER) -> zmq.Socket:
    socket = context.socket(kind)
    OPEN.append(socket)
    socket.connect(endpoint)
    socket.setsockopt(zmq.RCVTIMEO, 10_000)
    return socket


def stamped(request: requests.Request) -> bytes:
    """A request as the clients encode it: its time is in it, so that a stop just before it does not end it."""
    stamp(request)
    return wire.encode(request)


def hear(socket: zmq.Socket, until: type) -> list:
    events = []
    while not events or not isinstance(events[-1], until):
        events.append(wire.decode_event(socket.recv()))
    return events


def kinds(events) -> list[str]:
    return [type(e).__struct_config__.tag for e in events]
