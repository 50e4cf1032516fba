"""Fault schedules: read strictly, drawn from a seed; and what each kind does on the wire and to a servo."""

from __future__ import annotations

from pathlib import Path

import pytest

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.crc import crc16
from daemon.dynamixel.codec.packet import Packet, PacketDecoder
from daemon.errors import ConfigError, LinkLostError
from sim.clock import VirtualClock
from sim.errors import FaultFileError
from sim.faults import KINDS, PACKET_KINDS, Fault, FaultSchedule
from sim.port import SimPort
from tests.support.servo_bench import Bench
from tests.support.sizes import few_and_long


def test_a_schedule_is_read_and_strikes_in_its_time(tmp_path: Path) -> None:
    file = tmp_path / "faults.toml"
    file.write_text('seed = 3\n[[fault]]\nkind = "silent"\nstart_s = 1.0\nend_s = 2.0\nservo_id = 4\n')
    schedule = FaultSchedule.load(file)
    struck = []
    for t in (0.5, 1.5, 2.5):
        schedule.begin(t)
        struck.append([schedule.active("silent", t, i) is not None for i in (4, 5)])
    assert struck == [[False, False], [True, False], [False, False]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[[fault]]\nkind = "explode"\n', "fault 1: kind: 'explode'; allowed: drop, corrupt"),
        ('[[fault]]\nkind = "drop"\nwhen = 3\n', "start_s"),
        ('[[fault]]\nkind = "drop"\n[[fault]]\nkind = "drop"\nprobability = 1.5\n', "fault 2: probability: 1.5; allowed: 0 to 1"),
        ('[[fault]]\nkind = "drop"\nprobability = nan\n', "probability: nan"),
        ('[[fault]]\nkind = "stuck"\nprobability = 0.5\n', "probability: 0.5 for 'stuck'"),
        ('[[fault]]\nkind = "drop"\nstart_s = 3.0\nend_s = 2.0\n', "end_s: 2; allowed: more than start_s = 3"),
        ('[[fault]]\nkind = "drop"\nstart_s = -1.0\n', "start_s: -1"),
        ('[[fault]]\nkind = "drop"\nservo_id = 300\n', "servo_id: 300; allowed: 0 to 252"),
        ('[[fault]]\nkind = "drop"\nfirst_packet = 5\nlast_packet = 4\n', "first_packet: 5 to 4"),
        ('[[fault]]\nkind = "drop"\nevery_s = 1.0\n', "every_s: 1 for 'drop'"),
        ('[[fault]]\nkind = "drop"\npath = "x"\n', "path: 'x' for 'drop'; allowed: only for unplug"),
        ('[[fault]]\nkind = "delay"\namount = -1.0\n', "amount: -1 for 'delay'"),
        ('[[fault]]\nkind = "drop"\namount = 2.0\n', "amount: 2 for 'drop'; allowed: only for delay"),
        ('[[fault]]\nkind = "unplug"\nservo_id = 3\n', "fault 1: servo_id: 3 for 'unplug'; allowed: only for drop, corrupt"),
        ('[[fault]]\nkind = "echo"\nservo_id = 3\n', "servo_id: 3 for 'echo'"),
        ('[[fault]]\nkind = "clock_jump"\nservo_id = 3\n', "servo_id: 3 for 'clock_jump'"),
        ('[[fault]]\nkind = "stuck"\nfirst_packet = 5\n', "first_packet: 5 for 'stuck'; allowed: only for drop"),
        ('[[fault]]\nkind = "drop"\nstart_s = "soon"\n', "fault[0].start_s: Expected `float`, got `str`"),
        ("not toml", "not TOML"),
    ],
)  # fmt: skip
def test_a_wrong_schedule_is_refused_with_where_and_what_is_allowed(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "faults.toml"
    file.write_text(text)
    with pytest.raises(ConfigError) as caught:
        FaultSchedule.load(file)
    assert said in str(caught.value) and str(file) in str(caught.value)


def test_a_fault_of_a_servo_that_is_not_there_is_refused() -> None:
    with pytest.raises(FaultFileError, match="fault 2: servo_id: 7; allowed: 1, 2"):
        Bench("XM430-W350", "XL430-W250", faults=(Fault("drop"), Fault("silent", servo_id=7)))


@pytest.mark.parametrize("servo_id", [None, 1])
def test_a_servo_without_an_encoder_error_cannot_have_one(servo_id: int | None) -> None:
    with pytest.raises(
        FaultFileError, match=r"fault 1: kind: 'encoder' for (servo 1|any servo); allowed: Protocol 2.0"
    ):
        Bench("MX-28", faults=(Fault("encoder", servo_id=servo_id),))
    b = Bench("MX-28", "XM430-W350", faults=(Fault("encoder"),))
    b.wait(0.1)
    assert [servo.alert() for servo in b.world.all] == [0, packet.ALERT_BIT]


@pytest.mark.parametrize("kind", ["wrong_id", "foreign"])
def test_in_a_fast_read_another_id_is_in_the_answer_too(kind: str) -> None:
    def answer(*faults: Fault) -> bytes:
        return Bench("XM430-W350", "XM430-W350", faults=faults).send(packet.sync_read(132, 4, [1, 2], fast=True))

    whole, spoilt = answer(), answer(Fault(kind, servo_id=2))
    if kind == "wrong_id":
        assert (spoilt[:17], spoilt[17], spoilt[18:22]) == (whole[:17], 3, whole[18:22])
        assert spoilt[-2:] == crc16(spoilt[:-2]).to_bytes(2, "little")
    else:
        assert (spoilt[:16], spoilt[17], spoilt[24:]) == (whole[:16], 102, whole[16:])


def test_a_missing_schedule_is_named(tmp_path: Path) -> None:
    with pytest.raises(FaultFileError, match=r"none.toml: file: No such file"):
        FaultSchedule.load(tmp_path / "none.toml")


@pytest.mark.parametrize("kind", few_and_long(["corrupt", "drop"], sorted(PACKET_KINDS.keys() - {"deaf"})))
def test_the_same_seed_spoils_the_same_answers(kind: str) -> None:
    def heard(seed: int) -> list[bytes]:
        b = Bench(faults=(Fault(kind, probability=0.4),), seed=seed)
        return [b.send(packet.ping(1)) for _ in range(30)]

    whole = Bench().send(packet.ping(1))
    assert heard(1) == heard(1)
    assert whole in heard(1), "not every one is struck"
    if kind in ("split", "delay"):
        assert set(heard(1)) == {whole}, "only its time is another"
    else:
        assert set(heard(1)) != {whole}


def test_what_each_fault_leaves_of_an_answer() -> None:
    def answer(kind: str, **more: float) -> bytes:
        return Bench(faults=(Fault(kind, **more),)).send(packet.ping(1))

    whole = Bench().send(packet.ping(1))
    assert answer("drop") == answer("silent") == b""
    assert answer("duplicate") == whole * 2
    assert answer("truncate") == whole[:7] and answer("truncate", amount=3) == whole[:3]
    assert PacketDecoder().feed(answer("wrong_id"))[0].servo_id == 2
    assert [p.servo_id for p in PacketDecoder().feed(answer("foreign"))] == [101, 1]
    assert answer("noise", amount=5)[5:] == whole
    assert sum(bin(x ^ y).count("1") for x, y in zip(answer("corrupt"), whole, strict=True)) == 1
    assert PacketDecoder().feed(answer("collision")) == []
    assert answer("echo") == packet.ping(1) + whole


def test_faults_by_packet_number_strike_just_these() -> None:
    b = Bench(faults=(Fault("drop", first_packet=3, last_packet=4),))
    assert [bool(b.send(packet.ping(1))) for _ in range(6)] == [True, True, False, False, True, True]


def test_a_deaf_servo_neither_answers_nor_obeys() -> None:
    b = Bench("XM430-W350", "XM430-W350", faults=(Fault("deaf", servo_id=1, end_s=1.0),))
    b.send(packet.sync_write(65, 1, [(1, b"\1"), (2, b"\1")]))
    assert b.ask(packet.ping(1)) == []
    b.wait(1.1)
    assert [b.read("led", i) for i in (1, 2)] == [0, 1]


def test_a_brown_out_resets_every_servo_and_none_answers_meanwhile() -> None:
    b = Bench("XM430-W350", "XL430-W250", faults=(Fault("brown_out", start_s=1.0, end_s=2.0),))
    for i in (1, 2):
        b.ask(packet.write(i, 64, b"\1"))
    b.wait(1.2)
    assert [b.ask(packet.ping(i)) for i in (1, 2)] == [[], []]
    b.wait(1.2)
    assert [b.read("torque_enable", i) for i in (1, 2)] == [0, 0]


def test_a_brown_out_of_one_servo_leaves_the_others_alone() -> None:
    b = Bench("XM430-W350", "XM430-W350", faults=(Fault("brown_out", start_s=1.0, end_s=2.0, servo_id=2),))
    for i in (1, 2):
        b.ask(packet.write(i, 64, b"\1"))
    b.wait(1.2)
    assert [len(b.ask(packet.ping(i))) for i in (1, 2)] == [1, 0]
    b.wait(1.2)
    assert [b.read("torque_enable", i) for i in (1, 2)] == [1, 0]


def test_a_little_too_low_a_voltage_is_an_alert_and_torque_stays() -> None:
    b = Bench(faults=(Fault("brown_out", start_s=1.0, end_s=2.0, amount=0.75),))
    b.write("torque_enable", 1)
    b.wait(1.5)
    answer = b.ask(packet.read(1, 64, 1))[0]
    assert answer == Packet(1, packet.Instruction.STATUS, b"\1", packet.ALERT_BIT)
    assert b.read("hardware_error_status") == 1


def test_instants_come_again_when_they_are_told_to() -> None:
    b = Bench(faults=(Fault("reboot", start_s=1.0, every_s=1.0, end_s=3.5),))
    torque = []
    for _ in range(5):
        b.write("torque_enable", 1)
        b.wait(1.25)
        torque.append(b.read("torque_enable"))
    assert b.world.faults.struck["reboot"] == 3
    assert torque[-1] == 1


def test_a_slipped_gear_is_somewhere_else_at_once() -> None:
    b = Bench(faults=(Fault("slip", start_s=1.0, amount=150),))
    before = b.read("present_position")
    b.wait(1.01)
    assert b.read("present_position") == before + 150


def test_an_unplugged_port_is_lost_and_what_was_under_way_is_gone() -> None:
    b, clock = Bench(faults=(Fault("unplug", start_s=1.0, end_s=2.0),)), VirtualClock()
    port = SimPort(b.bus, clock)
    port.write(packet.ping(1))
    clock.sleep_until(1.5)
    for call in (lambda: port.write(b""), lambda: port.read(1, 0.0)):
        with pytest.raises(LinkLostError, match="unplugged"):
            call()
    clock.sleep_until(2.5)
    assert port.read(100, 0.01) == b""
    port.write(packet.ping(1))
    assert PacketDecoder().feed(port.read(100, 0.1))[0].servo_id == 1


def test_a_clock_that_jumps_moves_no_servo_and_needs_virtual_time() -> None:
    b, clock = Bench(faults=(Fault("clock_jump", start_s=1.0, amount=3600.0),)), VirtualClock()
    port = SimPort(b.bus, clock)
    clock.sleep_until(1.5)
    port.write(packet.ping(1))
    assert clock.now_s() == pytest.approx(3601.5) and clock.true_s == pytest.approx(1.5)
    assert b.world.t_s < 1.6
    from daemon.host.clock import RealClock

    with pytest.raises(FaultFileError, match="virtual time"):
        SimPort(b.bus, RealClock())


def test_every_kind_says_what_it_is() -> None:
    assert all(KINDS.values()) and len(KINDS) >= 22
