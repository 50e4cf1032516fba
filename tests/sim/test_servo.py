"""One servo of Protocol 2.0 over its wire: what each register does, and the error each mistake earns."""

from __future__ import annotations

import pytest

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.packet import ErrorCode, FactoryReset
from daemon.dynamixel.registers.models import MODELS
from tests.support.servo_bench import Bench
from tests.support.sizes import few_and_long

PROTOCOL_2 = [m.name for m in MODELS.values() if m.protocol == 2.0]


@pytest.mark.parametrize("name", few_and_long(PROTOCOL_2[::6], PROTOCOL_2))
def test_every_model_answers_with_its_number_and_goes_where_it_is_sent(name: str) -> None:
    b = Bench(name)
    answer = b.ask(packet.ping(1))[0].parameters
    assert int.from_bytes(answer[:2], "little") == b.servo.model.model_number
    assert answer[2] == b.servo.firmware
    assert b.write("torque_enable", 1) == 0
    model, tick = b.servo.model, b.servo.model.ticks_per_turn / 4096
    goal = model.zero_tick + round(500 * tick)
    assert b.write("goal_position", goal) == 0
    b.wait(3.0)
    error = abs(b.read("present_position") - goal)
    assert error <= 6 * tick, "within half a degree: there is friction and no integral gain"
    assert b.read("present_velocity") == 0
    assert (b.read("moving_status") & 4 if model.family == "y" else b.read("moving")) == 0


@pytest.mark.parametrize(
    ("name", "value", "torque", "error"),
    [
        ("goal_position", 5000, False, ErrorCode.DATA_LIMIT),
        ("goal_position", 4096, True, ErrorCode.DATA_LIMIT),
        ("goal_velocity", 201, False, ErrorCode.DATA_LIMIT),
        ("goal_current", 1194, False, ErrorCode.DATA_LIMIT),
        ("goal_pwm", 886, False, ErrorCode.DATA_RANGE),
        ("torque_enable", 7, False, ErrorCode.DATA_RANGE),
        ("operating_mode", 2, False, ErrorCode.DATA_RANGE),
        ("baud_rate", 9, False, ErrorCode.DATA_RANGE),
        ("id", 253, False, ErrorCode.DATA_RANGE),
        ("position_p_gain", 16384, False, ErrorCode.DATA_RANGE),
        ("return_delay_time", 5, True, ErrorCode.ACCESS),
        ("operating_mode", 4, True, ErrorCode.ACCESS),
        ("present_position", 0, False, ErrorCode.ACCESS),
        ("model_number", 12, False, ErrorCode.ACCESS),
        ("bus_watchdog", -1, False, ErrorCode.DATA_RANGE),
    ],
)
def test_each_mistake_earns_its_error_and_changes_nothing(name: str, value: int, torque: bool, error: int) -> None:
    b = Bench()
    if torque:
        assert b.write("torque_enable", 1) == 0
    before = b.read(name)
    assert b.write(name, value) == error
    assert b.read(name) == before


def test_writes_of_no_item_half_an_item_or_beyond_the_table() -> None:
    b = Bench()
    errors = [
        b.ask(packet.write(1, address, data))[0].error
        for address, data in ((116, b"\1\2"), (14, b"\1"), (660, b"\0\0\0"))
    ]
    assert errors == [ErrorCode.DATA_LENGTH, ErrorCode.ACCESS, ErrorCode.ACCESS]
    assert b.ask(packet.read(1, 600, 200))[0].error == ErrorCode.ACCESS
    assert b.ask(packet.read(1, 14, 4))[0].error == ErrorCode.ACCESS


def test_one_bad_item_among_several_and_nothing_is_written() -> None:
    b = Bench()
    profile = (40000).to_bytes(4, "little") + (50).to_bytes(4, "little") + (2100).to_bytes(4, "little")
    assert b.ask(packet.write(1, 108, profile))[0].error == ErrorCode.DATA_RANGE
    assert [b.read(n) for n in ("profile_acceleration", "profile_velocity", "goal_position")] == [0, 0, 2048]


def test_the_status_return_level_decides_who_is_answered() -> None:
    b = Bench()
    assert b.ask(packet.write(1, 68, b"\1")) == [], "it holds from the write on"
    assert b.ask(packet.write(1, 65, b"\1")) == []
    assert b.read("led") == 1
    b.send(packet.write(1, 68, b"\0"))
    assert b.ask(packet.read(1, 65, 1)) == [] and len(b.ask(packet.ping(1))) == 1


def test_a_registered_write_waits_for_action() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    for servo_id in (1, 2):
        assert b.ask(packet.reg_write(servo_id, 65, b"\1"))[0].error == 0
    assert (b.read("led"), b.read("registered_instruction")) == (0, 1)
    assert b.ask(packet.action()) == [], "a broadcast is not answered"
    assert [b.read("led", i) for i in (1, 2)] == [1, 1] and b.read("registered_instruction") == 0


def test_a_servo_obeys_its_second_id_without_a_word() -> None:
    b = Bench("XM430-W350", "XM430-W350")
    assert b.write("secondary_id", 2, servo_id=1) == 0
    assert len(b.ask(packet.write(2, 65, b"\1"))) == 1
    assert [b.read("led", i) for i in (1, 2)] == [1, 1]


