"""The bus process by itself: its start, and when its cycles begin."""

import numpy as np
import pytest

from daemon.control.control_loop import LOOK_S
from daemon.control.starting import start
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import PortMissingError
from daemon.shared_memory.bus_link import BusLink, BusRequest, Readiness
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.port import SimPort


def test_start_says_why_there_is_no_robot():
    robot = load_robot("reference")
    clock = VirtualClock()
    link = BusLink.create(robot.n_joints)

    def missing() -> ServoBus:
        raise PortMissingError("dxl:///dev/ttyUSB9", "no such device", "plug it in")

    try:
        assert start(robot, missing, link, clock) is None
        assert link.readiness is Readiness.FAILED and "ttyUSB9" in link.text
        deaf = SimPort(SimBus(robot), clock, baud=57_600)
        assert start(robot, lambda: ServoBus.on_port(deaf, robot.servos, clock), link, clock) is None
        assert "baud" in link.text
        other = SimPort(SimBus(load_robot("op3")), clock)
        assert start(robot, lambda: ServoBus.on_port(other, robot.servos, clock), link, clock) is None
        assert "expected" in link.text and "head_yaw" in link.text
        good = SimPort(SimBus(robot), clock)
        assert start(robot, lambda: ServoBus.on_port(good, robot.servos, clock), link, clock) is not None
        assert link.readiness is Readiness.READY
    finally:
        link.close()


def test_the_start_says_how_to_set_a_slow_adapters_timer(monkeypatch, caplog):
    monkeypatch.setattr("daemon.control.starting.latency_advice", lambda device: f"run: set {device}" if device else "")
    robot, clock = load_robot("reference"), VirtualClock()
    link = BusLink.create(robot.n_joints)
    port = SimPort(SimBus(robot), clock)
    port.device = "/dev/ttyUSB7"
    try:
        with caplog.at_level("WARNING", "daemon.control.starting"):
            assert start(robot, lambda: ServoBus.on_port(port, robot.servos, clock), link, clock) is not None
        assert "run: set /dev/ttyUSB7" in caplog.text and link.readiness is Readiness.READY
    finally:
        link.close()


class Running:
    """A streamer that runs by itself on a clock of its own; `begun_s` is when each of its cycles began."""

    def __init__(self, robot: RobotModel, link: BusLink, clock: VirtualClock, n_cycles: int) -> None:
        self.sim, self.begun_s = SimBus(robot), list[float]()
        bus_clock = VirtualClock()
        streamer = start(
            robot, lambda: ServoBus.on_port(SimPort(self.sim, bus_clock), robot.servos, bus_clock), link, clock
        )
        assert streamer is not None
        inner = streamer.cycle

        def cycle() -> None:
            self.begun_s.append(clock.now_s())
            inner()
            streamer.stopping = len(self.begun_s) == n_cycles

        streamer.cycle = cycle  # type: ignore[method-assign]
        self.streamer = streamer


def test_late_cycles_are_skipped_and_counted_not_made_up_for():
    class Slow(VirtualClock):
        def sleep_until(self, t_s: float) -> None:
            super().sleep_until(t_s + (0.055 if self.true_s < 0.5 <= t_s else 0.0))

    robot = load_robot("reference")
    link = BusLink.create(robot.n_joints)
    try:
        running = Running(robot, link, Slow(), n_cycles=100)
        running.streamer.run()
        record = link.cycles.since(link.cycles.count - 1)[0][0]
    finally:
        link.close()
    assert 4 <= record["late_cycles"] <= 6
    assert (np.diff(running.begun_s) >= robot.bus.period_s - 1e-9).all(), "never two cycles in one period"


@pytest.mark.parametrize(
    ("request_", "early"), [(BusRequest.ESTOP, True), (BusRequest.ESTOP_HOLD, False), (BusRequest.STOP, False)]
)
def test_an_e_stop_that_cuts_waits_for_no_cycle_and_braking_keeps_rate(request_, early):
    robot = load_robot("reference")
    period_s = robot.bus.period_s
    link = BusLink.create(robot.n_joints)

    class Asking(VirtualClock):
        def sleep_until(self, t_s: float) -> None:
            if self.true_s < 10.3 * period_s <= t_s:
                link.request(request_)
            super().sleep_until(t_s)

    try:
        running = Running(robot, link, Asking(), n_cycles=20)
        running.streamer.run()
    finally:
        link.close()
    between = np.diff(running.begun_s) / period_s
    assert np.allclose(np.delete(between, 10), 1.0)
    assert between[10] == pytest.approx(LOOK_S / period_s * 2 if early else 1.0)
