import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from daemon.bench.tty_servos import served
from daemon.control.arming import WATCHDOG_UNITS
from daemon.control.starting import start
from daemon.dynamixel.bus_opening import open_bus
from daemon.dynamixel.registers.registers import WATCHDOG_TRIPPED, WATCHDOG_UNIT_S
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState, Readiness
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.pty import PtyServer
from tests.support.robots import packaged

pytestmark = pytest.mark.realtime

ROBOT = packaged("reference")


class BusProcess:
    """The real process; the test is its front."""

    def __init__(self, bus_url: str) -> None:
        self.link = BusLink.create(ROBOT.n_joints)
        command = [sys.executable, "-m", "daemon.control.process", "--robot", "reference"]
        command += ["--bus", bus_url, "--link", str(self.link.path)]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

    @property
    def state(self) -> BusState:
        self.link.heartbeat()
        n = self.link.cycles.count
        return BusState(int(self.link.cycles.since(n - 1)[0][0]["state"])) if n else BusState.LIMP

    def wait_for(self, what: Callable[[], bool]) -> None:
        end_s = time.monotonic() + 30
        while not what():
            assert time.monotonic() < end_s, (self.state, self.link.text)
            self.link.heartbeat()
            time.sleep(0.01)

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()
        self.link.close()


@pytest.fixture
def started():
    processes: list[BusProcess] = []

    def make(url: str) -> BusProcess:
        processes.append(BusProcess(url))
        return processes[-1]

    yield make
    for process in processes:
        process.close()


@pytest.fixture
def servos(tmp_path):
    """The simulated robot behind a real tty."""
    with served(PtyServer(SimBus(ROBOT), tmp_path / "servos")) as server:
        yield server


@pytest.mark.long
def test_it_says_when_it_has_the_robot_and_what_rights_it_got(started):
    bus = started("sim://")
    bus.wait_for(lambda: bus.link.readiness is Readiness.READY and bus.link.cycles.count > 3)
    assert bus.state is BusState.LIMP
    assert all(isinstance(right, bool) for right in bus.link.has_realtime)
    os.kill(bus.process.pid, signal.SIGINT)  # Ctrl-C is the front's to handle
    before = bus.link.cycles.count
    bus.wait_for(lambda: bus.link.cycles.count > before + 5)
    bus.link.request(BusRequest.SHUTDOWN)
    assert bus.process.wait(10) == 0


@pytest.mark.long
@pytest.mark.parametrize(
    ("url", "says", "readiness"),
    [
        ("dxl:///dev/ttyNOSUCH?baud=1000000", "ttyNOSUCH", Readiness.FAILED),
        ("usb://x", "unknown scheme", Readiness.REFUSED),
        ("sim://?baud=57600", "57600 baud", Readiness.FAILED),
    ],
)
def test_it_says_why_it_has_no_robot(started, url, says, readiness):
    bus = started(url)
    assert bus.process.wait(30) == 1
    assert bus.link.readiness is readiness
    assert says in bus.link.text
    assert "Traceback" not in bus.process.stderr.read()


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("sim://?body=foo", "body = 'foo'"),
        ("sim://?baud=abc", "baud 'abc'"),
        ("sim://?faults=missing.toml", "missing.toml"),
    ],
)
def test_an_option_that_the_bus_cannot_have_is_refused(url, says):
    """In this process: a refusal ends the daemon with status 2 (tests/daemon/cli/test_first_hour.py)."""
    link, clock = BusLink.create(ROBOT.n_joints, ROBOT.n_servos), VirtualClock()
    try:
        assert start(ROBOT, lambda: open_bus(url, ROBOT, clock), link, clock) is None
        assert link.readiness is Readiness.REFUSED and says in link.text
    finally:
        link.close()


def test_killed_while_armed_the_servos_stop_by_their_watchdog(started, servos, tmp_path):
    """Nobody is left to brake: within the stated time every servo stands, and takes no goal until it is armed anew."""
    bus = started(f"dxl://{tmp_path}/servos?baud=1000000")
    bus.wait_for(lambda: bus.link.readiness is Readiness.READY)
    bus.link.request(BusRequest.ARM)
    bus.wait_for(lambda: bus.state is BusState.HOLDING)
    bus.process.kill()
    bus.process.wait(10)
    simulated = list(servos.bus.servos.values())
    end_s = time.monotonic() + 30  # by watchdogs of 0.2 s, on a machine that may have much else to do
    while not all(s.memory.get("bus_watchdog") == WATCHDOG_TRIPPED for s in simulated):
        assert time.monotonic() < end_s, [s.servo_id for s in simulated if not s.watchdog_tripped]
        time.sleep(0.01)
    stands_tick = [round(s.position_tick) for s in simulated]
    time.sleep(0.1)
    assert [round(s.position_tick) for s in simulated] == stands_tick
    assert servos.bus.audit.report()["violations"] == 0

    again = started(f"dxl://{tmp_path}/servos?baud=1000000")
    again.wait_for(lambda: again.link.readiness is Readiness.READY and again.link.cycles.count > 3)
    assert again.state is BusState.FAULT, "a new process arms nothing by itself, and calls nothing limp that has torque"
    assert "torque" in again.link.text and "mmmd reset" in again.link.text
    again.link.request(BusRequest.RESET)
    again.wait_for(lambda: again.state is BusState.LIMP)
    again.link.request(BusRequest.ARM)
    again.wait_for(lambda: again.state is BusState.HOLDING)
    again.link.request(BusRequest.PARK)
    again.wait_for(lambda: again.state is BusState.LIMP)
    assert servos.bus.audit.report()["violations"] == 0, servos.bus.audit.report()["details"]
    assert not any(s.torque for s in servos.bus.servos.values())


@pytest.mark.long
def test_frozen_while_armed_it_comes_back_in_a_named_fault(started, servos, tmp_path):
    bus = started(f"dxl://{tmp_path}/servos?baud=1000000")
    bus.wait_for(lambda: bus.link.readiness is Readiness.READY)
    bus.link.request(BusRequest.ARM)
    bus.wait_for(lambda: bus.state is BusState.HOLDING)
    os.kill(bus.process.pid, signal.SIGSTOP)
    time.sleep(2 * WATCHDOG_UNITS * WATCHDOG_UNIT_S)
    bus.link.heartbeat()
    os.kill(bus.process.pid, signal.SIGCONT)
    bus.wait_for(lambda: bus.state is BusState.FAULT)
    assert "held up" in bus.link.text and "watchdog" in bus.link.text
    assert servos.bus.audit.report()["violations"] == 0, servos.bus.audit.report()["details"]


@pytest.mark.long
def test_sigterm_leaves_the_servos_without_torque(started, servos, tmp_path: Path):
    bus = started(f"dxl://{tmp_path}/servos?baud=1000000")
    bus.wait_for(lambda: bus.link.readiness is Readiness.READY)
    bus.link.request(BusRequest.ARM)
    bus.wait_for(lambda: bus.state is BusState.HOLDING)
    bus.process.terminate()
    assert bus.process.wait(10) == 0
    end_s = time.monotonic() + 5
    while any(s.torque for s in servos.bus.servos.values()) and time.monotonic() < end_s:
        time.sleep(0.01)
    assert not any(s.torque for s in servos.bus.servos.values())
