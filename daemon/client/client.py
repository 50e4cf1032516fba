"""A small client: `with Client() as robot: robot.say("wave with your right hand")`. Every call has a time-out."""

from __future__ import annotations

import math
import time
import uuid
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from typing import Literal, Unpack

import zmq

from daemon.client.compositions import (
    FIRST_REPLY_TIMEOUT_S,
    MOTION_TIMEOUT_S,
    REPLY_TIMEOUT_S,
    CompositionCalls,
    has_no_end,
    patience_s,
)
from daemon.client.controls import ControlCalls
from daemon.client.errors import CancelledByError, NoAnswerError, RefusedError, Said, unexpected
from daemon.client.streams import LeaseNews, Stream, begun, new_lease
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


class Client(ControlCalls, CompositionCalls[Said]):
    """Talks to one daemon. Not for several threads at once."""

    def say(
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
        """Move as the text says.

        Args:
            text: the command, in English.
            seed: seed of the motion; equal text, seed and seconds give equal motions.
            seconds: length of the motion; None lets the model choose.
            prefix_s: seconds of the running motion that the new one continues from, 0.2 to 1.6; 0 for none.
            context: whether the text may refer to what this client said last: "again", "slower", "with the other hand".
            wait: whether to return when the motion has ended; else once it is accepted, as one without end is ("keep waving").
            timeout_s: seconds to wait for the end at most; None takes a time that fits the request.
            command_id: id of the command; a repeated id is one command, an empty one is replaced by a new id.
            options: tempo, amplitude, mirror, repeat, loop, hold, when, at_s, deadline_s; see `daemon.wire.requests.Play`.

        Raises:
            RefusedError: the request is invalid, was rejected, or failed.
            CancelledByError: another command ended it; only with `wait`.
            NoAnswerError: not in time.
        """
        name = command_id or uuid.uuid4().hex
        request = Say(id=name, text=text, seed=seed, seconds=seconds, prefix_s=prefix_s, context=context, **options)
        return self.play(request, wait=wait, timeout_s=timeout_s)

    def gesture(
        self,
        name: str,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
        command_id: str = "",
        **options: Unpack[PlayOptions],
    ) -> Said:
        """Play a clip of the library; options as for `say`.

        Raises:
            RefusedError, CancelledByError, NoAnswerError: as for `say`.
        """
        request = Gesture(id=command_id or uuid.uuid4().hex, name=name, **options)
        return self.play(request, wait=wait, timeout_s=timeout_s)

    def play(self, request: Play, *, wait: bool = True, timeout_s: float | None = None) -> Said:
        """Send a request that plays something; return when it has ended; without `wait`, or without an end, once it is accepted.

        Raises:
            RefusedError, CancelledByError, NoAnswerError: as for `say`.
        """
        heard: list[AnyEvent] = []
        for event in self.events_of(request, timeout_s):
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

    def events_of(self, request: Play, timeout_s: float | None = None) -> Iterator[AnyEvent]:
        """Send a request and yield its events as they come, the last one terminal.

        Raises:
            NoAnswerError: not in time.
        """
        socket = self._cmd_socket()
        self._send(socket, request, self.endpoints.cmd)
        began_s, asked = time.monotonic(), f"{tag_of(request)} {request.words[:60]!r}"
        waits_for_the_end = timeout_s is None
        timeout_s = patience_s(request) if timeout_s is None else timeout_s
        limit_s = min(timeout_s, FIRST_REPLY_TIMEOUT_S)
        while True:
            event = self._receive(socket, began_s, limit_s, self.endpoints.cmd, asked)
            if event.id not in (request.id, ""):
                continue
            if waits_for_the_end and has_no_end(event, request):
                timeout_s = math.inf
            limit_s = timeout_s
            yield event
            if event.terminal:
                return

    def cancel(self, command_id: str = "") -> Ack:
        """End a command, any when the id is empty; the robot brakes and holds.

        Raises:
            RefusedError: no such command runs.
            NoAnswerError: not in time.
        """
        return self._command(Cancel(id=uuid.uuid4().hex, command=command_id))

    def look(self, yaw_deg: float | None = None, pitch_deg: float | None = None) -> Ack:
        """Turn the head left and down during any motion; without angles the head is free again.

        Raises:
            NoAnswerError: not in time.
        """
        return self._command(Look(id=uuid.uuid4().hex, yaw_deg=yaw_deg, pitch_deg=pitch_deg))

    def idle(self, on: bool = True, style: Literal["calm", "lively"] = "calm") -> Ack:
        """Switch the small movements while nothing is played on or off.

        Raises:
            NoAnswerError: not in time.
        """
        return self._command(Idle(id=uuid.uuid4().hex, on=on, style=style))

    @contextmanager
    def stream(
        self, holder: str = "", *, silence_s: float | None = None, timeout_s: float = MOTION_TIMEOUT_S
    ) -> Generator[Stream]:
        """A lease on the robot's joints, once it has begun: `with robot.stream() as s: s.send(q_rad)`, again and again.

        Args:
            holder: name of the requesting program in a word or two; the refusal of a second program's request repeats it.
            silence_s: seconds without a target after which the robot brakes and holds; None takes the daemon's setting.
            timeout_s: seconds to wait at most for the lease to begin (the robot may have to be armed) and to end.

        Raises:
            RefusedError: another program holds a lease, the robot's state forbids it, or the lease has failed.
            CancelledByError: a stop or another command ended it.
            NoAnswerError: not in time.
        """
        request = new_lease(holder, silence_s)
        news, cmd = LeaseNews(request), self._connect(self.endpoints.cmd)
        socket = self._context.socket(zmq.PUB)
        try:
            self._secure(socket, self.endpoints.stream)
            socket.connect(self.endpoints.stream)
            self._send(cmd, request, self.endpoints.cmd)
            stream = Stream(news, socket, cmd)
            stream.until(begun, timeout_s, self.endpoints.cmd)
            try:
                yield stream
            except BaseException:
                self._send(cmd, Cancel(id=uuid.uuid4().hex, command=request.id), self.endpoints.cmd)
                raise
            if news.end is None:
                self._send(cmd, Release(id=uuid.uuid4().hex, lease=request.id), self.endpoints.cmd)
            stream.until(lambda event: event.terminal, timeout_s, self.endpoints.cmd)
        finally:
            socket.close(0)
            cmd.close(200)

    def record(self, name: str, command_id: str = "", *, replace: bool = False) -> Ack:
        """Keep the motion of a command, the newest when no id is given, as a gesture.

        Raises:
            RefusedError: the command is unknown, its motion cannot be kept, or the name is taken and `replace` is not given.
            NoAnswerError: not in time.
        """
        return self._command(Record(id=uuid.uuid4().hex, name=name, command=command_id, replace=replace))

    def capabilities(self) -> CapabilitiesEvent:
        """The abilities of this robot and this daemon.

        Raises:
            NoAnswerError: not in time.
        """
        event = self._ask(Capabilities(id=uuid.uuid4().hex), self._cmd_socket(), self.endpoints.cmd)
        if not isinstance(event, CapabilitiesEvent):
            raise unexpected(event, "capabilities")
        return event

    def watch(self, *topics: str, timeout_s: float = REPLY_TIMEOUT_S) -> Iterator[tuple[str, AnyEvent]]:
        """Yield (topic, event) of `v1/state`, `v1/health`, `v1/event` and `v1/log` (all when none is named), without end.

        Raises:
            NoAnswerError: nothing was published for `timeout_s`.
        """
        socket = self._context.socket(zmq.SUB)
        try:
            for topic in topics or ("v1/",):
                socket.setsockopt(zmq.SUBSCRIBE, topic.encode())
            self._secure(socket, self.endpoints.pub)
            socket.connect(self.endpoints.pub)
            last: dict[bytes, bytes] = {}
            while True:
                if not socket.poll(int(1000 * timeout_s)):
                    raise NoAnswerError(self.endpoints.pub, f"watch {' '.join(topics) or 'v1/'}", timeout_s)
                topic, payload = socket.recv_multipart()
                if last.get(topic) == payload:  # sent again for a new subscriber
                    continue
                last[topic] = payload
                yield topic.decode(), decode_event(payload)
        finally:
            socket.close(0)
