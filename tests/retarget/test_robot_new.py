"""A robot file from a description: roles against the makers' tables, a stranger brought to work, bad descriptions named."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from retarget.errors import RobotFileError
from retarget.pipeline import Retargeter
from retarget.robot.description import rotation_to_standard
from retarget.robot.kinematics import Kinematics
from retarget.robot.loading import list_robots, load_robot
from retarget.setup.inspection import inspect_robot
from retarget.setup.limb_detection import find_anatomy
from retarget.setup.scaffold import propose
from retarget.setup.standing_pose import Direction, standing_pose
from tests.retarget.test_pipeline import RATES_HZ, at_rest, check_bounds
from tests.support.shipped import shipped_engine
from tests.support.two_arms import proposed, two_arms

SHARED = Path(__file__).parents[3] / "shared" / "robots"


NEW_NAMES = {"upper_arm_yaw": "shoulder_yaw", "torso": "waist"}


NOT_OURS = ("gripper", "lift", "differential", "antenna", "platform")


def described(folder: str) -> Path:
    path = SHARED / folder
    if not path.is_dir():
        pytest.skip("no ../shared/robots beside this checkout")
    return next(p for p in path.iterdir() if p.stem == "robot")


@pytest.mark.parametrize(
    "folder",
    [
        "berkeley_humanoid_lite",
        "poppy_torso",
        "reachy_2021",
        "robotis_ffw_bg2",
        "robotis_op2",
        "robotis_op3",
        "toddlerbot",
    ],
)
def test_roles_are_those_of_the_makers_table(folder: str) -> None:
    description = described(folder)
    table = tomllib.loads((description.parent / "joints.toml").read_text())
    wanted: dict[str, str] = {}
    for joint in table["joint"]:
        role = joint["role"]
        for old, new in NEW_NAMES.items():
            role = role.replace(old, new)
        if not any(word in role for word in NOT_OURS):
            wanted[joint.get("drives", joint["name"])] = role
    found = {j.name: j.role for j in find_anatomy(description).joints}
    assert found == wanted


@pytest.mark.parametrize("name", list_robots())
def test_roles_of_the_packaged_descriptions_are_those_of_their_files(name: str) -> None:
    robot = load_robot(name)
    found = find_anatomy(robot.description_path)
    assert {j.name: j.role for j in found.joints} == {j.name: j.role for j in robot.joints}
    assert (found.forward, found.up) == ("x", "z")


def filled_in(text: str, first_id: int = 1) -> str:
    ids = iter(range(first_id, 253))
    return re.sub(r'id = "\?"', lambda _: f"id = {next(ids)}", text)


def test_a_description_of_strangers_works_with_no_edits_but_ids(tmp_path: Path) -> None:
    """Berkeley Humanoid Lite, written by none of us: five joints in each arm, axes tilted by 15 degrees, no head."""
    robot_file = tmp_path / "berkeley" / "robot.toml"
    proposal = propose(described("berkeley_humanoid_lite"), robot_file, "XM430-W350")
    assert len(proposal.blanks) == 10
    with pytest.raises(RobotFileError, match=r"servo\.id: blank, one of 10"):
        load_robot(str(robot_file))
    assert all("blank" in lack for lack in inspect_robot(load_robot(str(robot_file), blanks=True)).missing)
    robot_file.write_text(filled_in(proposal.text))
    robot = load_robot(str(robot_file))
    assert inspect_robot(robot).missing == ()
    r = Retargeter(robot)
    places = dict(
        zip((p.name for p in r.kinematics.key_points), r.kinematics.places(robot.rest_rad[None])[0], strict=True)
    )
    assert places["left_wrist"][2] < places["left_elbow"][2] < places["left_shoulder"][2], "its arms hang at rest"
    engine = shipped_engine()
    for text, up in (("raise your right arm", "right"), ("wave with your left hand", "left"), ("clap your hands", "")):
        path = r.retarget(engine.generate(text, seed=1).motion, at_rest(r))
        for rate_hz in RATES_HZ:
            check_bounds(path, at_rest(r), r, rate_hz)
        assert not r.contact.frames(path.at_rate(100.0)).any()
        moved = r.kinematics.places(path.q_rad)
        names = [p.name for p in r.kinematics.key_points]
        height = {
            s: (moved[:, names.index(f"{s}_wrist"), 2] - moved[:, names.index(f"{s}_shoulder"), 2]).max()
            for s in ("left", "right")
        }
        if up:  # its ranges end where the arm is level or little above
            assert height[up] > -0.05
            assert height[up] > 0.2 + min(height.values()), (text, height)

    for upper, fore in (
        ((0.0, 0.5, 1.0), (0.0, 0.0, 1.0)),
        ((1.0, 0.2, 0.2), (0.0, 0.0, 1.0)),
        ((0.3, 0.3, -1.0), (1.0, 0.0, 0.5)),
    ):
        assert_nearest_there_is(r, upper, fore)


def assert_nearest_there_is(r: Retargeter, upper: Direction, fore: Direction) -> None:
    """Its ranges are narrow (yaw 45, elbow 90 degrees): not exact, but hardly worse than the best of many poses."""
    robot, names = r.robot, [p.name for p in r.kinematics.key_points]
    share = np.random.default_rng(0).uniform(size=(20_000, robot.n_joints))
    anywhere = robot.position_min_rad + share * (robot.position_max_rad - robot.position_min_rad)
    poses = np.concatenate([standing_pose(r, upper, fore)[None], anywhere])
    places = r.kinematics.places(poses)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        error = np.zeros(len(poses))
        for (a, b), (forward, outward, up) in ((("shoulder", "elbow"), upper), (("elbow", "wrist"), fore)):
            bone = places[:, names.index(f"{side}_{b}")] - places[:, names.index(f"{side}_{a}")]
            wanted = np.array([forward, sign * outward, up])
            cosine = bone @ wanted / np.linalg.norm(bone, axis=-1) / np.linalg.norm(wanted)
            error += np.rad2deg(np.arccos(np.clip(cosine, -1, 1)))
        assert error[0] <= error[1:].min() + 8.0, (side, upper, fore, error[0], error[1:].min())


def test_another_frame_gives_the_same_robot(tmp_path: Path) -> None:
    """Poppy's description looks along -y; what comes out looks along x, with the left hand on the left."""
    propose(described("poppy_torso"), tmp_path / "robot.toml")
    robot = load_robot(str(tmp_path), blanks=True)
    assert robot.forward == "-y"
    kinematics = Kinematics(robot)
    places = dict(
        zip((p.name for p in kinematics.key_points), kinematics.places(np.zeros((1, robot.n_joints)))[0], strict=True)
    )
    assert places["left_wrist"][1] > 0.4
    assert places["right_wrist"][1] < -0.4
    assert places["head"][2] > places["chest"][2]
    assert rotation_to_standard("-y", "z") @ [0, -1, 0] == pytest.approx([1, 0, 0])


