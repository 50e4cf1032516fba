"""What the tools are made of: scan, single servos with guards, checks and their fixes, doctor, adapter, calibration."""

from __future__ import annotations

import os
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from daemon.cli import main
from daemon.dynamixel.ports.adapter import (
    Adapter,
    adapter_at,
    device_of,
    latency_advice,
    latency_remedy,
    latency_timer_ms,
)
from daemon.dynamixel.ports.serial_port import SerialPort
from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS
from daemon.dynamixel.registers.rules import ADVISED, NEEDED
from daemon.dynamixel.scan import scan
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.calibration import Ranges, calibrate, write_robot_file
from daemon.dynamixel.setup.checks import check_servos, fix, require_needed
from daemon.dynamixel.setup.doctor import BAD, GOOD, diagnose
from daemon.dynamixel.setup.single_servo import find
from daemon.errors import BusMismatchError, CommandError, LinkLostError, LinkTimeoutError, PortMissingError
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.port import SimPort
from sim.pty import PtyServer
from tests.support.robots import packaged
from tests.support.servo_emulator import FakePort, FakeServo, fake

pytestmark = pytest.mark.realtime

ROBOT = packaged("reference")


def wired(robot: RobotModel = ROBOT) -> tuple[ServoBus, FakePort, VirtualClock]:
    """A robot's servos as the factory made them, on a bus."""
    clock = VirtualClock()
    servos = [FakeServo(MODELS[s.model.model_number], s.servo_id) for s in robot.servos]
    for s in servos:
        s.set("present_input_voltage", 50 if s.model.name.startswith("XL330") else 120)
        s.set("present_temperature", 30)
        s.set("present_position", 2048)
    port = FakePort(clock, servos, robot.bus.baud)
    bus = ServoBus.on_port(port, robot.servos, clock)
    bus.verify()
    return bus, port, clock


# Scan.


def test_a_scan_finds_every_servo_at_its_baud_and_in_its_protocol() -> None:
    clock = VirtualClock()
    at = {57_600: ("XL330-M288", "XM430-W350"), 1_000_000: ("AX-12A", "MX-28", "2XL430-W250")}
    seen: list[tuple[int, float, float]] = []

    def open_at(baud: int) -> FakePort:
        servos = [FakeServo(MODELS[MODEL_NUMBERS[n]], 3 * i) for i, n in enumerate(at.get(baud, ()), 1)]
        return FakePort(clock, servos, baud)

    result = scan(open_at, clock, bauds=(57_600, 115_200, 1_000_000), on_progress=lambda *a: seen.append(a))
    assert [(f.baud, f.protocol, f.servo_id, f.model_name) for f in result.found] == [
        (57_600, 2.0, 3, "XL330-M288"), (57_600, 2.0, 6, "XM430-W350"), (1_000_000, 2.0, 9, "2XL430-W250"),
        (1_000_000, 1.0, 3, "AX-12A"), (1_000_000, 1.0, 6, "MX-28"),
    ]  # fmt: skip
    assert {f.firmware for f in result.found} == {52} and result.garbled_bauds == ()
    assert seen[0] == (57_600, 2.0, 0.0) and seen[-1] == (1_000_000, 1.0, 1.0)
    assert clock.now_s() < 40


def test_two_servos_with_one_id_are_seen_in_a_scan() -> None:
    far, _, clock = fake("XM430-W350", "XM430-W350")
    far.servos[2].doubled = True
    result = scan(lambda _baud: far, clock, bauds=(1_000_000,), protocols=(2.0,))
    assert [f.servo_id for f in result.found] == [1, 2] and result.garbled_bauds == (1_000_000,)


# Single servos.


