"""Messages of several parts, and of endlessly many: refused by name, and they cost neither the daemon nor its memory."""

from __future__ import annotations

import time

import pytest
import zmq

from daemon.wire import codec as wire
from daemon.wire import events as ev
from tests.attacks.zmtp import RawPeer, frame
from tests.support.harness import running_daemon

pytestmark = [pytest.mark.timeout(120), pytest.mark.realtime]
MANY = 100_000
STANDS = ("idle", "holding")
"""States of an armed robot that nobody moves."""


@pytest.fixture(scope="module")
def running():
    with running_daemon(tcp=True) as daemon, daemon.armed():
        yield daemon


@pytest.fixture
def context():
    made = zmq.Context()
    yield made
    made.destroy(linger=0)


def test_a_target_of_several_parts_is_counted_and_moves_nothing(running, context):
    """SUB with CONFLATE aborts the process upon one such message: `Assertion failed: !(msg_->flags () & msg_t::more)`."""
    sender = context.socket(zmq.PUB)
    sender.connect(running.endpoints.stream)
    with running.client() as client:
        bad: dict[str, int] = {}
        for n_parts in (2, 3, 9, 500):
            before, end_s = bad.get("frames", 0), time.monotonic() + 20
            while bad.get("frames", 0) == before:
                sender.send_multipart([b"x"] * n_parts)
                bad = client.status().stream.bad
                assert time.monotonic() < end_s, f"{n_parts} parts were not counted: {bad}"
        assert client.status().state in STANDS
    sender.close(0)


def test_a_request_of_many_parts_is_refused_and_the_next_one_is_answered(running, context):
    peer = context.socket(zmq.DEALER)
    peer.setsockopt(zmq.SNDHWM, 0)
    peer.setsockopt(zmq.RCVTIMEO, 20_000)
    peer.connect(running.endpoints.cmd)
    for n_parts in (2, 8, 500):
        peer.send_multipart([b"x"] * n_parts)
        error = wire.decode_event(peer.recv())
        assert isinstance(error, ev.ErrorEvent) and error.code == "frames"
        peer.send(b'{"type": "status"}')
        assert isinstance(wire.decode_event(peer.recv()), ev.StateEvent)
    peer.close(0)


def test_a_whole_message_of_100000_parts_holds_nobody_up(running):
    """Read as one list it would hold up the event loop, and so the robot."""
    with RawPeer(running.endpoints.cmd, "DEALER") as peer, running.client() as client:
        assert peer.send(frame(b"x", more=True) * MANY + frame(b"end"))
        for _ in range(20):
            client.status()
        assert client.status().state in STANDS
