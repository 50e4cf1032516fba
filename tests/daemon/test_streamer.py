import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rig import Rig, rig, swing

from daemon.bus.models import CONTROL_TABLES
from daemon.bus.servo_bus import ServoBus
from daemon.driving import shared
from daemon.driving.shared import BusLink, BusRequest, BusState, Readiness
from daemon.driving.starting import start
from daemon.driving.streamer import FAULT_LIMP_S, HEARTBEAT_LOST_S, LOOK_S, PARK_AFTER_S, TORQUE_OFF_REPEATS
from daemon.errors import PortMissingError
from retarget.collision import SelfContact
from retarget.robot import RobotModel, list_robots, load_robot
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault
from sim.port import SimPort

ROBOTS = [
    name
    for name in list_robots()
    if all(s.model.protocol == 2.0 and s.model.model_number in CONTROL_TABLES for s in load_robot(name).servos)
]
"""Those whose servos the bus knows how to talk to."""


def assert_brakes_within_limits(records, robot) -> None:
    """From the first record on the joints come to rest as fast as the acceleration allows, and no faster."""
    velocity = np.array([r["velocity_rad_s"] for r in records])
    change = np.abs(np.diff(velocity, axis=0))
    assert (change <= robot.acceleration_limit_rad_s2 * robot.bus.period_s * (1 + 1e-6)).all()
    assert (np.abs(velocity[1:]) <= np.abs(velocity[:-1]) + 1e-9).all()
    longest_s = (robot.velocity_limit_rad_s / robot.acceleration_limit_rad_s2).max()
    assert not velocity[int(longest_s * robot.bus.rate_hz) + 2 :].any()


def lead_to(r: Rig, state: str, parking_cycles: int = 1) -> None:
    """From limp to holding, playing, stopping or parking; the last two out of a motion."""
    r.arm()
    if state != "holding":
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
    if state in ("stopping", "parking"):
        r.link.request(BusRequest.STOP if state == "stopping" else BusRequest.PARK)
        r.cycle(1 if state == "stopping" else parking_cycles)


def test_nothing_moves_because_a_process_started():
    with rig() as r:
        r.push(swing(r.robot, 0.5))
        before = [s.position_tick for s in r.sim.servos.values()]
        r.cycle(100)
        assert r.state is BusState.LIMP and not any(r.torque)
        assert r.sim.audit.goals == 0
        assert [s.position_tick for s in r.sim.servos.values()] == before
        assert r.records[-1]["valid"].all(), "but it is measured"


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("seed", range(3))
def test_arming_pins_then_goes_slowly_to_rest(name, seed):
    """From any pose in which it is not in itself; those are in `test_park.py`."""
    robot = load_robot(name)
    drawn = np.random.default_rng(seed).uniform(robot.position_min_rad, robot.position_max_rad, (100, robot.n_joints))
    start_rad = drawn[SelfContact(robot).clearance_m(drawn) > 0][0]
    with rig(name, start_rad=start_rad) as r:
        r.arm()
        assert all(r.torque)
        ticks = np.rint(r.streamer._ticks.to_ticks(robot.rest_rad)).astype(int)
        assert list(r.records[-1]["goal_tick"]) == list(ticks)
        assert np.abs(r.goals_rad()[0] - start_rad).max() < 0.01
        assert np.abs([v["velocity_rad_s"] for v in r.records]).max() <= 1.0
        r.assert_limits_kept()


def test_setpoints_inside_the_limits_reach_the_servos_bit_for_bit():
    with rig() as r:
        r.arm()
        q = swing(r.robot, 2.0)
        first = len(r.records)
        r.push(q, plan_id=9)
        r.cycle(len(q) + 5)
        played = [x for x in r.records[first:] if x["plan_id"] == 9][: len(q)]
        assert np.array([x["goal_rad"] for x in played]).tobytes() == q.tobytes()
        assert [x["frame"] for x in played] == list(range(len(q)))
        assert not any(x["clipped"].any() for x in played)
        assert r.state is BusState.HOLDING
        r.assert_limits_kept()


