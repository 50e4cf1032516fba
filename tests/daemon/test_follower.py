"""What the bus process reports is followed; what cannot be is an e-stop that says why."""

from __future__ import annotations

import pytest

from daemon.driving.shared import BusRequest, BusState
from daemon.playing.follower import BUS_SILENT_S, Follower
from daemon.playing.planner import Planner
from daemon.state.bus_view import BusView
from daemon.state.machine import RobotState, StateMachine
from retarget.robot import load_robot
from tests.daemon.rig import Rig, rig

ROBOT = load_robot("reference")


class Front:
    """The front's end of a rig, on a clock that only `Front` moves."""

    def __init__(self, r: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
        self.rig, self.now_s = r, 0.0
        monkeypatch.setattr("daemon.state.bus_view.time.monotonic", lambda: self.now_s)
        view = BusView(r.link, ROBOT)
        self.machine = StateMachine()
        self.follower = Follower(r.link, view, Planner(ROBOT, r.link, view, 0.1), self.machine)

    def tick(self, cycles: int = 1, seconds: float = 0.01) -> RobotState:
        self.rig.cycle(cycles)
        self.now_s += seconds
        self.follower.update()
        return self.machine.state

    def arm(self) -> None:
        self.rig.link.request(BusRequest.ARM)
        while self.tick() is not RobotState.IDLE:
            assert self.rig.state in (BusState.LIMP, BusState.ARMING, BusState.HOLDING)


def test_a_bus_process_that_was_silent_and_comes_back_armed_is_stopped_and_the_e_stop_says_why(monkeypatch) -> None:
    with rig("reference") as r:
        front = Front(r, monkeypatch)
        front.arm()
        assert front.tick(cycles=0, seconds=1.2 * BUS_SILENT_S) is RobotState.FAULT
        assert "silent" in front.follower.fault_reason
        front.tick()
        assert all(r.torque), "it holds still, and nobody knew"
        assert front.tick() is RobotState.ESTOP and not any(r.torque)
        reason = front.follower.fault_reason
        assert "itself" in reason and "'bus holding'" in reason and "silent" in reason
        r.link.request(BusRequest.RESET)
        assert front.tick() is RobotState.LIMP and front.follower.fault_reason == ""


def test_an_e_stop_that_somebody_gave_has_no_reason_of_the_daemons(monkeypatch) -> None:
    with rig("reference") as r:
        front = Front(r, monkeypatch)
        front.arm()
        r.link.request(BusRequest.ESTOP)
        assert front.tick() is RobotState.ESTOP and front.follower.fault_reason == ""
