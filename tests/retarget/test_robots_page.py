"""docs/robots.md: its examples are TOML that is read, its table names the robots that ship."""

import re
from pathlib import Path

import pytest

from retarget.robot.loading import list_robots, load_robot
from retarget.robot.servos import servo_models

PAGE = (Path(__file__).parents[2] / "docs" / "robots.md").read_text()
EXAMPLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
XML = """<mujoco><worldbody>
<body><joint name="l_sho_pitch"/><geom size=".1"/><body name="left_forearm"><joint name="elbow"/><geom size=".1"/></body></body>
<body><joint name="nod"/><geom size=".1"/></body>
<body><joint name="waist_roll"/><geom size=".1"/><body><joint name="waist_yaw"/><geom size=".1"/></body></body>
</worldbody></mujoco>"""


def test_the_examples_together_are_one_robot(tmp_path: Path) -> None:
    whole, pair, rods, differential = EXAMPLES

    def joint(name: str, role: str, drive: str) -> str:
        return f'[[joint]]\nname = "{name}"\nrole = "{role}"\nposition_limit_deg = [-30, 30]\n{drive}\n'

    (tmp_path / "robot.xml").write_text(XML)
    (tmp_path / "robot.toml").write_text(
        whole + joint("elbow", "left_elbow", pair) + joint("nod", "head_pitch", rods)
        + joint("waist_roll", "waist_roll", "") + joint("waist_yaw", "waist_yaw", "") + differential
    )  # fmt: skip
    robot = load_robot(str(tmp_path))
    assert (robot.n_joints, robot.n_servos) == (5, 6)
    assert [s.servo_id for s in robot.servos] == [5, 8, 9, 1, 2, 3]


@pytest.mark.parametrize("name", list_robots())
def test_every_robot_stands_in_the_table_with_its_bus(name: str) -> None:
    row = next(line for line in PAGE.splitlines() if line.startswith(f"| `{name}`"))
    bus = load_robot(name).bus
    assert f"Protocol {bus.protocol}, {bus.baud / 1e6:g} Mbit/s, {bus.rate_hz:g} Hz" in row


def test_servo_models_are_named_once_and_turn_within_their_range() -> None:
    numbers = [m.model_number for m in servo_models().values()]
    assert len(set(numbers)) == len(numbers)
    for model in servo_models().values():
        assert model.min_tick <= model.zero_tick <= model.max_tick
        assert model.max_tick - model.min_tick <= model.ticks_per_turn
