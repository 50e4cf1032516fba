"""Arming: every step gives the cycle back, a halt between any two of them counts, and nothing old is taken for known."""

from __future__ import annotations

import pytest

from daemon.control.starting import start
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState, Readiness
from sim.faults import Fault
from tests.support.rig import rig, swing
from tests.support.sizes import few_and_long

A, P, S, E = BusRequest.ARM, BusRequest.PARK, BusRequest.STOP, BusRequest.ESTOP


@pytest.mark.parametrize("halt", few_and_long([E], [P, S]))
def test_a_halt_between_any_two_steps_of_arming_leaves_the_robot_limp(halt):
    """At every cycle of arming: before torque is on it never comes on; after that it is brought to rest, parked or cut."""
    steps = 0
    with rig() as r:
        r.link.request(A)
        while not any(r.torque):
            r.cycle()
            steps += 1
        assert steps > 3, "arming takes several cycles"
        assert all(BusState(int(x["state"])) is BusState.ARMING for x in r.records)
    for before in range(1, steps):
        with rig() as r:
            r.link.request(A)
            r.cycle(before)
            r.link.request(halt)
            for _ in range(60):
                r.cycle()
                assert not any(r.torque)
            assert r.state is (BusState.ESTOP if halt is E else BusState.LIMP)
            assert r.sim.audit.report()["violations"] == 0
    with rig() as r:
        r.link.request(A)
        r.cycle(steps)
        r.link.request(halt)
        r.cycle()
        r.until(BusState.ESTOP if halt is E else BusState.LIMP if halt is P else BusState.HOLDING)
        assert r.sim.audit.report()["violations"] == 0


def torque_after_estop_s(robot: str, kind: BusRequest, n_torque: int) -> float:
    """Seconds of the simulated wire for which any servo has torque after an e-stop that comes when so many have got it."""
    with rig(robot) as r:
        write, asked_s = r.port.write, []

        def count_and_write(data: bytes) -> None:
            if sum(r.torque) >= n_torque and not asked_s:
                r.link.request(kind)
                asked_s.append(r.clock.now_s())
            write(data)

        r.port.write = count_and_write
        r.link.request(A)
        off_s = 0.0
        for _ in range(1000):
            if asked_s and not any(r.torque):
                break
            r.streamer.cycle()
            off_s = r.clock.now_s()
            r.clock.sleep_until(off_s + r.robot.bus.period_s)
        assert not any(r.torque), "it holds"
        assert r.sim.audit.report()["violations"] == 0
        return off_s - asked_s[0]


