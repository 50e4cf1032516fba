"""Simulated DYNAMIXEL-Y and -P over their wire: where they are not like X."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.packet import ErrorCode
from sim.bodies.motors import MOTORS
from sim.faults import Fault
from tests.support.servo_bench import Bench

Y, P = "YM070-210-R099-RH", "PH42-020-S300-R"
BOTH = pytest.mark.parametrize("name", [Y, P])


@pytest.mark.parametrize(
    ("name", "item", "value", "torque", "error"),
    [
        (Y, "goal_position", 262145, False, ErrorCode.DATA_LIMIT),
        (Y, "goal_velocity", 2021, False, ErrorCode.DATA_LIMIT),
        (Y, "goal_pwm", 1001, False, ErrorCode.DATA_RANGE),
        (Y, "operating_mode", 2, False, ErrorCode.DATA_RANGE),
        (Y, "profile_velocity", 2021, False, ErrorCode.DATA_LIMIT),
        (Y, "return_delay_time", 5, True, ErrorCode.ACCESS),
        (Y, "error_code", 0, False, ErrorCode.ACCESS),
        (P, "goal_position", -303455, False, ErrorCode.DATA_LIMIT),
        (P, "goal_pwm", 2010, False, ErrorCode.DATA_RANGE),
        (P, "operating_mode", 5, False, ErrorCode.DATA_RANGE),
        (P, "profile_acceleration", 10766, False, ErrorCode.DATA_LIMIT),
        (P, "homing_offset", 5, True, ErrorCode.ACCESS),
    ],
)  # fmt: skip
def test_each_mistake_earns_its_error_and_changes_nothing(
    name: str, item: str, value: int, torque: bool, error: int
) -> None:
    b = Bench(name)
    assert b.write("torque_enable", int(torque)) == 0
    before = b.read(item)
    assert b.write(item, value) == error and b.read(item) == before


@BOTH
def test_indirect_addresses_are_written_without_torque_and_kept(name: str) -> None:
    b = Bench(name)
    start = 256 if name == Y else 168
    wanted = [b.servo.items["present_position"].address + i for i in range(4)]
    data = b"".join(a.to_bytes(2, "little") for a in wanted)
    assert b.ask(packet.write(1, start, data))[0].error == 0
    b.ask(packet.reboot(1))
    b.wait(0.3)
    b.servo.position_tick = 1234
    shown = b.ask(packet.read(1, 634, 4))[0].parameters
    assert int.from_bytes(shown, "little", signed=True) == 1234
    assert b.write("torque_enable", 1) == 0
    assert b.ask(packet.write(1, start, data))[0].error == ErrorCode.ACCESS


def test_a_p_shows_its_ram_alone_through_indirect_addresses() -> None:
    b = Bench(P)
    assert b.ask(packet.write(1, 168, (31).to_bytes(2, "little")))[0].error == ErrorCode.DATA_RANGE


def test_a_y_keeps_gains_profile_and_turns_over_a_reboot() -> None:
    b = Bench(Y)
    b.servo.position_tick = 524288 + 1000
    assert b.write("torque_enable", 1) == 0
    assert b.write("position_p_gain", 1583185) == 0
    b.write("torque_enable", 0)
    b.ask(packet.reboot(1))
    b.wait(0.3)
    assert b.read("position_p_gain") == 1583185 and b.read("profile_velocity") == 0
    assert b.read("present_position") == 525288
    b.servo.restore_factory(keep=("id", "baud_rate"))
    assert (b.read("position_p_gain"), b.read("profile_velocity")) == (6283185, 2020)


def test_a_p_forgets_whole_turns_and_counts_from_the_middle() -> None:
    b = Bench(P)
    for tick, after in ((-1000, -1000), (607500 + 2000, 2000), (-303000 - 607500, -303000)):
        b.servo.position_tick = tick
        b.ask(packet.reboot(1))
        b.wait(0.3)
        assert b.read("present_position") == after
        b.servo._turn_tick = 0.0  # the next one counts from where it was put


@BOTH
def test_reverse_mode_mirrors_about_the_middle(name: str) -> None:
    b = Bench(name)
    b.servo.position_tick = 5000
    assert b.write("drive_mode", 1) == 0
    assert b.read("present_position") == -5000
    for item, value in (("torque_enable", 1), ("goal_position", 90000)):
        assert b.write(item, value) == 0
    b.wait(2.0)
    assert b.read("present_position") == pytest.approx(90000, abs=900)
    assert b.servo.drives.position_tick[0] == pytest.approx(-90000, abs=900)


@pytest.mark.parametrize(("kind", "code"), [("overload", 5), ("hot", 4), ("encoder", 13)])
def test_an_error_of_a_y_is_a_code_with_a_history_and_takes_its_torque(kind: str, code: int) -> None:
    b = Bench(Y, faults=(Fault(kind, start_s=1.0),))
    b.write("torque_enable", 1)
    b.wait(1.1)
    answer = b.ask(packet.read(1, 512, 1))[0]
    assert answer.error == packet.ALERT_BIT and answer.parameters == b"\0"
    assert (b.read("error_code"), b.read("error_code_history_1"), b.read("error_code_history_2")) == (code, code, 0)
    assert b.write("torque_enable", 1) == packet.ALERT_BIT | ErrorCode.RESULT_FAIL
    b.servo.drives.temperature_c[:] = 30
    b.ask(packet.reboot(1))
    b.wait(0.3)
    assert b.read("error_code") == 0 and b.write("torque_enable", 1) == 0


@pytest.mark.parametrize(("share", "code"), [(0.65, 2), (1.5, 1)])
def test_a_y_tells_low_from_high_voltage(share: float, code: int) -> None:
    """16 to 32 V from the factory; it runs on 24."""
    b = Bench(Y)
    b.wait(1.0)
    b.servo.drives.supply_share[:] = share
    b.wait(0.2)
    assert b.read("error_code") == code and b.read("present_input_voltage") == pytest.approx(2400 * share, abs=20)


@BOTH
def test_the_watchdog_stops_it_refuses_goals_and_is_cleared_by_zero(name: str) -> None:
    b = Bench(name)
    for item, value in (("torque_enable", 1), ("bus_watchdog", 5), ("goal_position", 250000)):
        assert b.write(item, value) == 0
    b.wait(0.12)
    stopped = b.servo.position_tick
    b.wait(1.0)
    assert b.read("bus_watchdog") == -1 and abs(b.read("present_position") - stopped) < 4000 < stopped < 200000
    assert b.write("goal_position", 1000) & 0x7F == ErrorCode.DATA_RANGE
    assert b.read("torque_enable") == 1
    if name == Y:
        assert b.read("error_code") == 18
    assert b.write("bus_watchdog", 0) & 0x7F == 0
    assert b.servo.error == 0 and b.write("goal_position", 1000) == 0


def test_time_based_profiles_of_a_y_have_items_of_their_own() -> None:
    """Profile time 800 of 0.2 ms, of which 400 to speed up and 400 to slow down: half way after 80 ms."""
    b = Bench(Y)
    assert b.write("drive_mode", 4) == 0
    for item, value in (("torque_enable", 1), ("goal_position", 20000)):
        assert b.write(item, value) == 0
    b.wait(0.08)
    assert b.read("position_trajectory") == pytest.approx(10000, abs=1500)
    b.wait(0.12)
    assert b.read("position_trajectory") == pytest.approx(20000, abs=100)


def test_from_the_factory_a_y_follows_its_own_profile() -> None:
    """161 times 10 rev/min2, 161 degrees a second in each second: after 0.5 s it has come 20 degrees, whatever it was told."""
    b = Bench(Y)
    b.servo.restore_factory(keep=("id", "baud_rate"))
    for item, value in (("torque_enable", 1), ("goal_position", 262144)):
        assert b.write(item, value) == 0
    b.wait(0.5)
    assert np.degrees(b.read("position_trajectory") * b.servo.rad_per_tick) == pytest.approx(20.1, abs=1.0)


def test_a_y_holds_its_continuous_torque_without_overheating() -> None:
    """Continuous current over maximum (manual, "Specifications"): the heat of that settles below the motor's 60 degrees."""
    for number, continuous_a in ((4030, 11.0), (4150, 10.7)):
        motor = MOTORS[number]
        loss_w = continuous_a**2 * motor.resistance_ohm
        assert 45 < 25 + loss_w * motor.heating_k_per_j / motor.cooling_per_s < 60
