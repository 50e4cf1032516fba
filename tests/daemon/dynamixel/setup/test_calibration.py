"""Calibration: zero positions and ranges from a robot moved by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from daemon.dynamixel.setup.calibration import Ranges, calibrate, write_robot_file
from daemon.errors import CommandError
from retarget.robot.loading import load_robot
from tests.support.factory_bus import ROBOT, wired

pytestmark = pytest.mark.realtime


def test_positions_are_unwrapped_over_the_turn() -> None:
    ranges = Ranges(np.array([4000, 100, 500], np.int32), np.array([4096, 4096, 1 << 30], np.int32))
    ok = np.ones(3, bool)
    for tick in ((4090, 10, 1023), (20, 4090, 0), (200, 4000, 400)):
        ranges.update(np.array(tick, np.int32), ok)
    assert ranges.tick.tolist() == [4296, -96, 400]
    assert ranges.low.tolist() == [4000, -96, 0] and ranges.high.tolist() == [4296, 100, 1023]
    ranges.update(np.array([0, 0, 0], np.int32), np.zeros(3, bool))
    assert ranges.tick.tolist() == [4296, -96, 400], "who does not answer stays where he was"


def test_calibration_writes_zero_and_range_of_what_was_moved(tmp_path: Path) -> None:
    bus, port, _ = wired()
    for s in port.servos.values():
        s.set("torque_enable", 1)
    rows = {name: i for i, name in enumerate(ROBOT.joint_names)}
    waist, elbow, knob = (port.servos[ROBOT.servo_ids[rows[n]]] for n in ("waist_yaw", "left_elbow", "head_yaw"))

    def zero(follow) -> None:
        assert not any(s.get("torque_enable") for s in port.servos.values()), "limp before anything is asked of hands"
        waist.set("present_position", 2100)
        knob.set("present_position", 4000)
        follow()

    def ends(follow) -> None:
        for tick in (1600, 2100, 2600):
            waist.set("present_position", tick)
            follow()
        for tick in (4090, 80, 300, 4090, 3900):
            knob.set("present_position", tick)
            follow()

    found = {c.joint_name: c for c in calibrate(bus, ROBOT, wait_zero=zero, wait_range=ends)}
    c = found["waist_yaw"]
    assert c.zero_tick == 2100 and (c.low_deg, c.high_deg) == (-41.9, 41.9) and not c.problem
    assert found["left_elbow"].low_deg is None and elbow.get("present_position") == found["left_elbow"].zero_tick
    assert "crosses the end" in found["head_yaw"].problem and "homing_offset -1024" in found["head_yaw"].problem
    for name in ("robot.xml", "robot.toml"):
        (tmp_path / name).write_text((ROBOT.path.parent / name).read_text("utf-8"), "utf-8")
    robot, out = load_robot(str(tmp_path)), tmp_path / "mine.toml"
    write_robot_file(robot, [found["waist_yaw"], found["left_elbow"]], out)
    new = load_robot(str(out))
    joint = new.joints[rows["waist_yaw"]]
    assert new.servos[rows["waist_yaw"]].zero_tick == 2100
    assert np.rad2deg([joint.position_min_rad, joint.position_max_rad]).round(1).tolist() == [-41.9, 41.9]
    assert new.joints[rows["left_elbow"]] == ROBOT.joints[rows["left_elbow"]], "its range stays"
    assert out.read_text("utf-8").splitlines()[0].startswith("#"), "comments stay"


def test_answers_that_are_lost_become_no_zero_and_a_silent_servo_is_named() -> None:
    bus, port, _ = wired()
    waist, lost = port.servos[3], [True] * 4

    def zero(_follow) -> None:
        waist.set("present_position", 2100)
        port.spoil = lambda raw, _servo_id: b"" if lost and lost.pop() else raw

    found = calibrate(bus, ROBOT, wait_zero=zero, wait_range=lambda _follow: None)
    assert not lost and found[2].zero_tick == 2100
    with pytest.raises(CommandError, match="servo 3 does not answer"):
        calibrate(bus, ROBOT, wait_zero=lambda _follow: setattr(waist, "silent", True), wait_range=lambda _follow: None)


def test_a_calibration_that_makes_no_valid_file_is_not_kept(tmp_path: Path) -> None:
    bus, _, _ = wired()
    found = calibrate(bus, ROBOT, wait_zero=lambda follow: None, wait_range=lambda follow: None)
    for name in ("robot.xml", "robot.toml"):
        (tmp_path / name).write_text((ROBOT.path.parent / name).read_text("utf-8"), "utf-8")
    robot = load_robot(str(tmp_path))
    before = robot.path.read_text("utf-8")
    bad = [replace(c, zero_tick=4095) for c in found]
    with pytest.raises(CommandError, match="no valid robot file"):
        write_robot_file(robot, bad, robot.path)
    assert robot.path.read_text("utf-8") == before
    with pytest.raises(CommandError, match="no valid robot file"):
        write_robot_file(robot, bad, tmp_path / "other.toml")
    assert not (tmp_path / "other.toml").exists()
