"""The servos behind real ttys: other people's drivers, several ports, unplug and replug, and the command."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from dynamixel_sdk import COMM_RX_TIMEOUT, COMM_SUCCESS, GroupSyncRead, PacketHandler, PortHandler

from daemon.dynamixel.codec import packet
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.ports.serial_port import SerialPort
from daemon.dynamixel.ports.tty_speed import tty_speed
from daemon.dynamixel.scan import scan
from daemon.errors import CommandError, LinkLostError, PortBaudError
from daemon.host.clock import RealClock
from daemon.host.realtime import BUS_PRIORITY, may_fifo
from retarget.robot.loading import load_robot
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from sim.pty import PtyServer
from sim.world import World
from tests.support.robots import packaged
from tests.support.sizes import few_and_long

pytestmark = pytest.mark.realtime

ROBOT = packaged("reference")
BAUD = ROBOT.bus.baud


@contextmanager
def serving(*servers: PtyServer) -> Iterator[None]:
    threads = [threading.Thread(target=s.serve) for s in servers]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        for server in servers:
            server.stop()
        for thread in threads:
            thread.join(5)
        for server in servers:
            server.close()


def until(what, seconds: float = 10.0) -> None:
    end_s = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end_s
        time.sleep(0.01)


def answered(port: SerialPort, servo_id: int) -> bool:
    """Whether a servo answers one of a few pings: a loaded machine may be late."""
    decoder = packet.PacketDecoder()
    for _ in range(10):
        port.write(packet.ping(servo_id))
        end_s = time.monotonic() + 0.3
        while time.monotonic() < end_s:
            if any(p.servo_id == servo_id for p in decoder.feed(port.read(100, 0.05))):
                return True
    return False


def test_the_stock_sdk_reads_groups_and_misses_who_is_silent(tmp_path: Path) -> None:
    faults = FaultSchedule((Fault("silent", servo_id=3),))
    with serving(PtyServer(SimBus(ROBOT, faults), tmp_path / "servos")):
        port, handler = PortHandler(str(tmp_path / "servos")), PacketHandler(2.0)
        assert port.openPort() and port.setBaudRate(BAUD)
        try:
            read = GroupSyncRead(port, handler, 132, 4)
            for servo_id in (1, 2, 4, 5):
                read.addParam(servo_id)
            until(lambda: read.txRxPacket() == COMM_SUCCESS)  # its 34 ms pass at once on a busy machine
            assert read.getData(1, 132, 4) == 2048
            assert handler.ping(port, 3)[1] == COMM_RX_TIMEOUT
            until(lambda: handler.reboot(port, 5) == (COMM_SUCCESS, 0))
            until(lambda: handler.broadcastPing(port)[1] == COMM_SUCCESS)
        finally:
            port.closePort()


def test_a_scan_finds_each_servo_once(tmp_path: Path) -> None:
    """16 servos of 8 were found: at 4,500,000 baud, which termios has no name for, the simulated servos answered as well."""
    robot = load_robot("op3")
    with serving(PtyServer(SimBus(robot), tmp_path / "servos")):

        def open_at(baud: int) -> SerialPort:
            return SerialPort(str(tmp_path / "servos"), baud)

        def found() -> list[tuple[int, int]]:
            result = scan(open_at, RealClock(), bauds=(4_500_000, 2_000_000, 57_600), protocols=(2.0,))
            return [(f.servo_id, f.baud) for f in result.found]

        until(lambda: found() == [(i, 2_000_000) for i in sorted(robot.servo_ids)])


def test_the_speed_of_a_tty_is_read_back(tmp_path: Path) -> None:
    with serving(PtyServer(SimBus(ROBOT), tmp_path / "servos")):
        for baud in (9600, 4_500_000, 57_142):
            port = SerialPort(str(tmp_path / "servos"), baud)
            assert tty_speed(port._fd) == baud
            port.close()


def test_a_speed_that_the_port_does_not_take_is_left_out_of_the_scan() -> None:
    clock = VirtualClock()

    def open_at(baud: int) -> Port:
        if baud == 4_500_000:
            raise PortBaudError("dxl:///dev/ttyUSB0", "baud 4500000 is not possible", "allowed: 57600")
        return SimPort(SimBus(load_robot("op3")), clock)

    result = scan(open_at, clock, bauds=(4_500_000, 2_000_000), protocols=(2.0,))
    assert result.impossible_bauds == (4_500_000,) and len(result.found) == 8


def test_rustypot_drives_the_servos(tmp_path: Path) -> None:
    rustypot = pytest.importorskip("rustypot", reason="rustypot is not installed (extra 'bench')")
    server = PtyServer(SimBus(ROBOT), tmp_path / "servos")
    with serving(server):
        driver = rustypot.Xl330PyController(str(tmp_path / "servos"), BAUD, 1.0)
        ids = [1, 2]  # the head: XL330
        assert driver.sync_read_present_position(ids) == pytest.approx([0.0, 0.262], abs=0.01)
        driver.sync_write_torque_enable(ids, [True, True])
        driver.sync_write_goal_position(ids, [0.2, 0.3])
        until(lambda: driver.sync_read_present_position(ids) == pytest.approx([0.2, 0.3], abs=0.02))
        assert driver.ping(1) and all(driver.sync_read_torque_enable(ids))


def test_two_ports_lead_to_one_robot(tmp_path: Path) -> None:
    world = World(ROBOT)
    halves = {"left": ROBOT.servo_ids[:8], "right": ROBOT.servo_ids[8:]}
    servers = [PtyServer(SimBus(ROBOT, world=world, servo_ids=ids), tmp_path / name) for name, ids in halves.items()]
    with serving(*servers):
        for name, ids in halves.items():
            port = SerialPort(str(tmp_path / name), BAUD)
            other = (set(ROBOT.servo_ids) - set(ids)).pop()
            port.write(packet.ping(other))
            assert port.read(100, 0.05) == b""
            assert answered(port, ids[0])
            port.close()


@pytest.mark.parametrize("other_path", few_and_long([True], [False, True]))
def test_unplugged_the_tty_is_gone_and_comes_back_as_another_one(tmp_path: Path, other_path: bool) -> None:
    link, again = tmp_path / "servos", tmp_path / ("other" if other_path else "servos")
    fault = Fault("unplug", start_s=0.4, end_s=0.8, path=str(again) if other_path else None)
    server = PtyServer(SimBus(ROBOT, FaultSchedule((fault,))), link)
    with serving(server):
        first = os.readlink(link)
        port = SerialPort(str(link), BAUD)
        assert answered(port, 1)
        with pytest.raises(LinkLostError, match="lost"):
            end_s = time.monotonic() + 10
            while time.monotonic() < end_s:
                port.write(packet.ping(1))
                port.read(100, 0.01)
        port.close()
        until(lambda: again.is_symlink() and server._master >= 0)
        assert other_path != link.is_symlink(), "the old link is gone when it comes back under another"
        assert os.readlink(again).startswith("/dev/pts/") and first.startswith("/dev/pts/")
        port = SerialPort(str(again), BAUD)
        assert answered(port, 1)
        port.close()
    assert not again.is_symlink()


def test_servos_nobody_talks_to_stop_by_their_watchdog_in_real_time(tmp_path: Path) -> None:
    bus = SimBus(ROBOT)
    with serving(PtyServer(bus, tmp_path / "servos")):
        servo = bus.servos[3]
        with bus.world.lock:
            servo.write(64, b"\1")
            servo.write(98, b"\5")
        until(lambda: servo.get("bus_watchdog") == -1)


def test_a_link_that_is_a_file_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "servos").write_text("mine")
    with pytest.raises(CommandError, match="is no link"):
        PtyServer(SimBus(ROBOT), tmp_path / "servos")
    assert (tmp_path / "servos").read_text() == "mine"


def run_sim(*arguments: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "daemon.cli", "sim", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.long
def test_the_command_serves_two_ports_names_its_faults_and_audits(tmp_path: Path) -> None:
    schedule, audit = tmp_path / "faults.toml", tmp_path / "audit.json"
    schedule.write_text('[[fault]]\nkind = "overload"\nservo_id = 2\n')
    links = [f"{tmp_path / 'left'}=1-8", f"{tmp_path / 'right'}=9-16"]
    process = run_sim("--port", *links, "--faults", str(schedule), "--audit", str(audit), "--latency-ms", "1")
    try:
        until(lambda: (tmp_path / "right").is_symlink() and (tmp_path / "left").is_symlink(), 30)
        port = SerialPort(str(tmp_path / "left"), BAUD)
        assert answered(port, 2)
        port.write(packet.write(3, 64, b"\1"))
        assert answered(port, 3)  # what is written into an answer is lost, as on a wire
        port.write(packet.write(3, 116, (4000).to_bytes(4, "little")))
        assert answered(port, 3)
        port.close()
        # Each thread that serves a port, as servos have processors of their own; at normal priority they answered late.
        policies = [os.sched_getscheduler(int(task.name)) for task in Path(f"/proc/{process.pid}/task").iterdir()]
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=20)
    finally:
        process.kill()
        process.communicate()
    report = json.loads(audit.read_text())
    assert process.returncode == 1, "a goal beyond the robot's limits"
    assert report["violations_by_kind"]["position"] == 1 and report["faults"] == {"overload": 1}
    assert "8 servos of 'reference' at 1000000 baud on" in out and "fault overload servo 2" in err
    may = may_fifo(BUS_PRIORITY)
    assert (policies.count(os.SCHED_FIFO) >= len(links)) == may and ("no real-time priority" in out) != may


def test_two_ports_cannot_come_back_under_one_link(tmp_path: Path, capsys) -> None:
    from daemon.cli import main

    schedule = tmp_path / "faults.toml"
    schedule.write_text('[[fault]]\nkind = "unplug"\nstart_s = 1.0\nend_s = 2.0\npath = "again"\n')
    ports = [f"{tmp_path / 'left'}=1-8", f"{tmp_path / 'right'}=9-16"]
    assert main(["sim", "--port", *ports, "--faults", str(schedule)]) in (1, 2)
    assert "two cannot come back under one link" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--body", "jelly"], "body = 'jelly'; allowed: plain, mujoco"),
        (["--latency-ms", "soon"], "latency_ms = 'soon'"),
        (["--port", "x=1-99"], "servo ids = 17, 18"),
        (["--pieces", "9-2"], "piece_bytes = (9, 2)"),
        (["--faults", "none.toml"], "none.toml: file: No such file"),
    ],
)
def test_the_command_refuses_what_cannot_be(arguments: list[str], said: str, capsys) -> None:
    from daemon.cli import main

    assert main(["sim", *arguments]) in (1, 2)
    assert said in capsys.readouterr().err
