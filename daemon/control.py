"""The `ctl` socket in its own thread: stop and e-stop reach the bus process whatever the rest of the daemon does."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Protocol

import zmq

from daemon.events import Ack, Event, Rejected
from daemon.ledger import split_route
from daemon.realtime import CONTROL_PRIORITY, take_fifo
from daemon.replies import refusal
from daemon.requests import Arm, CtlRequest, Estop, Park, Reset, Status, Stop
from daemon.state import CommandRefusedError
from daemon.wire import WireError, decode_ctl, encode, error_event

log = logging.getLogger(__name__)

POLL_MS = 100


class Controls(Protocol):
    """What the thread acts on; every call returns at once and may come from this thread."""

    def stop(self) -> str:
        """Brake within the limits and hold; returns the state before."""
        ...

    def estop(self) -> str:
        """Cut torque; returns the state before."""
        ...

    def reset(self) -> str:
        """Leave fault or e-stop; returns the state before."""
        ...

    def arm(self) -> str:
        """Torque on; returns the state before."""
        ...

    def park(self) -> str:
        """Park; returns the state before."""
        ...

    def status(self) -> Event:
        """The state event."""
        ...

    def sent(self, event: Event) -> Event:
        """Number an event that is being sent, and tell the subscribers of it."""
        ...


class ControlThread:
    """Serves the `ctl` socket until closed."""

    def __init__(self, socket: zmq.Socket[bytes], controls: Controls) -> None:
        self._socket = socket
        self._controls = controls
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
            if not self._socket.poll(POLL_MS):
                continue
            route, parts = split_route(self._socket.recv_multipart())
            try:
                event = self._answer(parts)
            except Exception as error:  # the thread that can stop the robot must outlive every bug
                log.exception("a ctl request failed")
                event = Rejected(code="internal", asked="ctl", found=str(error), allowed="", do="see the daemon's log")
            reply = encode(self._controls.sent(event))
            try:
                self._socket.send_multipart([*route.frames, reply], zmq.DONTWAIT)
            except zmq.ZMQError as error:
                log.warning("a ctl reply was lost: %s", error)

    def _answer(self, parts: list[bytes]) -> Event:
        try:
            if len(parts) != 1:
                raise WireError(
                    "frames", "read a request", f"{len(parts)} frames", "1 frame", "send the request as one frame"
                )
            request = decode_ctl(parts[0])
        except WireError as error:
            return error_event(error)
        try:
            return self._carry_out(request)
        except CommandRefusedError as error:
            return refusal(request.id, error)

    def _carry_out(self, request: CtlRequest) -> Event:
        verbs: dict[type, Callable[[], str]] = {
            Stop: self._controls.stop,
            Estop: self._controls.estop,
            Reset: self._controls.reset,
            Arm: self._controls.arm,
            Park: self._controls.park,
        }
        if isinstance(request, Status):
            event = self._controls.status()
            event.id = request.id
            return event
        state = verbs[type(request)]()
        return Ack(id=request.id, verb=str(type(request).__struct_config__.tag), state=state)
