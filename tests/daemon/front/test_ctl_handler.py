"""The front's side of `ctl`: what a halt ends there, when it is told of late or not at all, and what the state forbids."""

from __future__ import annotations

import asyncio
import time

import numpy as np
import pytest

from daemon.ctl.channel import FRONT_SERVES_S, Answered
from daemon.front.ctl_handler import UNTOLD_S
from daemon.shared_memory.bus_link import BusRequest
from daemon.state.machine import RobotState
from daemon.wire import codec as wire
from daemon.wire import events as ev
from tests.support.ctl_front import Front, run, soon


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


def test_an_arm_that_a_stop_overtook_does_not_let_texts_arm_again() -> None:
    async def test(front: Front) -> None:
        front.machine.limp_by_person()
        number = front.ctl.new_number()
        front.halted("stop", told=False)
        front.handed("arm", number)
        front.desk.take_waiting()
        await soon()
        assert front.machine.must_arm

    run(test, RobotState.LIMP)
