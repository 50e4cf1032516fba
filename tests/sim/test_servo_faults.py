"""Faults of simulated servos: latched errors, overload, heat, and the bus watchdog."""

from __future__ import annotations

import pytest

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.packet import ErrorCode
from sim.faults import Fault
from tests.support.servo_bench import Bench

# Latches.


@pytest.mark.parametrize("kind", ["overload", "hot"])
def test_a_latched_error_drops_torque_is_reported_and_needs_a_reboot(kind: str) -> None:
    b = Bench(faults=(Fault(kind, start_s=1.0),))
    b.write("torque_enable", 1)
    b.wait(1.1)
    answer = b.ask(packet.read(1, 64, 1))[0]
    assert answer.error == packet.ALERT_BIT and answer.parameters == b"\0"
    assert b.write("torque_enable", 1) == packet.ALERT_BIT | ErrorCode.RESULT_FAIL
    b.servo.drives.temperature_c[:] = 30
    b.ask(packet.reboot(1))
    b.wait(0.3)
    assert b.write("torque_enable", 1) == 0


def test_an_error_outside_the_shutdown_mask_alerts_but_keeps_torque() -> None:
    b = Bench(faults=(Fault("encoder", start_s=1.0),))
    b.write("torque_enable", 1)
    b.wait(1.1)
    assert b.ask(packet.ping(1))[0].error == packet.ALERT_BIT
    assert b.read("torque_enable") == 1 and b.read("hardware_error_status") == 8


def test_a_blocked_shaft_overloads_within_seconds() -> None:
    b = Bench(faults=(Fault("stuck", start_s=0.5),))
    b.write("torque_enable", 1)
    b.wait(0.6)
    b.write("goal_position", 3000)
    b.wait(1.0)
    assert b.read("torque_enable") == 1 and b.read("present_current") > 700
    b.wait(5.0)
    assert b.read("hardware_error_status") == 1 << 5 and b.read("torque_enable") == 0


@pytest.mark.long
def test_work_heats_a_servo_and_rest_cools_it() -> None:
    b = Bench(faults=(Fault("stuck", start_s=0.1, end_s=100.0),))
    b.write("current_limit", 400)  # 47 % of stall: no overload
    b.write("torque_enable", 1)
    b.wait(0.2)
    b.write("goal_position", 3000)
    b.wait(90.0)
    hot = b.read("present_temperature")
    assert hot > 30
    b.write("torque_enable", 0)
    b.wait(600.0)
    assert 25 <= b.read("present_temperature") < hot
    assert b.read("hardware_error_status") == 0


# Watchdog.


def test_the_watchdog_stops_it_refuses_goals_and_is_cleared_by_zero() -> None:
    b = Bench()
    for name, value in (("torque_enable", 1), ("bus_watchdog", 5), ("goal_position", 4000)):
        assert b.write(name, value) == 0
    b.wait(0.09)
    assert b.servo.get("bus_watchdog") == 5
    b.wait(0.3)
    stopped = b.read("present_position")
    assert 2048 < stopped < 3500 and b.read("bus_watchdog") == -1
    assert b.write("goal_position", 2048) == ErrorCode.DATA_RANGE
    b.wait(2.0)
    assert abs(b.read("present_position") - stopped) < 60, "it stays about where it was when the bus fell silent"
    assert b.write("bus_watchdog", 0) == 0
    assert b.write("goal_position", 2048) == 0


def test_any_instruction_feeds_the_watchdog_also_one_for_another() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    b.write("torque_enable", 1)
    b.write("bus_watchdog", 5)
    for _ in range(20):
        b.wait(0.05)
        b.ask(packet.ping(2))
    assert b.read("bus_watchdog") == 5


def test_the_watchdog_of_the_330_size_flags_but_does_not_stop() -> None:
    b = Bench("XL330-M288")
    for name, value in (("torque_enable", 1), ("bus_watchdog", 5), ("goal_position", 4000)):
        b.write(name, value)
    b.wait(1.0)
    assert b.read("bus_watchdog") == -1 and b.read("present_position") > 3900
    old = Bench(firmware={1: 37})
    for name, value in (("torque_enable", 1), ("bus_watchdog", 5), ("goal_position", 3000)):
        old.write(name, value)
    old.wait(2.0)
    assert old.read("bus_watchdog") == 5 and abs(old.read("present_position") - 3000) <= 3


def test_a_trip_moves_a_joint_with_homing_offset_in_extended_mode() -> None:
    """DynamixelSDK#584."""
    b = Bench()
    for name, value in (("operating_mode", 4), ("homing_offset", 200), ("torque_enable", 1), ("bus_watchdog", 5)):
        assert b.write(name, value) == 0
    before = b.read("present_position")
    b.wait(2.0)
    assert b.read("present_position") == pytest.approx(before + 200, abs=5)
