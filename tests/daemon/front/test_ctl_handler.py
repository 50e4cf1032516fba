"""The front's side of `ctl`: what a halt ends there, when it is told of late or not at all, and what the state forbids."""

from __future__ import annotations

import asyncio
import time
from types import SimpleNamespace

import numpy as np
import pytest

from daemon.ctl.channel import FRONT_SERVES_S, Answered, Channel, Handed, pair
from daemon.front.ctl_handler import UNTOLD_S, CtlHandler
from daemon.scheduling.command_queue import StopOrdering
from daemon.shared_memory.bus_link import BusLink, BusRequest
from daemon.shared_memory.request_words import Asker
from daemon.state.ledger import Ledger
from daemon.state.machine import RobotState, StateMachine
from daemon.wire import codec as wire
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

    def handed(self, verb: str, number: int) -> None:
        assert self.far.send(Handed(number, verb.encode()))

    def answer(self) -> Answered | None:
        message = self.far.receive()
        return message if isinstance(message, Answered) else None


def run(test, state: RobotState = RobotState.MOVING):
    """A test as a coroutine on a front of its own."""
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
    for _ in range(5):
        await asyncio.sleep(0)


@pytest.mark.parametrize("verb", ["stop", "estop"])
def test_a_halt_ends_earlier_commands_and_the_front_pushes_none_of_them(verb):
    async def test(front: Front) -> None:
        before = front.link.epoch
        front.link.setpoints.push(np.zeros((3, 2)), 1, 0, before, last=False)
        number = front.halted(verb)
        assert front.link.epoch == before, "the front knows nothing of it yet"
        front.link.setpoints.push(np.zeros((3, 2)), 1, 3, front.link.epoch, last=True)
        assert front.ctl.take_setpoint() is None, "what it pushes meanwhile is void"
        front.desk.take_waiting()
        await soon()
        assert front.ended == [verb] and front.link.epoch != before and not front.link.epochs.unknown_halts
        assert front.answer() == Answered(number)
        front.link.setpoints.push(np.zeros((1, 2)), 2, 0, front.link.epoch, last=True)
        setpoint = front.ctl.take_setpoint()
        assert setpoint is not None and setpoint.plan_id == 2

    run(test)


def test_a_halt_of_which_nobody_tells_is_noticed_once():
    """The process behind `ctl` may be killed between asking the bus process and telling the front."""

    async def test(front: Front) -> None:
        number = front.halted("stop", told=False)
        front.desk.tick()
        assert not front.ended
        await asyncio.sleep(1.5 * UNTOLD_S)
        front.desk.tick()
        await soon()
        assert front.ended == ["stop"] and front.follower.stopped
        front.handed("stop", number)  # it was only late: what has begun since goes on
        front.desk.take_waiting()
        await soon()
        assert front.ended == ["stop"] and front.answer() == Answered(number)

    run(test)


def test_the_answer_waits_a_moment_for_the_texts_before_it_and_no_longer():
    async def test(front: Front) -> None:
        front.drained.clear()
        number = front.halted("stop")
        front.desk.take_waiting()
        await soon()
        assert front.answer() is None and front.halts.overtook
        await asyncio.sleep(0.2)
        assert front.answer() == Answered(number) and front.ended == []
        front.drained.set()
        await soon()
        assert front.ended == ["stop"] and front.answer() is None

    run(test)


@pytest.mark.parametrize(
    ("verb", "state", "asks"),
    [
        ("reset", RobotState.ESTOP, BusRequest.RESET), ("arm", RobotState.LIMP, BusRequest.ARM),
        ("park", RobotState.MOVING, BusRequest.PARK),
    ],
)  # fmt: skip
def test_what_the_state_allows_is_asked_with_the_number_of_its_request(verb, state, asks):
    async def test(front: Front) -> None:
        number = front.ctl.new_number()
        front.handed(verb, number)
        front.desk.take_waiting()
        await soon()
        answer = front.answer()
        assert answer is not None and answer.number == number
        assert isinstance(wire.decode_event(answer.event), ev.Ack) and len(front.published) == 1
        taken = front.ctl.take_request()
        assert taken is not None and (taken.kind, taken.number) == (asks, number)

    run(test, state)


@pytest.mark.parametrize("verb", ["reset", "arm", "park"])
def test_what_an_estop_has_overtaken_is_refused(verb):
    async def test(front: Front) -> None:
        number = front.ctl.new_number()
        front.halted("estop", told=False)
        front.handed(verb, number)
        front.desk.take_waiting()
        await soon()
        answer = front.answer()
        assert answer is not None and wire.decode_event(answer.event).code == "overtaken"

    run(test, {"reset": RobotState.FAULT, "arm": RobotState.LIMP, "park": RobotState.IDLE}[verb])


def test_what_the_state_forbids_is_refused_and_asks_for_nothing():
    async def test(front: Front) -> None:
        front.handed("park", front.ctl.new_number())
        front.desk.take_waiting()
        answer = front.answer()
        assert answer is not None and wire.decode_event(answer.event).code == "wrong_state"
        assert front.ctl.take_request() is None

    run(test, RobotState.FAULT)


def test_what_its_sender_was_told_that_nobody_serves_is_not_served_late():
    """A front that was frozen for a while must not arm a robot for a request of long ago."""

    async def test(front: Front) -> None:
        front.handed("arm", 2 * (time.monotonic_ns() - round(1.1e9 * FRONT_SERVES_S)))
        front.desk.take_waiting()
        assert front.answer() is None and front.ctl.take_request() is None

    run(test, RobotState.LIMP)
