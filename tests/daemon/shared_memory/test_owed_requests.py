"""A stop that no bus cycle has carried out is owed by the next bus process: killed at every step, in virtual time.

The real streamer, start and request words on simulated servos that outlive them. A process is killed by an exception in the
middle of what it sends or reads, which nothing in it catches; the next one knows nothing but the shared memory and the servos.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import pytest

from daemon.control.control_loop import ControlLoop
from daemon.control.starting import start
from daemon.dynamixel.servo_bus import ServoBus
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from tests.support.rig import swing
from tests.support.robots import slow
from tests.support.sizes import few_and_long

STATES = ("limp", "arming", "holding", "playing", "stopping", "parking", "fault")


class Killed(BaseException):
    """The process is no more."""


class MortalPort(SimPort):
    """Calls `at_step` before each write or read."""

    at_step: Callable[[], None] = staticmethod(lambda: None)

    def write(self, data: bytes) -> None:
        self.at_step()
        super().write(data)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        self.at_step()
        return super().read(max_bytes, timeout_s)


class Robot:
    """Servos and shared memory that outlive each of the bus processes."""

    def __init__(self, robot: RobotModel, link: BusLink, *faults: Fault) -> None:
        self.robot, self.front = robot, link
        self.clock = VirtualClock()
        self.sim = SimBus(robot, FaultSchedule(tuple(faults)))
        self.steps = 0
        self.at: dict[int, Callable[[], None]] = {}
        self.streamer: ControlLoop | None = None

    def _step(self) -> None:
        self.steps += 1
        if self.steps in self.at:
            self.at[self.steps]()

    def at_steps_from_now(self, steps: int, what: Callable[[], None]) -> None:
        self.at[self.steps + steps] = what

    def start(self, *, after_loss: bool) -> None:
        """A bus process on what the one before has left."""
        link = BusLink.attach(self.front.path, self.robot.n_joints, self.robot.n_servos)
        port = MortalPort(self.sim, self.clock)
        port._start_s, port.at_step = 0.0, self._step  # time goes on from one process to the next
        opened = lambda: ServoBus.on_port(port, self.robot.servos, self.clock)
        self.streamer = None
        self.streamer = start(self.robot, opened, link, self.clock, after_loss=after_loss)
        assert self.streamer is not None, link.text
        self.streamer._watch_front = False

    def cycle(self, n: int = 1) -> None:
        assert self.streamer is not None
        for _ in range(n):
            self.streamer.cycle()
            self.clock.sleep_until(self.clock.now_s() + self.robot.bus.period_s)

    @property
    def torque(self) -> bool:
        return any(s.torque for s in self.sim.servos.values())

    def lead_to(self, state: str) -> None:
        """From a start to a state."""
        assert self.streamer is not None
        if state == "limp":
            return
        self.front.request(BusRequest.ARM)
        self.cycle(2)
        if state == "arming":
            return
        for _ in range(2000):
            if self.streamer.state is BusState.HOLDING:
                break
            self.cycle()
        if state != "holding":
            self.front.setpoints.push(swing(self.robot, 2.0), 1, 0, self.front.epoch, last=True)
            self.cycle(round(0.6 * self.robot.bus.rate_hz))
        kinds = {"stopping": BusRequest.STOP, "parking": BusRequest.PARK, "fault": BusRequest.FAULT}
        if state in kinds:
            self.front.request(kinds[state])
            self.cycle()
        assert self.streamer.state.name.lower() == state


@contextmanager
def robot(*faults: Fault) -> Iterator[Robot]:
    model = slow()
    link = BusLink.create(model.n_joints, model.n_servos)
    try:
        yield Robot(model, link, *faults)
    finally:
        link.close()


def kill() -> None:
    raise Killed


@pytest.mark.parametrize("kind", [BusRequest.ESTOP, BusRequest.ESTOP_HOLD])
@pytest.mark.parametrize("state", few_and_long(["playing"], STATES))
@pytest.mark.parametrize("steps", few_and_long([2], [1, 3, 8]))
def test_an_e_stop_is_carried_out_by_the_next_process_after_any_kill(state, steps, kind):
    """Killed in a motion, an e-stop given within a second was acknowledged and lost, 4 of 4; all servos kept their torque."""
    with robot() as r:
        r.start(after_loss=False)
        r.lead_to(state)
        r.at_steps_from_now(steps, kill)
        asked = r.front.request(kind)
        with suppress(Killed):
            r.cycle(20)
        r.start(after_loss=True)
        assert not r.torque or r.front.carried_out(asked), "an e-stop that holds may have been carried out before"
        r.cycle(8)
        assert r.front.carried_out(asked) and not r.front.owes(kind)
        if not r.torque:
            assert r.streamer.state in (BusState.ESTOP, BusState.FAULT)
        else:  # carried out before the kill: braked and held, as set; the fault of the loss can be reset
            assert kind is BusRequest.ESTOP_HOLD and r.streamer.state is BusState.FAULT
        report = r.sim.audit.report()
        assert report["violations"] == 0, report["details"]


@pytest.mark.parametrize("state", few_and_long(["playing"], STATES))
@pytest.mark.parametrize("killed_again_at", few_and_long([None, 3], [2, 40]))
def test_an_e_stop_without_a_process_cuts_torque_before_verification(state, killed_again_at):
    with robot() as r:
        r.start(after_loss=False)
        r.lead_to(state)
        r.at_steps_from_now(1, kill)
        with suppress(Killed):
            r.cycle()
        asked = r.front.request(BusRequest.ESTOP)
        assert not r.front.carried_out(asked), "who asks is told that nobody has done it yet"
        if killed_again_at is not None:
            r.at_steps_from_now(killed_again_at, kill)
            with suppress(Killed):
                r.start(after_loss=True)
                r.cycle(30)
            assert killed_again_at == 2 or not r.torque, "torque off is the first thing that it sends"
        r.start(after_loss=True)
        assert not r.torque
        r.cycle(2)
        assert r.front.carried_out(asked) and r.streamer.state in (BusState.ESTOP, BusState.FAULT)
        r.front.request(BusRequest.RESET)
        r.cycle(2)
        assert r.streamer.state is BusState.LIMP and not r.torque


@pytest.mark.parametrize("steps", few_and_long([50], [1, 50, 150, 300]))
def test_an_e_stop_given_while_the_bus_starts_cuts_torque_in_the_start(steps):
    with robot() as r:
        r.start(after_loss=False)
        r.lead_to("holding")
        asked = []
        r.at_steps_from_now(steps, lambda: asked.append(r.front.request(BusRequest.ESTOP)))
        r.start(after_loss=True)
        if not asked:
            pytest.skip(f"the start takes fewer than {steps} steps")
        r.cycle()
        assert not r.torque and r.front.carried_out(asked[0]) and r.streamer.state is BusState.ESTOP


def test_an_e_stop_on_a_lost_port_is_owed_until_the_port_is_back():
    with robot(Fault("unplug", start_s=3.0, end_s=4.0)) as r:
        r.start(after_loss=False)
        r.lead_to("holding")
        while r.clock.now_s() < 3.1:
            r.cycle()
        asked = r.front.request(BusRequest.ESTOP)
        r.cycle(5)
        assert r.streamer.state is BusState.ESTOP and not r.front.carried_out(asked) and r.torque
        while r.clock.now_s() < 4.2:  # this process ends meanwhile; nobody has sent a torque off
            r.clock.sleep_until(r.clock.now_s() + 0.1)
        r.start(after_loss=True)
        r.cycle()
        assert not r.torque and r.front.carried_out(asked)


@pytest.mark.parametrize("state", few_and_long(["playing"], ["holding", "playing", "parking"]))
def test_torque_off_is_owed_as_well(state):
    with robot() as r:
        r.start(after_loss=False)
        r.lead_to(state)
        r.at_steps_from_now(1, kill)
        with suppress(Killed):
            r.cycle()
        asked = r.front.request(BusRequest.TORQUE_OFF)
        r.start(after_loss=True)
        r.cycle(2)
        assert not r.torque and r.front.carried_out(asked) and r.streamer.state is BusState.FAULT


@pytest.mark.parametrize("kind", few_and_long([BusRequest.ARM], [BusRequest.ARM, BusRequest.PARK, BusRequest.RESET]))
def test_requests_that_move_or_unlatch_are_not_left_to_the_next_process(kind):
    with robot() as r:
        r.start(after_loss=False)
        r.lead_to("holding")
        r.front.request(kind)
        goals = r.sim.audit.goals
        r.start(after_loss=True)
        r.cycle(20)
        assert r.streamer.state is BusState.FAULT and r.sim.audit.goals == goals


def test_a_reset_and_an_arm_from_before_an_e_stop_do_not_undo_it():
    """The front may be held up between taking a request from `ctl` and handing it on."""
    with robot() as r:
        r.start(after_loss=False)
        r.lead_to("holding")
        early = r.front.new_number()
        asked = r.front.request(BusRequest.ESTOP)
        r.cycle(3)
        assert r.front.carried_out(asked)
        for kind in (BusRequest.RESET, BusRequest.ARM):
            late = r.front.request(kind, number=early)
            assert r.front.overtaken(late)
            r.cycle(3)
            assert r.streamer.state is BusState.ESTOP and not r.torque
        r.front.request(BusRequest.RESET)
        r.cycle()
        assert r.streamer.state is BusState.LIMP
