"""What the `ctl` thread does: the bus process first, the event loop afterwards, and no longer than nobody else asks."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from daemon.driving.shared import BusRequest
from daemon.state.machine import CommandRefusedError, Trigger
from daemon.wire.event_base import Event
from daemon.wire.requests import Estop, Park, Stop, Torque
from daemon.wire.status import StateEvent

if TYPE_CHECKING:
    from daemon.front.front import Front

DRAIN_TIMEOUT_S = 0.05
"""Longest wait of a `stop` reply for the texts that came before it; the stop itself does not wait."""
LOOK_MS = 1
"""How often that wait looks whether it is over."""


class FrontControls:
    """The verbs of `ctl` on a front.

    Args:
        front: the front.
        next_request: waits so many milliseconds for another request on `ctl`; whether there is one.
        estop_holds: whether an e-stop brakes and holds.
    """

    def __init__(self, front: Front, next_request: Callable[[int], int], *, estop_holds: bool = False) -> None:
        self._front, self._next_request, self._estop_holds = front, next_request, estop_holds

    def stop(self, request: Stop) -> str:
        """Brake within the limits and hold; returns the state before."""
        return self._halt(Trigger.STOP, request, BusRequest.STOP)

    def estop(self, request: Estop) -> str:
        """Cut torque, or hold where the daemon is set so; returns the state before."""
        kind = BusRequest.ESTOP_HOLD if self._estop_holds else BusRequest.ESTOP
        return self._halt(Trigger.ESTOP, request, kind)

    def park(self, request: Park) -> str:
        """Park, then torque off; returns the state before."""
        return self._halt(Trigger.PARK, request, BusRequest.PARK)

    def torque_off(self, request: Torque) -> str:
        """Brake within the limits, then torque off until an explicit `arm`; returns the state before."""
        self._front.machine.limp_by_person()  # first: no text may arm it meanwhile
        return self._halt(Trigger.TORQUE_OFF, request, BusRequest.TORQUE_OFF)

    def reset(self) -> str:
        """Leave fault or e-stop; returns the state before."""
        machine, state = self._front.machine, self._front.machine.state
        machine.check(Trigger.RESET)
        if not self._front.follower.bus_alive:
            do = "the bus process is being started again; wait a second, then `mmmd reset`"
            raise CommandRefusedError(state, Trigger.RESET, (), do)
        self._front.link.request(BusRequest.RESET)
        return state.value

    def arm(self) -> str:
        """Torque on, slow move to rest; returns the state before."""
        machine, state = self._front.machine, self._front.machine.state
        machine.check(Trigger.ARM)
        machine.armed_by_person()
        self._front.link.request(BusRequest.ARM)
        return state.value

    def status(self) -> Event:
        """The state event."""
        return self._front.state_event()

    def sent(self, event: Event) -> Event:
        """Number an event that is being sent, and tell the subscribers of it."""
        self._front.ledger.stamp(event)
        if not isinstance(event, StateEvent):
            self._front.publish_from_thread(event)
        return event

    def _halt(self, command: Trigger, request: Stop | Estop | Park | Torque, kind: BusRequest) -> str:
        front, performer, state = self._front, self._front.performer, self._front.machine.state
        front.machine.check(command)
        performer.halts.note(command.value, request)
        front.follower.stopped = command is Trigger.STOP
        front.link.request(kind)
        ended = threading.Event()

        async def end_commands() -> None:
            try:
                await front.drain_cmd()
                await asyncio.sleep(0)  # a request that was already received is taken now
                performer.end_halted()
            finally:  # what comes later is no longer taken for what came before
                performer.halts.served()
                ended.set()

        ending = end_commands()
        try:
            asyncio.run_coroutine_threadsafe(ending, front.loop)
        except RuntimeError:  # the loop is closed: there is nothing left to end
            ending.close()
            return state.value
        end_s = time.monotonic() + DRAIN_TIMEOUT_S
        while not ended.is_set() and time.monotonic() < end_s and not self._next_request(LOOK_MS):
            pass
        return state.value
