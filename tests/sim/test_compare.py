"""A run's log played to simulated servos: a simulated run comes out as itself, another servo as another."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from daemon.cli import main
from daemon.recording.mcap_log import LogWriter
from sim.replay import Stretch, compare
from tests.support.harness import slow_reference
from tests.support.rig import rig, swing

TICK_DEG = 360 / 4096
"""The two may be a step of the simulation (2 ms) out of phase; at this speed that is up to 0.082 degrees."""


@pytest.fixture(scope="module")
def run():
    with rig() as r:
        r.cycle(3)
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(230)
        return r.robot, list(r.records)


def stretch_of(records) -> Stretch:
    armed = [r for r in records if r["torque"]]
    return Stretch(
        np.array([(int(r["t_mono_ns"]) - int(armed[0]["t_mono_ns"])) * 1e-9 for r in armed]),
        np.array([r["goal_tick"] for r in armed], np.int64),
        np.array([r["present_tick"] for r in armed], np.int64),
    )


@pytest.mark.long
def test_a_simulated_run_is_what_the_simulator_makes_of_its_log(run):
    robot, records = run
    found = compare([stretch_of(records)], robot)
    assert found.refused_goals == 0
    assert found.rms_deg < TICK_DEG, [(s.joint_name, s.rms_deg) for s in found.servos]
    lags = [(s.lag_logged_ms, s.lag_simulated_ms) for s in found.servos if s.lag_logged_ms is not None]
    assert len(lags) > 10
    assert all(abs(a - b) <= 6 and 10 < b < 120 for a, b in lags)


@pytest.mark.long
def test_a_robot_of_protocol_1_is_played_in_its_protocol():
    with rig("poppy_torso") as r:
        r.cycle(3)
        r.arm()
        r.push(swing(r.robot, 2.0))
        r.cycle(230)
        found = compare([stretch_of(r.records)], r.robot)
    assert found.refused_goals == 0 and len(found.servos) == len(r.robot.servos)
    assert found.rms_deg < 0.1, [(s.joint_name, s.rms_deg) for s in found.servos]


def test_servos_that_did_something_else_are_found(run):
    robot, records = run
    stretch = stretch_of(records)
    odd = stretch.present_tick.copy()
    odd[:, 4] += 200
    found = compare([Stretch(stretch.t_s, stretch.goal_tick, odd)], robot)
    assert found.worst.joint_name == robot.joint_names[4] and found.worst.rms_deg > 10


@pytest.mark.long
def test_gravity_makes_a_difference(run):
    robot, records = run
    plain, heavy = (compare([stretch_of(records)], robot, body).rms_deg for body in ("plain", "mujoco"))
    assert heavy > plain


def test_the_command_says_it_in_words_and_as_json(run, tmp_path: Path, capsys):
    robot, records = run
    path = tmp_path / "run.mcap"
    with path.open("wb") as f:
        writer = LogWriter(f, robot)
        for record in records:
            writer.cycle(record)
        writer.finish()
    assert main(["sim", "--replay", str(path), "--robot", slow_reference(), "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert (
        figures["robot"] == "reference" and len(figures["servos"]) == robot.n_joints and figures["rms_deg"] < TICK_DEG
    )
    assert main(["sim", "--replay", str(path), "--robot", slow_reference()]) == 0
    assert "all servos:" in capsys.readouterr().out
    assert main(["sim", "--replay", str(tmp_path / "none.mcap")]) == 2
