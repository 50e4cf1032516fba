"""Connections, subscriptions and messages without end: each peer has its share, and nobody else is kept from the daemon."""

from __future__ import annotations

import contextlib
import os
import socket
import time
from pathlib import Path

import pytest
import zmq

from daemon.front.subscriptions import BURST, COST_OF_OTHERS, MOST_TOPIC_BYTES, RATE_HZ, Subscriptions
from daemon.wire import codec as wire
from tests.attacks.zmtp import RawPeer, connected, frame
from tests.support.harness import RunningDaemon, running_daemon
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]
STANDS = ("idle", "holding")
"""States of an armed robot that nobody moves; a daemon that an attack holds up for long lets it park, or ends in a fault."""
MOST_GROWTH_BYTES = 500 << 20


@pytest.fixture(scope="module", params=few_and_long(["mixed"], ["tcp", "ipc"]))
def running(request):
    """A daemon with its sockets on tcp or ipc; mixed: `ctl` on ipc, the others on tcp."""
    with running_daemon(tcp={"mixed": "but ctl", "tcp": True, "ipc": False}[request.param]) as daemon, daemon.armed():
        yield daemon


def memory_bytes(daemon: RunningDaemon) -> int:
    return int(Path(f"/proc/{daemon.process.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def descriptors(daemon: RunningDaemon) -> int:
    return len(os.listdir(f"/proc/{daemon.process.pid}/fd"))


@contextlib.contextmanager
def crowd(endpoint: str, n: int):
    """So many connections that say nothing; as many as the daemon takes."""
    sockets: list[socket.socket] = []
    try:
        for _ in range(n):
            with contextlib.suppress(OSError):
                sockets.append(connected(endpoint))
        yield sockets
    finally:
        for one in sockets:
            one.close()


@pytest.mark.parametrize(
    ("running", "name", "n"),
    few_and_long(
        [("mixed", "ctl", 1500)],
        [("mixed", "cmd", 1500), ("tcp", "ctl", 700), ("tcp", "pub", 700), ("tcp", "stream", 700), ("ipc", "cmd", 700)],
    )
    + [
        pytest.param(transport, name, 1500, marks=pytest.mark.soak)
        for transport, name in (("tcp", "ctl"), ("tcp", "pub"), ("tcp", "stream"), ("ipc", "cmd"))
    ],
    indirect=["running"],
    scope="module",
)
def test_many_connections_to_a_socket_keep_no_new_client_out(running, name, n):
    """1500 took every descriptor of the daemon in 0.7 s: no new client got in; over ipc libzmq aborted the daemon.

    The daemon may keep fewer than 700 connections to a socket open, so it has to close some of the smaller crowd, too.
    """
    with crowd(getattr(running.endpoints, name), n) as sockets:
        assert len(sockets) > 2 * n / 3
        with running.client() as client:
            assert client.status().state in STANDS
            assert client.stop().verb == "stop"
        end_s = time.monotonic() + 20
        while descriptors(running) > 400:
            assert time.monotonic() < end_s, f"{descriptors(running)} descriptors are open"
            time.sleep(0.1)


@pytest.mark.parametrize("name", few_and_long(["ctl"], ["cmd", "ctl"]))
def test_a_client_that_sends_whole_messages_is_never_cut_off(running, name):
    """However much they are together: 6 MB here, in messages that are answered."""
    context = zmq.Context()
    peer = context.socket(zmq.DEALER)
    peer.setsockopt(zmq.RCVTIMEO, 20_000)
    peer.connect(getattr(running.endpoints, name))
    monitor = peer.get_monitor_socket(zmq.EVENT_DISCONNECTED)
    try:
        for _ in range(150):
            peer.send(b'{"type": "status", "id": "' + b" " * 40_000 + b'"}')
            assert peer.recv()
        assert not monitor.poll(200)
        peer.disable_monitor()
        monitor.close(0)
    finally:
        context.destroy(linger=0)


def test_connections_that_never_shake_hands_end_by_themselves(running):
    with crowd(running.endpoints.cmd, 3) as sockets:
        for one in sockets:
            one.settimeout(15)
            while one.recv(100):
                pass


def test_peers_that_have_shaken_hands_with_ctl_keep_no_newcomer_out(running):
    """An e-stop comes from a client that connects when it is needed; whoever holds connections gives way."""
    with contextlib.ExitStack() as stack:
        for _ in range(80):
            with contextlib.suppress(OSError):
                stack.enter_context(RawPeer(running.endpoints.ctl, "DEALER"))
        with running.client() as client:
            assert client.stop().verb == "stop"


@pytest.mark.parametrize(
    ("running", "name", "kind"),
    few_and_long(
        [("mixed", "cmd", "DEALER")], [("ipc", "cmd", "DEALER"), ("tcp", "pub", "SUB"), ("tcp", "stream", "PUB")]
    ),
    indirect=["running"],
    scope="module",
)
def test_a_message_of_endlessly_many_parts_takes_no_memory(running, name, kind):
    """ZeroMQ keeps the parts of a message that has not ended, beside every bound: 1.6 GB in 7 s."""
    before = most = memory_bytes(running)
    with running.client() as client:
        shut = client.status().bus_info["connections_shut"]
    parts, end_s = frame(b"x", more=True) * 20_000, time.monotonic() + 60
    with RawPeer(getattr(running.endpoints, name), kind) as peer:
        while peer.send(parts):
            most = max(most, memory_bytes(running))
            assert time.monotonic() < end_s, f"it goes on and on: {most >> 20} MiB"
    with running.client() as client:
        status = client.status()
        assert status.state in STANDS and status.bus_info["connections_shut"] > shut
    assert most - before < MOST_GROWTH_BYTES, most


@pytest.mark.parametrize(
    ("running", "topic_bytes", "n_topics"),
    few_and_long([("mixed", 1000, 200)], [("tcp", 60, 200), ("tcp", 1, 1), ("ipc", 1000, 200)]),
    indirect=["running"],
    scope="module",
)
def test_a_flood_of_subscriptions_is_cut_off_and_others_are_served(running, topic_bytes, n_topics):
    """200 topics of 1 kB subscribed to and given up again as fast as it goes kept the daemon from an e-stop for 12 s."""
    context = zmq.Context()
    good = context.socket(zmq.SUB)
    good.connect(running.endpoints.pub)
    good.subscribe(b"v1/state")
    good.setsockopt(zmq.RCVTIMEO, 10_000)
    good.recv_multipart()
    topics = [f"{k:x}".rjust(topic_bytes, "v").encode() for k in range(n_topics)]
    flood = b"".join(frame(verb + topic) for topic in topics for verb in (b"\1", b"\0"))
    try:
        with running.client() as client:
            before = client.status().bus_info["connections_shut"]
            end_s = time.monotonic() + 1.0
            while time.monotonic() < end_s:
                with contextlib.suppress(OSError), RawPeer(running.endpoints.pub, "SUB") as peer:
                    while peer.send(flood) and time.monotonic() < end_s:
                        pass
            while good.poll(0):
                good.recv_multipart()
            for _ in range(20):  # a second of states goes on coming
                assert isinstance(wire.decode_event(good.recv_multipart()[1]).t_mono, float)
            assert client.stop().verb == "stop"
            while client.status().bus_info["connections_shut"] == before:
                assert time.monotonic() < end_s + 20, "who floods was not cut off"
    finally:
        context.destroy(linger=0)


def test_subscriptions_are_bounded_by_length_number_and_rate():
    topics = ("v1/state", "v1/event")
    s = Subscriptions(topics)
    assert s.take(b"\1v1/", 5, 0.0) == "" and s.owed == {b"v1/state", b"v1/event"}
    s.owed.clear()
    assert s.take(b"\0v1/state", 5, 0.0) == "" and s.take(b"\1other", 5, 0.0) == "" and not s.owed
    assert "65 bytes" in s.take(b"\1" + b"x" * (MOST_TOPIC_BYTES + 1), 5, 0.0)
    assert all(s.take(b"\1v1/state", 6, 0.0) == "" for _ in range(BURST)) and s.take(b"\1v1/state", 6, 0.0)
    assert s.take(b"\1v1/state", 6, 1.5 / RATE_HZ) == ""
    taken = [s.take(b"\1other", 7, 0.0) for _ in range(BURST)]
    assert taken.count("") == BURST // COST_OF_OTHERS