def test_settings_are_written_read_back_and_guarded() -> None:
    far, _, clock = fake("XM430-W350", "AX-12A")
    one, old = find(far, clock, 1), find(far, clock, 2)
    assert (one.model.name, old.model.name, old.firmware) == ("XM430-W350", "AX-12A", 52)
    one.set("return_delay_time", 0)
    old.set("punch", 40)
    assert far.servos[1].get("return_delay_time") == 0 and far.servos[2].get("punch") == 40
    for servo, item, value, said in (
        (one, "goal_position", 5, "the daemon's alone"), (one, "torque_enable", 1, "the daemon's alone"),
        (one, "bus_watchdog", 10, "the daemon's alone"),
        (one, "shutdown", 200, r"outside \[0, 63\] of XM430-W350"), (one, "id", 5, "mmmd servo id"),
        (one, "baud_rate", 3, "mmmd servo baud"), (one, "elan", 3, "no item 'elan'"), (old, "moving_speed", 9, "the daemon's"),
        (one, "present_position", 3, "read only"),
    ):  # fmt: skip
        with pytest.raises(CommandError, match=said):
            servo.set(item, value)
    far.servos[1].set("torque_enable", 1)
    with pytest.raises(CommandError, match=r"only with torque off.*mmmd park"):
        one.set("return_delay_time", 5)
    with pytest.raises(CommandError, match="lets its joint fall"):
        one.reboot(drop=False)
    one.reboot(drop=True)
    with pytest.raises(CommandError, match="knows no reboot"):
        old.reboot(drop=True)
    with pytest.raises(LinkTimeoutError, match="mmmd scan"):
        find(far, clock, 77)


@pytest.mark.parametrize(
    ("servo_id", "item", "value"), [(1, "torque_enable", 0), (2, "torque_enable", 0), (2, "torque_limit", 99)]
)
def test_a_joint_that_is_held_is_let_go_only_when_it_is_said(servo_id: int, item: str, value: int) -> None:
    """`mmmd servo set 3 torque_enable 0` dropped an arm, which `reboot` refuses to do unasked."""
    far, _, clock = fake("XM430-W350", "AX-12A")
    one, there = find(far, clock, servo_id), far.servos[servo_id]
    if servo_id == 2:
        there.set("torque_limit", 500)
    there.set("torque_enable", 1)
    before = there.get(item)
    with pytest.raises(CommandError, match=rf"holds torque: '{item}' = {value} lets its joint fall; --drop"):
        one.set(item, value)
    assert there.get(item) == before
    one.set(item, value, drop=True)
    assert there.get(item) == value
    there.set("torque_enable", 0)
    one.set(item, 0)


def test_an_id_is_changed_only_when_it_is_free_and_the_new_one_answers() -> None:
    far, _, clock = fake("XM430-W350", "XM430-W350")
    with pytest.raises(CommandError, match="id 2 is taken"):
        find(far, clock, 1).set_id(2)
    with pytest.raises(CommandError, match="allowed are 0 to 252"):
        find(far, clock, 1).set_id(253)
    find(far, clock, 1).set_id(7)
    assert find(far, clock, 7).get("id") == 7
    with pytest.raises(LinkTimeoutError):
        find(far, clock, 1)


@pytest.mark.parametrize("servo_id", [1, 3])
def test_an_id_is_changed_and_a_reboot_waited_for_on_simulated_servos(servo_id: int) -> None:
    clock = VirtualClock()
    port = SimPort(SimBus(ROBOT), clock)
    find(port, clock, servo_id).set_id(40)
    one = find(port, clock, 40)
    one.set("led", 1)
    one.reboot(drop=False)
    assert one.get("led") == 0 and clock.now_s() < 1.0, "it is back, and its RAM is as after power on"


@pytest.mark.parametrize("kind", ["id", "baud"])
def test_a_servo_that_confirms_as_its_new_self_is_looked_for_there(kind: str) -> None:
    """Some answer a new id or baud at once under it: no answer comes from the servo that was asked."""
    far, _, clock = fake("XM430-W350")
    one = find(far, clock, 1)
    far.spoil = lambda raw, _servo_id: b"" if far.writes[-1][7] == 3 else raw
    if kind == "id":
        one.set_id(7)
        assert find(far, clock, 7).get("id") == 7
    else:
        one.set_baud(2_000_000)
        assert far.servos[1].get("baud_rate") == 4


def test_a_baud_that_the_model_has_not_is_refused() -> None:
    far, _, clock = fake("XL330-M288", "AX-12A")
    with pytest.raises(CommandError, match="no 4500000 baud"):
        find(far, clock, 1).set_baud(4_500_000)
    find(far, clock, 1).set_baud(2_000_000)
    find(far, clock, 2).set_baud(500_000)
    assert far.servos[1].get("baud_rate") == 4 and far.servos[2].get("baud_rate") == 3


