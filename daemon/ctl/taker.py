"""Takes the requests on `ctl`: a stop or an e-stop goes to the bus process at once, the rest to the front. Waits for neither.

An e-stop goes before all requests that were read already, and voids every reset, arm, park or torque among them. Its reply says
whether a bus cycle has carried it out; if none has yet, `carried_out` follows when one has.
"""

from __future__ import annotations

import itertools
import logging
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

import zmq

from daemon.ctl.channel import FRONT_ANSWERS_S, Answered, Channel, Handed, Told
from daemon.network.connections import ConnectionGuard, connection_of
from daemon.network.inbox import MOST_DISCARDED, MOST_PARTS
from daemon.shared_memory.bus_link import BusLink
from daemon.shared_memory.request_words import Asked, BusRequest
from daemon.state.ledger import Route, split_route
from daemon.state.machine import RobotState
from daemon.wire.codec import WireError, decode_ctl, encode, error_event, only_frame
from daemon.wire.event_base import Event
from daemon.wire.events import Ack, CarriedOut, Rejected
from daemon.wire.requests import Arm, CtlRequest, Estop, Park, Reset, Status, Stop, Torque, tag_of

log = logging.getLogger(__name__)

BEAT_MS = 10
"""Milliseconds to wait for a request at most: then the process beats again."""
LOOK_MS = 1
"""Milliseconds to wait for a request at most while a reply waits for the bus process or the front."""
HALT_REPLY_S = 0.05
"""Seconds that the reply to a stop or an e-stop waits at most for the bus cycle that takes it, and for earlier texts to end."""
STATUS_PATIENCE_S = 30.0
"""Seconds that the reply to a `status` waits at most; the front may be late: the daemon starts, or its machine was held up."""
AT_ONCE = 16
"""Requests that a turn reads before it serves them, to find an e-stop among them; more wait in their senders' sockets. An
e-stop that arrives during a turn waits for its end."""
PAUSE_S = 0.001
"""Seconds of pause after a turn that has read `AT_ONCE` requests: this process goes before all others but the bus process, and
under a flood of requests it would leave the processor to nobody, not even to the client that sends the e-stop."""
MOST_OPEN = 4096
"""Number of replies that may be due, and of messages to the front that may wait; beyond it the oldest are given up."""


_STATES = [state.value for state in RobotState]


@dataclass(eq=False)
class _Waiting:
    """A request that was read and not yet served; one that an e-stop has `overtaken` may not be carried out any more."""

    route: Route
    request: CtlRequest | WireError
    frame: bytes = b""
    overtaken: bool = False


@dataclass(eq=False)
class _Due:
    """A request whose reply is due.

    Attributes:
        route: address of the reply.
        request: the request.
        until_s: time by which it is answered at the latest, seconds.
        asked: the request to the bus process, for a stop or an e-stop; else None.
        state: the robot's state before the request.
        ended: whether the front has ended the commands before the request.
    """

    route: Route
    request: CtlRequest
    until_s: float
    asked: Asked | None = None
    state: str = ""
    ended: bool = False
    began_s: float = field(default_factory=time.monotonic)