@pytest.mark.parametrize("look", ["x", "y"])
def test_names_in_another_language_still_give_a_pair_of_arms(tmp_path: Path, look: str) -> None:
    """A robot that looks along y, with joints named "links" and "rechts": no arms were found, and nothing said why."""
    side = "y" if look == "x" else "x"
    at = {"x": "{} 0 {}", "y": "0 {} {}"}[side]
    links, joints = ['<link name="rumpf"/>'], list[str]()
    for name, where in (("links", 0.1), ("rechts", -0.1)):
        above = "rumpf"
        for i, place in enumerate((at.format(where, 0.3), "0 0 0", "0 0 -0.2"), 1):
            axis = "0 1 0" if (look == "x") == (i != 2) else "1 0 0"
            shape = '<visual><origin xyz="0 0 -0.1"/><geometry><box size="0.03 0.03 0.18"/></geometry></visual>'
            links.append(f'<link name="{name}_{i}_teil">{shape}</link>')
            joints.append(
                f'<joint name="{name}_{i}" type="revolute"><parent link="{above}"/><child link="{name}_{i}_teil"/>'
                f'<origin xyz="{place}"/><axis xyz="{axis}"/><limit lower="-1.5" upper="1.5" effort="1" velocity="3"/></joint>'
            )
            above = f"{name}_{i}_teil"
    path = tmp_path / "eigen.urdf"
    path.write_text(f'<robot name="eigen">{"".join(links + joints)}</robot>')
    found = find_anatomy(path)
    roles = [j.role.partition("_")[2] for j in found.joints]
    assert sorted(roles) == sorted(["shoulder_pitch", "shoulder_roll", "elbow"] * 2)
    assert found.forward == look and any("left and right may be swapped" in note for note in found.notes)


