"""The client for asyncio: `async with AsyncClient() as robot: await robot.say("wave with your right hand")`.

Requests, events and errors are those of `daemon.client.Client`; every call has a time-out, and several may run at once.
ZeroMQ connects again by itself when the daemon comes back; a request that could not be sent meanwhile is not sent later.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
import uuid
from collections.abc import AsyncGenerator, Coroutine
from typing import Any, Literal, Unpack

import zmq

from daemon.client.async_controls import AsyncControlCalls
from daemon.client.compositions import (
    FIRST_REPLY_TIMEOUT_S,
    MOTION_TIMEOUT_S,
    REPLY_TIMEOUT_S,
    CompositionCalls,
    has_no_end,
    patience_s,
)
from daemon.client.errors import (
    CancelledByError,
    NoAnswerError,
    RefusedError,
    Said,
    unexpected,
)
from daemon.client.streams import AsyncStream, LeaseNews, begun, new_lease
from daemon.wire.codec import decode_event
from daemon.wire.events import Ack, AnyEvent, Done, Refusal
from daemon.wire.requests import (
    Cancel,
    Capabilities,
    Gesture,
    Idle,
    Look,
    Play,
    PlayOptions,
    Record,
    Release,
    Say,
    tag_of,
)
from daemon.wire.status import CapabilitiesEvent


class AsyncClient(AsyncControlCalls, CompositionCalls[Coroutine[Any, Any, Said]]):
    """Talks to one daemon from one event loop.

    Args:
        endpoints: the daemon's endpoints.
        timeout_s: seconds to wait for a reply at most.
    """

    async def say(
        self,
        text: str,
        *,
        seed: int = 0,
        seconds: float | None = None,
        prefix_s: float = 0.0,
        context: bool = True,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> Said:
        """Move as the text says; arguments and errors as for `daemon.client.Client.say`."""
        name = command_id or uuid.uuid4().hex
        request = Say(id=name, text=text, seed=seed, seconds=seconds, prefix_s=prefix_s, context=context, **options)
        return await self.play(request, wait=wait, timeout_s=timeout_s)

    async def gesture(
        self,
        name: str,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> Said:
        """Play a clip of the library."""
        request = Gesture(id=command_id or uuid.uuid4().hex, name=name, **options)
        return await self.play(request, wait=wait, timeout_s=timeout_s)

    async def play(self, request: Play, *, wait: bool = True, timeout_s: float | None = None) -> Said:
        """Send a request that plays something; return when it has ended; without `wait`, or without an end, once it is accepted.

        Raises:
            RefusedError: the request is invalid, was rejected, or failed.
            CancelledByError: another command ended it; only with `wait`.
            NoAnswerError: no answer in time.
        """
        heard: list[AnyEvent] = []
        async with contextlib.aclosing(self.events_of(request, timeout_s)) as events:
            async for event in events:
                heard.append(event)
                if isinstance(event, Refusal):
                    raise RefusedError(event)
                if not wait or has_no_end(event, request):
                    break
        last = heard[-1]
        is_over = isinstance(last, Done | Ack)  # an `ack` answers a text that means to stop
        if wait and not is_over and not has_no_end(last, request):
            raise CancelledByError(str(getattr(last, "by", "the daemon")))
        return Said(request.id, tuple(heard))

    async def events_of(self, request: Play, timeout_s: float | None = None) -> AsyncGenerator[AnyEvent]:
        """Send a request and yield its events as they come, the last one terminal.

        Raises:
            NoAnswerError: no answer in time.
        """
        line, asked = self._line(self.endpoints.cmd), f"{tag_of(request)} {request.words[:60]!r}"
        waits_for_the_end = timeout_s is None
        timeout_s = patience_s(request) if timeout_s is None else timeout_s
        end_s, limit_s = time.monotonic() + timeout_s, min(timeout_s, FIRST_REPLY_TIMEOUT_S)
        async with line.asked(request, limit_s) as heard:
            while True:
                event = await line.next_event(heard, limit_s, asked)
                yield event
                if event.terminal:
                    return
                if waits_for_the_end and has_no_end(event, request):
                    end_s = math.inf
                limit_s = max(0.0, end_s - time.monotonic())

    async def cancel(self, command_id: str = "") -> Ack:
        """End a command, all when the id is empty; the robot brakes and holds."""
        return await self._command(Cancel(id=uuid.uuid4().hex, command=command_id))

    async def look(self, yaw_deg: float | None = None, pitch_deg: float | None = None) -> Ack:
        """Turn the head left and down during any motion; without angles the head is free again."""
        request = Look(id=uuid.uuid4().hex, yaw_deg=yaw_deg, pitch_deg=pitch_deg)
        return await self._command(request)

    async def idle(self, on: bool = True, style: Literal["calm", "lively"] = "calm") -> Ack:
        """Switch the small movements while nothing is played on or off."""
        return await self._command(Idle(id=uuid.uuid4().hex, on=on, style=style))

    @contextlib.asynccontextmanager
    async def stream(
        self, holder: str = "", *, silence_s: float | None = None, timeout_s: float = MOTION_TIMEOUT_S
    ) -> AsyncGenerator[AsyncStream]:
        """A lease on the robot's joints, once it has begun; arguments and errors as for `daemon.client.Client.stream`."""
        request, cmd = new_lease(holder, silence_s), self.endpoints.cmd
        news, socket = LeaseNews(request), self._context.socket(zmq.PUB)
        try:
            self._secure(socket, self.endpoints.stream)
            socket.connect(self.endpoints.stream)
            async with self._line(cmd).asked(request, timeout_s) as heard:
                stream = AsyncStream(news, socket, heard)
                await stream.until(begun, timeout_s, cmd)
                try:
                    yield stream
                except BaseException:
                    await self._ask(Cancel(id=uuid.uuid4().hex, command=request.id), cmd)
                    raise
                if news.end is None:
                    await self._ask(Release(id=uuid.uuid4().hex, lease=request.id), cmd)
                await stream.until(lambda event: event.terminal, timeout_s, cmd)
        finally:
            socket.close(0)

    async def record(self, name: str, command_id: str = "", *, replace: bool = False) -> Ack:
        """Keep the motion of a command, the newest when no id is given, as a gesture; see `Client.record`."""
        request = Record(id=uuid.uuid4().hex, name=name, command=command_id, replace=replace)
        return await self._command(request)

    async def capabilities(self) -> CapabilitiesEvent:
        """The abilities of this robot and this daemon."""
        event = await self._ask(Capabilities(id=uuid.uuid4().hex), self.endpoints.cmd)
        if not isinstance(event, CapabilitiesEvent):
            raise unexpected(event, "capabilities")
        return event

    async def watch(self, *topics: str, timeout_s: float = REPLY_TIMEOUT_S) -> AsyncGenerator[tuple[str, AnyEvent]]:
        """Yield (topic, event) of `v1/state`, `v1/health`, `v1/event` and `v1/log` (all when none is named), without end.

        Raises:
            NoAnswerError: nothing was published for `timeout_s`.
        """
        socket = self._context.socket(zmq.SUB)
        try:
            self._secure(socket, self.endpoints.pub)
            for topic in topics or ("v1/",):
                socket.setsockopt(zmq.SUBSCRIBE, topic.encode())
            socket.connect(self.endpoints.pub)
            last: dict[bytes, bytes] = {}
            while True:
                try:
                    topic, payload = await asyncio.wait_for(socket.recv_multipart(), timeout_s)
                except TimeoutError:
                    asked = f"watch {' '.join(topics) or 'v1/'}"
                    raise NoAnswerError(self.endpoints.pub, asked, timeout_s) from None
                if last.get(topic) == payload:  # sent again for a new subscriber
                    continue
                last[topic] = payload
                yield topic.decode(), decode_event(payload)
        finally:
            socket.close(0)
