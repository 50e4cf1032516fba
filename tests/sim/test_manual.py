"""Answers of simulated servos where they once differed from the ROBOTIS e-manual, transcribed from its pages.

Protocol pages: "Status Packet", error numbers 0x02, 0x03 and 0x07 (2.0), bits 3, 4 and 6 (1.0). Control table of XM430-W350:
Secondary ID (12), Homing Offset (20), Indirect Data (224), Profile Velocity (112), Moving Status (123), Velocity
Trajectory (136). Control table of MX-28 (1.0): Moving Speed (32).
"""

from __future__ import annotations

import pytest
from test_servo1 import Bench as Bench1

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import ErrorCode
from sim.servos.servo_protocol1 import CHECKSUM_ERROR, INSTRUCTION_ERROR, RANGE_ERROR
from tests.support.servo_bench import Bench

INDIRECT_DATA_1, INDIRECT_DATA_29 = 224, 634


def spoilt(data: bytes) -> bytes:
    """The packet with one bit of its checksum wrong."""
    return data[:-1] + bytes([data[-1] ^ 1])


class TestAction:
    def test_without_reg_write_it_is_an_instruction_error(self) -> None:
        b = Bench()
        assert b.ask(packet.action(1))[0].error == ErrorCode.INSTRUCTION
        assert b.ask(packet.reg_write(1, 65, b"\1"))[0].error == 0
        assert b.ask(packet.action(1))[0].error == 0
        assert b.ask(packet.action(1))[0].error == ErrorCode.INSTRUCTION, "the write was used up"
        assert b.read("led") == 1

    def test_protocol_1_says_bit_6(self) -> None:
        b = Bench1("MX-28")
        assert b.ask(packet1.action(1))[0].error == INSTRUCTION_ERROR == 1 << 6
        b.ask(packet1.reg_write(1, 25, b"\1"))
        assert b.ask(packet1.action(1))[0].error == 0


class TestChecksum:
    def test_a_wrong_one_is_answered_with_its_error_and_nothing_is_done(self) -> None:
        b = Bench("XM430-W350", "XM430-W350")
        answers = b.ask(spoilt(packet.write(1, 65, b"\1")))
        assert [(p.servo_id, p.error, p.parameters) for p in answers] == [(1, ErrorCode.CRC, b"")]
        assert b.read("led") == 0

    def test_byte_by_byte_it_is_answered_once(self) -> None:
        b = Bench()
        raw = spoilt(packet.write(1, 65, b"\1"))
        for _ in range(2):
            answers = [p for byte in raw for p in b.ask(bytes([byte]))]
            assert [p.error for p in answers] == [ErrorCode.CRC]
        assert [p.error for p in b.ask(packet.ping(1))] == [0]

    @pytest.mark.parametrize("data", [packet.sync_write(65, 1, [(1, b"\1")]), packet.ping(packet.BROADCAST_ID)])
    def test_a_broadcast_and_a_packet_for_nobody_are_not_answered(self, data: bytes) -> None:
        b = Bench()
        assert b.ask(spoilt(data)) == [] and b.ask(spoilt(packet.ping(7))) == []

    def test_a_servo_that_answers_reads_alone_is_silent(self) -> None:
        b = Bench()
        b.ask(packet.write(1, 68, b"\1"))
        assert b.ask(spoilt(packet.read(1, 65, 1))) == []

    def test_protocol_1_says_bit_4(self) -> None:
        b = Bench1("MX-28")
        answers = b.ask(spoilt(packet1.write(1, 25, b"\1")))
        assert [p.error for p in answers] == [CHECKSUM_ERROR] == [1 << 4]
        assert b.read("led") == 0 and b.ask(spoilt(packet1.ping(7))) == []


