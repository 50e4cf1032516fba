"""Messages taken from a socket in portions: each arrives once and in order, also where a portion ends."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
import zmq
import zmq.asyncio

from daemon.network.connections import ConnectionGuard
from daemon.network.inbox import MOST_PARTS, Inbox


async def _taken(address: str, sent: list[list[bytes]], most: int) -> list[list[bytes]]:
    """The first parts of the messages of each portion of at most `most`, until all that were sent have come."""
    context = zmq.asyncio.Context()
    receiving = context.socket(zmq.PULL)
    receiving.setsockopt(zmq.RCVHWM, 0)
    receiving.bind(address)
    sending = zmq.Socket(context, zmq.PUSH)
    sending.setsockopt(zmq.SNDHWM, 0)
    sending.connect(address)
    try:
        inbox, portions = Inbox(receiving, ConnectionGuard({})), list[list[bytes]]()
        for parts in sent:
            sending.send_multipart(parts)
        while sum(map(len, portions)) < len(sent):
            portions.append([message.parts[0] async for message in inbox.arrived(most)])
        assert await inbox.waiting() is None
        return portions
    finally:
        sending.close(0)
        receiving.close(0)
        context.term()


@pytest.mark.parametrize("n", [1, 15, 16, 17, 33, 600])
def test_none_is_lost_where_a_portion_ends(tmp_path: Path, n: int) -> None:
    """The 257th of the waiting targets was lost, and the 2,048th of the waiting subscriptions."""
    sent = [[b"%d" % k] for k in range(n)]
    portions = asyncio.run(asyncio.wait_for(_taken(f"ipc://{tmp_path}/in", sent, 16), 20))
    assert [one for portion in portions for one in portion] == [parts[0] for parts in sent]
    assert all(1 <= len(portion) <= 16 for portion in portions)


def test_a_message_of_too_many_parts_takes_no_other_with_it(tmp_path: Path) -> None:
    sent = [[b"%d" % k, *([b"part"] * (k % 3) * MOST_PARTS)] for k in range(50)]
    portions = asyncio.run(asyncio.wait_for(_taken(f"ipc://{tmp_path}/in", sent, 7), 20))
    assert [one for portion in portions for one in portion] == [parts[0] for parts in sent]
