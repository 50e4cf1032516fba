"""Robot files: what is wrong is named with file, key, found and allowed; the packaged ones are sound."""

from __future__ import annotations

import math
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from retarget.errors import RobotFileError, UnknownRobotError
from retarget.pipeline import Retargeter
from retarget.robot import ROBOTS_DIR, list_robots, load_robot
from retarget.ticks import JointServoMap


def test_an_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(UnknownRobotError) as caught:
        load_robot("r2d2")
    assert "r2d2" in str(caught.value)
    assert all(name in str(caught.value) for name in list_robots())


CHANGES = [
    (
        "unknown key",
        'name = "head_yaw"',
        'name = "head_yaw"\ncolour = "red"',
        ["joint[0]", "colour", "position_limit_deg"],
    ),
    ("radians", "rest_deg = 0", "rest_rad = 0", ["rest_rad", "radians", "rest_deg"]),
    ("reversed limits", "[-80, 80]", "[80, -80]", ["head_yaw", "position_limit_deg", "[80.0, -80.0]", "low < high"]),
    ("rest outside", "rest_deg = 0", "rest_deg = 99", ["head_yaw", "rest_deg", "99", "[-80.0, 80.0]"]),
    ("two joints on one servo", "{ id = 2,", "{ id = 1,", ["servo.id", "'1'", "each once"]),
    ("beyond the servo's turn", "[-80, 80]", "[-80, 181]", ["head_yaw", "ticks 1138 to 4107", "0 to 4095"]),
    ("unknown servo", '"XL330-M288"', '"XL999"', ["XL999", "XM430-W350"]),
    ("unknown role", 'role = "head_yaw"', 'role = "tail"', ["role", "'tail'", "left_elbow"]),
    ("two joints of one role", 'role = "head_pitch"', 'role = "head_yaw"', ["role", "head_yaw", "each once"]),
    ("wrong type", "baud = 1000000", 'baud = "fast"', ["bus.baud", "int"]),
    ("no such joint", 'name = "head_yaw"', 'name = "head_turn"', ["head_turn", "not in robot.xml", "head_yaw"]),
    ("no description", 'description = "robot.xml"', 'description = "none.xml"', ["description", "none.xml"]),
    ("newer format", "format = 1", "format = 9", ["format", "9", "1"]),
    ("direction", "direction = 1 }", "direction = 2 }", ["direction", "2", "1 or -1"]),
    ("rate", "rate_hz = 100", "rate_hz = 0", ["bus.rate_hz", "1 to 1000"]),
    ("no TOML", "format = 1", "format = = 1", ["not TOML"]),
]


@pytest.mark.parametrize(("old", "new", "said"), [pytest.param(*c[1:], id=c[0]) for c in CHANGES])
def test_each_mistake_is_named_with_what_is_allowed(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(ROBOTS_DIR / "reference", folder)
    text = (folder / "robot.toml").read_text()
    assert old in text
    (folder / "robot.toml").write_text(text.replace(old, new, 1))
    with pytest.raises(RobotFileError) as caught:
        Retargeter(load_robot(str(folder)))
    message = str(caught.value)
    assert "robot.toml" in message
    for part in said:
        assert part in message, message


def test_a_description_that_mujoco_cannot_read_is_named(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(ROBOTS_DIR / "reference", folder)
    (folder / "robot.xml").write_text("<mujoco><worldbody><body></mujoco>")
    with pytest.raises(RobotFileError, match=r"robot\.xml.*description"):
        Retargeter(load_robot(str(folder)))


@pytest.mark.parametrize("name", list_robots())
def test_packaged_robots_are_slower_than_their_servos_and_park_without_touching(name: str) -> None:
    robot = load_robot(name)
    for joint, servo in zip(robot.joints, robot.servos, strict=True):
        assert joint.velocity_limit_rad_s * servo.gear_ratio <= servo.model.no_load_speed_rad_s
    contact = Retargeter(robot).contact
    assert contact.pairs(robot.park_rad) == []
    assert contact.pairs(robot.rest_rad) == []


def test_directions_and_zero_are_as_the_file_says() -> None:
    robot = load_robot("reference")
    ticks = JointServoMap(robot)
    q = np.full(robot.n_joints, math.radians(9.0))
    right, left = robot.joint_names.index("right_shoulder_pitch"), robot.joint_names.index("left_shoulder_pitch")
    assert ticks.rad_to_tick(q)[left] == 2048 + round(4096 * 9 / 360)
    assert ticks.rad_to_tick(q)[right] == 2048 - round(4096 * 9 / 360)


def test_retargeting_loads_no_torch() -> None:
    code = "import sys, retarget.pipeline, daemon.streamer, daemon.front; sys.exit('torch' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=60, check=False).returncode == 0