def test_stop_brakes_within_limits_and_holds():
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.link.request(BusRequest.STOP)
        r.cycle(100)
        assert r.state is BusState.HOLDING and all(r.torque)
        assert_brakes_within_limits(r.records[-101:], r.robot)
        assert r.link.queued_frames == 0
        r.assert_limits_kept()


def test_a_late_front_makes_it_slow_down_and_go_on():
    with rig() as r:
        r.arm()
        q = swing(r.robot, 2.0)
        r.push(q[:60], last=False)
        r.cycle(61)
        assert r.state is BusState.PLAYING and r.records[-1]["underrun"]
        r.cycle(60)
        assert_brakes_within_limits(r.records[-62:], r.robot)
        assert r.state is BusState.PLAYING, "the plan has not ended"
        r.push(q[60:])
        r.cycle(len(q))
        assert r.state is BusState.HOLDING
        assert np.array_equal(r.records[-1]["goal_rad"], q[-1])
        r.assert_limits_kept()


def test_a_reset_and_an_arm_that_came_before_an_e_stop_do_not_undo_it():
    """Requests of one cycle were once served by kind: e-stop, reset, arm; the robot was armed again after its e-stop."""
    with rig() as r:
        r.arm()
        for request in (BusRequest.RESET, BusRequest.ARM, BusRequest.ESTOP):
            r.link.request(request)
        r.cycle(5)
        assert r.state is BusState.ESTOP and not any(r.torque)
        for request in (BusRequest.ESTOP, BusRequest.RESET, BusRequest.ARM):  # given after it they are carried out
            r.link.request(request)
        assert [BusState(int(r.cycle()["state"])) for _ in range(3)] == [BusState.ESTOP, BusState.LIMP, BusState.ARMING]


@pytest.mark.parametrize("state", ["arming", "holding", "playing", "stopping", "parking"])
def test_e_stop_cuts_torque_in_its_cycle_and_is_latched(state):
    with rig() as r:
        if state == "arming":
            r.link.request(BusRequest.ARM)
            r.cycle(5)
        else:
            lead_to(r, state)
        assert r.state.name.lower() == state
        r.link.request(BusRequest.ARM)
        r.link.request(BusRequest.ESTOP)
        r.cycle()
        assert not any(r.torque)
        assert r.state is BusState.ESTOP and not r.records[-1]["torque"]
        goals = r.sim.audit.goals
        for request in (BusRequest.ARM, BusRequest.PARK, BusRequest.STOP):
            r.link.request(request)
            r.push(swing(r.robot, 0.2))
            r.cycle(5)
            assert r.state is BusState.ESTOP and not any(r.torque)
        assert r.sim.audit.goals == goals
        r.link.request(BusRequest.RESET)
        r.cycle(5)
        assert r.state is BusState.LIMP and not any(r.torque), "reset arms nothing"
        r.arm()
        r.assert_limits_kept()


@pytest.mark.parametrize("state", ["arming", "holding", "playing", "stopping", "parking"])
def test_an_e_stop_that_holds_brakes_within_limits_and_the_second_cuts(state):
    with rig() as r:
        if state == "arming":
            r.link.request(BusRequest.ARM)
            r.until(BusState.ARMING)
            while not any(r.torque):
                r.cycle()
            r.cycle(30)
        else:
            lead_to(r, state, parking_cycles=40)
        assert r.state.name.lower() == state
        r.link.request(BusRequest.ESTOP_HOLD)
        began = len(r.records) - 1
        for request in (BusRequest.ARM, BusRequest.PARK, BusRequest.STOP, BusRequest.TORQUE_OFF):
            r.cycle(25)
            assert r.state is BusState.ESTOP and all(r.torque)
            r.link.request(request)
            r.push(swing(r.robot, 0.2))
        assert_brakes_within_limits(r.records[began:], r.robot)
        assert np.array_equal(r.records[-1]["goal_rad"], r.records[-20]["goal_rad"])
        r.link.request(BusRequest.ESTOP_HOLD)
        r.cycle()
        assert r.state is BusState.ESTOP and not any(r.torque)
        r.link.request(BusRequest.RESET)
        r.cycle(3)
        r.arm()
        r.assert_limits_kept()


