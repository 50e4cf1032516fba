"""The servo bus against another emulator: every family, fast sync read, indirect windows, slow registers and watchdogs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from daemon.dynamixel.codec.packet import Instruction, Part, fast_status, sync_read
from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.health import Health
from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import BusMismatchError, CommandError, ConfigError
from tests.support.mixed_bus import ALL_KINDS, X20, bus_of, kinds, put
from tests.support.servo_emulator import fake


def test_every_family_reads_and_takes_goals_in_the_same_way() -> None:
    bus, far, _ = bus_of(*ALL_KINDS)
    put(far)
    goals = np.arange(9, dtype=np.int32) + 500
    reading = bus.exchange(goals)
    assert reading.valid.all()
    assert reading.position_tick.tolist() == list(range(1001, 1010))
    assert reading.velocity_raw.tolist() == [-5] * 9
    assert reading.current_raw.tolist() == [-7] * 9
    assert [s.get("goal_position") for s in far.servos.values()] == goals.tolist()


@pytest.mark.parametrize("n", [1, 2, 20])
def test_a_group_that_knows_fast_sync_reads_is_one_write_and_one_packet(n: int) -> None:
    bus, far, _ = bus_of(*X20[:n])
    put(far)
    far.writes.clear()
    reading = bus.exchange(np.full(n, 2048, np.int32))
    assert reading.valid.all() and reading.position_tick.tolist() == [1001 + i for i in range(n)]
    (request,) = far.writes
    assert (sync_read(126, 10, bus.ids, fast=True) in request) == (n > 1), "a single servo wins nothing by it"


def test_an_unanswered_fast_sync_read_is_tried_only_once() -> None:
    far, servos, clock = fake(*X20[:4])
    far.servos[3].fast = False
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    assert kinds(bus) == [BusEventKind.FAST_SYNC_OFF]
    far.writes.clear()
    assert bus.exchange(None).valid.all()
    assert far.writes == [sync_read(126, 10, bus.ids)]


@pytest.mark.parametrize(("firmware", "fast"), [(44, False), (45, True)])
def test_old_firmware_is_not_even_asked_for_it(firmware: int, fast: bool) -> None:
    far, servos, clock = fake(*X20[:4])
    for s in far.servos.values():
        s.set("firmware_version", firmware)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    assert any(Instruction.FAST_SYNC_READ == w[7] for w in far.writes) == fast
    assert bus.firmware == [firmware] * 4


@pytest.mark.parametrize(
    "names",
    [
        pytest.param(X20, id="fast", marks=pytest.mark.long),
        pytest.param(("MX-28",) * 6, id="mx1", marks=pytest.mark.long),
        pytest.param(("MX-64-2",) * 6, id="sync"),
        pytest.param(("AX-12A",) * 4, id="ax", marks=pytest.mark.long),
    ],
)
def test_a_dead_servo_costs_only_itself_and_almost_nothing_in_quarantine(names: tuple[str, ...]) -> None:
    bus, far, clock = bus_of(*names)

    def rate_hz(n: int = 1) -> float:
        start_s = clock.now_s()
        for _ in range(n):
            bus.exchange(np.full(len(names), 100, np.int32))
        return n / (clock.now_s() - start_s)

    before_hz = rate_hz(50)
    far.servos[2].silent = True
    valid = np.array([bus.exchange(None).valid.copy() for _ in range(15)])
    chained = (far.servos[1].fast and names[0].startswith("XM")) or names[0] == "MX-28"
    assert valid[2 if chained else 0 :, [0, *range(2, len(names))]].all(), (
        "the others answer, for themselves if need be"
    )
    assert not valid[:, 1].any()
    assert bus.chains[0].link.health.state[1] == Health.QUARANTINED and bus.timeouts[1] == 10
    assert BusEventKind.QUARANTINED in kinds(bus)
    for _ in range(25):
        bus.exchange(None)
    asked_s = clock.now_s()
    after_hz = rate_hz(500)
    assert after_hz > 0.95 * before_hz
    far.servos[2].silent = False
    while clock.now_s() < asked_s + 10 and not bus.exchange(None).valid[1]:
        pass
    assert bus.chains[0].link.health.state[1] == Health.OK and BusEventKind.RETURNED in kinds(bus)


def test_all_silent_at_once_is_named_and_nobody_is_given_up() -> None:
    bus, far, _ = bus_of(*X20)
    for s in far.servos.values():
        s.silent = True
    for _ in range(30):
        bus.exchange(None)
    assert kinds(bus) == [BusEventKind.BROWN_OUT]
    assert bus.chains[0].link.health.asked.all() and (bus.chains[0].link.health.state == Health.MISSING).all()
    for s in far.servos.values():
        s.silent = False
    assert bus.exchange(None).valid.all()


@pytest.mark.parametrize("slow_every", [1, 3])
def test_slow_registers_come_in_turn_for_every_family(slow_every: int) -> None:
    bus, far, clock = bus_of(*ALL_KINDS, slow_every=slow_every)
    for i, s in far.servos.items():
        s.set("present_input_voltage", 100 + i)
        s.set("present_temperature", 30 + i)
    assert (bus.reading.torque == -1).all(), "unknown before the first"
    bus.write_all("torque_enable", 1)
    for _ in range(2 * 9 * slow_every):
        reading = bus.exchange(None)
    assert reading.voltage_raw.tolist() == [101 + i for i in range(9)]
    assert reading.temperature_c.tolist() == [31 + i for i in range(9)]
    assert reading.torque.tolist() == [1] * 9
    assert (clock.now_s() - reading.slow_read_s < 1.0).all()


def test_indirect_windows_stand_where_model_and_firmware_have_them() -> None:
    far, servos, clock = fake("XM430-W350", "XL330-M288", "XL330-M288")
    old = far.servos[3]
    old.firmware = 45
    old.__post_init__()
    bus = ServoBus.on_port(far, servos, clock, slow_every=1)
    bus.verify()
    for i, s in far.servos.items():
        s.set("present_temperature", 40 + i)
    far.writes.clear()
    for _ in range(3):
        bus.exchange(None)
    asked = [int.from_bytes(w[8:10], "little") for w in far.writes if w[7] == Instruction.READ]
    assert asked == [224, 208, 224]
    assert bus.reading.temperature_c.tolist() == [41, 42, 43]


@pytest.mark.parametrize("name", ["XM430-W350", "XL330-M288", "AX-12A"])
def test_a_rebooted_servo_is_named_and_its_zeros_are_not_believed(name: str) -> None:
    bus, far, _ = bus_of(name, name, name, slow_every=1)
    for s in far.servos.values():
        s.set("present_temperature", 40)
    bus.write_all("torque_enable", 1)
    for _ in range(6):
        bus.exchange(None)
    assert kinds(bus) == []
    far.servos[2].reboot()
    far.servos[2].set("present_temperature", 40)
    for _ in range(6):
        bus.exchange(None)
    assert BusEventKind.REBOOTED in kinds(bus)
    assert bus.chains[0].link.health.state.tolist() == [Health.OK, Health.FAULTED, Health.OK]
    assert bus.reading.temperature_c.tolist() == [40] * 3
    bus.verify()
    bus.exchange(None)
    assert bus.chains[0].link.health.state.tolist() == [Health.OK] * 3, "verified anew"


def test_many_servos_without_torque_are_a_brown_out() -> None:
    bus, far, _ = bus_of(*X20[:6], slow_every=1)
    bus.write_all("torque_enable", 1)
    for s in list(far.servos.values())[:4]:
        s.reboot()
    for _ in range(12):
        bus.exchange(None)
    assert BusEventKind.BROWN_OUT in kinds(bus)


def test_the_watchdog_is_armed_where_it_exists_and_reported_where_not() -> None:
    bus, far, _ = bus_of(*ALL_KINDS)
    without = bus.arm_watchdog(10)
    assert set(without) == {3, 4, 5, 6, 7}, "the 330 size, and protocol 1.0"
    assert [far.servos[i].get("bus_watchdog") for i in (1, 2, 3, 8, 9)] == [10] * 5


def test_a_tripped_watchdog_is_cleared_only_after_the_torque_is_off() -> None:
    """Cleared under torque, the servo would go on to the goal it was stopped on the way to."""
    bus, far, _ = bus_of(*X20[:3])
    bus.write_all("torque_enable", 1)
    far.servos[2].set("bus_watchdog", -1)
    far.writes.clear()
    bus.clear_watchdog()
    to_2 = [w for w in far.writes if w[4] == 2 and w[7] == Instruction.WRITE]
    assert [int.from_bytes(w[8:10], "little") for w in to_2] == [64, 98]
    assert [s.get("torque_enable") for s in far.servos.values()] == [1, 0, 1]
    assert kinds(bus) == [BusEventKind.WATCHDOG_TRIPPED]


def test_effort_and_torque_off_reach_every_family() -> None:
    bus, far, _ = bus_of(*ALL_KINDS)
    bus.write_all("torque_enable", 1)
    bus.set_effort(0.5)
    assert far.servos[1].get("goal_pwm") == 442 and far.servos[6].get("torque_limit") == 512
    bus.send_torque_off()
    assert all(s.get("torque_enable") == 0 for s in far.servos.values())


def test_hardware_errors_in_words_for_both_protocols() -> None:
    bus, far, _ = bus_of("XM430-W350", "AX-12A", "XM430-W350")
    for i in (1, 2):
        far.servos[i].hardware_error = 0b100100
    far.servos[1].set("hardware_error_status", 0b100100)
    reading = bus.exchange(None)
    assert reading.error.tolist() == [0x80, 0x80, 0]
    assert {bus.hardware_error_text(i) for i in (1, 2)} == {"overheating, overload"}
    assert bus.chains[0].link.health.state.tolist() == [Health.FAULTED, Health.FAULTED, Health.OK]
    assert bus.chains[0].link.health.counters.alerts.tolist() == [1, 1, 0]
    bus.exchange(None)
    events = [e.servo_id for e in bus.chains[0].link.events.take() if e.kind is BusEventKind.HARDWARE_ERROR]
    assert events == [1, 2], "told when it begins, not in every cycle"


def test_what_is_not_there_is_named() -> None:
    far, servos, clock = fake("XM430-W350", "AX-12A")
    far.servos[2].silent = True
    far.servos[1].set("model_number", 1060)
    bus = ServoBus.on_port(far, servos, clock)
    with pytest.raises(BusMismatchError, match=r"XL430-W250 \(model 1060\), firmware 52"):
        bus.verify()
    with pytest.raises(CommandError, match="no servo 9 on this bus; there are 1, 2"):
        bus.read_item(9, "led")
    with pytest.raises(CommandError, match="no servo on fake:// has an item 'elan'"):
        bus.chains[0].registers.send_all("elan", 1)


def test_a_servo_without_a_control_table_is_refused() -> None:
    far, servos, clock = fake("XM430-W350")
    strange = replace(servos[0].model, name="XQ-1", model_number=9999)
    odd = replace(servos[0], joint_name="arm", model=strange)
    with pytest.raises(ConfigError, match=r"XQ-1.*known: XH430-W350"):
        ServoBus.on_port(far, [odd], clock)


def test_an_emulator_whose_parts_carry_no_checksums_is_understood() -> None:
    """Some only end the common packet in a right CRC."""
    bus, far, _ = bus_of(*X20[:3])

    def spoil(raw: bytes, _servo_id: int) -> bytes:
        whole = fast_status([Part(i, 0, raw[10 + 14 * (i - 1) : 20 + 14 * (i - 1)]) for i in (1, 2, 3)])
        return whole if raw[7] == Instruction.STATUS and len(raw) == len(whole) else raw

    far.spoil = spoil
    assert bus.exchange(None).valid.all()


def test_models_of_the_table_and_of_this_test_agree() -> None:
    assert {m.family for m in MODELS.values()} == {
        "x_current",
        "x_load",
        "x330",
        "mx2_load",
        "mx2_current",
        "mx1",
        "ax",
        "y",
        "p",
    }
