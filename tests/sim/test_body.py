"""Bodies behind the servos: gravity, stops, contact, pushes; and that both keep one contract."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.dynamixel.registers.models import MODELS
from retarget.robot.loading import list_robots, load_robot
from retarget.robot.ticks import JointServoMap
from sim.bodies.mujoco_body import MujocoBody
from sim.errors import SimSettingError
from sim.faults import Fault, FaultSchedule
from sim.options import world_of
from sim.world import World
from tests.support.sizes import few_and_long

ROBOTS = [n for n in list_robots() if all(s.model.model_number in MODELS for s in load_robot(n, blanks=True).servos)]
REFERENCE = load_robot("reference")
LEFT_ROLL = REFERENCE.joint_names.index("left_shoulder_roll")
LEFT_ELBOW = REFERENCE.joint_names.index("left_elbow")


def goals(world: World, q_rad: np.ndarray, seconds: float, torque: bool = True) -> np.ndarray:
    """Torque on and goals written; (J,) joint angles after a while."""
    ticks = JointServoMap(world.robot).to_ticks(q_rad)
    for servo, tick in zip(world.all, ticks, strict=True):
        for name, value in (("torque_enable", 1), ("goal_position", round(tick)))[0 if torque else 1 :]:
            item = servo.items[name]
            assert servo.write(item.address, item.encode(value)) == 0
    world.advance(world.t_s + seconds)
    return JointServoMap(world.robot).tick_to_rad(world.drives.position_tick)


@pytest.mark.parametrize("name", few_and_long(["reference", "op3"], ROBOTS))
@pytest.mark.parametrize("body", ["plain", "mujoco"])
def test_every_robot_holds_its_rest_pose_in_either_body(name: str, body: str) -> None:
    robot = load_robot(name)
    world = world_of(robot, None, body)
    end = goals(world, robot.rest_rad, 3.0)
    assert np.abs(end - robot.rest_rad).max() < 0.1, "gravity against a proportional gain: some sag"
    speed = np.abs(world.drives.velocity_tick_s * world.drives.rad_per_tick)
    assert speed.max() < 20 * 2 * np.pi / 4096, "it stands, but for the creep of MuJoCo's soft friction"
    assert world.body.self_contacts == 0


def test_limp_arms_fall_and_only_with_gravity() -> None:
    raised = REFERENCE.rest_rad.copy()
    raised[LEFT_ROLL] = np.radians(90)
    ends = []
    for body in ("plain", "mujoco"):
        world = world_of(REFERENCE, None, body, start_rad=raised.tolist())
        world.advance(4.0)
        ends.append(JointServoMap(REFERENCE).tick_to_rad(world.drives.position_tick)[LEFT_ROLL])
    assert ends[0] == pytest.approx(np.radians(90))
    assert ends[1] < np.radians(60)


def test_a_raised_arm_draws_current_that_a_hanging_one_does_not() -> None:
    world = world_of(REFERENCE, None, "mujoco")
    goals(world, REFERENCE.rest_rad, 2.0)
    hanging = abs(world.drives.current_a[LEFT_ROLL])
    raised = REFERENCE.rest_rad.copy()
    raised[LEFT_ROLL] = np.radians(90)
    goals(world, raised, 3.0)
    assert abs(world.drives.current_a[LEFT_ROLL]) > hanging + 0.05


def test_a_push_deflects_and_is_resisted() -> None:
    servo_id = REFERENCE.servo_ids[LEFT_ELBOW]
    fault = Fault("push", start_s=2.0, end_s=3.0, servo_id=servo_id, amount=1.0)
    world = world_of(REFERENCE, FaultSchedule((fault,)), "mujoco")
    rest = goals(world, REFERENCE.rest_rad, 1.9)
    pushed = goals(world, REFERENCE.rest_rad, 1.0)
    after = goals(world, REFERENCE.rest_rad, 2.0)
    assert 0.03 < abs(pushed - rest)[LEFT_ELBOW] < 0.5
    assert abs(after - rest)[LEFT_ELBOW] < 0.02


def test_a_joint_ends_at_its_stop() -> None:
    world = world_of(REFERENCE, None, "mujoco")
    servo = world.all[LEFT_ELBOW]
    servo.write(11, b"\x10")  # PWM mode: it pushes for ever
    servo.write(64, b"\1")
    servo.write(100, (300).to_bytes(2, "little", signed=True))
    world.advance(3.0)
    q = JointServoMap(REFERENCE).tick_to_rad(world.drives.position_tick)[LEFT_ELBOW]
    assert REFERENCE.position_max_rad[LEFT_ELBOW] - 0.1 < abs(q) < REFERENCE.position_max_rad[LEFT_ELBOW] + 0.2
    assert abs(world.drives.velocity_tick_s[LEFT_ELBOW]) < 5


def test_a_robot_that_strikes_itself_is_seen_and_does_not_pass_through() -> None:
    pose = REFERENCE.rest_rad.copy()
    pose[LEFT_ROLL] = np.radians(-15)
    pose[LEFT_ELBOW] = np.radians(120)
    pose[REFERENCE.joint_names.index("left_shoulder_yaw")] = np.radians(-90)
    world = world_of(REFERENCE, None, "mujoco")
    end = goals(world, pose, 3.0)
    assert world.audit.report()["led_contacts"] > 0
    assert np.abs(end - pose).max() > 0.1


def test_a_limp_robot_that_rests_on_itself_was_not_led_there() -> None:
    pose = REFERENCE.rest_rad.copy()
    pose[LEFT_ROLL] = np.radians(-15)
    world = world_of(REFERENCE, None, "mujoco", start_rad=pose.tolist())
    world.advance(3.0)
    report = world.audit.report()
    assert report["body_contacts"] > 0 and report["led_contacts"] == 0


def test_same_start_same_goals_same_end() -> None:
    ends = [goals(world_of(REFERENCE, None, "mujoco"), REFERENCE.rest_rad, 1.0).tobytes() for _ in range(2)]
    assert ends[0] == ends[1]


def test_what_happens_does_not_depend_on_when_somebody_looks() -> None:
    ends = []
    for step_s in (0.0013, 0.1):
        world = world_of(REFERENCE)
        goals(world, REFERENCE.rest_rad, 0.0)
        for i in range(1, round(1.0 / step_s) + 1):
            world.advance(i * step_s)
        world.advance(1.0)
        ends.append(world.drives.position_tick.tobytes())
    assert ends[0] == ends[1]


def test_other_bodies_and_servos_without_a_joint_are_refused() -> None:
    with pytest.raises(SimSettingError, match="plain, mujoco"):
        world_of(REFERENCE, None, "jelly")
    with pytest.raises(SimSettingError, match="without a joint"):
        World(REFERENCE, body=MujocoBody, extra=REFERENCE.servos[:1])