def test_a_reset_makes_limp_what_an_e_stop_holds_and_before_torque_is_on_there_is_nothing_to_hold():
    with rig() as r:
        r.link.request(BusRequest.ARM)
        r.cycle(2)
        r.link.request(BusRequest.ESTOP_HOLD)
        r.cycle(50)
        assert r.state is BusState.ESTOP and not any(r.torque)
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        r.link.request(BusRequest.ESTOP_HOLD)
        r.cycle(10)
        assert all(r.torque)
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        assert r.state is BusState.LIMP and not any(r.torque)
        r.assert_limits_kept()


def test_what_an_e_stop_holds_goes_limp_when_nobody_is_there(monkeypatch):
    with rig(watch_front=True) as r:
        age_s = 0.0
        monkeypatch.setattr(type(r.link), "heartbeat_age_s", property(lambda _: age_s))
        r.arm()
        r.link.request(BusRequest.ESTOP_HOLD)
        age_s = FAULT_LIMP_S - 0.5
        r.cycle(30)
        assert r.state is BusState.ESTOP and all(r.torque) and not r.streamer.made_limp
        age_s = FAULT_LIMP_S + 0.5
        r.cycle(TORQUE_OFF_REPEATS + 2)
        assert r.state is BusState.ESTOP and not any(r.torque) and r.streamer.made_limp


@pytest.mark.parametrize("state", ["limp", "arming", "holding", "playing", "parking"])
def test_torque_off_brakes_within_limits_and_goes_limp_where_it_stands(state):
    with rig() as r:
        if state == "arming":
            r.link.request(BusRequest.ARM)
            r.cycle(3)
        elif state != "limp":
            lead_to(r, state, parking_cycles=20)
        r.link.request(BusRequest.TORQUE_OFF)
        began = len(r.records) - 1
        r.cycle(100)
        assert r.state is BusState.LIMP and not any(r.torque)
        if state == "playing":
            assert_brakes_within_limits([x for x in r.records[began:] if x["torque"]], r.robot)
            assert np.abs(r.records[-1]["goal_rad"] - r.robot.park_rad).max() > 0.1, "it was not led to park"
        r.arm()
        r.assert_limits_kept()


def test_a_stop_that_follows_torque_off_before_it_stands_holds():
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.link.request(BusRequest.TORQUE_OFF)
        r.cycle(2)
        r.link.request(BusRequest.STOP)
        r.cycle(100)
        assert r.state is BusState.HOLDING and all(r.torque)


def test_an_e_stop_while_unplugged_is_carried_out_when_the_bus_is_back():
    """The torque-off that could not be sent is not forgotten: the person who pressed it believes the robot is limp."""
    with rig("reference", Fault("unplug", start_s=3.0, end_s=3.5)) as r:
        r.arm()
        while r.clock.now_s() < 3.1:
            r.cycle()
        assert all(r.torque)
        r.link.request(BusRequest.ESTOP)
        r.cycle()
        assert r.state is BusState.ESTOP
        while r.clock.now_s() < 3.6:
            r.cycle()
        assert not any(r.torque)
        assert r.state is BusState.ESTOP


def test_parking_ends_limp_in_the_park_pose():
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP)
        assert not any(r.torque)
        r.cycle(20)
        ticks = r.streamer._ticks.rad_to_tick(r.robot.park_rad)
        assert np.abs(r.records[-1]["present_tick"] - ticks).max() <= 6, "half a degree: friction stops a servo short"
        r.assert_limits_kept()


def test_a_park_may_stay_in_the_park_pose_before_it_goes_limp():
    """A lease that fell silent leads there; a plain park, also while it stays, goes limp at once."""
    with rig() as r:
        r.arm()
        r.link.request(BusRequest.PARK, stay_s=3.0)
        r.cycle()
        r.until(BusState.LIMP)
        stood = [
            i for i, k in enumerate(r.records) if k["torque"] and not k["velocity_rad_s"].any() and k["state"] == 5
        ]
        assert len(stood) / r.robot.bus.rate_hz == pytest.approx(3.0, abs=0.2)
        r.arm()
        r.link.request(BusRequest.PARK, stay_s=60.0)
        r.cycle(400)
        assert r.state is BusState.PARKING and all(r.torque)
        r.link.request(BusRequest.PARK)
        r.cycle()
        r.until(BusState.LIMP, within_s=1.0)
        r.assert_limits_kept()


