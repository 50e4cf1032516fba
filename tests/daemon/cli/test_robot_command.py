"""`mmmd robot`: list, new, check, show, as a user types them."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from daemon.cli import main
from retarget.robot.loading import ROBOTS_DIR, list_robots, load_robot
from tests.support.rig import rig
from tests.support.sizes import few_and_long


def description(tmp_path: Path) -> Path:
    """The reference robot's description without its robot.toml and without its named places."""
    text = (ROBOTS_DIR / "reference" / "robot.xml").read_text()
    path = tmp_path / "mine" / "mine.xml"
    path.parent.mkdir()
    path.write_text(re.sub(r"<site [^>]*/>", "", text))
    return path


def test_list_names_every_packaged_robot(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["robot", "list"]) == 0
    assert capsys.readouterr().out.split() == list_robots()


@pytest.mark.parametrize("name", list_robots())
def test_check_finds_nothing_missing_in_what_ships(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["robot", "check", name]) == 0
    out = capsys.readouterr().out
    assert "nothing is missing" in out
    for joint in load_robot(name).joint_names:
        assert joint in out
    assert "bus has no control table" not in out
    assert "ms a cycle" in out


def test_check_refuses_a_rate_that_the_wire_cannot_carry(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(ROBOTS_DIR / "reference", tmp_path / "mine")
    robot_file = tmp_path / "mine" / "robot.toml"
    robot_file.write_text(robot_file.read_text().replace("baud = 1000000", "baud = 57600"))
    assert main(["robot", "check", str(tmp_path / "mine")]) == 1
    assert "missing: bus.rate_hz 100 is impossible at 57600 baud" in capsys.readouterr().out


def test_from_a_description_to_a_simulated_robot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = description(tmp_path)
    assert main(["robot", "new", str(path), "--servo", "XL430-W250"]) == 0
    out = capsys.readouterr().out
    robot_file = path.parent / "robot.toml"
    assert re.search(r"left_elbow +left_elbow +0\.00 -1\.00 0\.00", out)
    assert "blank: joint[0] 'head_yaw': servo.id" in out
    assert str(robot_file) in out

    assert main(["robot", "check", str(path.parent)]) == 1
    assert capsys.readouterr().out.count('is blank ("?")') == 16

    assert main(["robot", "new", str(path)]) == 2, "never over a file that is there"
    assert "is there already" in capsys.readouterr().err

    ids = iter(range(1, 17))
    robot_file.write_text(re.sub(r'id = "\?"', lambda _: f"id = {next(ids)}", robot_file.read_text()))
    assert main(["robot", "check", str(path.parent)]) == 0
    capsys.readouterr()

    with rig(str(path.parent)) as r:
        r.arm()
        assert all(r.torque)
        assert np.abs(r.goals_rad()[-1] - r.robot.rest_rad).max() < 0.01
        r.assert_limits_kept()


def test_the_description_may_stand_elsewhere(tmp_path: Path) -> None:
    path = description(tmp_path)
    assert main(["robot", "new", str(path), "--out", str(tmp_path / "other")]) == 0
    robot = load_robot(str(tmp_path / "other"), blanks=True)
    assert robot.description_path.resolve() == path.resolve()


def test_check_doubts_a_joint_in_radians(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One joint of a file in degrees was given in radians, and nothing was said."""
    shutil.copytree(ROBOTS_DIR / "reference", tmp_path / "mine")
    robot_file = tmp_path / "mine" / "robot.toml"
    block = robot_file.read_text()
    at = block.index('name = "waist_yaw"')
    robot_file.write_text(
        block[:at] + re.sub(r"position_limit_deg = \[.*?\]", "position_limit_deg = [-0.8, 0.8]", block[at:], count=1)
    )
    assert main(["robot", "check", str(tmp_path / "mine")]) == 0
    doubts = [line for line in capsys.readouterr().out.splitlines() if "radians?" in line]
    assert doubts == ["look at: waist_yaw: position_limit_deg [-0.8, 0.8] is hardly a movement; degrees, not radians?"]


def test_check_says_what_touches(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(ROBOTS_DIR / "reference", tmp_path / "mine")
    robot_file = tmp_path / "mine" / "robot.toml"
    block = robot_file.read_text()
    at = block.index('name = "left_shoulder_roll"')
    robot_file.write_text(block[:at] + block[at:].replace("park_deg = 8", "park_deg = -15", 1))
    assert main(["robot", "check", str(tmp_path / "mine")]) == 1
    assert re.search(r"missing: park pose: \S+ touches \S+; change park_deg", capsys.readouterr().out)


@pytest.mark.parametrize("name", few_and_long(["op2"], ["ffw_bg2"]))
def test_show_draws_rest_arms_out_and_a_gesture(name: str, tmp_path: Path) -> None:
    from matplotlib.image import imread  # slow to import, and every worker of xdist collects this file

    out = tmp_path / "robot.png"
    assert main(["robot", "show", name, "--out", str(out), "--text", "raise your left arm"]) == 0
    picture = imread(out)[..., :3]
    panels = np.array_split(picture, 6, axis=1)
    assert len({panel.tobytes() for panel in panels}) == 6, "six poses, all different"
    assert all((panel.min(-1) < 0.9).mean() > 0.02 for panel in panels), "and none empty"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["new"], "needs the description"),
        (["check"], "needs a robot"),
        (["new", "none.xml"], "no file none.xml"),
        (["check", "r2d2"], "unknown robot 'r2d2'"),
    ],
)
def test_bad_use_is_said_and_is_status_2(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["robot", *arguments]) == 2
    assert said in capsys.readouterr().err
