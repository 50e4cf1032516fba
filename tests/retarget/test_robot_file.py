"""Robot files: what is wrong is named with file, key, found and allowed; the packaged ones are sound."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daemon.control.safety_limiter import SafetyLimiter
from retarget.errors import RobotFileError, UnknownRobotError
from retarget.pipeline import Retargeter
from retarget.robot.loading import ROBOTS_DIR, list_robots, load_robot
from retarget.robot.ticks import JointServoMap
from tests.retarget.robot_files import joint, write_robot
from tests.support.sizes import examples


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
    ("rate", "rate_hz = 100", "rate_hz = 0", ["bus.rate_hz", "20 to 1000"]),
    ("not a number", "rest_deg = 0", "rest_deg = nan", ["rest_deg", "nan", "a finite number"]),
    ("infinite", "acceleration_limit_deg_s2 = 2300", "acceleration_limit_deg_s2 = inf", ["motion.acceleration", "inf"]),
    (
        "speed not positive",
        "rest_deg = 0",
        "rest_deg = 0\nvelocity_limit_deg_s = 0",
        ["joint[0].velocity_limit_deg_s", "1 to 10000"],
    ),
    ("margin", "velocity_margin = 0.9", "velocity_margin = 1.2", ["velocity_margin", "1.2", "at most 1"]),
    ("no servo", "servo = { id = 1, ", "# servo = { id = 1, ", ["head_yaw", "no servo", "[[differential]]"]),
    ("gear against", "direction = 1 }", "gear_ratio = -2 }", ["gear_ratio", "-2", "the sign is `direction`"]),
    ("id beyond", "{ id = 1,", "{ id = 253,", ["servo.id", "253", "0 to 252"]),
    ("id as text", "{ id = 1,", '{ id = "one",', ["servo.id", "'one'", "0 to 252"]),
    ("blank", "{ id = 1,", '{ id = "?",', ["servo.id", "blank, one of 1", "mmmd robot check"]),
    ("blank model", '"XL330-M288"', '"?"', ["servo.model", "blank", "a servo model's name"]),
    ("protocol of a servo", '"XL330-M288"', '"MX-28"', ["MX-28 speaks protocol 1.0", "the bus 2.0", "'-2'"]),
    ("protocol", "protocol = 2.0", "protocol = 3.0", ["bus.protocol", "3.0", "1.0 or 2.0"]),
    ("forward is up", "[motion]", '[frame]\nforward = "z"\n[motion]', ["frame", "'z'", "two different axes"]),
    ("no direction", "[motion]", '[frame]\nforward = "north"\n[motion]', ["frame.forward", "north", "-x"]),
    ("unknown point", "[motion]", '[points.tail]\nbody = "x"\n[motion]', ["points", "tail", "left_wrist"]),
    (
        "servo's own range",
        "direction = 1 }",
        "position_limit_deg = [-70, 70] }",
        ["head_yaw", "reaches", "1252 to 2844"],
    ),
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


NUMBER = re.compile(r"(?<![\w.\"-])-?\d+(?:\.\d+)?(?![\w.\"])")
ABSURD = [
    "1e300",
    "-1e300",
    "1e-300",
    "0",
    "-1",
    "9" * 400,
    "-" + "9" * 400,
    "1e9",
    "1e-9",
    "1",
    "0.001",
    "nan",
    "true",
]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Copies of packaged robots with gears, a linkage and a differential, and with fine ticks."""
    folder = tmp_path_factory.mktemp("absurd")
    return {name: Path(shutil.copytree(ROBOTS_DIR / name, folder / name)) for name in ("toddlerbot", "ffw_bg2")}


@given(data=st.data())
@settings(max_examples=examples(200), deadline=None)
def test_an_absurd_number_is_refused_or_leaves_sound_figures(files: dict[str, Path], data: st.DataObject) -> None:
    """1e300 as an acceleration or a coupling was taken, and the limiter's sums were no numbers any more."""
    name = data.draw(st.sampled_from(sorted(files)))
    lines = (ROBOTS_DIR / name / "robot.toml").read_text().splitlines()
    places = [(i, m.span()) for i, line in enumerate(lines) if line[:1] != "#" for m in NUMBER.finditer(line)]
    i, (start, end) = data.draw(st.sampled_from(places))
    lines[i] = lines[i][:start] + data.draw(st.sampled_from(ABSURD)) + lines[i][end:]
    (files[name] / "robot.toml").write_text("\n".join(lines))
    try:
        robot = load_robot(str(files[name]))
    except RobotFileError as error:
        assert len(str(error)) < 3000
        return
    ticks, gate = JointServoMap(robot), SafetyLimiter(robot)
    low, high = ticks.position_range_rad
    assert (low < high).all() and np.abs([low, high]).max() < 13
    for figures in (
        ticks.ticks_per_rad, ticks.velocity_limit_tick_s, ticks.acceleration_limit_tick_s2, robot.velocity_limit_rad_s,
        robot.acceleration_limit_rad_s2, ticks.to_ticks(low), ticks.to_ticks(high),
    ):  # fmt: skip
        assert np.isfinite(figures).all() and np.abs(figures).max() < 2**31
    assert (robot.velocity_limit_rad_s > 0).all() and 20 <= robot.bus.rate_hz <= 1000
    for target in (low, high, np.zeros_like(low)):
        for _ in range(20):
            goal = gate.step(target)
            assert np.isfinite(goal).all() and (np.abs(gate.velocity_rad_s) <= robot.velocity_limit_rad_s + 1e-9).all()
    assert np.abs(ticks.to_ticks(ticks.tick_to_rad(ticks.position_min_tick)) - ticks.position_min_tick).max() < 0.01