class TestIndirectData:
    @pytest.mark.parametrize("address", [INDIRECT_DATA_1, INDIRECT_DATA_29])
    def test_from_the_factory_it_points_to_itself_and_keeps_what_is_written(self, address: int) -> None:
        b = Bench()
        assert b.ask(packet.read(1, address, 2))[0].parameters == b"\0\0"
        assert b.ask(packet.write(1, address, b"\5\6"))[0].error == 0
        answer = b.ask(packet.read(1, address, 2))[0]
        assert (answer.error, answer.parameters) == (0, b"\5\6")

    def test_it_is_ram(self) -> None:
        b = Bench()
        b.ask(packet.write(1, INDIRECT_DATA_1, b"\5"))
        b.ask(packet.reboot(1))
        b.wait(1.0)
        assert b.ask(packet.read(1, INDIRECT_DATA_1, 1))[0].parameters == b"\0"


class TestSecondId:
    def test_it_cannot_change_the_eeprom(self) -> None:
        b = Bench("XM430-W350", "XM430-W350")
        assert b.write("secondary_id", 100, servo_id=1) == 0
        before = b.read("return_delay_time")
        for data in (packet.write(100, 9, b"\7"), packet.reg_write(100, 9, b"\7"), packet.action(100)):
            assert b.ask(data) == []
        assert b.read("return_delay_time") == before and b.read("registered_instruction") == 0
        b.ask(packet.factory_reset(100, packet.FactoryReset.EXCEPT_ID_AND_BAUD))
        assert b.read("secondary_id") == 100
        assert b.ask(packet.write(100, 65, b"\1")) == [] and b.read("led") == 1

    def test_a_servo_whose_two_ids_are_the_same_obeys_once(self) -> None:
        b = Bench()
        assert b.write("secondary_id", 1) == 0
        assert b.ask(packet.reg_write(1, 65, b"\1"))[0].error == 0
        assert [p.error for p in b.ask(packet.action(1))] == [0]
        assert b.write("return_delay_time", 7) == 0 and b.read("return_delay_time") == 7


class TestHomingOffset:
    @pytest.mark.parametrize(("offset", "counted"), [(1024, 1024), (-1024, -1024), (1025, 0), (1500, 0), (-1500, 0)])
    def test_position_mode_ignores_what_is_beyond_a_quarter_turn(self, offset: int, counted: int) -> None:
        b = Bench()
        assert b.write("homing_offset", offset) == 0
        assert (b.read("homing_offset"), b.read("present_position")) == (offset, 2048 + counted)

    def test_extended_position_mode_counts_all_of_it(self) -> None:
        b = Bench()
        b.write("operating_mode", 4)
        b.write("homing_offset", 1500)
        assert b.read("present_position") == 3548


class TestTrajectory:
    def test_in_velocity_mode_it_is_the_ramp_and_then_the_goal(self) -> None:
        b = Bench()
        for name, value in (("operating_mode", 1), ("profile_acceleration", 10), ("torque_enable", 1)):
            assert b.write(name, value) == 0
        assert b.read("velocity_trajectory") == 0
        b.write("goal_velocity", 100)
        b.wait(0.32)  # t1 = 64 * 100 / 10 = 640 ms
        assert b.read("velocity_trajectory") == pytest.approx(50, abs=1)
        b.wait(0.5)
        assert b.read("velocity_trajectory") == 100
        b.write("torque_enable", 0)
        b.wait(0.1)
        assert b.read("velocity_trajectory") == 0

    def test_in_position_mode_it_ends_at_zero(self) -> None:
        b = Bench()
        for name, value in (("profile_velocity", 100), ("torque_enable", 1), ("goal_position", 3000)):
            assert b.write(name, value) == 0
        b.wait(0.2)
        assert b.read("velocity_trajectory") == 100
        b.wait(3.0)
        assert b.read("velocity_trajectory") == 0