# Checks.


def test_wrong_settings_are_found_and_corrected_only_on_request() -> None:
    bus, port, _ = wired()
    s = port.servos
    s[1].set("operating_mode", 1)
    s[2].set("status_return_level", 1)
    s[3].set("drive_mode", 5)
    s[4].set("shutdown", 0)
    s[5].set("min_position_limit", 1800)
    s[6].set("return_delay_time", 250)
    before = {i: bytes(servo.memory) for i, servo in s.items()}
    findings = check_servos(bus, ROBOT)
    assert {i: bytes(servo.memory) for i, servo in s.items()} == before, "looking changes nothing"
    needed = {(f.servo_id, f.item) for f in findings if f.severity == NEEDED}
    assert needed == {(1, "operating_mode"), (2, "status_return_level"), (3, "drive_mode"), (5, "min_position_limit")}
    advised = {(f.servo_id, f.item) for f in findings if f.severity == ADVISED}
    assert {(4, "shutdown"), (6, "return_delay_time"), (7, "max_position_limit")} <= advised
    with pytest.raises(BusMismatchError) as caught:
        require_needed(findings)
    assert "operating_mode 3 (position)" in str(caught.value) and "mmmd doctor --fix" in str(caught.value)
    assert fix(bus, check_servos(bus, ROBOT)) == []
    assert check_servos(bus, ROBOT) == []
    require_needed(())
    assert s[3].get("drive_mode") == 0 and s[4].get("shutdown") == 0b100100


def test_nothing_is_corrected_under_torque() -> None:
    bus, port, _ = wired()
    port.servos[3].set("torque_enable", 1)
    port.servos[3].set("return_delay_time", 9)
    with pytest.raises(CommandError, match="servo 3: torque is on; park"):
        fix(bus, check_servos(bus, ROBOT))
    assert port.servos[3].get("return_delay_time") == 9


def test_what_only_a_person_can_do_is_left() -> None:
    bus, port, _ = wired()
    fix(bus, check_servos(bus, ROBOT))
    port.servos[3].set("hardware_error_status", 0b100)
    port.servos[4].set("present_input_voltage", 90)
    port.servos[5].set("present_temperature", 75)
    left = {(f.servo_id, f.item): f for f in fix(bus, check_servos(bus, ROBOT))}
    assert left[3, "hardware_error_status"].remedy == "mmmd servo reboot 3"
    assert left[4, "present_input_voltage"].found == "9.0 V"
    assert (5, "present_temperature") in left and len(left) == 3


# Doctor.


@pytest.mark.parametrize("level", [0, 1])
@pytest.mark.parametrize("name", ["reference", "op2"])
def test_the_doctor_lets_servos_answer_before_it_writes_anything_else(name: str, level: int) -> None:
    """At level 1 the return delay was written first, and not confirmed: "check its cable and power"; at 0 nothing was read."""
    robot = load_robot(name)
    bus, port, clock = wired(robot)
    fix(bus, check_servos(bus, robot))
    for servo_id in robot.servo_ids[1:3]:
        port.servos[servo_id].set("status_return_level", level)
        port.servos[servo_id].set("return_delay_time", 250)
    seen = diagnose(robot, lambda: [port], clock)
    rows = [c for c in seen.checks if c.verdict == BAD and f"servo {robot.servo_ids[1]} " in c.what]
    assert len(rows) == 1 and "status" in rows[0].what + rows[0].found
    if not level:
        assert any("mmmd doctor --fix" in c.remedy for c in seen.checks)
    port.unplugged = False
    mended = diagnose(robot, lambda: [port], clock, correct=True)
    assert not mended.bad, mended
    for servo_id in robot.servo_ids:
        assert port.servos[servo_id].get("status_return_level") == 2
        assert port.servos[servo_id].get("return_delay_time") == 0


def test_a_servo_that_the_robot_file_does_not_name_is_mentioned() -> None:
    bus, port, clock = wired()
    fix(bus, check_servos(bus, ROBOT))
    port.servos[77] = FakeServo(MODELS[1020], 77)
    seen = diagnose(ROBOT, lambda: [port], clock)
    assert not seen.bad
    (row,) = [c for c in seen.checks if c.what == "servo 77 (no joint) id"]
    assert row.found == "XM430-W350 (model 1020), firmware 52" and "take it off the bus" in row.remedy


