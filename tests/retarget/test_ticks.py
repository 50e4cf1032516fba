"""Joints to servo ticks: each kind of drive against ticks worked out by hand, and the laws that all keep."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from retarget.path.limits import JointLimits
from retarget.robot.loading import list_robots, load_robot
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from tests.retarget.robot_files import joint, write_robot
from tests.support.robots import ByName, packaged
from tests.support.sizes import examples, few_and_long

WAIST = (
    joint("waist_roll", "waist_roll", "[-30, 30]")
    + joint("waist_yaw", "waist_yaw", "[-90, 90]")
    + """[[differential]]
joints = ["waist_roll", "waist_yaw"]
joint_per_servo = [[-0.291667, 0.291667], [0.208333, 0.208333]]
servos = [
  { id = 2, model = "XC330-T288", extended = true, position_limit_deg = [-268, 268] },
  { id = 3, model = "XC330-T288", extended = true, position_limit_deg = [-268, 268] },
]
"""
)
FOUR_BAR = joint(
    "nod", "head_pitch", "[-40, 30]",
    '{ id = 1, model = "XL330-M288", direction = -1, '
    "linkage = { joint_deg = [-45, -20, 0, 15, 30], servo_deg = [-70, -28, 0, 20, 37] } }",
)  # fmt: skip
PAIR = joint("lift", "left_elbow", "[-60, 60]") .replace(
    "position_limit_deg",
    "servos = [ { id = 4, model = \"XM430-W350\" }, "
    "{ id = 5, model = \"XM430-W350\", direction = -1, zero_tick = 2000 } ]\nposition_limit_deg",
)  # fmt: skip

KINDS: dict[str, tuple[str, float, dict[str, float], list[int]]] = {
    # name: (file, protocol, joint angles in degrees, ticks by hand)
    "plain": (joint("a", "left_elbow", "[-60, 60]", '{ id = 1, model = "XM430-W350" }'), 2.0, {"a": 45}, [2560]),
    "turned": (
        joint("a", "left_elbow", "[-60, 60]", '{ id = 1, model = "XM430-W350", direction = -1, zero_tick = 1024 }'),
        2.0, {"a": 45}, [512],
    ),
    "geared": (
        joint("a", "head_yaw", "[-60, 60]", '{ id = 1, model = "XC330-T288", direction = -1, gear_ratio = 1.1 }'),
        2.0, {"a": 50}, [2048 - 626],  # 55 degrees of the servo
    ),
    "AX: 1023 steps of 300 degrees": (
        joint("a", "head_yaw", "[-60, 60]", '{ id = 1, model = "AX-12A" }'), 1.0, {"a": 50}, [512 + 170],  # 170.5 to even
    ),
    "524,288 ticks a turn": (
        joint("a", "left_elbow", "[-168, 61]", '{ id = 1, model = "YM070-210-R099-RH" }'), 2.0, {"a": -90}, [-131072],
    ),
    "a pair of servos back to back": (PAIR, 2.0, {"lift": 45}, [2560, 1488]),
    "differential, yaw alone turns both alike": (
        # 45 / 0.208333 / 2 = 108 degrees each
        WAIST, 2.0, {"waist_yaw": 45}, [2048 + 1229, 2048 + 1229],
    ),
    "differential, roll alone turns them apart": (
        # 20 / 0.291667 / 2 = 34.286 degrees
        WAIST, 2.0, {"waist_roll": 20}, [2048 - 390, 2048 + 390],
    ),
    "four-bar at a row": (FOUR_BAR, 2.0, {"nod": 15}, [2048 - 228]),  # 20 degrees of the servo, turned
}  # fmt: skip


@pytest.mark.parametrize(("body", "protocol", "pose", "ticks"), [pytest.param(*v, id=k) for k, v in KINDS.items()])
def test_ticks_are_those_worked_out_by_hand(
    tmp_path: Path, body: str, protocol: float, pose: dict[str, float], ticks: list[int]
) -> None:
    robot = load_robot(str(write_robot(tmp_path, body, protocol)))
    q = np.array([math.radians(pose.get(name, 0.0)) for name in robot.joint_names])
    assert JointServoMap(robot).rad_to_tick(q).tolist() == ticks


def small(body: str, protocol: float) -> RobotModel:
    with TemporaryDirectory() as folder:
        return load_robot(str(write_robot(Path(folder) / "small", body, protocol)))


ROBOTS = ByName((*list_robots(), *KINDS), lambda name: small(*KINDS[name][:2]) if name in KINDS else packaged(name))


@pytest.mark.parametrize("name", few_and_long(["reference", "turned", "geared"], ROBOTS))
@given(data=st.data())
@settings(max_examples=examples(40))
def test_ticks_are_at_most_half_a_tick_off_and_within_limits(name: str, data: st.DataObject) -> None:
    robot = ROBOTS[name]
    servo_map = JointServoMap(robot)
    low, high = servo_map.position_range_rad
    q = low + data.draw(arrays(np.float64, robot.n_joints, elements=st.floats(0, 1))) * (high - low)
    ticks = servo_map.rad_to_tick(q)
    assert (np.abs(ticks - servo_map.to_ticks(q)) <= 0.5 + 1e-6).all()
    for tick, servo in zip(ticks, robot.servos, strict=True):
        assert servo.min_tick <= tick <= servo.max_tick
    back = servo_map.tick_to_rad(ticks)
    assert (back >= robot.position_min_rad - 1e-9).all()
    assert (back <= robot.position_max_rad + 1e-9).all()
    again = servo_map.rad_to_tick(back)
    own = [all(len(s.couplings) == 1 for s in robot.servos if s.joint_name == t.joint_name) for t in robot.servos]
    paired = [sum(s.joint_name == t.joint_name for s in robot.servos) > 1 for t in robot.servos]
    assert (np.abs(again - ticks) <= np.where(paired, 1, 0))[own].all()
    assert np.array_equal(servo_map.to_ticks(np.stack([q, back]))[0], servo_map.to_ticks(q)), "same bits in a batch"


@pytest.mark.parametrize("name", few_and_long(["reference", "turned", "geared"], ROBOTS))
@given(data=st.data())
@settings(max_examples=examples(25))
def test_a_path_within_the_joints_limits_keeps_every_servos(name: str, data: st.DataObject) -> None:
    """Servo space: three poses a tenth of a millisecond apart, at the joints' speed and acceleration limits."""
    robot = ROBOTS[name]
    servo_map, J, period = JointServoMap(robot), robot.n_joints, 1e-4
    low, high = servo_map.position_range_rad
    share = data.draw(arrays(np.float64, (3, J), elements=st.floats(-1, 1)))
    velocity = share[0] * robot.velocity_limit_rad_s
    after = np.clip(
        velocity + share[1] * robot.acceleration_limit_rad_s2 * period,
        -robot.velocity_limit_rad_s, robot.velocity_limit_rad_s,
    )  # fmt: skip
    middle = np.clip((low + high) / 2 + share[2] * (high - low) / 2, low + 0.01, high - 0.01)
    t = servo_map.to_ticks(np.stack([middle - velocity * period, middle, middle + after * period]))
    speed = np.abs(np.diff(t, axis=0)).max(0) / period
    assert (speed <= servo_map.velocity_limit_tick_s * (1 + 1e-6)).all()
    no_load = [s.model.no_load_speed_rad_s * s.model.ticks_per_turn / (2 * math.pi) for s in robot.servos]
    assert (speed <= np.array(no_load) * (1 + 1e-6)).all()


