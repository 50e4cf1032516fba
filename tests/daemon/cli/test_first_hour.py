"""What a newcomer meets in the first hour: exit statuses, a machine without PyTorch, help, narrow terminals."""

from __future__ import annotations

import io
import os
import re
import subprocess
import time
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console

from daemon.cli.client.status import gaze_words
from daemon.cli.hardware.calibrate import _table as calibration_table
from daemon.cli.hardware.servo import _table as servo_table
from daemon.cli.help_text import cleaned
from daemon.cli.program import main
from daemon.cli.tables import table_of
from daemon.client import RefusedError
from daemon.dynamixel.registers.models import MODELS
from retarget.robot.loading import load_robot
from tests.support.harness import MMMD, START_TIMEOUT_S, RunningDaemon
from tests.support.sizes import few_and_long

WITHOUT_TORCH = """\
import sys
from importlib.machinery import PathFinder

class Without(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        return None if name.partition(".")[0] == "torch" else super().find_spec(name, path, target)

sys.meta_path[sys.meta_path.index(PathFinder)] = Without
"""
"""What a machine that has no PyTorch looks like to Python."""


def mmmd(*arguments: str, text: str | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*MMMD, *arguments], input=text, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.long
@pytest.mark.realtime
def test_a_machine_without_pytorch_runs_gestures_and_says_what_is_missing(tmp_path, monkeypatch):
    """`mmmd run` refused to start, although gestures, look, replay and stream need no PyTorch."""
    (tmp_path / "sitecustomize.py").write_text(WITHOUT_TORCH)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, (str(tmp_path), os.environ.get("PYTHONPATH")))))
    daemon = RunningDaemon(model=True, fresh=True)
    try:
        end_s = time.monotonic() + START_TIMEOUT_S
        while "ready: robot" not in daemon.said and time.monotonic() < end_s:
            time.sleep(0.05)
        with daemon.armed() as client:
            assert client.gesture("nod").done is not None
            with pytest.raises(RefusedError, match="PyTorch is not installed: `mmmd install-torch`") as caught:
                client.say("wave")
            assert caught.value.code == "generator_down"
            assert "install-torch" in client.status().generator
        assert daemon.terminate() == 0
    finally:
        daemon.close()


@pytest.mark.long
@pytest.mark.realtime
@pytest.mark.parametrize(
    "bus",
    [
        "sim://?body=foo",  # the bus process refuses the others alike: test_an_option_that_the_bus_cannot_have_is_refused
        pytest.param("sim://?baud=abc", marks=pytest.mark.soak),
        pytest.param("sim://?faults=missing.toml", marks=pytest.mark.soak),
    ],
)
def test_a_bad_option_of_the_bus_is_bad_use_and_named(bus, tmp_path):
    ends = [f"ipc://{tmp_path}/{name}" for name in ("cmd", "ctl", "pub", "stream")]
    done = mmmd("run", "--bus", bus, "--cmd", ends[0], "--ctl", ends[1], "--pub", ends[2], "--stream", ends[3])
    assert done.returncode == 2 and f"--bus {bus}" in done.stderr, done.stderr


def test_help_keeps_its_borders():
    """A default that was wrapped leaves no line behind, and every line its width."""
    whole = [
        "│ --log PATH   a file. (default: │",
        "│              None)             │",
        "│ --x {None}|INT  a number. (default: None) │",
    ]
    wrapped = "\n".join(whole) + "\n"
    lines = cleaned(wrapped).splitlines()
    assert [len(line) for line in lines] == [len(line) for line in whole[::2]]
    assert lines[0].split() == ["│", "--log", "PATH", "a", "file.", "│"] and "--x INT" in lines[1]


def test_an_unknown_command_is_told_what_it_is_like(capsys):
    assert main(["sya"]) == 2
    assert "did you mean say" in capsys.readouterr().err


def test_names_of_gestures_are_whole_in_a_narrow_terminal(monkeypatch, capsys):
    """At 60 columns names were cut, so that they could not be typed."""
    from daemon.gestures.library import GestureLibrary

    monkeypatch.setenv("COLUMNS", "60")
    assert main(["gesture", "list"]) == 0
    words = set(capsys.readouterr().out.split())
    assert {info.name for info in GestureLibrary().infos()} <= words


@pytest.mark.parametrize("width", [40, 60, 100])
def test_what_has_to_be_typed_is_whole_in_every_table(width, capsys):
    """Items of servos, joints, servo ids and bauds, as `mmmd servo`, `calibrate` and `scan` print them."""
    items = list(MODELS[1020].table.values())
    joints = load_robot("op3").servos
    ranges = SimpleNamespace(low=np.zeros(20), high=np.full(20, 4000), tick=np.full(20, 2048))
    scanned = table_of(("id", "model", "firmware", "protocol", "baud"), ("id", "model", "baud"))
    scanned.add_row("253", "XM540-W270", "45", "2.0", "4500000")
    tables = {
        servo_table("servo 1", items, {item.name: 1 for item in items}): [item.name for item in items],
        calibration_table(load_robot("op3"), ranges): [servo.joint_name for servo in joints],
        scanned: ["253", "XM540-W270", "4500000"],
    }
    for table, names in tables.items():
        Console(width=width).print(table)
        words = set(re.split(r"[\s│┃|]+", capsys.readouterr().out))
        assert set(names) <= words, set(names) - words


@pytest.mark.parametrize(
    "arguments", few_and_long([["--help"]], [[], ["say", "--help"], ["robot", "list"]]), ids=" ".join
)
def test_a_reader_that_has_gone_is_no_reason_to_complain(arguments):
    """`mmmd | head` ended in a traceback."""
    read_end, write_end = os.pipe()
    os.close(read_end)
    try:
        done = subprocess.run([*MMMD, *arguments], stdout=write_end, stderr=subprocess.PIPE, check=False)
    finally:
        os.close(write_end)
    assert (done.returncode, done.stderr) == (1, b"")


def test_a_wrong_option_is_told_what_it_is_like(capsys):
    assert main(["say", "wave", "--temop", "2"]) == 2
    assert "--tempo" in capsys.readouterr().err


@pytest.mark.parametrize(("answer", "options", "status"), [("n\n", [], 1), ("", [], 1), ("n\n", ["--yes"], 2)])
def test_hours_of_training_are_asked_for_at_a_terminal(answer, options, status, tmp_path, monkeypatch, capsys):
    """`mmmd train` by itself began at once. With --yes it goes on, here to the data that are missing."""
    terminal = io.StringIO(answer)
    monkeypatch.setattr(terminal, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("sys.stdin", terminal)
    found = main(["train", "--run", str(tmp_path / "run"), "--data", str(tmp_path / "none"), *options])
    assert found in ((status,) if status == 1 else (1, 2))
    said = capsys.readouterr()
    assert ("for hours" in said.out) == (not options)
    assert bool(said.err) == bool(options)


def test_a_service_is_not_installed_unasked(capsys):
    assert main(["install-service"]) == 2
    assert "/etc/systemd/system/mmmd.service" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("yaw_deg", "pitch_deg", "words"),
    [(30, -10, "30 degrees left, 10 degrees up"), (-5, 0, "5 degrees right"), (0, 0, "straight ahead")],
)
def test_where_the_head_looks_in_words(yaw_deg, pitch_deg, words):
    assert gaze_words(yaw_deg, pitch_deg) == words