def test_another_id_or_baud_is_followed_at_once() -> None:
    b = Bench()
    said = b.ask(packet.write(1, 7, b"\x09"))
    assert [(p.servo_id, p.error) for p in said] == [(1, 0)], "it answers as who was asked"
    assert b.ask(packet.ping(1)) == [] and b.ask(packet.ping(9))[0].servo_id == 9
    assert b.write("baud_rate", 1, servo_id=9) == 0
    assert b.ask(packet.ping(9)) == []
    b.baud = 57600
    assert b.ask(packet.ping(9))[0].servo_id == 9


@pytest.mark.parametrize(
    ("name", "firmware", "window"), [("XL330-M288", 51, 224), ("XL330-M288", 52, 208), ("XM430-W350", 45, 634)]
)
def test_indirect_addresses_bring_scattered_bytes_in_one_read(name: str, firmware: int, window: int) -> None:
    b = Bench(name, firmware={1: firmware})
    address = 578 if window == 634 else 168
    wanted = [*range(132, 136), 146, 144, 145]
    for i, target in enumerate(wanted):
        assert b.ask(packet.write(1, address + 2 * i, target.to_bytes(2, "little")))[0].error == 0
    data = b.ask(packet.read(1, window, len(wanted)))[0].parameters
    assert int.from_bytes(data[:4], "little") == b.read("present_position")
    assert data[4] == b.read("present_temperature")
    assert int.from_bytes(data[5:7], "little") == b.read("present_input_voltage")


def test_a_write_through_indirect_addresses_keeps_its_limits() -> None:
    b = Bench()
    for i, target in enumerate([65, 116, 117, 118, 119]):
        b.ask(packet.write(1, 168 + 2 * i, target.to_bytes(2, "little")))
    assert b.ask(packet.write(1, 224, b"\1" + (2100).to_bytes(4, "little")))[0].error == 0
    assert (b.read("led"), b.read("goal_position")) == (1, 2100)
    assert b.ask(packet.write(1, 224, b"\0" + (5000).to_bytes(4, "little")))[0].error == ErrorCode.DATA_LIMIT
    assert (b.read("led"), b.read("goal_position")) == (1, 2100)


def test_a_reboot_loses_ram_and_torque_keeps_eeprom_and_takes_a_while() -> None:
    b = Bench()
    for name, value in (("return_delay_time", 10), ("torque_enable", 1), ("position_p_gain", 77), ("led", 1)):
        assert b.write(name, value) == 0
    assert b.ask(packet.reboot(1))[0].error == 0
    assert b.ask(packet.ping(1)) == []
    b.wait(0.3)
    assert [b.read(n) for n in ("return_delay_time", "torque_enable", "position_p_gain", "led")] == [10, 0, 800, 0]


@pytest.mark.parametrize(
    ("keep", "after"),
    [(FactoryReset.EXCEPT_ID, (7, 1)), (FactoryReset.EXCEPT_ID_AND_BAUD, (7, 3)), (FactoryReset.ALL, (1, 1))],
)
def test_a_factory_reset_keeps_what_it_is_told(keep: FactoryReset, after: tuple[int, int]) -> None:
    b = Bench()
    b.write("id", 7)
    b.send(packet.factory_reset(7, keep))
    assert (b.servo.get("id"), b.servo.get("baud_rate")) == after
    assert b.servo.get("return_delay_time") == 250


def test_a_factory_reset_of_everything_is_refused_when_broadcast() -> None:
    b = Bench()
    b.write("led", 1)
    b.send(packet.factory_reset(254, FactoryReset.ALL))
    assert b.read("led") == 1


def test_backup_and_restore() -> None:
    b = Bench()
    b.write("position_p_gain", 640)
    assert b.ask(packet.restore(1))[0].error == ErrorCode.RESULT_FAIL
    assert b.ask(packet.backup(1))[0].error == 0
    b.write("position_p_gain", 100)
    assert b.ask(packet.restore(1))[0].error == 0
    assert b.read("position_p_gain") == 640


def test_whole_turns_are_lost_by_clear_and_by_a_reboot() -> None:
    b = Bench()
    for name, value in (("operating_mode", 4), ("torque_enable", 1), ("goal_position", 9000)):
        assert b.write(name, value) == 0
    b.wait(0.5)
    assert b.ask(packet.clear_multi_turn(1))[0].error == ErrorCode.RESULT_FAIL, "while it turns"
    b.wait(5.0)
    b.write("torque_enable", 0)
    position = b.read("present_position")
    assert b.ask(packet.clear_multi_turn(1))[0].error == 0
    assert 0 <= b.read("present_position") < 4096
    assert (position - b.read("present_position")) % 4096 == 0


def test_homing_offset_and_reverse_mode_change_what_positions_mean() -> None:
    b = Bench()
    assert b.write("homing_offset", 100) == 0
    assert b.read("present_position") == 2148
    b.write("homing_offset", 0)
    assert b.write("drive_mode", 1) == 0
    b.write("torque_enable", 1)
    b.write("goal_position", 2248)
    b.wait(2.0)
    assert abs(b.read("present_position") - 2248) <= 3
    assert b.servo.drives.position_tick[0] == pytest.approx(4096 - 2248, abs=3)


def test_torque_by_goal_update() -> None:
    b = Bench()
    assert b.write("drive_mode", 8) == 0
    assert b.write("goal_position", 2100) == 0
    assert b.read("torque_enable") == 1