def test_the_doctor_names_everything_with_its_remedy() -> None:
    _bus, port, clock = wired()
    port.servos[3].set("operating_mode", 1)
    port.servos[4].set("return_delay_time", 250)
    found = diagnose(ROBOT, lambda: [port], clock)
    by_what = {c.what: c for c in found.checks}
    assert by_what["servo 3 (waist_yaw) operating_mode"].verdict == BAD
    assert "mmmd servo set 3 operating_mode 3" in by_what["servo 3 (waist_yaw) operating_mode"].remedy
    assert "--fix" in by_what["servo 4 (waist_pitch) return_delay_time"].remedy
    assert found.bad and any("return delay" in line for line in found.budget)
    port.unplugged = False
    again = diagnose(ROBOT, lambda: [port], clock, correct=True)
    assert not again.bad, again
    assert {c.what: c for c in again.checks}["settings"].verdict == GOOD
    port.unplugged = False
    port.servos[3].silent = True
    gone = diagnose(ROBOT, lambda: [port], clock)
    assert gone.bad and any(c.what == "servo 3 (waist_yaw)" and "no answer" in c.found for c in gone.checks)


def test_the_doctor_says_when_a_rate_is_impossible_or_the_port_missing() -> None:
    _bus, port, clock = wired()
    robot = replace(ROBOT, bus=replace(ROBOT.bus, rate_hz=900.0))
    rate = next(c for c in diagnose(robot, lambda: [port], clock).checks if c.what == "rate")
    assert rate.verdict == BAD and "impossible" in rate.found and "baud" in rate.remedy

    def missing() -> list[FakePort]:
        raise PortMissingError("dxl:///dev/x", "no device '/dev/x'", "plug the adapter in")

    last = diagnose(ROBOT, missing, clock).checks[-1]
    assert (last.verdict, last.remedy) == (BAD, "plug the adapter in")


def test_the_doctor_looks_at_every_port() -> None:
    clock = VirtualClock()
    _, whole, _ = wired()
    halves = [FakePort(clock, [s for i, s in whole.servos.items() if i % 2 == n], ROBOT.bus.baud) for n in (0, 1)]
    found = diagnose(ROBOT, lambda: halves, clock, correct=True)
    assert not found.bad, found
    assert [c.what for c in found.checks].count("port") == 2
    assert "all 16 answer" in next(c.found for c in found.checks if c.what == "servos")


# Adapter.


def sysfs(root: Path, tty: str, serial: str, latency: str = "16") -> None:
    """What Linux shows of an FTDI adapter."""
    usb = root / "devices" / f"usb-{tty}-{serial}"
    port = usb / "1.0" / tty
    port.mkdir(parents=True, exist_ok=True)
    for name, text in (("idVendor", "0403"), ("idProduct", "6014"), ("serial", serial)):
        (usb / name).write_text(text + "\n")
    (port / "latency_timer").write_text(latency + "\n")
    link = root / "class" / "tty" / tty
    link.mkdir(parents=True)
    (link / "device").symlink_to(port)


def test_an_adapter_is_known_again_under_another_path(tmp_path: Path) -> None:
    sysfs(tmp_path, "ttyUSB0", "FT1")
    sysfs(tmp_path, "ttyUSB1", "FT2", "1")
    mine = adapter_at("/dev/ttyUSB0", tmp_path)
    assert mine == Adapter("0403", "6014", "FT1")
    assert device_of(mine, tmp_path) == "/dev/ttyUSB0"
    (tmp_path / "class" / "tty" / "ttyUSB0" / "device").unlink()
    assert device_of(mine, tmp_path) is None
    sysfs(tmp_path, "ttyUSB7", "FT1")
    assert device_of(mine, tmp_path) == "/dev/ttyUSB7"
    assert device_of(Adapter("0403", "6014", ""), tmp_path) is None, "without a serial number they are all alike"
    assert latency_timer_ms("/dev/ttyUSB1", tmp_path) == 1 and latency_timer_ms("/dev/ttyUSB7", tmp_path) == 16
    assert latency_timer_ms("/dev/pts/3", tmp_path) is None and adapter_at("/dev/pts/3", tmp_path) is None
    assert "echo 1 | sudo tee /sys/class/tty/ttyUSB7/device/latency_timer" in latency_remedy("/dev/ttyUSB7")
    assert latency_advice("/dev/ttyUSB1", tmp_path) == latency_advice("/dev/pts/3", tmp_path) == ""
    advice = latency_advice("/dev/ttyUSB7", tmp_path)
    assert "up to 16 ms" in advice and latency_remedy("/dev/ttyUSB7") in advice