def test_a_silent_front_holds_then_parks(monkeypatch):
    """Time of the heartbeat is the machine's; here it goes with the virtual clock."""
    with rig(watch_front=True) as r:
        monkeypatch.setattr(shared.time, "monotonic_ns", lambda: int(r.clock.now_s() * 1e9))
        r.link.heartbeat()
        r.link.request(BusRequest.ARM)
        for _ in range(400):
            r.link.heartbeat()
            r.cycle()
        assert r.state is BusState.HOLDING
        r.push(swing(r.robot, 2.0))
        for _ in range(30):
            r.link.heartbeat()
            r.cycle()
        lost_s, first = r.clock.now_s(), len(r.records)
        r.until(BusState.STOPPING, BusState.HOLDING, within_s=HEARTBEAT_LOST_S + 0.1)
        assert r.clock.now_s() - lost_s == pytest.approx(HEARTBEAT_LOST_S, abs=0.05)
        r.until(BusState.HOLDING, within_s=1.0)
        assert all(r.torque)
        r.until(BusState.PARKING, within_s=PARK_AFTER_S)
        r.until(BusState.LIMP)
        assert not any(r.torque)
        states = [BusState(int(x["state"])).name for x in r.records[first:]]
        assert [k for k, _ in itertools.groupby(states)] == ["PLAYING", "STOPPING", "HOLDING", "PARKING", "LIMP"]
        r.cycle(100)
        assert r.state is BusState.LIMP
        r.assert_limits_kept()


@pytest.mark.parametrize("playing", [False, True])
def test_a_servo_that_trips_is_a_named_fault_and_nothing_rearms(playing):
    with rig("reference", Fault("trip", start_s=4.0, servo_id=13)) as r:
        r.arm()
        while r.clock.now_s() < 4.2:
            if playing and r.link.queued_frames < 20:
                r.push(swing(r.robot, 1.0))
            r.cycle()
        assert r.state is BusState.FAULT
        assert "servo 13" in r.link.text and "overload" in r.link.text
        r.link.request(BusRequest.ARM)
        r.cycle(200)
        assert r.state is BusState.FAULT
        assert not r.records[-1]["velocity_rad_s"].any()
        r.assert_limits_kept()
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        assert r.state is BusState.LIMP and not any(r.torque)
        r.link.request(BusRequest.ARM)
        r.cycle(20)
        assert r.state is BusState.FAULT and "servo 13" in r.link.text, "it has not been rebooted"
        assert not any(r.torque)


def test_torque_lost_without_a_word_is_a_fault():
    """A servo that rebooted (a brown-out) answers as if nothing had happened, but holds nothing."""
    with rig() as r:
        r.arm()
        servo = list(r.sim.servos.values())[6]
        servo.reboot()
        r.until(BusState.FAULT, within_s=2.0)
        assert f"servo {servo.servo_id} " in r.link.text and "torque" in r.link.text
        r.cycle(100)
        assert r.state is BusState.FAULT and not servo.torque


def test_unplugged_is_a_fault_and_plugged_in_again_nothing_moves():
    with rig("reference", Fault("unplug", start_s=4.0, end_s=5.0)) as r:
        r.arm()
        while r.clock.now_s() < 6.0:
            if r.state in (BusState.HOLDING, BusState.PLAYING) and r.link.queued_frames < 20:
                r.push(swing(r.robot, 1.0))
            r.cycle()
        assert r.state is BusState.FAULT and "unplugged" in r.link.text
        before = [s.position_tick for s in r.sim.servos.values()]
        r.link.request(BusRequest.ARM)
        r.cycle(100)
        assert r.state is BusState.FAULT
        assert [s.position_tick for s in r.sim.servos.values()] == pytest.approx(before, abs=1)
        r.assert_limits_kept()
        r.link.request(BusRequest.RESET)
        r.cycle()
        r.arm()
        r.assert_limits_kept()


