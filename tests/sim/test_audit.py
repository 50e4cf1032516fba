"""The audit catches what it is there for, and nothing else."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet
from retarget.path.collision import SelfContact
from retarget.robot.loading import load_robot
from retarget.robot.ticks import JointServoMap
from sim.audit.audit import ANSWERS_TOLD, TTY_GOALS, Audit
from sim.audit.contact_audit import EVERY, ContactAudit
from sim.faults import Fault
from tests.support.robots import packaged
from tests.support.servo_bench import Bench

ROBOT = packaged("reference")
SERVO = ROBOT.servos[2]  # waist_yaw: an XM430 without gear
JOINT = ROBOT.joints[2]
TICKS_PER_RAD = 4096 / (2 * math.pi)
STEP = JOINT.velocity_limit_rad_s * TICKS_PER_RAD / ROBOT.bus.rate_hz
BEND = JOINT.acceleration_limit_rad_s2 * TICKS_PER_RAD / ROBOT.bus.rate_hz**2


def audited(*goals: int, on_at: int | None = None) -> dict[str, int]:
    audit = Audit(ROBOT)
    first = goals[0] if on_at is None else on_at
    audit.torque(0.0, SERVO.servo_id, True, first, first)
    for i, tick in enumerate(goals):
        audit.goal(0.01 * i, SERVO.servo_id, tick, True)
    return dict(audit.violations)


def test_a_gentle_path_is_clean() -> None:
    path = [2048 + round(50 * (1 - math.cos(i / 20))) for i in range(200)]
    assert audited(*path) == {}


@pytest.mark.parametrize(
    ("goals", "kind"),
    [
        ((2048, 2048 + math.ceil(BEND) + 3), "acceleration"),
        (tuple(2048 + i * (math.ceil(STEP) + 2) for i in range(8)), "velocity"),
        (tuple(range(2600, 2800, 2)), "position"),
    ],
)
def test_each_kind_of_violation_is_found(goals: tuple[int, ...], kind: str) -> None:
    assert kind in audited(*goals)


def test_a_step_at_the_limit_with_its_rounding_is_no_violation() -> None:
    goals, position, velocity = [2048], 2048.0, 0.0
    while velocity < STEP and len(goals) < 100:
        velocity = min(STEP, velocity + BEND)
        position += velocity
        goals.append(round(position))
    assert audited(*goals) == {}


def test_a_joint_found_outside_its_range_may_come_back_but_not_go_further() -> None:
    outside = 2048 + math.ceil(JOINT.position_max_rad * TICKS_PER_RAD) + 50
    back = [outside - round(0.5 * i * i) for i in range(9)]
    assert audited(*back, on_at=outside) == {}
    assert "position" in audited(outside, outside + 1, on_at=outside)


def test_torque_over_a_goal_away_from_the_joint_is_a_violation() -> None:
    audit = Audit(ROBOT)
    audit.torque(0.0, SERVO.servo_id, True, 2048, 2000)
    assert dict(audit.violations) == {"unpinned_torque": 1}


def test_goals_without_torque_are_counted_but_not_judged() -> None:
    audit = Audit(ROBOT)
    audit.goal(0.0, SERVO.servo_id, 0, False)
    assert (audit.goals, dict(audit.violations)) == (1, {})


def hurried(period_s: float, n: int, wait_s: float = 0.0, **options: int) -> bool:
    """Whether `n` goals that move a servo, `period_s` apart, are too many; the first `wait_s` after torque came on."""
    audit = Audit(ROBOT, **options)
    audit.torque(0.0, SERVO.servo_id, True, 2048, 2048)
    for i in range(n):
        audit.goal(wait_s + period_s * i, SERVO.servo_id, 2048 + i % 2, True)
    return "hurry" in audit.violations


def test_goals_faster_than_the_robots_rate_are_a_violation_unless_queued() -> None:
    assert not hurried(0.01, 500)
    assert hurried(0.005, 100), "twice the rate of the robot's file"
    assert hurried(0.0015, 25, wait_s=0.25), "in process nothing waits"
    assert not hurried(0.0015, 25, wait_s=0.25, waiting_goals=TTY_GOALS), "what waited in a tty comes at once"
    assert not hurried(0.02, 200)


@given(st.lists(st.floats(0.0, 0.99), min_size=1, max_size=200))
def test_cycles_that_are_late_but_never_by_a_period_are_no_burst(late: list[float]) -> None:
    """A cycle that was held up is made up for by the next ones, which start at once: that is as it should be."""
    audit, period_s = Audit(ROBOT), ROBOT.bus.period_s
    audit.torque(0.0, SERVO.servo_id, True, 2048, 2048)
    t_s = 0.0
    for i, share in enumerate(late):
        t_s = max(t_s, (i + share) * period_s)
        audit.goal(t_s, SERVO.servo_id, 2048 + i % 2, True)
    assert not audit.violations


def test_a_goal_lost_on_the_wire_is_not_a_step_of_the_daemons() -> None:
    step = int(STEP)
    audit = Audit(ROBOT)
    audit.torque(0.0, SERVO.servo_id, True, 2048, 2048)
    path = [2048 + round(min(i, 40) ** 2 * BEND / 2.2) for i in range(12)]
    assert path[-1] - path[-3] > step / 2
    for i, tick in enumerate(path):
        if i == 9:
            audit.missed(0.01 * i, SERVO.servo_id, tick)
        else:
            audit.goal(0.01 * i, SERVO.servo_id, tick, True)
    assert dict(audit.violations) == {}


def test_goals_to_a_tripped_servo_count_and_torque_is_a_violation() -> None:
    audit = Audit(ROBOT)
    for i in range(30):
        audit.goal(0.01 * i, SERVO.servo_id, 2048, False, faulted=True)
    assert audit.report()["writes_in_fault"] == 19 and audit.report()["violations"] == 0
    for _ in range(ANSWERS_TOLD):
        audit.heard_in_fault(0.3, SERVO.servo_id)
    for i in range(300):
        audit.goal(0.3 + 0.01 * i, SERVO.servo_id, 2048, False, faulted=True)
    assert audit.report()["violations"] == 0, "a group that holds may tell it to stand still"
    audit.torque_in_fault(1.0, SERVO.servo_id)
    assert audit.report()["violations_by_kind"] == {"torque_in_fault": 1}


@pytest.mark.parametrize(("answers", "violations"), [(0, 0), (1, 1)])
def test_torque_for_a_tripped_servo_is_a_violation_once_it_was_reported(answers: int, violations: int) -> None:
    audit = Audit(ROBOT)
    audit.goal(0.0, SERVO.servo_id, 2048, False)  # pinned
    for _ in range(answers):
        audit.heard_in_fault(0.002, SERVO.servo_id)
    audit.torque_in_fault(0.003, SERVO.servo_id)
    assert audit.report()["violations"] == violations


def led_on(alerts: int, for_s: float) -> dict[str, int]:
    """A servo that has tripped and told so often is led on for so long."""
    audit = Audit(ROBOT)
    audit.torque(0.0, SERVO.servo_id, True, 2048, 2048)
    for _ in range(alerts):
        audit.heard_in_fault(0.0, SERVO.servo_id)
    for i in range(round(for_s * 100)):
        audit.goal(0.01 * i, SERVO.servo_id, 2048 + i, False, faulted=True)
    return dict(audit.violations)


def test_a_servo_reported_as_tripped_may_only_come_to_rest() -> None:
    rest_s = JOINT.velocity_limit_rad_s / JOINT.acceleration_limit_rad_s2
    assert led_on(ANSWERS_TOLD, rest_s) == {}
    assert led_on(ANSWERS_TOLD - 1, rest_s + 5.0) == {}, "nobody may have heard it"
    assert led_on(ANSWERS_TOLD, rest_s + 0.2).keys() == {"goal_in_fault"}


ASKS = {
    "read": packet.read(1, 132, 4),
    "sync": packet.sync_read(132, 4, [1]),
    "fast": packet.sync_read(132, 4, [1], fast=True),
}


@pytest.mark.parametrize(
    ("ask", "spoilt", "kind"),
    [("read", None, "goal_in_fault"), ("sync", None, "goal_in_fault"), ("fast", None, "goal_in_fault"),
     ("sync", "drop", None), ("sync", "corrupt", None), ("fast", "corrupt", None)],
)  # fmt: skip
def test_a_trip_is_known_to_the_client_when_whole_answers_have_told_it(
    ask: str, spoilt: str | None, kind: str | None
) -> None:
    b = Bench(faults=(Fault("overload", start_s=1.0), *([Fault(spoilt)] if spoilt else [])))
    b.send(packet.write(1, 64, b"\1"))
    b.wait(1.1)
    for i in range(100):
        b.send(ASKS[ask])
        b.send(packet.sync_write(116, 4, [(1, (2048 + i).to_bytes(4, "little"))]))
        b.wait(0.01)
    assert set(b.bus.audit.violations) == ({kind} if kind else set())
    assert b.bus.audit.writes_in_fault > 0


def test_a_servo_stopped_by_its_watchdog_may_refuse_goals_until_read() -> None:
    b = Bench("XM430-W350", "XM430-W350", faults=(Fault("deaf", start_s=1.0, end_s=1.5, servo_id=1),))
    goals = packet.sync_write(116, 4, [(i, (2048).to_bytes(4, "little")) for i in (1, 2)])
    for i in (1, 2):
        b.send(packet.write(i, 64, b"\1"))
        b.send(packet.write(i, 98, b"\x0a"))

    def go_on(until_s: float, *asked: int) -> None:
        while b.t_s < until_s:
            b.send(goals + packet.sync_read(132, 4, asked) if asked else goals)
            b.wait(0.01)

    go_on(3.0, 2)
    assert b.servo.watchdog_tripped and not b.bus.audit.violations, "it is asked no more: nobody can know"
    assert b.bus.audit.writes_in_fault > 100
    go_on(3.15, 1, 2)
    assert not b.bus.audit.violations, "a moment to hear of it"
    go_on(4.0, 1, 2)
    assert b.bus.audit.violations.keys() == {"refused_goal"}


def test_a_robot_that_touches_itself_is_seen() -> None:
    audit = Audit(ROBOT)
    pose = ROBOT.rest_rad.copy()
    pose[ROBOT.joint_names.index("left_shoulder_roll")] = math.radians(-15)
    pose[ROBOT.joint_names.index("left_elbow")] = math.radians(120)
    pose[ROBOT.joint_names.index("left_shoulder_yaw")] = math.radians(-90)
    for servo in ROBOT.servos:
        audit.torque(0.0, servo.servo_id, True, 0, 0)
    for _ in range(10):
        for servo, q in zip(ROBOT.servos, pose, strict=True):
            audit.goal(0.0, servo.servo_id, round(2048 + servo.direction * q * TICKS_PER_RAD), True)
    assert audit.report()["self_contacts"] > 0


OP2 = load_robot("op2")
INSIDE, CLEAR = "inside", "clear"


def poses_of_op2() -> dict[str, list[int]]:
    """Ticks of a pose in which the robot is in itself, and of its rest pose."""
    body, ticks = SelfContact(OP2, margin_m=0.0), JointServoMap(OP2)
    draw = np.random.default_rng(1)
    q = draw.uniform(OP2.position_min_rad, OP2.position_max_rad, (2000, OP2.n_joints))
    inside = q[body.clearance_m(q).argmin()]
    return {INSIDE: ticks.rad_to_tick(inside).tolist(), CLEAR: ticks.rad_to_tick(OP2.rest_rad).tolist()}


def tell(contacts: ContactAudit, pose: list[int], times: int) -> None:
    for _ in range(times):
        for servo_id, tick in zip(OP2.servo_ids, pose, strict=True):
            contacts.told(0.0, servo_id, tick, torque=True)


def test_a_pose_in_contact_is_counted_and_described():
    contacts, pose = ContactAudit(OP2), poses_of_op2()
    tell(contacts, pose[CLEAR], 50)
    tell(contacts, pose[INSIDE], 50)
    report = contacts.report()
    assert (report["self_contacts"], report["inherited_contacts"], report["poses_checked"]) == (10, 0, 20)
    assert "mm deep" in report["contact_details"][0]


def test_a_contact_from_before_torque_is_inherited_until_it_ends_or_grows():
    contacts, pose = ContactAudit(OP2), poses_of_op2()
    for servo_id, tick in zip(OP2.servo_ids, pose[INSIDE], strict=True):
        contacts.begin(servo_id, tick)
    tell(contacts, pose[INSIDE], 50)
    report = contacts.report()
    assert report["self_contacts"] == 0 and report["inherited_contacts"] >= 10
    tell(contacts, pose[CLEAR], 50)
    tell(contacts, pose[INSIDE], 50)
    assert contacts.report()["self_contacts"] == 10, "once it was clear it has nothing to inherit"


def test_a_contact_that_nobody_commanded_is_measured_only():
    """A servo that is stuck: the others were led elsewhere, as told, and what was told is clear."""
    pose = poses_of_op2()
    contacts = ContactAudit(OP2, lambda: pose[INSIDE])
    tell(contacts, pose[CLEAR], 50)
    report = contacts.report()
    assert (report["self_contacts"], report["measured_contacts"]) == (0, 10)


def test_poses_that_come_while_others_are_checked_are_not_lost():
    """The thread that serves servos behind a tty goes on meanwhile; once it ended, since a list was being copied."""
    pose = poses_of_op2()[CLEAR]

    class Busy(ContactAudit):
        """Gets more poses at the first look at those before."""

        def _distances_m(self, ticks):
            if not self.checked and not self._times:
                tell(self, pose, 3 * EVERY)
            return super()._distances_m(ticks)

    contacts = Busy(OP2)
    tell(contacts, pose, 4 * EVERY)
    contacts.check()
    assert contacts.report()["poses_checked"] == 7


def test_a_goal_lost_on_the_wire_is_part_of_the_pose_that_was_told():
    audit, pose = Audit(OP2), poses_of_op2()
    for servo_id, tick in zip(OP2.servo_ids, pose[CLEAR], strict=True):
        audit.torque(0.0, servo_id, True, tick, tick)
    for _ in range(20):
        for servo_id, tick in zip(OP2.servo_ids, pose[INSIDE], strict=True):
            audit.missed(0.0, servo_id, tick)
    assert audit.report()["self_contacts"] >= 4
