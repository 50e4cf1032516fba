"""What the bus process reports is followed; what cannot be is an e-stop that says why."""

from __future__ import annotations

import pytest

from daemon.playback.bus_follower import BUS_SILENT_S, BusFollower
from daemon.playback.setpoint_buffer import SetpointBuffer
from daemon.shared_memory.bus_link import BusRequest, BusState
from daemon.state.bus_view import BusView
from daemon.state.machine import RobotState, StateMachine
from sim.clock import VirtualClock
from tests.support.rig import Rig, lead_to, rig
from tests.support.robots import packaged
from tests.support.sizes import few_and_long

ROBOT = packaged("reference")


class Front:
    """The front's end of a rig, on a clock that only `Front` moves."""

    def __init__(self, r: Rig) -> None:
        self.rig, self.clock = r, VirtualClock()
        self.view = view = BusView(r.link, ROBOT, self.clock)
        self.machine = StateMachine()
        self.follower = BusFollower(r.link, view, SetpointBuffer(ROBOT, r.link, view, 0.1), self.machine)

    def tick(self, cycles: int = 1, seconds: float = 0.01) -> RobotState:
        self.rig.cycle(cycles)
        self.clock.sleep_until(self.clock.now_s() + seconds)
        self.follower.update()
        return self.machine.state

    def arm(self) -> None:
        self.rig.link.request(BusRequest.ARM)
        while self.tick() is not RobotState.IDLE:
            assert self.rig.state in (BusState.LIMP, BusState.ARMING, BusState.HOLDING)


@pytest.mark.parametrize("state", few_and_long(["limp", "playing"], ["arming", "holding", "stopping", "parking"]))
def test_a_bus_process_back_from_silence_latches_the_fault_told(state):
    """It took up what it was doing, which cannot follow a fault, and ended in an e-stop that nobody had given."""
    with rig("reference", slowed=False) as r:
        front = Front(r)
        front.tick()
        if state == "arming":
            r.link.request(BusRequest.ARM)
        elif state != "limp":
            lead_to(r, state)
        front.tick()
        assert r.state.name.lower() == state
        had_torque = all(r.torque)
        assert front.tick(cycles=0, seconds=1.2 * BUS_SILENT_S) is RobotState.FAULT
        assert "silent" in front.follower.fault_reason
        passed = {front.tick() for _ in range(30)}
        assert passed == {RobotState.FAULT} and r.state is BusState.FAULT
        assert all(r.torque) == had_torque, "what has torque comes to rest and holds"
        assert "is back" in front.follower.fault_reason and "reset" in front.follower.fault_reason
        r.link.request(BusRequest.RESET)
        assert front.tick() is RobotState.LIMP and front.follower.fault_reason == "" and not any(r.torque)
        r.assert_limits_kept() if had_torque else None


def test_a_reset_given_in_the_silence_is_carried_out_after_the_fault():
    with rig("reference") as r:
        front = Front(r)
        front.arm()
        front.tick(cycles=0, seconds=1.2 * BUS_SILENT_S)
        r.link.request(BusRequest.RESET)
        states = [front.tick() for _ in range(4)]
        assert states[-1] is RobotState.LIMP and RobotState.ESTOP not in states and not any(r.torque)


@pytest.mark.parametrize("halt", few_and_long([None], [None, BusRequest.ESTOP]))
def test_a_fault_that_was_latched_and_reset_unseen_is_over(halt: BusRequest | None) -> None:
    """The robot stayed in a fault for ever: its bus process was limp, where a reset does nothing."""
    with rig("reference") as r:
        front = Front(r)
        front.arm()
        assert front.tick(cycles=0, seconds=1.2 * BUS_SILENT_S) is RobotState.FAULT
        if halt is not None:
            r.link.request(halt)
        r.cycle(3)
        r.link.request(BusRequest.RESET)
        r.cycle(3)
        front.view.begin(BusState.FAULT)  # of a new bus process: the cycles so far are not looked at
        front.tick(3)
        assert front.tick() is RobotState.LIMP and r.state is BusState.LIMP and not any(r.torque)
        front.arm()
        r.assert_limits_kept()


def test_what_cannot_follow_is_an_e_stop_that_says_why() -> None:
    with rig("reference") as r:
        front = Front(r)
        front.arm()
        front.machine.state = RobotState.FAULT  # which the bus process knows nothing of
        front.tick()
        assert front.tick() is RobotState.ESTOP and not any(r.torque)
        reason = front.follower.fault_reason
        assert "itself" in reason and "'bus holding'" in reason


def test_an_e_stop_that_somebody_gave_has_no_reason_of_the_daemons() -> None:
    with rig("reference") as r:
        front = Front(r)
        front.arm()
        r.link.request(BusRequest.ESTOP)
        assert front.tick() is RobotState.ESTOP and front.follower.fault_reason == ""
