"""The queue from the front to the recorder: bounded, so that it never keeps the front waiting."""

from __future__ import annotations

import asyncio
import logging
import time

import msgspec
import zmq

from daemon.recording.schemas import DROPPED_TOPIC, Dropped

log = logging.getLogger(__name__)

RECORDER_QUEUE = 2000
LINGER_MS = 500
TELL_EVERY_S = 1.0


class RecorderFeed:
    """Hands requests and events to the recorder's bounded queue; messages that do not fit are dropped and counted.

    Losses are reported in the daemon's log, once a second at most, and in the recorder's file as soon as there is room again.

    Attributes:
        dropped: number of messages that did not fit so far.
    """

    def __init__(self, endpoint: str, queue: int = RECORDER_QUEUE) -> None:
        self.endpoint, self.dropped, self._open = endpoint, 0, True
        self._recorded = 0
        self._told_s = float("-inf")
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.PUSH)
        self._socket.setsockopt(zmq.SNDHWM, queue)
        self._socket.connect(endpoint)

    def __call__(self, topic: str, payload: bytes) -> None:
        """Hand over one message, or count it as dropped."""
        if not self._open:
            return
        if self.dropped > self._recorded and self._sent(DROPPED_TOPIC, msgspec.json.encode(Dropped(self.dropped))):
            self._recorded = self.dropped
        if self._sent(topic, payload):
            return
        self.dropped += 1
        if time.monotonic() - self._told_s > TELL_EVERY_S:
            self._told_s = time.monotonic()
            log.warning("%d messages dropped: the recorder is too slow", self.dropped)

    async def close(self) -> None:
        """Stop handing over; unsent messages have half a second, during which the event loop runs on."""
        if self._open:
            self._open = False
            self._socket.close(LINGER_MS)
            await asyncio.to_thread(self._context.term)

    def _sent(self, topic: str, payload: bytes) -> bool:
        try:
            self._socket.send_multipart([topic.encode(), payload], zmq.DONTWAIT)
        except zmq.Again:
            return False
        return True
