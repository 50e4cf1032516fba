"""A running daemon with gestures of its own, its client, and one socket that gathers events."""

from __future__ import annotations

import time

import pytest
import zmq

from daemon.client.errors import stamp
from daemon.wire import codec as wire
from daemon.wire import events as ev
from tests.support.harness import running_daemon


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with running_daemon("--gestures", str(tmp_path_factory.mktemp("own"))) as daemon:
        yield daemon


@pytest.fixture
def robot(running):
    with running.armed() as client:
        yield client


class Talk:
    """One DEALER: sends requests, gathers what comes back by command."""

    def __init__(self, endpoint: str) -> None:
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.connect(endpoint)
        self.heard: dict[str, list[ev.Event]] = {}

    def send(self, request) -> None:
        stamp(request)
        self._socket.send(wire.encode(request))

    def until(self, command: str, kind: type, timeout_s: float = 15.0):
        end_s = time.monotonic() + timeout_s
        while not any(isinstance(e, kind) for e in self.heard.get(command, [])):
            left_s = end_s - time.monotonic()
            assert left_s > 0 and self._socket.poll(int(1000 * left_s)), f"{command}: no {kind}; heard {self.heard}"
            event = wire.decode_event(self._socket.recv())
            self.heard.setdefault(event.id, []).append(event)
        return next(e for e in self.heard[command] if isinstance(e, kind))

    def last(self, command: str) -> ev.Event:
        return self.heard[command][-1]

    def close(self) -> None:
        self._context.destroy(linger=0)


@pytest.fixture
def talk(running):
    made = Talk(running.endpoints.cmd)
    yield made
    made.close()
