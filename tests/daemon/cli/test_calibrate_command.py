"""`mmmd calibrate` as a person uses it: the zero pose shown, doubtful zeros asked about, nothing written over without a copy."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from daemon.bench.tty_servos import served
from daemon.cli import main
from daemon.dynamixel.bus_opening import bus_on
from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.servo_bus import ServoBus
from daemon.dynamixel.setup.calibration import MARGIN_S, Calibrated, calibrate, copy_of
from daemon.dynamixel.timing import MARGIN_S as RUN_MARGIN_S
from retarget.robot.loading import ROBOTS_DIR, load_robot
from retarget.robot.pose_words import pose_in_words
from sim.bus import SimBus
from sim.clock import VirtualClock
from sim.faults import Fault, FaultSchedule
from sim.port import SimPort
from sim.pty import PtyServer

pytestmark = pytest.mark.realtime

OP3 = load_robot("op3")


@pytest.fixture(scope="module")
def limp_op3(tmp_path_factory):
    """The port of an OP3 whose arms hang down, 75 degrees from its zero pose."""
    link = tmp_path_factory.mktemp("op3") / "servos"
    with served(PtyServer(SimBus(OP3), link)):
        yield f"dxl://{link}"


def run(bus: str, folder: Path, typed: str, *options: str) -> subprocess.CompletedProcess[str]:
    """The command in this process, with a folder to work in and the keys that a person presses."""
    if not (folder / "op3").exists():
        shutil.copytree(ROBOTS_DIR / "op3", folder / "op3")
    command = ["calibrate", "--robot", "op3", "--bus", bus, "--limp", "--out", "op3/robot.toml", *options]
    read_end, write_end = os.pipe()  # the command waits for keys with `select`
    os.write(write_end, typed.encode())
    os.close(write_end)
    out, err = io.StringIO(), io.StringIO()
    with (
        os.fdopen(read_end) as stdin, pytest.MonkeyPatch.context() as patch, contextlib.chdir(folder),
        contextlib.redirect_stdout(out), contextlib.redirect_stderr(err),
    ):  # fmt: skip
        patch.setattr("sys.stdin", stdin)
        status = main(command)
    return subprocess.CompletedProcess(command, status, out.getvalue(), err.getvalue())


@pytest.mark.parametrize("typed", ["\n\nno\n", "\n\n"])
def test_a_zero_far_from_the_files_is_asked_about_first(typed, limp_op3, tmp_path):
    """With the arms hanging, Enter was pressed: a zero 75 degrees off was written without a question."""
    done = run(limp_op3, tmp_path, typed)
    assert done.returncode == (1 if "no" in typed else 2), done.stderr
    assert "r_sho_roll: its zero is 75 deg from the robot file's" in done.stdout
    assert "nothing was written" in done.stdout + done.stderr
    assert (tmp_path / "op3" / "robot.toml").read_text() == OP3.path.read_text()
    assert sorted(p.name for p in (tmp_path / "op3").glob("*.toml")) == ["robot.toml"]


def test_the_zero_pose_is_said_and_drawn(limp_op3, tmp_path):
    done = run(limp_op3, tmp_path, "\n\nno\n")
    for words in (
        "left arm straight, pointing out to the side",
        "right arm straight, pointing out to the side",
        "head looking",
    ):
        assert words in done.stdout.split("hold the robot")[0]
    assert (tmp_path / "op3" / "zero_pose.png").read_bytes().startswith(b"\x89PNG")


def test_a_file_is_never_written_over_without_a_copy(limp_op3, tmp_path):
    before = OP3.path.read_text()
    assert run(limp_op3, tmp_path, "\n\nyes\n").returncode == 0
    file, copy = tmp_path / "op3" / "robot.toml", tmp_path / "op3" / "robot.before-1.toml"
    assert file.read_text() != before and copy.read_text() == before
    first = file.read_text()
    again = run(limp_op3, tmp_path, "\n\n", "--yes")
    assert again.returncode == 0 and "robot.before-2.toml" in again.stdout.replace("\n", "")
    assert copy.read_text() == before and copy_of(file) == tmp_path / "op3" / "robot.before-3.toml"
    assert (tmp_path / "op3" / "robot.before-2.toml").read_text() == first


def test_a_machine_that_is_held_up_is_no_brown_out():
    """Nobody answered for 40 ms, as on a busy machine: `brown-out: servos 1, 2, ... silent at once`, of healthy servos."""

    def events(margin_s: float) -> dict[BusEventKind, int]:
        clock = VirtualClock()
        held_up = FaultSchedule([Fault("silent", 0.5, 0.54)], 0)
        bus = bus_on([SimPort(SimBus(OP3, held_up), clock)], OP3, clock, margin_s=margin_s)
        assert isinstance(bus, ServoBus)

        def look(follow) -> None:
            while clock.now_s() < 0.7:
                follow()

        calibrate(bus, OP3, wait_zero=look, wait_range=look)
        return bus.chains[0].link.events.counts

    assert BusEventKind.BROWN_OUT in events(RUN_MARGIN_S)  # as a run has to judge it
    assert BusEventKind.BROWN_OUT not in events(MARGIN_S)


def test_a_joint_that_was_not_moved_is_doubted():
    good = Calibrated(1, "a", 2048, -80.0, 80.0, off_deg=14.0)
    assert not good.doubt
    assert "15" not in good.doubt and "20 deg" in Calibrated(1, "a", 2048, -80.0, 80.0, off_deg=-20.0).doubt
    assert "not moved" in Calibrated(1, "a", 2048, None, None, moved=False).doubt


@pytest.mark.parametrize(
    ("robot", "says"),
    [
        ("op3", "left arm straight, pointing out to the side"),
        ("reference", "right arm straight, pointing straight down"),
        ("op2", "left upper arm pointing out to the side and down, forearm pointing straight ahead"),
        ("poppy_torso", "trunk upright, facing ahead"),
    ],
)
def test_a_pose_in_words(robot, says):
    model = load_robot(robot)
    assert says in pose_in_words(model, np.zeros(model.n_joints))


def test_a_turned_head_and_an_arm_across_in_words():
    model = load_robot("reference")
    q = np.zeros(model.n_joints)
    q[model.joint_names.index("head_yaw")] = np.deg2rad(30)
    assert "head: head_yaw +30 deg" in pose_in_words(model, q)