def test_a_lost_tty_is_opened_again_where_its_link_leads_now(tmp_path: Path) -> None:
    link = tmp_path / "servos"

    def serve() -> tuple[PtyServer, threading.Thread]:
        server = PtyServer(SimBus(ROBOT), link)
        thread = threading.Thread(target=server.serve)
        thread.start()
        return server, thread

    def end(server: PtyServer, thread: threading.Thread) -> None:
        server.stop()
        thread.join(5)
        server.close()

    server, thread = serve()
    port = SerialPort(str(link), ROBOT.bus.baud)
    end(server, thread)
    with pytest.raises(LinkLostError):
        for _ in range(3):
            port.write(b"\0")
            port.read(1, 0.01)
    with pytest.raises(LinkLostError, match="still lost"):
        port.reopen()
    server, thread = serve()
    try:
        port.reopen()
        port.write(b"\xff\xff\xfd\x00\x01\x03\x00\x01\x19\x4e")
        assert len(port.read(14, 2.0)) == 14
        with pytest.raises(Exception, match=f"process {os.getpid()}"):
            SerialPort(str(link), ROBOT.bus.baud)
        port.close()
        with pytest.raises(LinkLostError, match="closed"):
            port.reopen()
    finally:
        end(server, thread)


# Calibration.


def test_positions_are_unwrapped_over_the_turn() -> None:
    ranges = Ranges(np.array([4000, 100, 500], np.int32), np.array([4096, 4096, 1 << 30], np.int32))
    ok = np.ones(3, bool)
    for tick in ((4090, 10, 1023), (20, 4090, 0), (200, 4000, 400)):
        ranges.update(np.array(tick, np.int32), ok)
    assert ranges.tick.tolist() == [4296, -96, 400]
    assert ranges.low.tolist() == [4000, -96, 0] and ranges.high.tolist() == [4296, 100, 1023]
    ranges.update(np.array([0, 0, 0], np.int32), np.zeros(3, bool))
    assert ranges.tick.tolist() == [4296, -96, 400], "who does not answer stays where he was"


def test_calibration_writes_zero_and_range_of_what_was_moved(tmp_path: Path) -> None:
    bus, port, _ = wired()
    for s in port.servos.values():
        s.set("torque_enable", 1)
    rows = {name: i for i, name in enumerate(ROBOT.joint_names)}
    waist, elbow, knob = (port.servos[ROBOT.servo_ids[rows[n]]] for n in ("waist_yaw", "left_elbow", "head_yaw"))

    def zero(follow) -> None:
        assert not any(s.get("torque_enable") for s in port.servos.values()), "limp before anything is asked of hands"
        waist.set("present_position", 2100)
        knob.set("present_position", 4000)
        follow()

    def ends(follow) -> None:
        for tick in (1600, 2100, 2600):
            waist.set("present_position", tick)
            follow()
        for tick in (4090, 80, 300, 4090, 3900):
            knob.set("present_position", tick)
            follow()

    found = {c.joint_name: c for c in calibrate(bus, ROBOT, wait_zero=zero, wait_range=ends)}
    c = found["waist_yaw"]
    assert c.zero_tick == 2100 and (c.low_deg, c.high_deg) == (-41.9, 41.9) and not c.problem
    assert found["left_elbow"].low_deg is None and elbow.get("present_position") == found["left_elbow"].zero_tick
    assert "crosses the end" in found["head_yaw"].problem and "homing_offset -1024" in found["head_yaw"].problem
    for name in ("robot.xml", "robot.toml"):
        (tmp_path / name).write_text((ROBOT.path.parent / name).read_text("utf-8"), "utf-8")
    robot, out = load_robot(str(tmp_path)), tmp_path / "mine.toml"
    write_robot_file(robot, [found["waist_yaw"], found["left_elbow"]], out)
    new = load_robot(str(out))
    joint = new.joints[rows["waist_yaw"]]
    assert new.servos[rows["waist_yaw"]].zero_tick == 2100
    assert np.rad2deg([joint.position_min_rad, joint.position_max_rad]).round(1).tolist() == [-41.9, 41.9]
    assert new.joints[rows["left_elbow"]] == ROBOT.joints[rows["left_elbow"]], "its range stays"
    assert out.read_text("utf-8").splitlines()[0].startswith("#"), "comments stay"