def test_a_description_that_mujoco_cannot_read_is_named(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(ROBOTS_DIR / "reference", folder)
    (folder / "robot.xml").write_text("<mujoco><worldbody><body></mujoco>")
    with pytest.raises(RobotFileError, match=r"robot\.xml.*description"):
        Retargeter(load_robot(str(folder)))


@pytest.mark.parametrize("name", list_robots())
def test_packaged_robots_are_slower_than_servos_and_park_without_contact(name: str) -> None:
    robot = load_robot(name)
    for tick_s, servo in zip(JointServoMap(robot).velocity_limit_tick_s, robot.servos, strict=True):
        assert tick_s * 2 * math.pi / servo.model.ticks_per_turn <= servo.model.no_load_speed_rad_s
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


@pytest.mark.long
def test_retargeting_loads_no_torch() -> None:
    code = "import sys, retarget.pipeline, daemon.control.control_loop, daemon.front.front; sys.exit('torch' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=60, check=False).returncode == 0


DIFFERENTIAL = (
    joint("waist_roll", "waist_roll", "[-30, 30]")
    + joint("waist_yaw", "waist_yaw", "[-60, 60]")
    + """[[differential]]
joints = ["waist_roll", "waist_yaw"]
joint_per_servo = [[-0.5, 0.5], [0.5, 0.5]]
servos = [{ id = 2, model = "XL430-W250" }, { id = 3, model = "XL430-W250" }]
"""
)
LINKAGE = joint(
    "nod", "head_pitch", "[-40, 30]",
    '{ id = 1, model = "XL430-W250", linkage = { joint_deg = [-45, 0, 30], servo_deg = [-70, 0, 37] } }',
)  # fmt: skip
DRIVES = [
    ("singular", DIFFERENTIAL, "[0.5, 0.5]]", "[-0.5, 0.5]]", ["joint_per_servo", "with an inverse"]),
    ("not square", DIFFERENTIAL, "[0.5, 0.5]]", "[0.5]]", ["joint_per_servo", "a row for each joint"]),
    ("a servo short", DIFFERENTIAL, ', { id = 3, model = "XL430-W250" }]', "]", ["2 joints and 1 servos"]),
    ("no such joint", DIFFERENTIAL, '["waist_roll", "waist_yaw"]', '["waist_roll", "hip"]', ["'hip'", "waist_yaw"]),
    ("twice", DIFFERENTIAL, '["waist_roll", "waist_yaw"]', '["waist_yaw", "waist_yaw"]', ["'waist_yaw' twice"]),
    ("same id", DIFFERENTIAL, "{ id = 3,", "{ id = 2,", ["servo.id", "'2'", "each once"]),
    (
        "a corner out of reach", DIFFERENTIAL, "[-60, 60]", "[-160, 160]",
        ["waist_roll", "waist_yaw", "reaches servo ticks -114 to 4210", "0 to 4095"],
    ),
    (
        "both too fast", DIFFERENTIAL.replace('"waist_yaw"\n', '"waist_yaw"\nvelocity_limit_deg_s = 200\n', 1),
        '"waist_roll"\n', '"waist_roll"\nvelocity_limit_deg_s = 200\n', ["velocity_limit_deg_s", "400 deg/s", "308 deg/s"],
    ),
    ("and a servo", DIFFERENTIAL, "[-30, 30]\n", '[-30, 30]\nservo = { id = 9, model = "XL430-W250" }\n', ["one of them"]),
    ("short table", LINKAGE, "[-45, 0, 30]", "[-30, 0, 30]", ["linkage", "from -30 to 30", "[-40, 30]"]),
    ("falling table", LINKAGE, "[-45, 0, 30]", "[-45, 40, 30]", ["linkage", "joint_deg rising"]),
    ("turning table", LINKAGE, "[-70, 0, 37]", "[-70, 50, 37]", ["linkage", "rising or falling"]),
    ("uneven table", LINKAGE, "[-70, 0, 37]", "[-70, 0]", ["3 joint and 2 servo angles"]),
    ("in radians", LINKAGE, "[-40, 30]", "[-0.7, 0.5]", ["position_limit_deg", "look like radians"]),
    ("MX in extended mode", LINKAGE, 'model = "XL430-W250"', 'model = "MX-28", extended = true', ["MX-28", "protocol"]),
]  # fmt: skip


@pytest.mark.parametrize(("body", "old", "new", "said"), [pytest.param(*c[1:], id=c[0]) for c in DRIVES])
def test_each_mistake_in_a_drive_is_named(tmp_path: Path, body: str, old: str, new: str, said: list[str]) -> None:
    load_robot(str(write_robot(tmp_path, body if "200" not in body else DIFFERENTIAL)))
    assert old in body
    with pytest.raises(RobotFileError) as caught:
        load_robot(str(write_robot(tmp_path, body.replace(old, new, 1))))
    for part in ("robot.toml", *said):
        assert part in str(caught.value), str(caught.value)


def test_a_servo_of_protocol_1_has_no_extended_mode(tmp_path: Path) -> None:
    body = joint("nod", "head_pitch", "[-40, 30]", '{ id = 1, model = "MX-28", extended = true }')
    with pytest.raises(RobotFileError, match="MX-28 has no extended position mode"):
        load_robot(str(write_robot(tmp_path, body, protocol=1.0)))


def test_a_file_with_blanks_can_be_looked_at(tmp_path: Path) -> None:
    body = joint("nod", "head_pitch", "[-40, 30]", '{ id = "?", model = "?" }')
    robot = load_robot(str(write_robot(tmp_path, body)), blanks=True)
    assert len(robot.blanks) == 2
    assert robot.servos[0].servo_id < 0
