"""The front's side of `ctl`: ends the commands that a stop ends, and decides on requests that need more than the bus process.

A stop or an e-stop reaches the bus process before the front learns of it (`daemon.ctl`). Ending commands here is bookkeeping: the
front's setpoints are void already, and stay void until the front knows of the halt.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable

from daemon.ctl.channel import FRONT_SERVES_S, Answered, Channel, Handed, Ready, Told
from daemon.front.late_requests import refused_as_late
from daemon.scheduling.scheduler import Scheduler
from daemon.shared_memory.bus_link import BusLink
from daemon.shared_memory.request_words import Asked, BusRequest
from daemon.state.ledger import Ledger
from daemon.state.machine import CommandRefusedError, Trigger
from daemon.state.replies import refusal
from daemon.wire.codec import WireError, decode_ctl, decode_event, encode
from daemon.wire.event_base import Event
from daemon.wire.events import Ack, Rejected
from daemon.wire.requests import Arm, CtlRequest, Estop, Park, Reset, Status, Stop, Torque, tag_of
from daemon.wire.status import StateEvent

log = logging.getLogger(__name__)

DRAIN_TIMEOUT_S = 0.05
"""Seconds that the answer to `park` and `torque off` waits at most for the texts that came before it."""
AT_ONCE = 64
"""Number of messages taken before the event loop continues with other tasks."""
UNTOLD_S = 0.1
"""Seconds after which the front serves a halt that no message told it of: the ctl process was killed before it could."""


class CtlHandler:
    """Serves the requests that the ctl process hands over, in the event loop.

    Args:
        link: shared memory.
        performer: scheduler of the commands that a halt ends.
        ledger: numbers events.
        drain_cmd: takes the requests that wait in the socket `cmd`.
        state: returns the state event.
        publish: publishes an event on `pub`.
    """

    def __init__(
        self,
        link: BusLink,
        performer: Scheduler,
        ledger: Ledger,
        drain_cmd: Callable[[], Awaitable[None]],
        state: Callable[[], StateEvent],
        publish: Callable[[Event], None],
    ) -> None:
        self._link, self._performer, self._ledger = link, performer, ledger
        self._machine, self._follower = performer.machine, performer.follower
        self._drain_cmd, self._state, self._publish = drain_cmd, state, publish
        self._channel: Channel | None = None
        self._answers: list[Answered] = []
        self._ending: set[asyncio.Task[None]] = set()
        self._started_s = time.monotonic()

    def attach(self, channel: Channel) -> None:
        """Serve this channel from now on; the previous channel belonged to a process that is gone."""
        self.detach()
        self._channel = channel
        asyncio.get_running_loop().add_reader(channel.fileno(), self.take_waiting)

    def detach(self) -> None:
        """Serve no channel."""
        if self._channel is not None:
            if self._channel.fileno() >= 0:
                asyncio.get_running_loop().remove_reader(self._channel.fileno())
            self._channel.close()
            self._channel = None

    def take_waiting(self) -> None:
        """Take the messages that have arrived. Called before each text too, so that an earlier stop is known by then."""
        for _ in range(AT_ONCE):
            message = None if self._channel is None else self._channel.receive()
            if message is None:
                break
            try:
                self._take(message)
            except Exception:  # one message must not end the daemon
                log.exception("a message of the ctl process failed")
        if self._channel is not None and self._channel.closed:
            self.detach()
        self._send_answers()

    def tick(self) -> None:
        """Serve halts for which no message came: the ctl process may have been killed before it sent one."""
        self._send_answers()
        for asked in self._link.epochs.unknown_halts:
            if time.monotonic_ns() - asked.number // 2 > 1e9 * UNTOLD_S:
                log.warning(
                    "%s was asked for, and ctl sent no message of it: the ctl process was lost, or the front held up",
                    asked.kind.name,
                )
                trigger = Trigger.STOP if asked.kind is BusRequest.STOP else Trigger.ESTOP
                self._halted(trigger, asked, None)

    def _take(self, message: Ready | Handed | Told | Answered) -> None:
        if isinstance(message, Told):
            event = decode_event(message.event)
            t_mono = event.t_mono
            self._ledger.stamp(event).t_mono = t_mono
            self._publish(event)
        elif isinstance(message, Handed):
            self._serve(message)

    def _serve(self, handed: Handed) -> None:
        try:
            request = decode_ctl(handed.frame)
        except WireError as error:  # it was decoded there already
            log.error("a request of ctl cannot be read: %s", error)
            return
        if isinstance(request, Stop | Estop):
            trigger = Trigger.STOP if isinstance(request, Stop) else Trigger.ESTOP
            kind = BusRequest.STOP if isinstance(request, Stop) else self._link.estop_kind
            self._halted(trigger, Asked(kind, handed.number), request)
        elif not isinstance(request, Status) and time.monotonic_ns() - handed.number // 2 > 1e9 * FRONT_SERVES_S:
            log.warning("%s came too late from the ctl process and is not carried out", tag_of(request))
        elif (refused := refused_as_late(request, time.monotonic(), self._started_s)) is not None:
            self._send_event(handed.number, refused)
        elif isinstance(request, Park) or (isinstance(request, Torque) and not request.on):
            self._halt(handed.number, request)
        else:
            self._answer(handed.number, request, lambda: self._decide(handed.number, request))

    def _halted(self, trigger: Trigger, asked: Asked, request: Stop | Estop | None) -> None:
        """End the commands that came before a stop or e-stop, which the bus process has received already."""
        if self._link.epochs.knows_of(asked):
            self._reply(Answered(asked.number))
            return
        self._performer.halts.note(trigger.value, request, at_s=asked.number / 2e9)
        self._follower.stopped = trigger is Trigger.STOP
        self._link.epochs.know_of(asked)
        self._start(self._end_halted(lambda: self._reply(Answered(asked.number))))

    def _halt(self, number: int, request: Park | Torque) -> None:
        """Serve park or torque off: the robot's state decides whether it is allowed, then commands end as for a stop."""
        kind, trigger = (
            (BusRequest.PARK, Trigger.PARK)
            if isinstance(request, Park)
            else (BusRequest.TORQUE_OFF, Trigger.TORQUE_OFF)
        )
        if trigger is Trigger.TORQUE_OFF:
            self._machine.limp_by_person()  # first, so that no text arms the robot meanwhile
        state = self._machine.state
        try:
            self._machine.check(trigger)
        except CommandRefusedError as error:
            self._send_event(number, refusal(request.id, error))
            return
        self._performer.halts.note(trigger.value, request, at_s=number / 2e9)
        self._follower.stopped = False
        asked = self._link.request(kind, number=number)
        event = (
            _overtaken(request)
            if self._link.overtaken(asked)
            else Ack(id=request.id, verb=tag_of(request), state=state.value)
        )
        self._start(self._end_halted(lambda: self._send_event(number, event)))

    def _decide(self, number: int, request: CtlRequest) -> Event:
        """Serve a request that ends no command.

        Raises:
            CommandRefusedError: the robot's state does not allow it.
        """
        if isinstance(request, Status):
            return self._state()
        state, kind = self._machine.state, BusRequest.RESET
        if isinstance(request, Reset):
            self._machine.check(Trigger.RESET)
            if not self._follower.bus_alive:
                do = "the bus process is being started again; wait a second, then `mmmd reset`"
                raise CommandRefusedError(state, Trigger.RESET, (), do)
        elif isinstance(request, Arm | Torque):
            self._machine.check(Trigger.ARM)
            kind = BusRequest.ARM
        else:
            raise TypeError(f"no answer to {type(request).__name__}")
        if self._link.overtaken(self._link.request(kind, number=number)):
            return _overtaken(request)
        if kind is BusRequest.ARM:
            self._machine.armed_by_person()
        return Ack(id=request.id, verb=tag_of(request), state=state.value)

    def _answer(self, number: int, request: CtlRequest, decide: Callable[[], Event]) -> None:
        try:
            event = decide()
        except CommandRefusedError as error:
            event = refusal(request.id, error)
        except Exception as error:  # one request must not end the daemon
            log.exception("a ctl request failed")
            event = Rejected(code="internal", asked="ctl", found=str(error), allowed="", do="see the daemon's log")
        event.id = request.id
        self._send_event(number, event)

    async def _end_halted(self, then: Callable[[], None]) -> None:
        """End the commands that came before a halt; `then` is called when that is done, or after `DRAIN_TIMEOUT_S`."""
        late = asyncio.get_running_loop().call_later(DRAIN_TIMEOUT_S, then)
        try:
            await self._drain_cmd()
            await asyncio.sleep(0)  # a request that was already received is taken now
            self._performer.end_halted()
        finally:  # commands that arrive from here on count as sent after the halt
            self._performer.halts.served()
            if not late.cancelled() and late.when() > asyncio.get_running_loop().time():
                late.cancel()
                then()

    def _start(self, work: Awaitable[None]) -> None:
        task = asyncio.ensure_future(work)
        self._ending.add(task)
        task.add_done_callback(self._ending.discard)

    def _send_event(self, number: int, event: Event) -> None:
        self._ledger.stamp(event)
        if not isinstance(event, StateEvent):
            self._publish(event)
        self._reply(Answered(number, encode(event)))

    def _reply(self, answer: Answered) -> None:
        self._answers.append(answer)
        self._send_answers()

    def _send_answers(self) -> None:
        while self._answers and (self._channel is None or self._channel.send(self._answers[0])):
            self._answers.pop(0)


def _overtaken(request: CtlRequest) -> Rejected:
    return Rejected(
        id=request.id, code="overtaken", asked=tag_of(request), found="a stop that came after it and was served first",
        allowed="what is asked after it", do="ask again",
    )  # fmt: skip
