"""The `ctl` thread over real sockets: an e-stop goes before everything that waits, and what it voids stays undone."""

from __future__ import annotations

import asyncio
import contextlib
from types import SimpleNamespace

import pytest
import zmq

from daemon.driving.shared import BusRequest
from daemon.front.control import ControlThread
from daemon.front.controls import FrontControls
from daemon.playing.waiting import Halts
from daemon.state.machine import RobotState, StateMachine
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire.requests import Estop, Stop

pytestmark = [pytest.mark.timeout(30), pytest.mark.realtime]


class Robot:
    """Writes down what it was told."""

    def __init__(self) -> None:
        self.told: list[str] = []

    def _tell(self, verb: str) -> str:
        self.told.append(verb)
        return "idle"

    def stop(self, request) -> str:
        return self._tell("stop")

    def estop(self, request) -> str:
        return self._tell("estop")

    def park(self, request) -> str:
        return self._tell("park")

    def reset(self) -> str:
        return self._tell("reset")

    def arm(self) -> str:
        return self._tell("arm")

    def torque_off(self, request) -> str:
        return self._tell("torque off")

    def status(self) -> ev.Event:
        return ev.Ack(verb=self._tell("status"), state="idle")

    def sent(self, event: ev.Event) -> ev.Event:
        return event


class Ctl:
    """A robot and its ctl thread, not yet begun; what is sent before waits in the socket."""

    def __init__(self) -> None:
        self._context, self.robot = zmq.Context(), Robot()
        server, self._client = self._context.socket(zmq.ROUTER), self._context.socket(zmq.DEALER)
        server.bind("inproc://ctl")
        self._client.setsockopt(zmq.RCVTIMEO, 10_000)
        self._client.connect("inproc://ctl")
        self._thread = ControlThread(server, self.robot)

    def answers(self, *verbs: str) -> dict[str, list[ev.Event]]:
        """What became of requests that were all there when the thread began, by verb."""
        for verb in verbs:
            self._client.send(f'{{"type": "{verb}", "id": "{verb}"}}'.encode())
        self._thread.start()
        found: dict[str, list[ev.Event]] = {verb: [] for verb in verbs}
        while not all(found.values()):
            event = wire.decode_event(self._client.recv())
            found.get(event.id, []).append(event)  # a frame that was none is answered without an id
        return found

    def send(self, frame: bytes) -> None:
        """One more frame, whatever it is."""
        self._client.send(frame)

    def close(self) -> None:
        self._thread.close()
        self._context.destroy(linger=0)


@pytest.fixture
def ctl():
    made = Ctl()
    yield made
    made.close()


def test_an_estop_goes_before_what_waits(ctl):
    ctl.answers("stop", "status", "stop", "estop", "status")
    assert ctl.robot.told == ["estop", "stop", "status", "stop", "status"]


def test_what_came_before_an_estop_does_not_undo_it(ctl):
    """Served after the e-stop that overtook them, a reset and an arm would switch the torque on again."""
    answers = ctl.answers("stop", "reset", "arm", "park", "estop")
    assert ctl.robot.told == ["estop", "stop"]
    assert [a.code for verb in ("reset", "arm", "park") for a in answers[verb]] == ["overtaken"] * 3


def test_what_comes_after_an_estop_is_carried_out(ctl):
    answers = ctl.answers("estop", "reset", "arm")
    assert ctl.robot.told == ["estop", "reset", "arm"]
    assert all(isinstance(a, ev.Ack) for [a] in answers.values())


def test_only_the_last_of_several_estops_can_be_undone(ctl):
    answers = ctl.answers("estop", "reset", "estop", "arm")
    assert sorted(ctl.robot.told) == ["arm", "estop", "estop"] and ctl.robot.told[-1] == "arm"
    assert answers["reset"][0].code == "overtaken"


def test_a_bad_frame_is_answered_in_its_turn(ctl):
    answers = ctl.answers("stop", "dance", "status")
    assert isinstance(answers["dance"][0], ev.ErrorEvent) and ctl.robot.told == ["stop", "status"]


@pytest.mark.parametrize("somebody_asks", [True, False])
def test_a_stop_waits_for_a_stalled_event_loop_only_while_nobody_asks(somebody_asks):
    """Ten stops before an e-stop delayed it by half a second."""
    looks, asked = [], []

    def next_request(_wait_ms: int) -> int:
        looks.append(len(asked))
        return zmq.POLLIN if somebody_asks else 0

    machine, halts, follower = StateMachine(), Halts(), SimpleNamespace(stopped=False)
    machine.state = RobotState.MOVING

    async def drain_cmd() -> None:
        asked.append("take what waits")

    stalled = asyncio.new_event_loop()  # it runs nothing until the stop is answered
    performer = SimpleNamespace(halts=halts, end_halted=lambda: asked.append("end what is played"))
    front = SimpleNamespace(
        machine=machine, performer=performer, follower=follower, loop=stalled,
        link=SimpleNamespace(request=asked.append), drain_cmd=drain_cmd,
    )  # fmt: skip
    with contextlib.closing(stalled):
        assert FrontControls(front, next_request).stop(Stop()) == "moving"
        assert asked == [BusRequest.STOP] and follower.stopped and halts.by == "stop"
        while len(asked) < 3:
            stalled.run_until_complete(asyncio.sleep(0))
    assert looks and set(looks) == {1}, "the bus process is told first"
    assert (len(looks) == 1) == somebody_asks


@pytest.mark.parametrize(("holds", "asked"), [(False, BusRequest.ESTOP), (True, BusRequest.ESTOP_HOLD)])
def test_an_estop_cuts_or_holds_as_the_daemon_is_set(holds, asked):
    told: list[BusRequest] = []
    machine = StateMachine()
    machine.state = RobotState.MOVING
    closed = asyncio.new_event_loop()
    closed.close()
    front = SimpleNamespace(
        machine=machine, performer=SimpleNamespace(halts=Halts(), end_halted=lambda: None),
        follower=SimpleNamespace(stopped=False), loop=closed, link=SimpleNamespace(request=told.append), drain_cmd=None,
    )  # fmt: skip
    assert FrontControls(front, lambda _: 0, estop_holds=holds).estop(Estop()) == "moving"
    assert told == [asked]
