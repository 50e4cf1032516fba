"""The servo bus over simulated servos: exchanges, losses, errors, and what is on the bus."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import BusMismatchError, CommandError, LinkLostError, LinkTimeoutError, ServoFaultError
from sim.faults import Fault, FaultSchedule
from tests.support.bus_rig import bus_rig
from tests.support.servo_emulator import fake, spec
from tests.support.sizes import few_and_long


def test_an_exchange_writes_every_goal_and_reads_every_servo() -> None:
    rig = bus_rig()
    rig.bus.verify()
    goals = rig.bus.exchange(None).position_tick + 5
    reading = rig.bus.exchange(goals)
    assert reading.valid.all()
    assert [rig.servos.servos[i].get("goal_position") for i in rig.bus.ids] == goals.tolist()
    assert reading.age_cycles.tolist() == [0] * 16


def test_negative_goals_and_ids_are_stuffed_where_needed() -> None:
    """-1 is FF FF FF FF on the wire: with an id of FD after it a header would appear; ids end at 252, bytes do not."""
    rig = bus_rig()
    goals = np.full(16, 0x00FDFFFF, np.int32)  # FF FF FD 00: a header in every goal
    rig.bus.exchange(goals)
    assert rig.bus.exchange(None).valid.all()
    assert sum(rig.servos.audit.violations.values()) == 16, "each servo read the goal and refused it"


def test_one_silent_servo_costs_itself_only_and_keeps_its_last_value() -> None:
    rig = bus_rig(Fault("silent", start_s=0.1, servo_id=7))
    before = rig.bus.exchange(None)
    row = rig.bus.ids.index(7)
    last = int(before.position_tick[row])
    rig.clock.sleep_until(0.2)
    start_s = rig.clock.now_s()
    reading = rig.bus.exchange(None)
    assert rig.clock.now_s() - start_s < 0.012, "one bounded deadline, not 34 ms a servo"
    assert np.flatnonzero(~reading.valid).tolist() == [row]
    assert reading.position_tick[row] == last
    assert reading.age_cycles[row] == 1


@pytest.mark.parametrize("kind", few_and_long(["corrupt"], ["drop", "corrupt"]))
def test_lost_and_broken_replies_lose_only_themselves(kind: str) -> None:
    rig = bus_rig(Fault(kind, probability=0.05))
    answered = np.zeros(16, int)
    for i in range(200):
        for servo in rig.servos.servos.values():
            servo.position_tick = 1000.0 + i  # a value that belongs to this cycle alone
        reading = rig.bus.exchange(None)
        answered += reading.valid
        assert (reading.position_tick[reading.valid] == 1000 + i).all(), "a valid value is never an old one"
    assert (answered > 160).all()
    assert answered.sum() < 16 * 200, "the fault was there"


def test_answers_that_come_too_late_are_not_taken_for_the_next_ones() -> None:
    """A loaded machine answered after the deadline; every later cycle then read the one before it, for ever."""
    rig = bus_rig()
    rig.servos.wire.answer(0.0, b"\xff\xff\xfd\x00\x01\x0e\x00\x55\x00", rig.port.baud)
    rig.clock.sleep_until(0.001)
    assert rig.bus.exchange(None).valid.all()


def test_the_hardware_alert_comes_with_every_reading() -> None:
    rig = bus_rig()
    rig.servos.servos[3].trip(1 << 5)
    assert rig.bus.exchange(None).error[rig.bus.ids.index(3)] == 0x80


def test_other_servos_than_the_file_says_are_shown_in_a_table() -> None:
    rig = bus_rig(Fault("silent", servo_id=16))
    rig.servos.servos[2]._set("model_number", 1060)
    with pytest.raises(BusMismatchError) as caught:
        rig.bus.verify()
    text = str(caught.value)
    assert [r.servo_id for r in caught.value.rows] == [2, 16]
    assert "head_pitch" in text and "XL330-M288" in text and "model 1060" in text and "no answer" in text
    assert "head_yaw" not in text, "only what differs is listed"


@pytest.mark.parametrize(("n", "silent"), [(1, [0]), (2, [0]), (3, [0]), (3, [0, 1]), (4, [0, 1, 2]), (9, [0, 1, 2])])
def test_whoever_answers_is_found_behind_silent_ones(n: int, silent: list[int]) -> None:
    """Of three servos the first was taken for the fourth: when it was silent all three were "no answer", wrong baud."""
    rig = bus_rig()
    ids = rig.bus.ids[:n]
    rig.servos.faults = FaultSchedule([Fault("silent", servo_id=ids[i]) for i in silent])
    bus = ServoBus.on_port(rig.port, rig.robot.servos[:n], rig.clock)
    with pytest.raises(BusMismatchError) as caught:
        bus.verify()
    assert [r.servo_id for r in caught.value.rows] == [ids[i] for i in silent]
    assert ("nothing answers" in str(caught.value)) == (len(silent) == n)


@pytest.mark.parametrize("servo_id", [1, 7, 16])
def test_a_servo_held_up_beyond_the_timeout_is_read_once_more(servo_id: int) -> None:
    """A machine that stalled for a tenth of a second at its first servo refused to arm: "no answer"."""
    rig = bus_rig(Fault("silent", 0.0, 0.15, servo_id=servo_id))
    rig.bus.verify()
    assert rig.clock.now_s() > 0.1 and rig.bus.chains[0].link.health.counters.retries[rig.bus.ids.index(servo_id)] >= 2


def test_a_silent_bus_is_given_up_after_four_servos() -> None:
    rig = bus_rig(Fault("silent"))
    with pytest.raises(BusMismatchError, match="nothing answers") as caught:
        rig.bus.verify()
    assert [r.found for r in caught.value.rows] == ["no answer"] * 16
    assert rig.clock.now_s() < 0.6


@pytest.mark.parametrize(("there", "expected"), [("MX-28", "MX-28-2"), ("MX-64-2", "MX-64")])
def test_a_servo_of_the_other_protocol_is_named(there: str, expected: str) -> None:
    far, _, clock = fake("XM430-W350", there)
    bus = ServoBus.on_port(far, [spec("XM430-W350", 1), spec(expected, 2)], clock)
    with pytest.raises(BusMismatchError) as caught:
        bus.verify()
    model = MODELS[MODEL_NUMBERS[there]]
    (row,) = caught.value.rows
    assert row.found == f"speaks protocol {model.protocol}: {there} (model {model.model_number}), firmware 52"
    assert "one protocol on a bus" in str(caught.value)


@pytest.mark.parametrize("name", ["XM430-W350", "AX-12A"])
def test_a_servo_that_answers_pings_only_is_named_as_such(name: str) -> None:
    """It was said to have no cable or no power."""
    far, servos, clock = fake("XL430-W250", name)
    far.servos[2].set("status_return_level", 0)
    bus = ServoBus.on_port(far, servos, clock)
    with pytest.raises(BusMismatchError, match="doctor --fix") as caught:
        bus.verify()
    assert [(r.servo_id, r.found) for r in caught.value.rows] == [(2, "answers pings only: status return level 0")]
    bus.let_answer()
    bus.verify()


@pytest.mark.parametrize(("limit", "steps"), [(600, (150, 300, 600)), (200, (50, 100, 200)), (885, (221, 442, 885))])
def test_effort_is_a_share_of_what_a_servo_allows_itself(limit: int, steps: tuple[int, ...]) -> None:
    """Steps of 885 units were refused without a word by a servo of limit 600, and one of 200 could not be armed."""
    rig = bus_rig()
    servo = rig.servos.servos[5]
    servo._set("pwm_limit", limit)
    rig.bus.verify()
    for confirmed in (True, False):
        for share, value in zip((0.25, 0.5, 1.0), steps, strict=True):
            rig.bus.set_effort(share, confirmed=confirmed)
            rig.bus.exchange(None)
            assert servo.get("goal_pwm") == value
            assert rig.servos.servos[6].get("goal_pwm") == round(885 * share)


def test_a_torque_limit_does_not_pass_the_max_torque_that_was_set() -> None:
    rig = bus_rig(name="op2")
    servo = rig.servos.servos[3]
    servo._set("max_torque", 400)
    rig.bus.verify()
    rig.bus.set_effort(1.0, confirmed=True)
    assert servo.get("torque_limit") == 400 and rig.servos.servos[4].get("torque_limit") == 1023
    rig.bus.set_effort(0.5)
    rig.bus.exchange(None)
    assert servo.get("torque_limit") == 200 and rig.servos.servos[4].get("torque_limit") == 512


def test_a_wrong_baud_is_named_as_a_possible_cause() -> None:
    rig = bus_rig(baud=57600)
    with pytest.raises(BusMismatchError, match="nothing answers at 57600 baud"):
        rig.bus.verify()


def test_items_are_read_and_written_by_name_and_refusals_are_named() -> None:
    rig = bus_rig()
    rig.bus.write_item(1, "led", 1)
    assert rig.bus.read_item(1, "led") == 1
    with pytest.raises(ServoFaultError, match=r"servo 1.*data limit"):
        rig.bus.write_item(1, "goal_position", 9000)
    with pytest.raises(CommandError, match="read only"):
        rig.bus.write_item(1, "present_position", 0)
    with pytest.raises(CommandError, match="no item 'elan'"):
        rig.bus.read_item(1, "elan")
    with pytest.raises(CommandError, match="does not fit"):
        rig.bus.write_item(1, "led", 300)


def test_a_servo_that_never_answers_times_out_after_three_tries() -> None:
    rig = bus_rig(Fault("silent", servo_id=4))
    with pytest.raises(LinkTimeoutError, match="servo 4"):
        rig.bus.read_item(4, "led")
    assert rig.clock.now_s() < 0.15


def test_an_unplugged_port_is_lost_not_slow() -> None:
    rig = bus_rig(Fault("unplug", start_s=1.0))
    rig.bus.exchange(None)
    rig.clock.sleep_until(1.5)
    with pytest.raises(LinkLostError, match="lost"):
        rig.bus.exchange(None)
