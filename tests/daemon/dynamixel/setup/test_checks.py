"""Settings that must not stand in a servo's memory: found on simulated servos, refused, corrected only when told to."""

from __future__ import annotations

import pytest

from daemon.dynamixel.registers.rules import ADVISED, NEEDED, Finding
from daemon.dynamixel.setup.checks import check_servos, fix, require_needed
from daemon.errors import BusMismatchError
from tests.support.bus_rig import BusRig, bus_rig


def findings_of(rig: BusRig, servo_id: int, severity: str) -> dict[str, Finding]:
    """What is said of one servo, by item."""
    found = check_servos(rig.bus, rig.robot)
    return {f.item: f for f in found if (f.servo_id, f.severity) == (servo_id, severity)}


@pytest.mark.parametrize(
    ("item", "value", "right"),
    [
        ("drive_mode", 0b1000, 0), ("drive_mode", 0b1101, 0), ("drive_mode", 0b0010, None),
        ("startup_configuration", 0b01, 0), ("startup_configuration", 0b11, 0b10), ("startup_configuration", 0b10, None),
    ],
)  # fmt: skip
def test_a_servo_that_would_switch_its_torque_on_by_itself_is_refused(item: str, value: int, right: int | None) -> None:
    """With drive mode bit 3 the first goal after a reboot put torque on wherever the joint had fallen to by then."""
    rig = bus_rig()
    rig.bus.verify()
    servo = rig.servos.servos[1]
    servo._set(item, value)
    found = findings_of(rig, 1, NEEDED)
    assert {i: f.fix for i, f in found.items()} == ({} if right is None else {item: right})
    assert servo.get(item) == value, "looking changes nothing"
    if right is None:
        return
    with pytest.raises(BusMismatchError, match=rf"{item} {right} \(.*no torque (by goal|at power-on)"):
        require_needed(list(found.values()))
    fix(rig.bus, list(found.values()))
    assert servo.get(item) == right and not findings_of(rig, 1, NEEDED)
    servo.reboot()
    rig.clock.sleep_until(rig.clock.now_s() + 1.0)
    rig.bus.exchange(rig.bus.exchange(None).position_tick)
    assert not servo.torque


@pytest.mark.parametrize(("name", "item"), [("reference", "pwm_limit"), ("op2", "max_torque")])
def test_a_servo_that_may_exert_nothing_is_refused_and_a_low_limit_is_not(name: str, item: str) -> None:
    rig = bus_rig(name=name)
    rig.bus.verify()
    servo_id = rig.bus.ids[2]
    for value, refused in ((300, False), (0, True)):
        rig.servos.servos[servo_id]._set(item, value)
        found = findings_of(rig, servo_id, NEEDED)
        assert list(found) == [item] * refused and all(f.fix is None for f in found.values())
    with pytest.raises(BusMismatchError, match=rf"torque off: mmmd servo set {servo_id} {item} \d+ or less$"):
        require_needed(list(found.values()))


@pytest.mark.parametrize("name", ["op2", "op3", "poppy_torso", "reachy_2021", "toddlerbot"])
def test_servos_without_such_items_are_checked_as_well(name: str) -> None:
    """MX has no startup configuration, and Protocol 1.0 neither item."""
    rig = bus_rig(name=name)
    rig.bus.verify()
    require_needed(check_servos(rig.bus, rig.robot))


@pytest.mark.parametrize(("offset", "armed"), [(200, False), (-7, False), (0, True)])
def test_a_watchdog_that_would_move_its_joint_is_not_armed(offset: int, armed: bool) -> None:
    """In extended position mode a trip moved the joint by its homing offset: a stall of 1 s moved it by 199 ticks."""
    rig = bus_rig(name="toddlerbot")
    servo = rig.servos.servos[17]
    servo.write(servo.items["homing_offset"].address, offset.to_bytes(4, "little", signed=True))
    rig.bus.verify()
    said = findings_of(rig, 17, ADVISED).get("homing_offset")
    assert (said is None) == armed
    if said is not None:
        assert said.fix is None and "mmmd servo set 17 homing_offset 0" in said.remedy and "calibrate" in said.remedy
    rig.bus.exchange(rig.bus.exchange(None).position_tick)
    rig.bus.write_all("torque_enable", 1)
    before = rig.bus.exchange(None).position_tick.copy()
    assert (17 in rig.bus.arm_watchdog(10)) != armed
    rig.clock.sleep_until(rig.clock.now_s() + 1.0)
    after = rig.bus.exchange(None).position_tick
    assert abs(after - before).max() <= 5
    assert set(rig.bus.ids) - set(rig.bus.tripped_watchdogs()) == (set() if armed else {17})


def test_a_homing_offset_in_position_mode_keeps_the_watchdog() -> None:
    rig = bus_rig(name="op3")
    servo = rig.servos.servos[1]
    servo.write(servo.items["homing_offset"].address, (20).to_bytes(4, "little"))
    rig.bus.verify()
    assert 1 not in rig.bus.arm_watchdog(10) and "homing_offset" not in findings_of(rig, 1, ADVISED)


@pytest.mark.parametrize("name", ["toddlerbot", "op2"])
def test_ids_and_settings_are_compared_with_five_reads_a_servo(name: str) -> None:
    rig = bus_rig(name=name)
    rig.bus.verify()
    sent: list[bytes] = []
    write = rig.port.write
    rig.port.write = lambda data: (sent.append(data), write(data))[1]  # type: ignore[method-assign]
    rig.bus.verify()
    require_needed(check_servos(rig.bus, rig.robot))
    assert len(sent) == 5 * len(rig.bus.ids)
    servo = rig.servos.servos[rig.bus.ids[0]]
    servo._set("status_return_level", 1)
    with pytest.raises(BusMismatchError, match="status_return_level 2"):
        require_needed(check_servos(rig.bus, rig.robot))
    servo._set("model_number", 9)
    with pytest.raises(BusMismatchError, match="unknown"):
        rig.bus.verify()
