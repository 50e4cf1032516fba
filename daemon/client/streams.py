"""Sending joint targets: `with robot.stream() as stream: stream.send(q_rad)`, for both clients.

The targets go out through a PUB socket of their own; the lease and its events through `cmd`. A context that ends well
releases the lease; one that ends in an exception cancels it.
"""

from __future__ import annotations

import asyncio
import secrets
import time
import uuid
from collections.abc import Callable, Mapping, Sequence

import zmq
import zmq.asyncio

from daemon.client.errors import CancelledByError, NoAnswerError, RefusedError
from daemon.wire.codec import decode_event, encode
from daemon.wire.events import AnyEvent, Cancelled, Progress, Refusal
from daemon.wire.requests import Lease, Target

Angles = Sequence[float] | Mapping[str, float]
"""Angles in radians: of every joint in the robot's order, or of some joints by name."""


class LeaseNews:
    """The events that a holder has received for its lease.

    Attributes:
        id: id of the lease.
        secret: secret of the lease, for programs that send targets by other means.
        events: all events so far.
        held_by: what keeps the robot from its target, as last reported: "self-collision", "silence", or "" for nothing.
    """

    def __init__(self, lease: Lease) -> None:
        self.id, self.secret = lease.id, lease.secret
        self.events: list[AnyEvent] = []
        self.held_by = ""
        self._sent = 0

    @property
    def end(self) -> AnyEvent | None:
        """The event that ended the lease, None while it lives."""
        return self.events[-1] if self.events and self.events[-1].terminal else None

    def take(self, event: AnyEvent) -> None:
        self.events.append(event)
        if isinstance(event, Progress):
            self.held_by = {"held": "self-collision", "silent": "silence", "streaming": ""}.get(
                event.stage, self.held_by
            )

    def check(self) -> None:
        """Raise an exception when the lease has ended otherwise than by `release`.

        Raises:
            RefusedError: the lease was rejected, or has failed.
            CancelledByError: a stop or another command ended the lease.
        """
        if isinstance(self.end, Refusal):
            raise RefusedError(self.end)
        if isinstance(self.end, Cancelled):
            raise CancelledByError(self.end.by)

    def frame(self, q_rad: Angles) -> bytes:
        """The bytes of a target message."""
        self._sent += 1
        angles = {k: float(v) for k, v in q_rad.items()} if isinstance(q_rad, Mapping) else [float(v) for v in q_rad]
        return encode(Target(id=self.id, secret=self.secret, q_rad=angles, seq=self._sent, t_mono=time.monotonic()))


def new_lease(holder: str, silence_s: float | None) -> Lease:
    """A request for a lease, with an id and a secret of its own."""
    return Lease(id=uuid.uuid4().hex, secret=secrets.token_urlsafe(32), holder=holder, silence_s=silence_s)


def begun(event: AnyEvent) -> bool:
    """Whether targets move the robot from this event on."""
    return isinstance(event, Progress) and event.stage == "leased"


class Stream:
    """A lease that has begun; `Client.stream` makes it. Not for several threads at once.

    Attributes:
        news: the events received for it.
    """

    def __init__(self, news: LeaseNews, targets: zmq.Socket[bytes], cmd: zmq.Socket[bytes]) -> None:
        self.news, self._targets, self._cmd = news, targets, cmd

    def send(self, q_rad: Angles) -> None:
        """Send a target to which the joints move: all joints in the robot's order, or some by name. Never waits.

        Raises:
            RefusedError: the lease has failed.
            CancelledByError: a stop or another command has ended it.
        """
        while self._cmd.poll(0):
            self._hear()
        self.news.check()
        self._targets.send(self.news.frame(q_rad), zmq.DONTWAIT)

    def until(self, wanted: Callable[[AnyEvent], bool], timeout_s: float, endpoint: str) -> None:
        """Wait for an event of the lease, or its end.

        Raises:
            RefusedError, CancelledByError: the lease has ended otherwise than by `release`.
            NoAnswerError: not in time.
        """
        end_s = time.monotonic() + timeout_s
        while self.news.end is None and not any(map(wanted, self.news.events)):
            if not self._cmd.poll(int(1000 * max(0.0, end_s - time.monotonic()))):
                raise NoAnswerError(endpoint, "lease", timeout_s)
            self._hear()
        self.news.check()

    def _hear(self) -> None:
        event = decode_event(self._cmd.recv())
        if event.id == self.news.id:
            self.news.take(event)
        elif isinstance(event, Refusal) and not event.id:
            raise RefusedError(event)


class AsyncStream:
    """A lease for asyncio, see `Stream`; `AsyncClient.stream` makes it.

    Attributes:
        news: the events received for it.
    """

    def __init__(self, news: LeaseNews, targets: zmq.asyncio.Socket, heard: asyncio.Queue[AnyEvent]) -> None:
        self.news, self._targets, self._heard = news, targets, heard

    async def send(self, q_rad: Angles) -> None:
        """Send a target; see `Stream.send`."""
        while not self._heard.empty():
            self.news.take(self._heard.get_nowait())
        self.news.check()
        await self._targets.send(self.news.frame(q_rad))

    async def until(self, wanted: Callable[[AnyEvent], bool], timeout_s: float, endpoint: str) -> None:
        """Wait for an event of the lease, or its end; see `Stream.until`."""
        try:
            async with asyncio.timeout(timeout_s):
                while self.news.end is None and not any(map(wanted, self.news.events)):
                    self.news.take(await self._heard.get())
        except TimeoutError:
            raise NoAnswerError(endpoint, "lease", timeout_s) from None
        self.news.check()