def test_half_of_the_servos_silent_is_a_fault():
    robot = load_robot("reference")
    silent = [Fault("silent", start_s=4.0, servo_id=i) for i in robot.servo_ids[: robot.n_joints // 2]]
    with rig("reference", *silent) as r:
        r.arm()
        r.until(BusState.FAULT, within_s=8.0)
        assert "silent" in r.link.text
        assert 4.0 < r.clock.now_s() < 5.0


@pytest.mark.parametrize("kind", ["drop", "corrupt"])
def test_lost_replies_do_not_stop_the_robot(kind):
    """One reply in fifty lost or spoilt: the values go stale for a cycle and say so, the motion goes on."""
    with rig("reference", Fault(kind, start_s=3.0, probability=0.02)) as r:
        r.arm()
        for _ in range(8):
            r.push(swing(r.robot, 1.0))
            r.cycle(105)
            assert r.state is BusState.HOLDING, r.link.text
        invalid = sum((~x["valid"].astype(bool)).sum() for x in r.records)
        assert invalid > 20
        r.assert_limits_kept()


def test_arming_fails_by_name_when_a_servo_is_silent():
    with rig("reference", Fault("silent", servo_id=15)) as r:
        r.link.request(BusRequest.ARM)
        r.cycle(3)
        assert r.state is BusState.FAULT and "15" in r.link.text and "no answer" in r.link.text
        assert not any(r.torque)
        assert r.sim.audit.goals == 0


def test_a_stall_longer_than_the_servos_watchdog_is_a_fault():
    """Frozen for a second while moving: the servos stopped by themselves and would refuse goals from then on."""
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(60)
        r.clock.sleep_until(r.clock.now_s() + 1.0)
        r.cycle(10)
        assert r.state is BusState.FAULT and "1.0" in r.link.text
        r.link.request(BusRequest.RESET)
        r.cycle(2)
        r.arm()
        r.assert_limits_kept()


class Running:
    """A streamer that runs by itself on a clock of its own; `begun_s` is when each of its cycles began."""

    def __init__(self, robot: RobotModel, link: BusLink, clock: VirtualClock, n_cycles: int) -> None:
        self.sim, self.begun_s = SimBus(robot), list[float]()
        bus_clock = VirtualClock()
        streamer = start(robot, lambda: ServoBus(SimPort(self.sim, bus_clock), robot.servos, bus_clock), link, clock)
        assert streamer is not None
        inner = streamer.cycle

        def cycle() -> None:
            self.begun_s.append(clock.now_s())
            inner()
            streamer.stopping = len(self.begun_s) == n_cycles

        streamer.cycle = cycle  # type: ignore[method-assign]
        self.streamer = streamer


def test_late_cycles_are_skipped_and_counted_not_made_up_for():
    class Slow(VirtualClock):
        def sleep_until(self, t_s: float) -> None:
            super().sleep_until(t_s + (0.055 if self.true_s < 0.5 <= t_s else 0.0))

    robot = load_robot("reference")
    link = BusLink.create(robot.n_joints)
    try:
        running = Running(robot, link, Slow(), n_cycles=100)
        running.streamer.run()
        record = link.cycles_since(link.n_cycles - 1)[0][0]
    finally:
        link.close()
    assert 4 <= record["late_cycles"] <= 6
    assert (np.diff(running.begun_s) >= robot.bus.period_s - 1e-9).all(), "never two cycles in one period"


@pytest.mark.parametrize(
    ("request_", "early"), [(BusRequest.ESTOP, True), (BusRequest.ESTOP_HOLD, False), (BusRequest.STOP, False)]
)
def test_an_e_stop_that_cuts_waits_for_no_cycle_and_what_brakes_keeps_the_rate(request_, early):
    robot = load_robot("reference")
    period_s = robot.bus.period_s
    link = BusLink.create(robot.n_joints)

    class Asking(VirtualClock):
        def sleep_until(self, t_s: float) -> None:
            if self.true_s < 10.3 * period_s <= t_s:
                link.request(request_)
            super().sleep_until(t_s)

    try:
        running = Running(robot, link, Asking(), n_cycles=20)
        running.streamer.run()
    finally:
        link.close()
    between = np.diff(running.begun_s) / period_s
    assert np.allclose(np.delete(between, 10), 1.0)
    assert between[10] == pytest.approx(LOOK_S / period_s * 2 if early else 1.0)


def test_start_says_why_there_is_no_robot():
    robot = load_robot("reference")
    clock = VirtualClock()
    link = BusLink.create(robot.n_joints)

    def missing() -> ServoBus:
        raise PortMissingError("dxl:///dev/ttyUSB9", "no such device", "plug it in")

    try:
        assert start(robot, missing, link, clock) is None
        assert link.readiness is Readiness.FAILED and "ttyUSB9" in link.text
        deaf = SimPort(SimBus(robot), clock, baud=57_600)
        assert start(robot, lambda: ServoBus(deaf, robot.servos, clock), link, clock) is None
        assert "baud" in link.text
        other = SimPort(SimBus(load_robot("op3")), clock)
        assert start(robot, lambda: ServoBus(other, robot.servos, clock), link, clock) is None
        assert "expected" in link.text and "head_yaw" in link.text
        good = SimPort(SimBus(robot), clock)
        assert start(robot, lambda: ServoBus(good, robot.servos, clock), link, clock) is not None
        assert link.readiness is Readiness.READY
    finally:
        link.close()


actions = st.lists(
    st.tuples(st.sampled_from([*BusRequest, "swing", "wild", "nan", "wait"]), st.integers(1, 120)), max_size=12
)


@settings(max_examples=12, deadline=None)
@given(actions, st.integers(0, 2**32 - 1))
def test_no_order_of_requests_and_setpoints_breaks_a_limit(sequence, seed):
    random = np.random.default_rng(seed)
    with rig() as r:
        r.link.request(BusRequest.ARM)
        r.cycle()
        for plan_id, (action, n) in enumerate(sequence, 1):
            if isinstance(action, BusRequest):
                r.link.request(action)
            elif action != "wait":
                q = swing(r.robot, 1.0)[: min(n, 200)].copy()
                if action != "swing":
                    q[:] = random.uniform(-4, 4, q.shape)
                if action == "nan":
                    q[random.integers(len(q))] = random.choice([np.nan, np.inf, 1e300])
                r.link.push(q, plan_id, 0, r.link.epoch, last=True)
            r.cycle(n)
        assert r.sim.audit.report()["violations"] == 0, r.sim.audit.report()["details"]
        torque = any(r.torque)
        assert not torque or not r.streamer.made_limp
        assert torque or r.state in (BusState.LIMP, BusState.ESTOP, BusState.FAULT, BusState.ARMING)


def test_the_start_says_how_to_set_a_slow_adapters_timer(monkeypatch, caplog):
    monkeypatch.setattr("daemon.driving.starting.latency_advice", lambda device: f"run: set {device}" if device else "")
    robot, clock = load_robot("reference"), VirtualClock()
    link = BusLink.create(robot.n_joints)
    port = SimPort(SimBus(robot), clock)
    port.device = "/dev/ttyUSB7"
    try:
        with caplog.at_level("WARNING", "daemon.driving.starting"):
            assert start(robot, lambda: ServoBus(port, robot.servos, clock), link, clock) is not None
        assert "run: set /dev/ttyUSB7" in caplog.text and link.readiness is Readiness.READY
    finally:
        link.close()


@pytest.mark.parametrize("request_", [BusRequest.ESTOP, BusRequest.PARK])
def test_a_servo_that_heard_no_torque_off_is_told_again_when_it_hears(request_):
    """A loose cable while the robot goes limp: the five packets that nobody answers were all lost on one servo."""
    deaf = Fault("deaf", start_s=4.0, end_s=12.0, servo_id=5)
    with rig("reference", deaf, slow_every=10) as r:
        r.cycle(3)
        r.arm()
        r.cycle(max(0, round((4.2 - r.clock.true_s) * 100)))
        r.link.request(request_)
        r.until(BusState.ESTOP, BusState.LIMP)
        r.cycle(20)
        if r.clock.true_s < 12.0:
            assert [i for i, s in r.sim.servos.items() if s.torque] == [5]
        r.cycle(1400)
        assert not any(r.torque), "it is limp once it hears again"
        r.assert_limits_kept()
