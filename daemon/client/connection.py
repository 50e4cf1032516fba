"""The sockets of the client: opened on first use; every wait for a reply has a time-out."""

from __future__ import annotations

import time
from types import TracebackType
from typing import Self

import zmq

from daemon.client.compositions import REPLY_TIMEOUT_S
from daemon.client.errors import ConnectionLostError, NoAnswerError, NobodyListensError, RefusedError, stamp, unexpected
from daemon.network.keys import KeyFolder, connect_curve
from daemon.network.probe import listening
from daemon.settings.config import Endpoints
from daemon.wire.codec import decode_event, encode
from daemon.wire.events import Ack, AnyEvent, Refusal
from daemon.wire.requests import Request, tag_of

LONGEST_POLL_S = 0.5
"""Seconds of one poll at most; after each it is asked whether the connection still stands."""


class Connection:
    """Sends requests and receives events over `cmd` and `ctl`. Not for several threads at once.

    ZeroMQ connects again by itself when the daemon comes back; a request that could not be sent meanwhile is not sent later.

    Args:
        endpoints: the daemon's endpoints; those that the environment names (`MMMD_CMD`, ...) when they are not given.
        timeout_s: seconds to wait for a reply at most.
    """

    def __init__(self, endpoints: Endpoints | None = None, timeout_s: float = REPLY_TIMEOUT_S) -> None:
        self.endpoints = endpoints or Endpoints.of_environment()
        self._timeout_s = timeout_s
        self._context = zmq.Context()
        self._cmd: zmq.Socket[bytes] | None = None
        self._ctl: zmq.Socket[bytes] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the sockets; unsent requests have 200 ms."""
        self._context.destroy(linger=200)

    def _command(self, request: Request) -> Ack:
        return self._acknowledged(request, self._cmd_socket(), self.endpoints.cmd)

    def _control(self, request: Request) -> Ack:
        return self._acknowledged(request, self._ctl_socket(), self.endpoints.ctl)

    def _acknowledged(self, request: Request, socket: zmq.Socket[bytes], endpoint: str) -> Ack:
        event = self._ask(request, socket, endpoint)
        if not isinstance(event, Ack):
            raise unexpected(event, tag_of(request))
        return event

    def _ask(self, request: Request, socket: zmq.Socket[bytes], endpoint: str) -> AnyEvent:
        asked = tag_of(request)
        self._send(socket, request, endpoint)
        began_s = time.monotonic()
        while True:
            event = self._receive(socket, began_s, self._timeout_s, endpoint, asked)
            if event.id == request.id:
                return event
            if isinstance(event, Refusal) and not event.id:
                raise RefusedError(event)

    def _send(self, socket: zmq.Socket[bytes], request: Request, endpoint: str) -> None:
        if not socket.poll(int(1000 * self._timeout_s), zmq.POLLOUT):
            raise NoAnswerError(endpoint, tag_of(request), self._timeout_s)
        stamp(request)
        try:
            socket.send(encode(request), zmq.DONTWAIT)
        except zmq.Again:
            raise NoAnswerError(endpoint, tag_of(request), self._timeout_s) from None

    def _receive(
        self, socket: zmq.Socket[bytes], began_s: float, timeout_s: float, endpoint: str, asked: str
    ) -> AnyEvent:
        while not socket.poll(int(1000 * min(LONGEST_POLL_S, max(0.0, began_s + timeout_s - time.monotonic())))):
            waited_s = time.monotonic() - began_s
            if waited_s >= timeout_s:
                raise NoAnswerError(endpoint, asked, timeout_s)
            # With IMMEDIATE there is room for a message only while there is a connection; an answer may have come before its end.
            if not socket.poll(0, zmq.POLLIN | zmq.POLLOUT):
                raise ConnectionLostError(endpoint, asked, waited_s)
        return decode_event(socket.recv())

    def _cmd_socket(self) -> zmq.Socket[bytes]:
        if self._cmd is None:
            self._cmd = self._connect(self.endpoints.cmd)
        return self._cmd

    def _ctl_socket(self) -> zmq.Socket[bytes]:
        if self._ctl is None:
            self._ctl = self._connect(self.endpoints.ctl)
        return self._ctl

    def _connect(self, endpoint: str) -> zmq.Socket[bytes]:
        if not listening(endpoint):
            raise NobodyListensError(endpoint)
        socket = self._context.socket(zmq.DEALER)
        socket.setsockopt(zmq.LINGER, 200)
        socket.setsockopt(zmq.IMMEDIATE, 1)
        self._secure(socket, endpoint)
        socket.connect(endpoint)
        return socket

    def _secure(self, socket: zmq.Socket[bytes], endpoint: str) -> None:
        if self.endpoints.keys is not None and endpoint.startswith("tcp://"):
            connect_curve(socket, KeyFolder(self.endpoints.keys), "daemon")
