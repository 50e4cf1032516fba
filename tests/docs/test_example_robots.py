"""The examples that bring robots of their own: several with one generator, and one from its URDF, both with the shipped model."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from mmm_core.inference.checkpoint import MODEL_FILE
from retarget.robot.loading import load_robot
from tests.support.harness import slowed

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
pytestmark = [
    pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout"),
    pytest.mark.timeout(300),
    pytest.mark.realtime,
]


@pytest.mark.long
def test_several_robots_share_a_generator() -> None:
    """Two robots of different joints show one text; both park at the end."""
    names = (slowed("reference"), slowed("op3"))
    command = [sys.executable, str(EXAMPLES / "several_robots.py"), *names]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    shown = sorted(done.stdout.splitlines())
    assert [line.partition(":")[0] for line in shown] == sorted(f"{name}[{k}]" for k, name in enumerate(names))
    assert all("waves with the right hand" in line for line in shown)
    assert done.stderr.count("PARKING -> LIMP") == len(names)


@pytest.mark.long
def test_a_robot_of_ones_own_from_its_urdf(tmp_path: Path) -> None:
    """The steps of docs/robots.md as a script: found, filled in, checked, drawn, and audited on simulated servos."""
    folder = tmp_path / "own"
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["sh", str(EXAMPLES / "own_robot.sh"), str(EXAMPLES / "own_robot.urdf"), str(folder)],
        capture_output=True, text=True, timeout=240, check=False, env={**os.environ, "PATH": path},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "nothing is missing" in done.stdout and (folder / "robot.png").stat().st_size > 10_000
    goals, violations, contacts = (
        int(re.search(rf"^{name}: (\d+)$", done.stdout, re.MULTILINE)[1])
        for name in ("goals", "violations", "self_contacts")
    )
    assert goals > 1000 and violations == 0 and contacts == 0
    robot = load_robot(str(folder))
    assert [servo.servo_id for servo in robot.servos] == list(range(1, 11))
    assert {joint.role for joint in robot.joints} >= {"head_yaw", "left_shoulder_roll", "right_elbow"}