@pytest.mark.parametrize("robot", few_and_long(["op3"], ["reference", "poppy_torso"]))
@pytest.mark.parametrize("kind", [E, BusRequest.ESTOP_HOLD])
def test_an_estop_while_torque_comes_on_is_carried_out_within_two_cycles(robot, kind):
    """Torque comes on servo by servo: the e-stop waited until all had it and their watchdogs were set, up to 85 ms."""
    with rig(robot) as r:
        n_servos, period_s = len(r.torque), r.robot.bus.period_s
    for n_torque in (1, n_servos // 2, n_servos - 2):
        assert torque_after_estop_s(robot, kind, n_torque) < 2 * period_s


def test_a_front_that_dies_while_it_arms_leaves_the_robot_limp(monkeypatch):
    with rig(watch_front=True) as r:
        monkeypatch.setattr(type(r.link), "heartbeat_age_s", property(lambda _: 0.0))
        r.link.request(A)
        r.cycle(2)
        monkeypatch.setattr(type(r.link), "heartbeat_age_s", property(lambda _: 0.7))
        for _ in range(100):
            r.cycle()
            assert not any(r.torque)
        assert r.state is BusState.LIMP


@pytest.mark.parametrize(
    ("item", "value"),
    few_and_long([("operating_mode", 1)], [("drive_mode", 1), ("max_position_limit", 2100)]),
)
def test_a_setting_changed_since_the_start_is_found_before_torque(item, value):
    with rig() as r:
        r.arm()
        r.link.request(P)
        r.until(BusState.LIMP)
        servo = r.sim.servos[13]
        servo.memory.set(item, value)
        r.link.request(A)
        r.cycle()
        r.until(BusState.FAULT, BusState.HOLDING)
        assert r.state is BusState.FAULT and item in r.link.text and "doctor --fix" in r.link.text
        assert not any(r.torque)


def test_servos_that_have_torque_at_the_start_are_a_fault_and_not_limp():
    """The process before was killed: its servos hold, and a robot that is called limp would be dropped at the next step."""
    with rig() as r:
        r.arm()
        link = BusLink.create(r.robot.n_joints, r.robot.n_servos)
        try:
            again = start(r.robot, lambda: r.bus, link, r.clock)
            assert again is not None and again.state is BusState.FAULT
            assert link.readiness is Readiness.READY and "torque" in link.text and "mmmd reset" in link.text
            link.request(A)
            for _ in range(20):
                again.cycle()
            assert again.state is BusState.FAULT and all(r.torque)
            link.request(BusRequest.RESET)
            for _ in range(3):
                again.cycle()
            assert again.state is BusState.LIMP and not any(r.torque)
        finally:
            link.close()


@pytest.mark.parametrize("servo_id", few_and_long([13], [1]))
def test_one_servo_that_stops_by_its_watchdog_is_a_named_fault(servo_id):
    """It heard nothing for a while and the others did: it answers as ever afterwards, and stands wherever it stopped."""
    with rig("op3" if servo_id == 1 else "reference", Fault("deaf", 6.0, 6.6, servo_id=servo_id)) as r:
        r.arm()
        servo = r.sim.servos[servo_id]
        while r.clock.now_s() < 6.6:
            if r.link.setpoints.queued_frames < 20:
                r.push(swing(r.robot, 1.5))
            r.cycle()
        r.until(BusState.FAULT, within_s=2.0)
        assert f"servo {servo_id} " in r.link.text and "watchdog" in r.link.text
        refused = r.sim.audit.report()["violations_by_kind"].get("refused_goal", 0)
        r.cycle(100)
        assert r.sim.audit.report()["violations_by_kind"].get("refused_goal", 0) == refused, "it gets no goals any more"
        assert not r.records[-1]["velocity_rad_s"].any() and servo.torque
        r.link.request(BusRequest.RESET)
        r.cycle(10)
        r.arm()
        assert r.bus.tripped_watchdogs() == []


@pytest.mark.parametrize(("robot", "servo_id", "before"), [
    *few_and_long([("reference", None, None)], [("reference", 13, BusRequest.ESTOP_HOLD), ("op3", 1, BusRequest.STOP)]),
    pytest.param("ffw_bg2", None, None, marks=pytest.mark.soak),
])  # fmt: skip
def test_a_servo_stopped_by_its_watchdog_in_a_fault_gets_no_goals(robot, servo_id, before):
    """All of them silent is a fault before the watchdogs run out: found by a soak, after 2.7 hours."""
    with rig(robot, Fault("deaf", 6.0, 6.97, servo_id=servo_id)) as r:
        r.arm()
        while r.clock.now_s() < 5.5:
            r.cycle()
        if before is not None:
            r.link.request(before)
        r.cycle(350)
        state = BusState.ESTOP if before is BusRequest.ESTOP_HOLD else BusState.FAULT
        assert r.state is state and r.records[-1]["torque"]
        r.assert_limits_kept()
        goals = r.sim.audit.goals
        r.cycle(10)
        told = (r.sim.audit.goals - goals) // 10
        assert told == (0 if servo_id is None else len(r.robot.servos) - 1), "the others hold"
        r.link.request(BusRequest.RESET)
        r.cycle(10)
        r.arm()
        r.assert_limits_kept()
        assert r.bus.tripped_watchdogs() == []
