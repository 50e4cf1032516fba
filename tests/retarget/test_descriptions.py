"""Descriptions with gaps: missing meshes, followers, loops, no arms, unknown bodies and servos."""

from __future__ import annotations

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

from retarget.errors import RobotFileError
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.setup.inspection import inspect_robot
from retarget.setup.limb_detection import find_anatomy
from retarget.setup.scaffold import propose
from tests.support.two_arms import proposed, two_arms


def test_missing_meshes_are_left_out_and_named(tmp_path: Path) -> None:
    more = '<geom type="mesh" mesh="hand"/>'
    robot_file = proposed(tmp_path, two_arms(more, '<asset><mesh name="hand" file="hand.stl"/></asset>'))
    robot = load_robot(str(robot_file), blanks=True)
    assert Retargeter(robot).arms
    assert any("no file of mesh hand" in doubt for doubt in inspect_robot(robot).doubts)


def test_a_mesh_that_is_there_keeps_its_shape(tmp_path: Path) -> None:
    vertices = "0 0 0  .1 0 0  0 .1 0  0 0 .1"
    tail = f'<asset><mesh name="hand" vertex="{vertices}"/></asset>'
    robot = load_robot(str(proposed(tmp_path, two_arms('<geom type="mesh" mesh="hand"/>', tail))), blanks=True)
    assert not any("mesh" in doubt for doubt in inspect_robot(robot).doubts)


MIMIC = '<equality><joint joint1="left_elbow" joint2="left_roll" polycoef="0 1 0 0 0"/></equality>'
LOOP = '<equality><connect body1="left_fore" body2="right_fore" anchor="0 0 0"/></equality>'


def test_two_listed_joints_of_which_one_follows_are_refused(tmp_path: Path) -> None:
    robot_file = proposed(tmp_path, two_arms())
    (tmp_path / "mine.xml").write_text(two_arms(tail=MIMIC))
    with pytest.raises(RobotFileError, match=r"'left_elbow' follows 'left_roll'.*both are listed.*one of the two"):
        Retargeter(load_robot(str(robot_file), blanks=True))


def test_a_follower_in_the_arm_that_is_not_listed_is_refused(tmp_path: Path) -> None:
    """If only the leading joint were listed, the forearm would keep its angle of the zero pose, which is wrong."""
    robot_file = proposed(tmp_path, two_arms())
    text = robot_file.read_text()
    start = text.index('[[joint]]\nname = "left_elbow"')
    robot_file.write_text(text[:start] + text[text.index("[[joint]]", start + 1) :])
    (tmp_path / "mine.xml").write_text(two_arms(tail=MIMIC))
    with pytest.raises(RobotFileError, match=r"'left_roll' drives 'left_elbow'.*gear_ratio"):
        Retargeter(load_robot(str(robot_file), blanks=True))


def test_a_mimic_joint_of_a_urdf_is_seen(tmp_path: Path) -> None:
    def arm(side: str, y: float) -> str:
        links = "".join(f'<link name="{side}_{n}"/>' for n in ("upper", "fore", "finger"))
        mimic = f'<mimic joint="{side}_elbow" multiplier="2"/>'
        rows = (
            ("pitch", "base", "upper", f"0 {y} 1", "0 1 0", ""),
            ("elbow", f"{side}_upper", "fore", "0 0 -.2", "1 0 0", ""),
            ("finger", f"{side}_fore", "finger", "0 0 -.2", "1 0 0", mimic),
        )
        joints = "".join(
            f'<joint name="{side}_{n}" type="revolute"><parent link="{parent}"/><child link="{side}_{child}"/><origin xyz="{xyz}"/>'
            f'<axis xyz="{axis}"/><limit lower="-1.5" upper="1.5" effort="1" velocity="0"/>{extra}</joint>'
            for n, parent, child, xyz, axis, extra in rows
        )
        return links + joints

    (tmp_path / "mine.urdf").write_text(
        f'<robot name="r"><link name="base"/>{arm("left", 0.2)}{arm("right", -0.2)}</robot>'
    )
    found = find_anatomy(tmp_path / "mine.urdf")
    assert {j.name: j.role for j in found.joints}["left_elbow"] == "left_elbow"
    assert mujoco.MjSpec.from_file(str(tmp_path / "mine.urdf")).equalities, "MuJoCo reads <mimic>"


def test_a_closed_loop_through_an_arm_is_refused(tmp_path: Path) -> None:
    robot_file = proposed(tmp_path, two_arms())
    (tmp_path / "mine.xml").write_text(two_arms(tail=LOOP))
    with pytest.raises(RobotFileError, match=r"ties 'left_fore' to 'right_fore': a closed loop.*linkage table"):
        Retargeter(load_robot(str(robot_file), blanks=True))


def test_a_description_without_arms_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine.xml").write_text(
        '<mujoco><worldbody><body><joint name="a"/><geom size=".1"/></body></worldbody></mujoco>'
    )
    with pytest.raises(RobotFileError, match=r"0 limbs on the left.*a pair of arms"):
        propose(tmp_path / "mine.xml", tmp_path / "robot.toml")
    (tmp_path / "none.xml").write_text('<mujoco><worldbody><geom size=".1"/></worldbody></mujoco>')
    with pytest.raises(RobotFileError, match=r"no hinge joint"):
        propose(tmp_path / "none.xml", tmp_path / "robot.toml")


def test_a_point_on_an_unknown_body_is_named(tmp_path: Path) -> None:
    robot_file = proposed(tmp_path, two_arms())
    robot_file.write_text(robot_file.read_text().replace('body = "left_fore"', 'body = "left_hand"'))
    with pytest.raises(
        RobotFileError, match=r"points\.left_wrist\.body: 'left_hand' is not in the description.*left_fore"
    ):
        Retargeter(load_robot(str(robot_file), blanks=True))


def test_an_unknown_servo_lists_the_known_ones(tmp_path: Path) -> None:
    (tmp_path / "mine.xml").write_text(two_arms())
    with pytest.raises(RobotFileError, match=r"'XL999'.*XM430-W350"):
        propose(tmp_path / "mine.xml", tmp_path / "robot.toml", "XL999")


def test_a_description_without_shapes_is_proposed_and_follows_a_motion(tmp_path: Path) -> None:
    """A URDF of visuals alone ended in an internal error: there is no pair of shapes that could touch."""
    robot_file = proposed(tmp_path, re.sub(r"<geom[^>]*/>", "", two_arms()))
    retargeter = Retargeter(load_robot(str(robot_file), blanks=True))
    assert not retargeter.contact.frames(np.zeros((2, len(retargeter.robot.joints)))).any()