class TestMovingStatus:
    @pytest.mark.parametrize(
        ("velocity", "acceleration", "goal", "profile"),
        [
            (0, 0, 3000, 0x00),
            (0, 20, 3000, 0x00),
            (100, 0, 3000, 0x10),
            (100, 20, 3000, 0x30),
            (100, 20, 2058, 0x20),  # 10 ticks: too near to reach the profile's velocity
        ],
    )
    def test_bits_4_and_5_tell_the_profile(self, velocity: int, acceleration: int, goal: int, profile: int) -> None:
        b = Bench()
        for name, value in (
            ("profile_acceleration", acceleration),
            ("profile_velocity", velocity),
            ("torque_enable", 1),
            ("goal_position", goal),
        ):
            assert b.write(name, value) == 0
        assert b.read("moving_status") & 0x30 == profile
        b.wait(5.0)
        assert b.read("moving_status") & 0x33 == profile | 0x01, "in position; the type stays"

    def test_without_a_profile_velocity_a_step_is_made(self) -> None:
        """Profile Velocity 0: "Profile not used (Step Instruction)", whatever the acceleration."""
        b = Bench()
        for name, value in (("profile_acceleration", 5), ("torque_enable", 1), ("goal_position", 2500)):
            assert b.write(name, value) == 0
        b.wait(0.01)
        assert b.read("position_trajectory") == 2500

    def test_a_profile_in_time(self) -> None:
        b = Bench()
        for name, value in (("drive_mode", 4), ("profile_velocity", 1000), ("torque_enable", 1)):
            assert b.write(name, value) == 0
        for acceleration, profile in ((0, 0x10), (200, 0x30), (500, 0x20)):
            b.write("profile_acceleration", acceleration)
            b.write("goal_position", 2500 + acceleration)
            assert b.read("moving_status") & 0x30 == profile

    def test_in_position_belongs_to_the_position_modes(self) -> None:
        b = Bench()
        b.write("operating_mode", 1)
        assert b.read("moving_status") & 0x01 == 0


class TestAddressesWithoutAnItem:
    @pytest.mark.parametrize(("address", "length"), [(14, 1), (14, 4), (13, 2), (18, 6), (148, 1), (900, 2)])
    def test_a_read_that_begins_or_ends_at_one_is_an_access_error(self, address: int, length: int) -> None:
        answer = Bench().ask(packet.read(1, address, length))[0]
        assert (answer.error, answer.parameters) == (ErrorCode.ACCESS, b"")

    def test_between_items_they_read_as_zero(self) -> None:
        answer = Bench().ask(packet.read(1, 13, 11))[0]
        assert (answer.error, answer.parameters) == (0, b"\2" + bytes(10))

    def test_also_behind_an_indirect_address(self) -> None:
        b = Bench()
        b.ask(packet.write(1, 168, (150).to_bytes(2, "little")))
        assert b.ask(packet.read(1, INDIRECT_DATA_1, 1))[0].error == ErrorCode.ACCESS
        assert b.ask(packet.write(1, INDIRECT_DATA_1, b"\1"))[0].error == ErrorCode.ACCESS


@pytest.mark.parametrize(
    ("wheel", "raw", "error"),
    [
        (False, 0, 0), (False, 1023, 0), (False, 1025, RANGE_ERROR), (False, 5000, RANGE_ERROR),
        (True, 0, 0), (True, 1023, 0), (True, 1024, 0), (True, 2047, 0), (True, 2048, RANGE_ERROR), (True, 5000, RANGE_ERROR),
    ],
)  # fmt: skip
@pytest.mark.parametrize("model", ["MX-28", "AX-12A"])
def test_a_moving_speed_beyond_its_range_is_a_range_error(model: str, wheel: bool, raw: int, error: int) -> None:
    b = Bench1(model)
    if wheel:
        b.write("min_position_limit", 0)
        b.write("max_position_limit", 0)
    before = b.read("moving_speed")
    assert b.ask(packet1.write(1, 32, raw.to_bytes(2, "little")))[0].error == error
    if error:
        assert b.read("moving_speed") == before
