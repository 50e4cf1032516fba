"""Subscriptions of `pub`: each subscriber gets the last value of its topic; one that sends too many subscriptions is cut off."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterable

from daemon.front.rate_limits import Rates
from daemon.network.connections import ConnectionGuard
from daemon.network.inbox import Inbox

RECEIVE_QUEUE = 4
"""Number of subscriptions that ZeroMQ reads ahead for each peer; it enters all of them into its tree before anything else."""
MOST_BYTES = 2048
"""Bytes of a frame on `pub` at most: of a handshake with keys, which is longer than any topic."""
MOST_TOPIC_BYTES = 64
"""Bytes of a topic at most. ZeroMQ keeps a tree of all subscribed topics, with a node for each byte."""
RATE_HZ, BURST = 20.0, 500
"""Subscriptions and unsubscriptions a second, and at once, that a connection may send; a program that connects again sends all of
its own at once."""
COST_OF_OTHERS = 8.0
"""Cost of a subscription to a topic that is not published; one to a published topic costs 1."""
PAUSE_S = 0.01
"""Seconds between two readings; a last value is sent once for all who subscribed meanwhile."""
MOST_AT_A_LOOK, MOST_AT_ONCE = 2048, 32
"""Number of subscriptions taken in one reading, and number taken before the event loop continues with other tasks."""


class Subscriptions:
    """Knows which topics are subscribed to. No I/O.

    Args:
        topics: the published topics.

    Attributes:
        owed: topics that were subscribed to since their last value was sent.
    """

    def __init__(self, topics: Iterable[str]) -> None:
        self._topics = [topic.encode() for topic in topics]
        self._rates = Rates(RATE_HZ, BURST)
        self.owed: set[bytes] = set()

    def take(self, frame: bytes, connection: int, now_s: float) -> str:
        """Note a subscription (byte 1 and a topic) or its end (byte 0 and a topic).

        Returns:
            The reason to cut its sender off; empty when there is none.
        """
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
        topics: the published topics.
        inbox: inbox of the XPUB socket.
        guard: guard of its connections.
        publish: sends a topic and its payload.
    """

    def __init__(
        self, topics: Iterable[str], inbox: Inbox, guard: ConnectionGuard, publish: Callable[[bytes, bytes], None]
    ) -> None:
        self._subscriptions = Subscriptions(topics)
        self._inbox, self._guard, self._publish = inbox, guard, publish
        self._values: dict[bytes, bytes] = {}

    def keep(self, topic: bytes, payload: bytes) -> None:
        """Keep the last payload of a topic."""
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
        """Wait for a subscription, and take all that have arrived by then."""
        n = 0
        async for message in self._inbox.arrived(MOST_AT_A_LOOK):
            n += 1
            too_much = self._subscriptions.take(message.parts[0], message.fd, time.monotonic())
            if too_much:
                self._guard.shut_down(message.fd, "too many subscriptions", too_much)
            if n % MOST_AT_ONCE == 0:
                await asyncio.sleep(0)