def test_joint_limits_are_those_in_which_rounding_stays() -> None:
    robot = ROBOTS["differential, yaw alone turns both alike"]
    limits, servo_map = JointLimits.of(robot), JointServoMap(robot)
    assert (limits.position_min_rad > robot.position_min_rad).all(), "half a tick of each servo before the limit"
    for corner in (
        np.array(np.meshgrid(*zip(limits.position_min_rad, limits.position_max_rad, strict=True))).reshape(2, -1).T
    ):
        back = servo_map.tick_to_rad(servo_map.rad_to_tick(corner))
        assert (back >= robot.position_min_rad).all()
        assert (back <= robot.position_max_rad).all()


def test_the_joints_of_a_differential_share_their_servos_speed(tmp_path: Path) -> None:
    def speeds(body: str) -> list[float]:
        robot = load_robot(str(write_robot(tmp_path, body, margin=1.0)))
        return np.rad2deg(robot.velocity_limit_rad_s).tolist()

    servo = math.degrees(6.807)
    assert speeds(WAIST) == pytest.approx([servo * 0.291667, servo * 0.208333], rel=1e-5), "half of each servo for each"
    slow = WAIST.replace('role = "waist_roll"', 'role = "waist_roll"\nvelocity_limit_deg_s = 29.1667')
    assert speeds(slow) == pytest.approx([29.1667, (servo - 50) * 0.416667], rel=1e-5), "what the roll leaves"


def test_a_linkage_passes_through_its_rows_and_stays_monotone() -> None:
    robot = ROBOTS["four-bar at a row"]
    linkage = robot.servos[0].linkage
    assert linkage is not None
    rows = np.deg2rad([-45, -20, 0, 15, 30]), np.deg2rad([-70, -28, 0, 20, 37])
    assert linkage.to_servo(rows[0]) == pytest.approx(rows[1])
    q = np.linspace(rows[0][0], rows[0][-1], 2001)
    servo = linkage.to_servo(q)
    assert (np.diff(servo) > 0).all()
    assert linkage.to_joint(servo) == pytest.approx(q, abs=1e-12)
    assert np.abs(np.diff(servo, 2)).max() < 1e-5, "no kink at a row: the speed changes by a hundredth a step at most"
    assert linkage.steepest == pytest.approx(np.abs(np.diff(servo) / np.diff(q)).max(), rel=1e-3)
