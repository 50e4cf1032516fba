"""The `ctl` socket in its own thread: stop and e-stop reach the bus process whatever the rest of the daemon does."""

from __future__ import annotations

import logging
import threading
from collections import deque
from dataclasses import dataclass
from typing import Protocol

import zmq

from daemon.driving.realtime import CONTROL_PRIORITY, take_fifo
from daemon.state.ledger import Route, split_route
from daemon.state.machine import CommandRefusedError
from daemon.state.replies import refusal
from daemon.wire.codec import WireError, decode_ctl, encode, error_event
from daemon.wire.event_base import Event
from daemon.wire.events import Ack, Rejected
from daemon.wire.requests import Arm, CtlRequest, Estop, Park, Reset, Status, Stop, Torque, tag_of

log = logging.getLogger(__name__)

POLL_MS = 100
MOST_READ = 4096
"""Requests that are read ahead of their turn, to find an e-stop among them; more wait in the sockets of their senders."""


class Controls(Protocol):
    """What the thread acts on; called from this thread. None waits long for anything, and none while a request waits."""

    def stop(self, request: Stop) -> str:
        """Brake within the limits and hold; returns the state before."""
        ...

    def estop(self, request: Estop) -> str:
        """Cut torque, or hold where the daemon is set so; returns the state before."""
        ...

    def reset(self) -> str:
        """Leave fault or e-stop; returns the state before."""
        ...

    def arm(self) -> str:
        """Torque on; returns the state before."""
        ...

    def park(self, request: Park) -> str:
        """Park; returns the state before."""
        ...

    def torque_off(self, request: Torque) -> str:
        """Brake within the limits, then torque off; returns the state before."""
        ...

    def status(self) -> Event:
        """The state event."""
        ...

    def sent(self, event: Event) -> Event:
        """Number an event that is being sent, and tell the subscribers of it."""
        ...


@dataclass(eq=False)
class _Waiting:
    """A request that was read and not yet served; `overtaken` by an e-stop it is not carried out any more."""

    route: Route
    request: CtlRequest | WireError
    overtaken: bool = False


class ControlThread:
    """Serves the `ctl` socket until closed."""

    def __init__(self, socket: zmq.Socket[bytes], controls: Controls) -> None:
        self._socket = socket
        self._controls = controls
        self._queue: deque[_Waiting] = deque()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="ctl", daemon=True)

    def start(self) -> None:
        """Begin to serve."""
        self._thread.start()

    def close(self) -> None:
        """End the thread and close its socket."""
        self._stopping.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=2.0)
        if self._thread.is_alive():
            log.error("the ctl thread did not end in 2 s")
        else:
            self._socket.close(0)

    def _run(self) -> None:
        if take_fifo(CONTROL_PRIORITY):
            log.info("the ctl thread has FIFO priority")
        while not self._stopping.is_set():
            if not self._queue and not self._socket.poll(POLL_MS):
                continue
            self._read()
            waiting = self._queue.popleft()
            try:
                event = self._answer(waiting)
            except Exception as error:  # the thread that can stop the robot must outlive every bug
                log.exception("a ctl request failed")
                event = Rejected(code="internal", asked="ctl", found=str(error), allowed="", do="see the daemon's log")
            reply = encode(self._controls.sent(event))
            try:
                self._socket.send_multipart([*waiting.route.frames, reply], zmq.DONTWAIT)
            except zmq.ZMQError as error:
                log.warning("a ctl reply was lost: %s", error)

    def _read(self) -> None:
        """Read what waits in the socket; an e-stop goes before all that was read already, and overtakes it."""
        while len(self._queue) < MOST_READ and self._socket.poll(0):
            route, parts = split_route(self._socket.recv_multipart())
            waiting = _Waiting(route, _decoded(parts))
            if not isinstance(waiting.request, Estop):
                self._queue.append(waiting)
                continue
            for earlier in self._queue:
                earlier.overtaken = True
            self._queue.appendleft(waiting)

    def _answer(self, waiting: _Waiting) -> Event:
        request = waiting.request
        if isinstance(request, WireError):
            return error_event(request)
        if waiting.overtaken and isinstance(request, Reset | Arm | Park | Torque):
            return _overtaken(request)
        try:
            return self._carry_out(request)
        except CommandRefusedError as error:
            return refusal(request.id, error)

    def _carry_out(self, request: CtlRequest) -> Event:
        match request:
            case Status():
                event = self._controls.status()
                event.id = request.id
                return event
            case Stop():
                state = self._controls.stop(request)
            case Estop():
                state = self._controls.estop(request)
            case Park():
                state = self._controls.park(request)
            case Reset():
                state = self._controls.reset()
            case Arm():
                state = self._controls.arm()
            case Torque():
                state = self._controls.arm() if request.on else self._controls.torque_off(request)
        return Ack(id=request.id, verb=tag_of(request), state=state)


def _decoded(parts: list[bytes]) -> CtlRequest | WireError:
    try:
        if len(parts) != 1:
            found = f"{len(parts)} frames"
            raise WireError("frames", "read a request", found, "1 frame", "send the request as one frame")
        return decode_ctl(parts[0])
    except WireError as error:
        return error


def _overtaken(request: CtlRequest) -> Rejected:
    """The event of what an e-stop voids: it came before, and would undo it when it was carried out afterwards."""
    return Rejected(
        id=request.id, code="overtaken", asked=tag_of(request), found="an e-stop that came after it and was served first",
        allowed="reset, then arm", do="ask again once the e-stop is answered",
    )  # fmt: skip