class Taker:
    """Serves one ROUTER socket; call `turn` again and again.

    Args:
        socket: the socket of `ctl`.
        link: shared memory with the bus process.
        channel: channel to the front.
        guard: guard of the socket's connections.
        now_s: monotonic clock, seconds.
    """

    def __init__(
        self,
        socket: zmq.Socket[bytes],
        link: BusLink,
        channel: Channel,
        guard: ConnectionGuard,
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self._socket, self._link, self._channel, self._guard, self._now_s = socket, link, channel, guard, now_s
        self._poller = zmq.Poller()
        self._poller.register(socket, zmq.POLLIN)
        self._poller.register(channel.fileno(), zmq.POLLIN)
        self._queue: deque[_Waiting] = deque()
        self._due: dict[int, _Due] = {}
        self._owed: deque[_Due] = deque(maxlen=MOST_OPEN)
        self._to_front: deque[Handed | Told] = deque(maxlen=MOST_OPEN)
        self._seq = itertools.count(1)

    def turn(self) -> None:
        """Read the waiting requests, serve them, and send the replies that are due; waits `BEAT_MS` at most."""
        self._link.ctl_beats()
        self._wait(LOOK_MS if self._due or self._owed else BEAT_MS)
        is_flooded = self._read()
        self._hear_front()
        self._serve_what_was_read()
        self._answer_what_is_due()
        self._tell_front()
        if is_flooded:
            time.sleep(PAUSE_S)

    def _wait(self, wait_ms: int) -> None:
        events = dict(self._poller.poll(wait_ms))
        if self._channel.closed and self._channel.fileno() in events:  # readable for ever
            self._poller.unregister(self._channel.fileno())

    # Requests.

    def _read(self) -> bool:
        """Read the waiting requests; returns whether there may be more. An e-stop overtakes all that were read already."""
        for _ in range(AT_ONCE):
            if (parts := self._message()) is None:
                return False
            self._link.ctl_beats()
            route, payload = split_route(parts)
            waiting = _decoded(route, payload)
            if not isinstance(waiting.request, Estop):
                self._queue.append(waiting)
                continue
            for earlier in self._queue:
                earlier.overtaken = True
            self._queue.appendleft(waiting)
            return False  # the rest of a flood is read after the e-stop is served
        return True

    def _message(self) -> list[bytes] | None:
        """The frames of the next message; None without one. Frames beyond `MOST_PARTS` are discarded; the sender may be cut off."""
        try:
            frame = self._socket.recv(zmq.DONTWAIT, copy=False)
        except zmq.Again:
            return None
        connection, parts, n_parts = connection_of(frame), [frame.bytes], 1
        while frame.more:
            self._link.ctl_beats()
            frame, n_parts = self._socket.recv(zmq.DONTWAIT, copy=False), n_parts + 1  # its parts come together
            if n_parts <= MOST_PARTS:
                parts.append(frame.bytes)
            elif n_parts == MOST_DISCARDED:
                self._guard.shut_down(connection, "a message of too many parts", f"more than {MOST_DISCARDED}")
        self._guard.received(connection)
        return parts

    def _serve_what_was_read(self) -> None:
        while self._queue:
            self._link.ctl_beats()
            waiting = self._queue.popleft()
            try:
                self._serve(waiting)
            except Exception as error:  # the process that can stop the robot must outlive every bug
                log.exception("a ctl request failed")
                event = Rejected(code="internal", asked="ctl", found=str(error), allowed="", do="see the daemon's log")
                self._reply(waiting.route, event)
            self._tell_front()

    def _serve(self, waiting: _Waiting) -> None:
        request = waiting.request
        if isinstance(request, WireError):
            self._reply(waiting.route, error_event(request))
        elif waiting.overtaken and isinstance(request, Reset | Arm | Park | Torque):
            self._reply(waiting.route, _overtaken(request))
        elif isinstance(request, Stop | Estop):
            self._halt(waiting, request)
        else:
            self._hand_over(waiting, request)

    def _halt(self, waiting: _Waiting, request: Stop | Estop) -> None:
        """Send a stop or an e-stop to the bus process before anything else."""
        number, state = self._link.new_number(), _STATES[self._link.robot_state]
        kind = BusRequest.STOP if isinstance(request, Stop) else self._link.estop_kind
        asked = self._link.request(kind, number=number)
        log.info("%s in %s", tag_of(request), state)
        self._due[number] = _Due(waiting.route, request, self._now_s() + HALT_REPLY_S, asked, state)
        self._to_front.appendleft(Handed(number, waiting.frame))

    def _hand_over(self, waiting: _Waiting, request: CtlRequest) -> None:
        number = self._link.new_number()
        if len(self._due) >= MOST_OPEN:
            self._reply(waiting.route, _front_silent(request))
            return
        patience_s = STATUS_PATIENCE_S if isinstance(request, Status) else FRONT_ANSWERS_S
        self._due[number] = _Due(waiting.route, request, self._now_s() + patience_s)
        self._to_front.append(Handed(number, waiting.frame))

    # Replies.

    def _answer_what_is_due(self) -> None:
        now_s = self._now_s()
        for number, due in list(self._due.items()):
            if due.asked is None:
                if now_s >= due.until_s:
                    del self._due[number]
                    self._reply(due.route, _front_silent(due.request))
                continue
            done = self._link.carried_out(due.asked)
            if (done and (due.ended or self._channel.closed)) or now_s >= due.until_s:
                del self._due[number]
                self._reply(
                    due.route, Ack(id=due.request.id, verb=tag_of(due.request), state=due.state, carried_out=done)
                )
                if not done:
                    log.warning("%s is not carried out yet: no bus cycle has taken it", tag_of(due.request))
                    self._owed.append(due)
        for due in list(self._owed):
            if due.asked is not None and self._link.carried_out(due.asked):
                self._owed.remove(due)
                after_s = round(now_s - due.began_s, 3)
                log.warning("%s is carried out, %.3f s after it was asked", tag_of(due.request), after_s)
                event = CarriedOut(id=due.request.id, verb=tag_of(due.request), after_s=after_s)
                self._reply(None if due.route.once else due.route, event)

    def _reply(self, route: Route | None, event: Event) -> None:
        """Send an event of this process to `route`, if any, and hand it to the front, which publishes it."""
        event.seq, event.t_mono = next(self._seq), time.monotonic()
        payload = encode(event)
        if route is not None:
            self._send(route, payload)
        self._to_front.append(Told(payload))

    def _send(self, route: Route, payload: bytes) -> None:
        try:
            self._socket.send_multipart([*route.frames, payload], zmq.DONTWAIT)
        except zmq.ZMQError as error:
            log.warning("a ctl reply was lost: %s", error)

    # The front.

    def _hear_front(self) -> None:
        while not self._channel.closed:
            message = self._channel.receive()
            if message is None:
                return
            if not isinstance(message, Answered):
                continue
            due = self._due.get(message.number)
            if due is not None and due.asked is not None:
                due.ended = True
            elif due is not None:
                del self._due[message.number]
                self._send(due.route, message.event)

    def _tell_front(self) -> None:
        while self._to_front and not self._channel.closed and self._channel.send(self._to_front[0]):
            self._to_front.popleft()


def _decoded(route: Route, parts: list[bytes]) -> _Waiting:
    try:
        frame = only_frame(parts)
        return _Waiting(route, decode_ctl(frame), frame)
    except WireError as error:
        return _Waiting(route, error)


def _overtaken(request: CtlRequest) -> Rejected:
    """The event of a request that an e-stop voids: carried out afterwards, the request would undo the e-stop."""
    return Rejected(
        id=request.id, code="overtaken", asked=tag_of(request), found="an e-stop that came after it and was served first",
        allowed="reset, then arm", do="ask again once the e-stop is answered",
    )  # fmt: skip


def _front_silent(request: CtlRequest) -> Rejected:
    return Rejected(
        id=request.id, code="front_silent", asked=tag_of(request), found="the daemon's front does not answer",
        allowed="stop and estop, which need no front", do="not carried out: ask again, or start the daemon anew",
    )  # fmt: skip
