"""The first goal of every servo is where it was measured, wherever that is; else arming refuses by name."""

from __future__ import annotations

import shutil
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.control.leading_back import LeadingBack
from daemon.control.safety_limiter import SafetyLimiter
from daemon.control.turns import TurnWatch
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import ServoFaultError
from daemon.host.clock import RealClock
from daemon.shared_memory.bus_link import BusRequest, BusState
from retarget.robot.loading import ROBOTS_DIR, list_robots, load_robot
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from sim.bus import SimBus
from sim.port import SimPort
from tests.support.rig import Rig, rig, swing
from tests.support.sizes import examples, few_and_long

PAIR = (
    'servo = { id = 8, model = "XM430-W350", direction = 1 }',
    'servos = [{ id = 8, model = "XM430-W350" }, { id = 20, model = "XM430-W350", direction = -1, zero_tick = 2100 }]',
)


@pytest.fixture(scope="module")
def paired(tmp_path_factory: pytest.TempPathFactory) -> str:
    """`reference` with two servos on one joint."""
    folder = tmp_path_factory.mktemp("robots") / "paired"
    shutil.copytree(ROBOTS_DIR / "reference", folder)
    text = (folder / "robot.toml").read_text()
    assert PAIR[0] in text
    (folder / "robot.toml").write_text(text.replace(*PAIR))
    return str(folder)


@cache
def parts(name: str) -> tuple[RobotModel, JointServoMap, TurnWatch, SafetyLimiter]:
    robot = load_robot(name)
    ticks = JointServoMap(robot)
    clock = RealClock()
    bus = ServoBus.on_port(SimPort(SimBus(robot), clock), robot.servos, clock)
    return robot, ticks, TurnWatch(robot, ticks, bus), SafetyLimiter(robot)


@pytest.mark.parametrize("name", few_and_long(["toddlerbot", "paired"], list_robots()))
@given(data=st.data())
@settings(max_examples=examples(150), deadline=None)
def test_the_first_goal_is_the_tick_that_was_read_or_arming_is_refused(
    name: str, paired: str, data: st.DataObject
) -> None:
    robot, ticks, turns, gate = parts(paired if name == "paired" else name)
    middle = ticks.to_ticks(robot.park_rad)
    most = np.array([s.model.ticks_per_turn for s in robot.servos])
    far = data.draw(st.sampled_from([0.002, 0.1, 0.5, 3.0, 300.0]))
    share = np.array([data.draw(st.floats(-1, 1)) for _ in robot.servos])
    measured = np.clip(np.rint(middle + share * far * most), -(2**31), 2**31 - 1).astype(np.int32)
    try:
        turns.require_one_pose(measured)
    except ServoFaultError as error:
        assert any(f"servo {i}:" in str(error) for i in robot.servo_ids)
        assert far > 0.002 or name == "paired"
        return
    leading = LeadingBack(ticks, most)
    gate.reset(leading.begin(measured))
    assert leading.goal_tick(gate.brake()).tolist() == measured.tolist()
    goals = [leading.goal_tick(gate.brake()) for _ in range(30)]
    assert leading.done and goals[-1].tolist() == np.rint(ticks.to_ticks(gate.position_rad)).tolist()
    steps = np.abs(np.diff([measured, *goals], axis=0)) / most
    assert steps.max() <= 1 / 1023, "a tick a cycle"


def armed_from(r: Rig, servo_id: int, tick: float) -> None:
    """Put one servo there by hand, and arm."""
    r.sim.servos[servo_id].position_tick = tick
    r.cycle(5)
    r.link.request(BusRequest.ARM)
    r.cycle()
    r.until(BusState.HOLDING, BusState.FAULT)


def first_goal(r: Rig, servo_id: int) -> tuple[int, int]:
    """First goal with torque and the ticks measured in that cycle."""
    record = next(k for k in r.records if k["torque"])
    row = r.robot.servo_ids.index(servo_id)
    return int(record["goal_tick"][row]), int(record["present_tick"][row])


@pytest.mark.parametrize("beyond_deg", few_and_long([40], [5, 15]))
@pytest.mark.parametrize("end", few_and_long([1], [-1, 1]))
def test_a_servo_beyond_its_linkages_table_is_led_back_slowly(beyond_deg: int, end: int) -> None:
    """ToddlerBot's neck pitch: it was taken for one at the table's end, and its first goal was a jump to there."""
    with rig("toddlerbot") as r:
        servo = r.robot.servos[r.robot.servo_ids.index(1)]
        assert servo.linkage is not None
        tick = round(servo.zero_tick + end * (80 if end < 0 else 35) * 4096 / 360 + end * beyond_deg * 4096 / 360)
        armed_from(r, 1, tick)
        assert r.state is BusState.HOLDING, r.link.text
        goal, present = first_goal(r, 1)
        assert abs(goal - present) <= 1
        goals = [int(k["goal_tick"][r.robot.servo_ids.index(1)]) for k in r.records if k["torque"]]
        assert max(abs(np.diff(goals))) <= 12, "0.9 rad/s at most"
        r.assert_limits_kept()


