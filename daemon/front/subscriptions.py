"""Subscriptions of `pub`: each is sent the last value of its topic, and who subscribes more than anybody needs is cut off."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterable

from daemon.front.rate_limits import Rates
from daemon.network.connections import ConnectionGuard
from daemon.network.inbox import Inbox

RECEIVE_QUEUE = 4
"""Subscriptions that ZeroMQ reads ahead of each peer: before it does anything else it enters all that are there into its tree."""
MOST_BYTES = 2048
"""Bytes of a frame on `pub`: of a handshake with keys, which is longer than any topic."""
MOST_TOPIC_BYTES = 64
"""Length of a topic. ZeroMQ keeps a tree of all that are subscribed to, with a node for each byte."""
RATE_HZ, BURST = 20.0, 500
"""Subscriptions and their ends that one connection may send; a program that connects again sends all of its own at once."""
COST_OF_OTHERS = 8.0
"""Cost of a topic that is not published, where a published one costs 1."""
PAUSE_S = 0.01
"""Seconds between two looks; a last value is sent once for all who subscribe meanwhile."""
MOST_AT_A_LOOK, MOST_AT_ONCE = 2048, 32
"""Subscriptions that are taken at one look, and before the event loop has its turn."""


class Subscriptions:
    """What is subscribed to. Sans-I/O.

    Args:
        topics: what is published.

    Attributes:
        owed: topics that were subscribed to since their last value was sent.
    """

    def __init__(self, topics: Iterable[str]) -> None:
        self._topics = [topic.encode() for topic in topics]
        self._rates = Rates(RATE_HZ, BURST)
        self.owed: set[bytes] = set()

    def take(self, frame: bytes, connection: int, now_s: float) -> str:
        """Note a subscription (1 and a topic) or its end (0 and a topic); why its sender is to be cut off, else empty."""
        verb, topic = frame[:1], frame[1:]
        if len(topic) > MOST_TOPIC_BYTES:
            return f"a topic of {len(topic)} bytes; allowed: {MOST_TOPIC_BYTES}"
        wanted = {ours for ours in self._topics if ours.startswith(topic)}
        cost = 1.0 if wanted and verb in (b"\0", b"\1") else COST_OF_OTHERS
        if not self._rates.allows(b"%d" % connection, now_s, cost):
            return f"more than {BURST} at once, or {RATE_HZ:g} a second for long"
        if verb == b"\1":
            self.owed |= wanted
        return ""


class LastValues:
    """The last message of each topic, for those who subscribe later.

    Args:
        topics: what is published.
        inbox: of the XPUB socket.
        guard: of its connections.
        publish: sends a topic and its payload.
    """

    def __init__(
        self, topics: Iterable[str], inbox: Inbox, guard: ConnectionGuard, publish: Callable[[bytes, bytes], None]
    ) -> None:
        self._subscriptions = Subscriptions(topics)
        self._inbox, self._guard, self._publish = inbox, guard, publish
        self._values: dict[bytes, bytes] = {}

    def keep(self, topic: bytes, payload: bytes) -> None:
        """Note what is published."""
        self._values[topic] = payload

    async def serve(self) -> None:
        """Send the last value of each topic to whoever subscribes to it, for ever."""
        owed = self._subscriptions.owed
        while True:
            await self._take_subscriptions()
            for topic in owed & self._values.keys():
                self._publish(topic, self._values[topic])
            owed.clear()
            await asyncio.sleep(PAUSE_S)

    async def _take_subscriptions(self) -> None:
        """Wait for a subscription, and take all that are there by then."""
        message = await self._inbox.receive()
        for n in range(1, MOST_AT_A_LOOK):
            too_much = self._subscriptions.take(message.parts[0], message.fd, time.monotonic())
            if too_much:
                self._guard.shut_down(message.fd, "too many subscriptions", too_much)
            if n % MOST_AT_ONCE == 0:
                await asyncio.sleep(0)
            following = await self._inbox.waiting()
            if following is None:
                return
            message = following
