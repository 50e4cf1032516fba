"""A bus of X, Y and P together, as `ffw_bg2` has it: each family at its own addresses, none taken for another."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.control.derating import FULL_LOAD, read_limits
from daemon.control.pinning import pin_where_they_stand, reading_at_rest
from daemon.dynamixel.codec.packet import Instruction, PacketDecoder
from daemon.dynamixel.rate_plan import plan_for
from daemon.dynamixel.registers.models import MODELS
from daemon.dynamixel.registers.rules import ADVISED, NEEDED
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.checks import check_servos, fix, require_needed
from daemon.errors import BusMismatchError, ServoFaultError
from daemon.recording.wiretap import Wiretap
from tests.support.bus_rig import BusRig, bus_rig

X_ID, Y_ID, P_ID = 61, 31, 37


def ffw(slow_every: int = 0) -> BusRig:
    """A verified bus of its 16 servos."""
    rig = bus_rig(name="ffw_bg2")
    rig.bus = ServoBus.on_port(rig.port, rig.robot.servos, rig.clock, slow_every=slow_every)
    rig.bus.verify()
    return rig


def test_one_exchange_brings_goals_and_feedback_of_all_three_families() -> None:
    rig = ffw()
    rig.bus.write_all("torque_enable", 1)
    goals = rig.bus.exchange(None).position_tick + np.array([s.model.ticks_per_turn // 500 for s in rig.robot.servos])
    reading = rig.bus.exchange(None)
    for _ in range(100):
        reading = rig.bus.exchange(goals.astype(np.int32))
        assert reading.valid.all()
    by_id = dict(zip(rig.bus.ids, goals, strict=True))
    for servo_id, servo in rig.servos.servos.items():
        assert servo.memory.get("goal_position") == by_id[servo_id]
        row = rig.bus.ids.index(servo_id)
        assert reading.position_tick[row] == pytest.approx(servo.position_tick, abs=200)


def test_16_servos_at_4_mbit_need_a_fifth_of_100_hz() -> None:
    rig = ffw()
    plan = rig.bus.plan()
    assert plan.requests == 3 and plan.require(100.0) and plan.cycle_s < 0.002
    ahead = plan_for([MODELS[s.model.model_number] for s in rig.robot.servos], 4_000_000)
    assert ahead.goal_bytes == plan.goal_bytes == 3 * 14 + 16 * 5
    assert (ahead.request_bytes, ahead.reply_bytes) == (plan.request_bytes, plan.reply_bytes) == (3 * 14 + 16, 16 * 21)


@pytest.mark.parametrize("silent", [X_ID, Y_ID, P_ID])
def test_a_silent_servo_of_any_family_is_missing_alone(silent: int) -> None:
    rig = ffw()
    rig.servos.servos[silent].silent_until_s = 1e9
    reading = rig.bus.exchange(None)
    assert [i for i, ok in zip(rig.bus.ids, reading.valid, strict=True) if not ok] == [silent]


def test_slow_registers_come_through_windows_also_of_y_and_p() -> None:
    """Y measures two temperatures, in hundredths of a volt; all that is told is in tenths."""
    rig = ffw(slow_every=1)
    assert rig.bus.chains[0].probe.slow.n_windows == 16
    rig.servos.world.drives.temperature_c[:] = 41.0
    rig.servos.world.drives.touch()
    reading = rig.bus.exchange(None)
    for _ in range(20):
        reading = rig.bus.exchange(None)
    assert not reading.torque.any() and not reading.hardware_error.any()
    assert (np.abs(reading.temperature_c - 41) <= 1).all()
    volts = dict(zip(rig.bus.ids, reading.voltage_raw, strict=True))
    assert (volts[X_ID], volts[Y_ID], volts[P_ID]) == (120, 240, 240)


def test_a_kept_window_is_not_written_again() -> None:
    """Their indirect addresses are EEPROM: each start would wear it."""
    rig = ffw(slow_every=1)
    again = ServoBus.on_port(rig.port, rig.robot.servos, rig.clock, slow_every=1)
    sent, write = list[bytes](), rig.port.write
    rig.port.write = lambda data: (sent.append(data), write(data))[1]  # type: ignore[method-assign]
    again.verify()
    written = {p.servo_id for p in PacketDecoder().feed(b"".join(sent)) if p.instruction == Instruction.WRITE}
    assert again.chains[0].probe.slow.n_windows == 16 and written == {61, 62}


@pytest.mark.parametrize(
    ("servo_id", "item", "value", "severity", "right"),
    [
        (Y_ID, "profile_velocity", 2020, NEEDED, 0),  # as from the factory
        (P_ID, "profile_velocity", 100, ADVISED, 0),
        (X_ID, "profile_velocity", 100, None, None),  # somebody has set it since power-on, as ever
        (Y_ID, "drive_mode", 69, NEEDED, 64),  # as ROBOTIS' AI Worker: dynamic brake, time-based, reverse
        (Y_ID, "electronic_gearratio_numerator", 1, NEEDED, 99),
        (Y_ID, "operating_mode", 1, NEEDED, 3),
        (Y_ID, "startup_configuration", 1, NEEDED, 0),
        (Y_ID, "status_return_level", 1, NEEDED, 2),
        (P_ID, "drive_mode", 8, NEEDED, 0),
        (P_ID, "shutdown", 58, ADVISED, 62),  # as from the factory: heat does not cut its torque
    ],
)  # fmt: skip
def test_settings_of_y_and_p_are_judged_by_their_own_items(servo_id, item, value, severity, right) -> None:
    rig = ffw()
    before = check_servos(rig.bus, rig.robot)
    require_needed(before)
    assert {f.item for f in before} == {"min_position_limit", "max_position_limit"}
    servo = rig.servos.servos[servo_id]
    servo._set(item, value)
    found = [f for f in check_servos(rig.bus, rig.robot) if f.servo_id == servo_id and "position_limit" not in f.item]
    assert [(f.item, f.severity, f.fix) for f in found] == ([] if severity is None else [(item, severity, right)])
    if severity is NEEDED:
        with pytest.raises(BusMismatchError, match=item):
            require_needed(found)
    assert not fix(rig.bus, found)
    assert severity is None or servo.get(item) == right


def test_errors_heat_and_voltage_of_a_y_are_told_in_words() -> None:
    rig = ffw()
    servo, row = rig.servos.servos[Y_ID], rig.bus.ids.index(Y_ID)
    rig.servos.world.drives.temperature_c[row] = 58.0
    servo.trip(1 << 5)
    said = {f.item: f.found for f in check_servos(rig.bus, rig.robot) if f.servo_id == Y_ID}
    assert said["error_code"] == "overload" and said["present_motor_temperature"] == "58 degC"
    assert "present_inverter_temperature" not in said and "present_input_voltage" not in said
    assert rig.bus.hardware_error_text(Y_ID) == "overload" and rig.bus.hardware_error_text(P_ID) == "none"


def test_limits_for_slowing_down_are_those_of_each_family() -> None:
    """Of Y the motor's 60 degrees, or what the inverter's limit leaves where that is lower."""
    rig = ffw()
    rig.servos.servos[32]._set("inverter_temperature_limit", 70)
    limits = read_limits(rig.bus)
    row = rig.bus.ids.index
    assert [limits.temperature_c[row(i)] for i in (X_ID, Y_ID, 32, P_ID)] == [80, 60, 50, 80]
    assert [limits.voltage_raw[row(i)] for i in (X_ID, Y_ID, P_ID)] == [95, 160, 150]
    assert [limits.current_raw[row(i)] for i in (X_ID, Y_ID, P_ID)] == [1193, 2080, 4500]
    assert FULL_LOAD not in limits.current_raw


def test_effort_is_a_share_of_each_servos_own_pwm_limit() -> None:
    rig = ffw()
    rig.servos.servos[P_ID]._set("pwm_limit", 1000)
    rig.bus.verify()
    rig.bus.set_effort(0.3, confirmed=True)
    found = [rig.servos.servos[i].get("goal_pwm") for i in (X_ID, Y_ID, P_ID)]
    rig.bus.set_effort(0.5)
    rig.bus.exchange(None)
    assert (found, [rig.servos.servos[i].get("goal_pwm") for i in (X_ID, Y_ID, P_ID)]) == (
        [266, 300, 300], [442, 500, 500],
    )  # fmt: skip


def test_every_watchdog_is_armed_trips_and_is_cleared_without_torque() -> None:
    rig = ffw()
    rig.bus.exchange(rig.bus.exchange(None).position_tick)
    rig.bus.write_all("torque_enable", 1)
    assert rig.bus.arm_watchdog(10) == ()
    rig.clock.sleep_until(rig.clock.now_s() + 1.0)
    assert sorted(rig.bus.tripped_watchdogs()) == sorted(rig.bus.ids)
    assert rig.bus.hardware_error_text(Y_ID) == "bus watchdog"
    rig.bus.clear_watchdog()
    assert not rig.bus.tripped_watchdogs() and not any(s.torque for s in rig.servos.servos.values())
    assert not any(s.error for s in rig.servos.servos.values())


def ended(rig: BusRig, steps):
    """What a generator returns; a cycle goes by at each of its steps."""
    while True:
        try:
            next(steps)
            rig.clock.sleep_until(rig.clock.now_s() + rig.robot.bus.period_s)
        except StopIteration as end:
            return end.value


@pytest.mark.parametrize(("ticks", "pinned_anew"), [(900, False), (1200, True)])
def test_a_fine_servo_may_be_as_many_degrees_from_its_pin_as_a_coarse_one(ticks: int, pinned_anew: bool) -> None:
    """8 of 4096 ticks are 1024 of 524,288. Its encoder is never still to two ticks of these, as a coarse one is."""
    rig = ffw()
    servo, moved = rig.servos.servos[Y_ID], list[int]()

    def push(_t_s: float, servo_id: int, _tick: int) -> None:
        if servo_id == rig.bus.ids[-1] and not moved:
            moved.append(ticks)
            servo.position_tick = servo.position_tick + ticks

    before = round(servo.position_tick)
    rig.servos.on_goal = push
    reading = ended(rig, reading_at_rest(rig.bus, rig.clock))
    present = ended(rig, pin_where_they_stand(rig.bus, rig.clock, reading, 0.3))
    assert present[rig.bus.ids.index(Y_ID)] == pytest.approx(before + ticks * pinned_anew, abs=2)


def test_a_y_outside_its_own_limits_is_named_with_them() -> None:
    rig = ffw()
    rig.servos.servos[Y_ID].position_tick = 262144 + 9000
    with pytest.raises(ServoFaultError, match="it takes -262144 to 262144 only"):
        ended(rig, pin_where_they_stand(rig.bus, rig.clock, rig.bus.exchange(None), 0.3))


def test_the_wiretap_sees_the_goals_of_all_families_as_one_set() -> None:
    rig = ffw()
    places = {(m.table["goal_position"].address, m.table["goal_position"].size) for m in rig.bus.models}
    assert places == {(116, 4), (532, 4), (564, 4)}
    link = rig.bus.chains[0].link
    link.port = tap = Wiretap(link.port, rig.bus.ids, places)
    goals = rig.bus.exchange(None).position_tick.copy()
    rig.bus.exchange(goals)
    assert tap.writes == 1 and (tap.goal_tick == goals).all()
