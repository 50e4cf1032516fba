"""Robots whose joints are not their servos, through the bus side: two servos on a joint, a differential, gears, a linkage."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from retarget.robot.loading import ROBOTS_DIR, load_robot
from tests.support.rig import rig, swing


def test_two_servos_of_a_joint_turn_against_each_other(tmp_path: Path):
    shutil.copytree(ROBOTS_DIR / "reference", tmp_path / "paired")
    robot_file = tmp_path / "paired" / "robot.toml"
    text = robot_file.read_text()
    single = 'servo = { id = 8, model = "XM430-W350", direction = 1 }'
    pair = 'servos = [{ id = 8, model = "XM430-W350" }, { id = 20, model = "XM430-W350", direction = -1, zero_tick = 2100 }]'
    assert single in text
    robot_file.write_text(text.replace(single, pair))
    robot = load_robot(str(tmp_path / "paired"))
    assert (robot.n_joints, robot.n_servos) == (16, 17)
    with rig(str(tmp_path / "paired")) as r:
        r.arm()
        r.push(swing(r.robot, 2.0), plan_id=3)
        r.cycle(220)
        goals = np.array([record["goal_tick"] for record in r.records])
        assert goals.shape[1] == 17
        one, two = robot.servo_ids.index(8), robot.servo_ids.index(20)
        assert np.ptp(goals[:, one]) > 50
        assert (goals[:, one] + goals[:, two] == 2048 + 2100).all()
        r.assert_limits_kept()


@pytest.mark.long
def test_a_waist_differential_turns_both_servos_alike():
    """ToddlerBot: gears, a linkage and a differential, through the packets and back."""
    robot = load_robot("toddlerbot")
    with rig("toddlerbot") as r:
        r.arm()
        path = np.tile(robot.rest_rad, (150, 1))
        path[:, robot.joint_names.index("waist_yaw")] = 0.4 * (1 - np.cos(np.linspace(0, np.pi, 150))) / 2
        r.push(path, plan_id=4)
        r.cycle(170)
        last = r.records[-1]
        servos = [robot.servo_ids.index(i) for i in (2, 3)]
        turned = last["goal_tick"][servos] - 2048
        assert turned[0] == turned[1] == round(0.4 / 0.208333 / 2 * 4096 / (2 * np.pi))
        assert np.abs(last["present_tick"][servos] - last["goal_tick"][servos]).max() <= 2, "and they get there"
        r.assert_limits_kept()
