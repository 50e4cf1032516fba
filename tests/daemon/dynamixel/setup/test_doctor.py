"""The doctor and the checks of servo settings: findings, remedies, corrections on request."""

from __future__ import annotations

from dataclasses import replace

import pytest

from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.registers.rules import ADVISED, NEEDED
from daemon.dynamixel.setup.checks import check_servos, fix, require_needed
from daemon.dynamixel.setup.doctor import BAD, GOOD, diagnose
from daemon.errors import BusMismatchError, CommandError, PortMissingError
from retarget.robot.loading import load_robot
from sim.clock import VirtualClock
from tests.support.factory_bus import ROBOT, wired
from tests.support.servo_emulator import FakePort, FakeServo

pytestmark = pytest.mark.realtime


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