@pytest.mark.parametrize("turns", few_and_long([-1, 2], [-2, -1, 1, 2]))
def test_a_servo_with_a_wrong_count_of_turns_is_refused_by_name(turns: int) -> None:
    """In extended position mode, 69 degrees and two turns from its zero: its joint was driven 789 degrees."""
    for servo_id, name in ((1, "neck_pitch"), (19, "left_elbow_roll")):
        with rig("toddlerbot") as r:
            armed_from(r, servo_id, r.sim.servos[servo_id].position_tick + turns * 4096)
            assert r.state is BusState.FAULT and not any(r.torque)
            assert f"servo {servo_id}: position of {name}" in r.link.text and "whole turns" in r.link.text
            assert r.sim.audit.goals == 0


def test_a_turned_waist_that_lost_power_is_refused_until_led_to_park() -> None:
    """Its two servos stood at 192 degrees and report -168 afterwards: both are within the joint's range."""
    robot = load_robot("toddlerbot")
    start = robot.park_rad.copy()
    start[robot.joint_names.index("waist_yaw")] = np.deg2rad(80)
    with rig("toddlerbot", start_rad=start) as r:
        for servo_id in (2, 3):
            r.sim.servos[servo_id].reboot()
            assert abs(r.sim.servos[servo_id].position_tick - 2048) == pytest.approx(1911, abs=2)
        r.clock.sleep_until(0.5)
        r.link.request(BusRequest.ARM)
        r.cycle()
        r.until(BusState.HOLDING, BusState.FAULT)
        assert r.state is BusState.FAULT and not any(r.torque) and r.sim.audit.goals == 0
        assert "servo 2: position of waist_roll+waist_yaw" in r.link.text and "park pose" in r.link.text
        for servo_id in (2, 3):  # by hand to its middle, and switched off and on there
            r.sim.servos[servo_id].position_tick = 2048 - 4096
            r.sim.servos[servo_id].reboot()
        r.clock.sleep_until(r.clock.now_s() + 0.5)
        r.link.request(BusRequest.RESET)
        r.cycle(5)
        r.arm()
        r.assert_limits_kept()


@pytest.mark.long
def test_a_waist_whose_turns_were_followed_is_armed_anywhere() -> None:
    """An e-stop in a turned pose: its turns were counted without a pause, so they are known; after a power cut they are not."""
    with rig("toddlerbot") as r:
        r.arm()
        path = swing(r.robot, 4.0, 0.0)
        yaw = r.robot.joint_names.index("waist_yaw")
        path[:, yaw] = np.deg2rad(70) * (1 - np.cos(np.linspace(0, np.pi, len(path)))) / 2
        for at in range(0, len(path), 100):
            r.push(path[at : at + 100], last=at + 100 >= len(path))
            r.cycle(100)
        r.link.request(BusRequest.ESTOP)
        r.cycle(5)
        r.link.request(BusRequest.RESET)
        r.cycle(5)
        r.arm()
        r.assert_limits_kept()
        r.link.request(BusRequest.ESTOP)
        r.cycle(5)
        for servo_id in (2, 3):
            r.sim.servos[servo_id].position_tick = 2048 + 1900
        r.cycle(5)
        for servo in r.sim.servos.values():
            servo.reboot()
        r.cycle(60)
        r.link.request(BusRequest.RESET)
        r.cycle(5)
        r.link.request(BusRequest.ARM)
        r.cycle()
        r.until(BusState.HOLDING, BusState.FAULT)
        assert r.state is BusState.FAULT and "whole turns" in r.link.text and not any(r.torque)


@pytest.mark.parametrize("apart_tick", few_and_long([20, 40], [1, 7, 20, 40]))
def test_two_disagreeing_servos_of_a_joint_are_led_together_or_refused(paired: str, apart_tick: int) -> None:
    with rig(paired) as r:
        before = r.sim.servos[20].position_tick
        armed_from(r, 20, before + apart_tick)
        if apart_tick > 23:  # two degrees
            assert r.state is BusState.FAULT and "servos 8, 20 disagree by 3.5 degrees" in r.link.text
            assert not any(r.torque)
            return
        assert r.state is BusState.HOLDING, r.link.text
        first = next(k for k in r.records if k["torque"])
        goals = np.array([k["goal_tick"] for k in r.records if k["torque"]])
        rows = [r.robot.servo_ids.index(i) for i in (8, 20)]
        assert np.abs(first["goal_tick"][rows] - first["present_tick"][rows]).max() <= 1
        assert (np.abs(np.diff(goals[: apart_tick // 2 + 2, rows], axis=0)) <= 1).all()
        assert np.abs(goals[-1, rows].sum() - (2048 + 2100)) <= 1
        r.assert_limits_kept()
