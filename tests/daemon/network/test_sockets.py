"""Peers that never read lose what is theirs: it is counted, and nobody else loses anything."""

from __future__ import annotations

import asyncio
import contextlib

import pytest
import zmq
import zmq.asyncio

from daemon.network.sockets import publish_now, send_now
from daemon.recording.feed import RecorderFeed

pytestmark = [pytest.mark.timeout(30), pytest.mark.realtime]
N, HWM = 3000, 500
KEPT = 2 * HWM
"""Over inproc the queues of both ends are one."""


@contextlib.contextmanager
def bound(kind: int, *options: int):
    """(context, a bound socket), both of asyncio."""
    context = zmq.asyncio.Context()
    socket = context.socket(kind)
    for option in options:
        socket.setsockopt(option, 1)
    socket.setsockopt(zmq.SNDHWM, HWM)
    socket.bind("inproc://here")
    try:
        yield context, socket
    finally:
        context.destroy(linger=0)


def peer(context: zmq.asyncio.Context, kind: int) -> zmq.asyncio.Socket:
    socket = context.socket(kind)
    socket.setsockopt(zmq.RCVHWM, HWM)
    socket.connect("inproc://here")
    return socket


def test_a_subscriber_that_never_reads_is_counted_at_no_cost_to_others():
    async def main() -> None:
        with bound(zmq.XPUB, zmq.XPUB_NODROP, zmq.XPUB_VERBOSE) as (context, pub):
            deaf, reads, elsewhere = (peer(context, zmq.SUB) for _ in range(3))
            for socket, topic in ((deaf, b"a"), (reads, b"a"), (elsewhere, b"b")):
                socket.subscribe(topic)
                await pub.recv()
            overruns = 0
            for n in range(N):
                overruns += not publish_now(pub, [b"a", str(n).encode()])
                assert await reads.recv_multipart() == [b"a", str(n).encode()]
            assert overruns == 1
            assert publish_now(pub, [b"b", b"for another"])  # the full queue is not one of its subscribers
            assert await elsewhere.recv_multipart() == [b"b", b"for another"]
            kept = [(await deaf.recv_multipart())[1] for _ in range(KEPT)]
            assert kept == [str(n).encode() for n in range(KEPT)]
            assert publish_now(pub, [b"a", b"again"])
            assert await deaf.recv_multipart() == [b"a", b"again"]  # once it reads it is served again

    asyncio.run(main())


def test_a_peer_that_reads_no_replies_is_counted_but_not_one_that_left():
    async def main() -> None:
        with bound(zmq.ROUTER, zmq.ROUTER_MANDATORY) as (context, cmd):
            deaf, reads = peer(context, zmq.DEALER), peer(context, zmq.DEALER)
            await deaf.send(b"hello")
            deaf_id, _ = await cmd.recv_multipart()
            await reads.send(b"hello")
            reads_id, _ = await cmd.recv_multipart()
            lost = 0
            for n in range(N):
                lost += not send_now(cmd, [deaf_id, str(n).encode()])
                assert send_now(cmd, [reads_id, str(n).encode()])
                assert await reads.recv() == str(n).encode()
            assert lost == N - KEPT
            assert send_now(cmd, [b"never seen", b"x"])

    asyncio.run(main())


def test_the_end_of_recording_does_not_hold_up_the_event_loop(tmp_path):
    """A recorder that died leaves messages behind; waiting for them in the loop cost the bus process its heartbeat."""

    async def main() -> None:
        feed = RecorderFeed(f"ipc://{tmp_path}/nobody")
        feed("topic", b"never read")
        closing = asyncio.create_task(feed.close())
        for _ in range(10):
            await asyncio.sleep(0)
        assert not closing.done(), "the loop goes on while what is left has its time"
        feed("topic", b"after the end")
        await closing
        await feed.close()

    asyncio.run(main())
