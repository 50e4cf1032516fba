"""One simulated servo: registers, torque, motion, watchdog."""

from __future__ import annotations

import math

from daemon.bus.packet import ErrorCode
from retarget.robot import load_robot
from sim.servo import SimServo

SPEC = load_robot("op3").servos[0]  # an XM430-W350
GOAL, TORQUE, WATCHDOG, RETURN_DELAY = 116, 64, 98, 9


def servo() -> SimServo:
    made = SimServo(SPEC, 0.0)
    made.advance(0.0)
    return made


def int4(value: int) -> bytes:
    return value.to_bytes(4, "little", signed=True)


def test_it_answers_for_its_model() -> None:
    assert servo().get("model_number") == 1020
    assert servo().get("present_position") == 2048


def test_without_torque_a_goal_moves_nothing() -> None:
    s = servo()
    assert s.write(GOAL, int4(3000)) == ErrorCode.NONE
    s.advance(1.0)
    assert s.get("present_position") == 2048


def test_with_torque_it_goes_there_no_faster_than_it_can() -> None:
    s = servo()
    s.write(TORQUE, b"\1")
    s.write(GOAL, int4(3072))
    top_tick_s = SPEC.model.no_load_speed_rad_s * 4096 / (2 * math.pi)
    last = s.position_tick
    for i in range(1, 200):
        s.advance(i * 0.01)
        assert abs(s.position_tick - last) <= top_tick_s * 0.01 + 1e-6
        last = s.position_tick
    assert s.get("present_position") == 3072


def test_eeprom_is_locked_while_torque_is_on() -> None:
    s = servo()
    assert s.write(RETURN_DELAY, b"\0") == ErrorCode.NONE
    s.write(TORQUE, b"\1")
    assert s.write(RETURN_DELAY, b"\5") == ErrorCode.ACCESS


def test_each_mistake_earns_its_error_and_writes_nothing() -> None:
    s = servo()
    assert s.write(GOAL, int4(5000)) == ErrorCode.DATA_LIMIT
    assert s.write(TORQUE, b"\7") == ErrorCode.DATA_RANGE
    assert s.write(132, int4(0)) == ErrorCode.ACCESS
    assert s.write(GOAL, b"\1\2") == ErrorCode.DATA_LENGTH
    assert s.get("goal_position") == 2048


def test_a_trip_drops_torque_until_a_reboot() -> None:
    s = servo()
    s.write(TORQUE, b"\1")
    s.trip(1 << 5)
    assert not s.torque
    assert s.alert() == 0x80
    assert s.write(TORQUE, b"\1") == ErrorCode.RESULT_FAIL
    s.reboot()
    assert s.alert() == 0
    assert s.write(TORQUE, b"\1") == ErrorCode.NONE


def test_the_watchdog_stops_it_refuses_goals_and_is_cleared_by_zero() -> None:
    s = servo()
    s.write(TORQUE, b"\1")
    s.write(WATCHDOG, b"\5")  # 100 ms
    s.write(GOAL, int4(4000))
    s.fed(0.0)
    s.advance(0.09)
    assert s.get("bus_watchdog") == 5
    s.advance(0.3)
    stopped = s.position_tick
    assert s.get("bus_watchdog") == -1
    assert s.write(GOAL, int4(2048)) == ErrorCode.DATA_RANGE
    s.advance(2.0)
    assert abs(s.position_tick - stopped) < 60, "it stays about where it was when the bus fell silent"
    assert s.write(WATCHDOG, b"\0") == ErrorCode.NONE
    assert s.write(GOAL, int4(2048)) == ErrorCode.NONE
