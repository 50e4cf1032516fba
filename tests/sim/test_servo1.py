"""AX and MX servos of Protocol 1.0 over their wire: tables, error bits, alarms."""

from __future__ import annotations

import pytest

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec import packet_protocol1 as packet1
from daemon.dynamixel.codec.packet import Packet
from daemon.dynamixel.registers.models import MODELS
from sim.faults import Fault
from sim.servos.servo_protocol1 import ANGLE_ERROR, INSTRUCTION_ERROR, OVERLOAD_ERROR, RANGE_ERROR
from tests.support.servo_bench import Bench as Bench2
from tests.support.sizes import few_and_long

PROTOCOL_1 = [m.name for m in MODELS.values() if m.protocol == 1.0]


class Bench(Bench2):
    """A client that speaks Protocol 1.0."""

    def ask(self, data: bytes) -> list[Packet]:
        return packet1.PacketDecoder().feed(self.send(data))

    def write(self, name: str, value: int, servo_id: int = 1) -> int:
        item = self.servo.items[name]
        return self.ask(packet1.write(servo_id, item.address, item.encode(value)))[0].error

    def read(self, name: str, servo_id: int = 1) -> int:
        item = self.servo.items[name]
        return item.decode(self.ask(packet1.read(servo_id, item.address, item.size))[0].parameters)


@pytest.mark.parametrize("name", few_and_long(PROTOCOL_1[:2], PROTOCOL_1))
def test_every_model_answers_and_goes_where_it_is_sent(name: str) -> None:
    b = Bench(name)
    assert b.ask(packet1.ping(1)) == [Packet(1, packet.Instruction.STATUS)]
    assert b.read("model_number") == b.servo.model.model_number
    assert b.write("goal_position", 700) == 0
    assert b.read("torque_enable") == 1, "a goal switches torque on"
    b.wait(3.0)
    assert abs(b.read("present_position") - 700) <= 6
    assert b.read("present_speed") == 0


def test_a_speed_is_kept_and_wheels_turn_both_ways() -> None:
    b = Bench("MX-28")
    b.write("moving_speed", 100)
    b.write("goal_position", 3500)
    b.wait(0.8)
    assert b.read("present_speed") == pytest.approx(100, abs=3)
    b.write("torque_enable", 0)
    for name, value in (
        ("min_position_limit", 0),
        ("max_position_limit", 0),
        ("torque_enable", 1),
        ("moving_speed", -200),
    ):
        assert b.write(name, value) == 0
    b.wait(2.0)
    assert b.read("present_speed") == pytest.approx(-200, abs=5)


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("goal_position", 1023, ANGLE_ERROR),
        ("goal_position", 5000, RANGE_ERROR),
        ("led", 2, RANGE_ERROR),
        ("present_position", 1, INSTRUCTION_ERROR),
    ],
)
def test_mistakes_earn_error_bits(name: str, value: int, error: int) -> None:
    b = Bench("AX-12A")
    assert b.write("max_position_limit", 900) == 0
    before = b.read(name)
    assert b.write(name, value) == error
    assert b.read(name) == before


def test_a_baud_that_is_nearly_the_clients_is_heard() -> None:
    """2,000,000 / 35 is 57,142; drivers say 57,600."""
    b = Bench("MX-28")
    assert b.write("baud_rate", 34) == 0
    assert b.ask(packet1.ping(1)) == []
    b.baud = 57_600
    assert b.ask(packet1.ping(1)) == [Packet(1, packet.Instruction.STATUS)]


def test_a_sync_write_and_a_bulk_read_reach_all() -> None:
    b = Bench("MX-28", "MX-64")
    b.send(packet1.sync_write(25, 1, [(1, b"\1"), (2, b"\1")]))
    found = b.ask(packet1.bulk_read([(1, 25, 1), (2, 36, 2)]))
    assert [(p.servo_id, p.parameters) for p in found] == [(1, b"\1"), (2, b"\x00\x08")]


@pytest.mark.parametrize("faults", [(), (Fault("silent", servo_id=2),)])
def test_in_a_bulk_read_nobody_goes_on_behind_one_who_stays_away(faults: tuple[Fault, ...]) -> None:
    b = Bench("MX-28", "MX-64", "MX-106", faults=faults)
    asked = [(1, 36, 2), (2, 36, 2), (3, 36, 2)]
    found = b.ask(packet1.bulk_read(asked if faults else [asked[0], (9, 36, 2), asked[2]]))
    assert [p.servo_id for p in found] == [1]


def test_an_overload_takes_torque_until_its_limit_is_written_again() -> None:
    b = Bench("AX-12A", faults=(Fault("overload", start_s=1.0),))
    b.write("torque_enable", 1)
    b.wait(1.1)
    assert b.ask(packet1.ping(1))[0].error == OVERLOAD_ERROR
    assert (b.read("torque_enable"), b.read("torque_limit")) == (0, 0)
    b.write("torque_limit", 1023)
    assert b.ask(packet1.ping(1))[0].error == 0
    assert b.write("torque_enable", 1) == 0


def test_a_torque_limit_is_in_force_and_above_max_torque_a_violation() -> None:
    """Max torque is only what the limit begins with when power comes on: who writes all over it undoes what the owner set."""
    b = Bench("AX-12A")
    b.write("max_torque", 300)
    assert b.read("torque_limit") == 1023, "not before power comes on"
    b.servo.lose_power()
    b.servo.restore_power()
    b.wait(0.3)
    assert (b.read("torque_limit"), b.world.drives.limit_duty[0]) == (300, pytest.approx(300 / 1023))
    assert b.write("torque_limit", 200) == 0 and not b.bus.audit.violations
    assert b.write("torque_limit", 1023) == 0, "the servo takes it"
    assert b.world.drives.limit_duty[0] == 1.0
    assert b.bus.audit.violations == {"torque_limit": 1}


def test_both_protocols_share_one_wire_without_hearing_each_other() -> None:
    b = Bench("XM430-W350", "AX-12A")
    assert b.ask(packet1.ping(2))[0].servo_id == 2
    assert packet.PacketDecoder().feed(b.send(packet.ping(1)))[0].servo_id == 1
    assert b.send(packet.ping(2)) == b.send(packet1.ping(1)) == b""