def test_gears_and_unfit_ranges_become_servo_keys(tmp_path: Path) -> None:
    propose(described("toddlerbot"), tmp_path / "robot.toml", "XL330-M288")
    text = (tmp_path / "robot.toml").read_text()
    neck = text[text.index('name = "neck_yaw_driven"') :].partition("[[joint]]")[0]
    assert "direction = -1, gear_ratio = 1.1" in neck
    assert "write a [[differential]]" in text


def test_a_range_that_does_not_fit_about_the_middle_moves_the_zero(tmp_path: Path) -> None:
    robot_file = proposed(tmp_path, two_arms().replace("-90 90", "-60 250"))
    assert "zero_tick = 967" in robot_file.read_text()
    robot_file.unlink()
    robot_file = proposed(tmp_path, two_arms().replace("-90 90", "-190 250"))
    assert "extended = true" in robot_file.read_text()
    robot = load_robot(str(robot_file), blanks=True)
    assert {s.extended for s in robot.servos} == {True, False}


def test_an_unlimited_joint_is_marked_as_a_guess(tmp_path: Path) -> None:
    proposal = propose(described("robotis_op3"), tmp_path / "robot.toml")
    assert proposal.text.count("# ? the description has no range") == 8
    assert any("no range" in note and "l_el" in note for note in proposal.anatomy.notes)
    robot = load_robot(str(tmp_path), blanks=True)
    assert len(robot.blanks) == 16, "ids and models"
    assert any("has no range" in doubt for doubt in inspect_robot(robot).doubts)


FAMILIES = [
    # joints of the left arm: (name, axis, place, role)
    ("pitch, elbow", [("a", "0 1 0", "0 .2 1", "shoulder_pitch"), ("b", "0 1 0", "0 0 -.2", "elbow")]),
    ("pitch, roll, stiff", [("a", "0 1 0", "0 .2 1", "shoulder_pitch"), ("b", "1 0 0", "0 .02 0", "shoulder_roll")]),
    (
        "roll, pitch, elbow",
        [("a", "1 0 0", "0 .2 1", "shoulder_roll"), ("b", "0 1 0", "0 0 -.02", "shoulder_pitch"),
         ("c", "0 1 0", "0 0 -.2", "elbow")],
    ),
    (
        "yaw last, T-pose",
        [("a", "0 1 0", "0 .2 1", "shoulder_pitch"), ("b", "1 0 0", "0 .03 0", "shoulder_roll"),
         ("c", "0 1 0", "0 .1 0", "shoulder_yaw"), ("d", "1 0 0", "0 .1 0", "elbow"), ("e", "0 1 0", "0 .05 0", "forearm_yaw"),
         ("f", "1 0 0", "0 .15 0", "wrist")],
    ),
]  # fmt: skip


@pytest.mark.parametrize(("joints"), [pytest.param(j, id=name) for name, j in FAMILIES])
def test_roles_of_each_family_of_arms(tmp_path: Path, joints: list[tuple[str, str, str, str]]) -> None:
    def arm(side: str, mirror: float) -> str:
        out = [float(v) for v in joints[-1][2].split()] if len(joints) > 3 else [0.0, 0.0, -0.2]
        bodies = ""
        for name, axis, place, _ in joints:
            x, y, z = (float(v) for v in place.split())
            bodies += f'<body pos="{x} {mirror * y} {z}"><joint name="{side}_{name}" axis="{axis}"/><geom size=".02"/>'
        hand = f'<geom size=".01" pos="{out[0]} {mirror * out[1]} {out[2]}"/>'
        return bodies + hand + "</body>" * len(joints)

    path = tmp_path / "mine.xml"
    path.write_text(f"<mujoco><worldbody>{arm('left', 1.0)}{arm('right', -1.0)}</worldbody></mujoco>")
    found = {j.name: j.role for j in find_anatomy(path).joints}
    assert found == {f"{s}_{name}": f"{s}_{role}" for s in ("left", "right") for name, _, _, role in joints}