def test_answers_that_are_lost_become_no_zero_and_a_silent_servo_is_named() -> None:
    bus, port, _ = wired()
    waist, lost = port.servos[3], [True] * 4

    def zero(_follow) -> None:
        waist.set("present_position", 2100)
        port.spoil = lambda raw, _servo_id: b"" if lost and lost.pop() else raw

    found = calibrate(bus, ROBOT, wait_zero=zero, wait_range=lambda _follow: None)
    assert not lost and found[2].zero_tick == 2100
    with pytest.raises(CommandError, match="servo 3 does not answer"):
        calibrate(bus, ROBOT, wait_zero=lambda _follow: setattr(waist, "silent", True), wait_range=lambda _follow: None)


def test_a_calibration_that_makes_no_valid_file_is_not_kept(tmp_path: Path) -> None:
    bus, _, _ = wired()
    found = calibrate(bus, ROBOT, wait_zero=lambda follow: None, wait_range=lambda follow: None)
    for name in ("robot.xml", "robot.toml"):
        (tmp_path / name).write_text((ROBOT.path.parent / name).read_text("utf-8"), "utf-8")
    robot = load_robot(str(tmp_path))
    before = robot.path.read_text("utf-8")
    bad = [replace(c, zero_tick=4095) for c in found]
    with pytest.raises(CommandError, match="no valid robot file"):
        write_robot_file(robot, bad, robot.path)
    assert robot.path.read_text("utf-8") == before
    with pytest.raises(CommandError, match="no valid robot file"):
        write_robot_file(robot, bad, tmp_path / "other.toml")
    assert not (tmp_path / "other.toml").exists()


# Commands.


def test_a_servo_is_given_another_baud_and_heard_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    server = PtyServer(SimBus(ROBOT), tmp_path / "servos")
    thread = threading.Thread(target=server.serve)
    thread.start()
    url = f"dxl://{tmp_path}/servos?baud="
    try:
        assert main(["servo", "baud", "3", "57600", "--bus", url + "1000000"]) == 0
        assert "its baud is now 57600; it answers there" in capsys.readouterr().out
        assert main(["servo", "get", "3", "id", "--bus", url + "1000000"]) == 1
        assert f"at 1000000 baud on {url}1000000" in capsys.readouterr().err, "the URL as it was given"
    finally:
        server.stop()
        thread.join(5)
        server.close()


@pytest.mark.parametrize("name", ["scan", "doctor", "servo", "calibrate"])
def test_every_tool_says_how_to_use_it(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--help"]) == 0
    assert "Example" in capsys.readouterr().out


def test_the_tools_on_simulated_servos(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["servo", "get", "3", "present_temperature", "--bus", "sim://", "--json"]) == 0
    assert '"present_temperature": ' in capsys.readouterr().out
    assert main(["servo", "set", "3", "led", "1", "--bus", "sim://"]) == 0
    assert main(["servo", "set", "3", "led", "--bus", "sim://"]) == 2
    assert main(["servo", "id", "3", "x", "--bus", "sim://"]) == 2
    assert main(["calibrate", "--bus", "sim://"]) == 2
    assert "--limp" in capsys.readouterr().err
    assert main(["doctor", "--bus", "sim://", "--json"]) == 0
    assert '"rate"' in capsys.readouterr().out
    assert main(["doctor", "--bus", "dxl:///dev/ttyNONE"]) == 1
    assert main(["scan", "/dev/ttyNONE"]) == 1
    assert main(["scan", "/dev/ttyNONE", "--protocol", "3.0"]) == 2
