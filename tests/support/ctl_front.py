"""The front's side of `ctl` among stand-ins: no sockets, no robot; the test is the ctl process at the other end of the channel."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from types import SimpleNamespace

from daemon.ctl.channel import Answered, Channel, Handed, pair
from daemon.front.ctl_handler import CtlHandler
from daemon.scheduling.command_queue import StopOrdering
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.shared_memory.request_words import Asker
from daemon.state.ledger import Ledger
from daemon.state.machine import RobotState, StateMachine
from daemon.wire import events as ev


class Front:
    """A desk among stand-ins, the process behind `ctl` at the other end."""

    def __init__(self, link: BusLink, state: RobotState = RobotState.MOVING) -> None:
        self.link, self.ctl = link, BusLink.attach(link.path, link.n_joints, asker=Asker.CTL)
        self.machine, self.halts, self.ended = StateMachine(), StopOrdering(), []
        self.machine.state = state
        self.follower = SimpleNamespace(stopped=False, bus_alive=True)
        performer = SimpleNamespace(
            machine=self.machine,
            follower=self.follower,
            halts=self.halts,
            end_halted=lambda: self.ended.append(self.halts.by),
        )
        self.drained = asyncio.Event()
        self.published: list[ev.Event] = []
        ledger = Ledger(lambda *_: None, self.published.append)
        self.desk = CtlHandler(link, performer, ledger, self.drained.wait, lambda: None, self.published.append)
        ours, theirs = pair()
        self.far = Channel(theirs)
        self.desk.attach(Channel(ours))

    def halted(self, verb: str, *, told: bool = True) -> int:
        number = self.ctl.new_number()
        self.ctl.request(BusRequest[verb.upper()], number=number)
        if told:
            self.handed(verb, number)
        return number

    def handed(self, frame: str, number: int) -> None:
        """Hand over a request of that number: a bare verb, or JSON."""
        assert self.far.send(Handed(number, frame.encode()))

    def answer(self) -> Answered | None:
        message = self.far.receive()
        return message if isinstance(message, Answered) else None


def run(test: Callable[[Front], Awaitable[None]], state: RobotState = RobotState.MOVING) -> None:
    """Run a test as a coroutine on a front of its own."""
    link = BusLink.create(2)

    async def body() -> None:
        front = Front(link, state)
        front.drained.set()
        try:
            await test(front)
        finally:
            front.desk.detach()
            front.far.close()

    try:
        asyncio.run(body())
    finally:
        link.close()


async def soon() -> None:
    """Let tasks that are ready run."""
    for _ in range(5):
        await asyncio.sleep(0)
