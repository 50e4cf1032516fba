"""The client for asyncio: `async with AsyncClient() as robot: await robot.say("wave with your right hand")`.

The same requests, events and errors as `daemon.client.Client`; every call has a time-out, and several may be under way at once.
ZeroMQ connects again by itself when the daemon comes back; what could not be sent meanwhile is not sent then.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
import uuid
from collections.abc import AsyncGenerator, Coroutine
from types import TracebackType
from typing import Any, Literal, Self, Unpack

import zmq
import zmq.asyncio

from daemon.client.compositions import (
    FIRST_REPLY_TIMEOUT_S,
    MOTION_TIMEOUT_S,
    NOT_MOVING,
    REPLY_TIMEOUT_S,
    CompositionCalls,
    patience_s,
)
from daemon.client.errors import (
    ARMING_ENDS,
    CancelledByError,
    NoAnswerError,
    RefusedError,
    Said,
    unexpected,
    waited_in_vain,
)
from daemon.client.lines import Line, within
from daemon.client.streams import AsyncStream, LeaseNews, begun, new_lease
from daemon.network.keys import KeyFolder, connect_curve
from daemon.settings.config import Endpoints
from daemon.wire.codec import decode_event
from daemon.wire.events import Ack, AnyEvent, Done, Refusal
from daemon.wire.requests import (
    Arm,
    Cancel,
    Capabilities,
    Estop,
    Gesture,
    Idle,
    Look,
    Park,
    Play,
    PlayOptions,
    Record,
    Release,
    Request,
    Reset,
    Say,
    Status,
    Stop,
    Torque,
    tag_of,
)
from daemon.wire.status import CapabilitiesEvent, StateEvent


class AsyncClient(CompositionCalls[Coroutine[Any, Any, Said]]):
    """Talks to one daemon from one event loop.

    Args:
        endpoints: where the daemon is.
        timeout_s: longest wait for a reply.
    """

    def __init__(self, endpoints: Endpoints | None = None, timeout_s: float = REPLY_TIMEOUT_S) -> None:
        self.endpoints = endpoints or Endpoints()
        self._timeout_s = timeout_s
        self._context = zmq.asyncio.Context()
        self._lines: dict[str, Line] = {}

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the sockets; what was not sent yet has 200 ms."""
        for line in self._lines.values():
            await line.close()
        self._context.destroy(linger=200)

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
        """Send a request that plays something; return when it has ended, or without `wait` once it is accepted.

        Raises:
            RefusedError: rejected, failed, or no valid request.
            CancelledByError: ended by another command, with `wait`.
            NoAnswerError: not in time.
        """
        heard: list[AnyEvent] = []
        async with contextlib.aclosing(self.events_of(request, timeout_s)) as events:
            async for event in events:
                heard.append(event)
                if isinstance(event, Refusal):
                    raise RefusedError(event)
                if not wait:
                    break
        last = heard[-1]
        if wait and not isinstance(last, Done | Ack):  # an `ack` answers a text that means to stop
            raise CancelledByError(str(getattr(last, "by", "the daemon")))
        return Said(request.id, tuple(heard))

    async def events_of(self, request: Play, timeout_s: float | None = None) -> AsyncGenerator[AnyEvent]:
        """Send a request and yield its events as they come, the last one terminal.

        Raises:
            NoAnswerError: not in time.
        """
        line, asked = self._line(self.endpoints.cmd), f"{tag_of(request)} {request.words[:60]!r}"
        timeout_s = patience_s(request) if timeout_s is None else timeout_s
        end_s, limit_s = time.monotonic() + timeout_s, min(timeout_s, FIRST_REPLY_TIMEOUT_S)
        async with line.asked(request, limit_s) as heard:
            while True:
                event = await within(heard, limit_s, line.endpoint, asked)
                yield event
                if event.terminal:
                    return
                limit_s = max(0.0, end_s - time.monotonic())

    async def cancel(self, command_id: str = "") -> Ack:
        """End a command, all when the id is empty; the robot brakes and holds."""
        return await self._acknowledged(Cancel(id=uuid.uuid4().hex, command=command_id), self.endpoints.cmd)

    async def look(self, yaw_deg: float | None = None, pitch_deg: float | None = None) -> Ack:
        """Turn the head left and down, whatever the body does; without angles it is let go again."""
        request = Look(id=uuid.uuid4().hex, yaw_deg=yaw_deg, pitch_deg=pitch_deg)
        return await self._acknowledged(request, self.endpoints.cmd)

    async def idle(self, on: bool = True, style: Literal["calm", "lively"] = "calm") -> Ack:
        """Small movements while there is nothing to play, or none."""
        return await self._acknowledged(Idle(id=uuid.uuid4().hex, on=on, style=style), self.endpoints.cmd)

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
        return await self._acknowledged(request, self.endpoints.cmd)

    async def capabilities(self) -> CapabilitiesEvent:
        """What this robot and this daemon can do."""
        event = await self._ask(Capabilities(id=uuid.uuid4().hex), self.endpoints.cmd)
        if not isinstance(event, CapabilitiesEvent):
            raise unexpected(event, "capabilities")
        return event

    async def stop(self, *, wait: bool = True) -> Ack:
        """Brake within the limits and hold; with `wait`, return once nothing is played any more."""
        ack = await self._acknowledged(Stop(id=uuid.uuid4().hex), self.endpoints.ctl)
        if wait:
            await self.wait_for(*NOT_MOVING, timeout_s=self._timeout_s)
        return ack

    async def estop(self, *, wait: bool = True) -> Ack:
        """Cut torque at once (or hold, as the daemon is set), latched; with `wait`, return once it is confirmed."""
        ack = await self._acknowledged(Estop(id=uuid.uuid4().hex), self.endpoints.ctl)
        if wait:
            await self.wait_for("estop", "fault", timeout_s=self._timeout_s)
        return ack

    async def reset(self, *, wait: bool = True) -> Ack:
        """Leave e-stop or fault; the robot is limp and must be armed."""
        ack = await self._acknowledged(Reset(id=uuid.uuid4().hex), self.endpoints.ctl)
        if wait and ack.state in ("fault", "estop"):
            await self.wait_for("limp", "fault", timeout_s=self._timeout_s)
        return ack

    async def arm(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Torque on over a pinned goal, slow move to the rest pose; limp again where that was broken off (`status` tells)."""
        ack = await self._acknowledged(Arm(id=uuid.uuid4().hex), self.endpoints.ctl)
        if wait:
            began_s = time.monotonic()
            if (await self.wait_for("arming", *ARMING_ENDS, timeout_s=timeout_s)).state == "arming":
                left_s = timeout_s - (time.monotonic() - began_s)
                await self.wait_for("limp", *ARMING_ENDS, timeout_s=left_s)
        return ack

    async def torque_off(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Brake within the limits, then limp where the robot stands; it moves again only after `arm`."""
        ack = await self._acknowledged(Torque(id=uuid.uuid4().hex, on=False), self.endpoints.ctl)
        if wait:
            await self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    async def park(self, *, wait: bool = True, timeout_s: float = 30.0) -> Ack:
        """Slow move to the park pose, then torque off."""
        ack = await self._acknowledged(Park(id=uuid.uuid4().hex), self.endpoints.ctl)
        if wait:
            await self.wait_for("limp", "fault", "estop", timeout_s=timeout_s)
        return ack

    async def status(self) -> StateEvent:
        """The robot and the daemon now, by way of `ctl`."""
        event = await self._ask(Status(id=uuid.uuid4().hex), self.endpoints.ctl)
        if not isinstance(event, StateEvent):
            raise unexpected(event, "status")
        return event

    async def wait_for(self, *states: str, timeout_s: float) -> StateEvent:
        """Poll until the robot is in one of `states`.

        Raises:
            NoAnswerError: not in time.
        """
        end_s = time.monotonic() + timeout_s
        while True:
            status = await self.status()
            if status.state in states:
                return status
            if time.monotonic() > end_s:
                raise waited_in_vain(self.endpoints.ctl, states, status, timeout_s)
            await asyncio.sleep(0.05)

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
                if last.get(topic) == payload:  # sent again, for somebody who has just subscribed
                    continue
                last[topic] = payload
                yield topic.decode(), decode_event(payload)
        finally:
            socket.close(0)

    async def _acknowledged(self, request: Request, endpoint: str) -> Ack:
        event = await self._ask(request, endpoint)
        if not isinstance(event, Ack):
            raise unexpected(event, tag_of(request))
        return event

    async def _ask(self, request: Request, endpoint: str) -> AnyEvent:
        async with self._line(endpoint).asked(request, self._timeout_s) as heard:
            return await within(heard, self._timeout_s, endpoint, tag_of(request))

    def _line(self, endpoint: str) -> Line:
        if endpoint not in self._lines:
            socket = self._context.socket(zmq.DEALER)
            socket.setsockopt(zmq.IMMEDIATE, 1)
            self._secure(socket, endpoint)
            socket.connect(endpoint)
            self._lines[endpoint] = Line(socket, endpoint)
        return self._lines[endpoint]

    def _secure(self, socket: zmq.asyncio.Socket, endpoint: str) -> None:
        if self.endpoints.keys is not None and endpoint.startswith("tcp://"):
            connect_curve(socket, KeyFolder(self.endpoints.keys), "daemon")
