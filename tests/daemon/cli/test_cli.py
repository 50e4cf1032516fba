"""The commands from outside: help, exit status, one message for an error, nothing heavy loaded that is not needed."""

from __future__ import annotations

import importlib.util
import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from daemon.cli.program import COMMANDS, main
from mmm_core.inference.checkpoint import MODEL_FILE
from tests.support.shipped import loaded_once

PRESENT = [n for n, c in COMMANDS.items() if importlib.util.find_spec(c.target.partition(":")[0]) is not None]
NOWHERE = [
    "--cmd",
    "ipc:///tmp/mmmd-nowhere-cmd",
    "--ctl",
    "ipc:///tmp/mmmd-nowhere-ctl",
    "--pub",
    "ipc:///tmp/mmmd-nowhere-pub",
]
needs_model = pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout")


def test_the_overview_lists_every_command(capsys):
    assert main(["--help"]) == 0
    out = capsys.readouterr().out
    assert all(f"  {name}" in out for name in COMMANDS) and "example" in out


def test_without_arguments_it_is_bad_use_and_helps(capsys):
    assert main([]) == 2
    assert "usage: mmmd" in capsys.readouterr().out


@pytest.mark.parametrize("name", PRESENT)
def test_every_command_has_help_with_an_example(name, capsys):
    assert main([name, "--help"]) == 0
    out = capsys.readouterr().out
    assert "Example" in out and f"mmmd {name}" in out
    assert "{None" not in out and "None)" not in out, "help speaks no Python"


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["dance"], "unknown command 'dance'; "),
        (["stop", "--now"], "--now"),
        (["say"], "Missing from mmmd say"),
        (["say", "wave", "--seed", "x", *NOWHERE], "seed"),
        (["say", "wave", "--seed", "-4", *NOWHERE], "0 to 2147483647"),
        (["say", "", *NOWHERE], "1 to 2000"),
        (["say", "a" * 10_000, *NOWHERE], "10000"),
        (["stop", "--ctl", "tcp://192.168.1.5:5872"], "other machines"),
        (["status", "--ctl", "5872"], "ZeroMQ endpoint"),
        (["understand", "wave", " "], "no sentence"),
        (["generate"], "example"),
        (["generate", "wave"], "--out"),
        (["generate", "wave", "--out", "x.npz", "--seconds", "60"], "0.2 to 9.8"),
        (["generate", "wave", "--out", "/no/such/folder/x.npz"], "no folder"),
        (["generate", "--batch", "/no/such/file.jsonl", "--out", "x"], "No such file"),
    ],
)
def test_bad_use_is_one_message_and_status_2(arguments, says, capsys):
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert says in captured.err + captured.out
    assert "Traceback" not in captured.err


@pytest.mark.parametrize("command", [["stop"], ["estop"], ["status"], ["say", "wave"], ["park"]])
def test_without_a_daemon_it_says_so_at_once(command, capsys):
    assert main([*command, *NOWHERE]) == 1
    err = capsys.readouterr().err
    assert "mmmd run" in err and err.count("\n") == 1


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("{", "line 1"),
        ('{"id": "a", "text": "nod", "speed": 2}', "speed"),
        ('{"id": "../a", "text": "nod"}', "no file name"),
        ('{"id": "a", "text": "nod"}\n{"id": "a", "text": "bow"}', "line 2: id 'a' stands twice"),
        ("", "no lines"),
    ],
)
def test_a_batch_is_checked_before_it_is_begun(line, says, tmp_path, capsys):
    path = tmp_path / "prompts.jsonl"
    path.write_text(line)
    assert main(["generate", "--batch", str(path), "--out", str(tmp_path / "out")]) == 2
    assert says in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_batch_answers_each_line_and_counts_the_refused(tmp_path, capsys):
    """A file of two thousand lines was refused for one empty text."""
    path = tmp_path / "prompts.jsonl"
    lines = ['{"id": "a", "text": ""}', '{"id": "b", "text": "nod", "seconds": 0.4}']
    path.write_text("\n".join([*lines, '{"id": "c", "text": "nod", "seconds": 99}']))
    assert main(["generate", "--batch", str(path), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr()
    assert "a: refused: the text is empty" in told.err and "c: refused: seconds 99" in told.err
    assert told.out.startswith("1 motions in ") and told.out.endswith("2 lines refused\n")
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["b.npz"]


def test_a_batch_that_is_not_utf8(tmp_path, capsys):
    path = tmp_path / "prompts.jsonl"
    path.write_bytes(b'{"id": "a", "text": "\xff"}')
    assert main(["generate", "--batch", str(path), "--out", str(tmp_path / "out")]) == 2
    assert "UTF-8" in capsys.readouterr().err


def test_stop_loads_nothing_heavy():
    code = (
        "import sys; from daemon.cli import main; main(['stop', '--ctl', 'ipc:///tmp/mmmd-nowhere']);"
        "print(sorted({'torch', 'mujoco', 'numpy', 'ruckig', 'rich.table'} & set(sys.modules)))"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30, check=True)
    assert result.stdout.strip() == "[]"


@needs_model
def test_generate_writes_what_the_design_names(tmp_path, capsys):
    npz, bvh = tmp_path / "wave.npz", tmp_path / "wave.bvh"
    text, files = "wave with your right hand", ("--out", str(npz), "--bvh", str(bvh))
    with loaded_once():
        assert main(["generate", text, "--seed", "7", *files, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["status"] == "accepted"
    with np.load(npz) as data:
        T = len(data["joints"])
        assert data["joints"].shape == (T, 22, 3) and data["joints"].dtype == np.float32
        assert data["fps"] == 20 and data["head_quat_wxyz"].shape == (T, 4) and data["features"].shape == (T, 263)
        assert data["tokens"].ndim == 1 and str(data["text"]) == "wave with your right hand" and data["seed"] == 7
        assert str(data["status"]) == "accepted" and 0 <= data["scope_score"] <= 1
        joints = data["joints"]
    assert f"Frames: {T}" in bvh.read_text()
    prompts = tmp_path / "p.jsonl"
    prompts.write_text(
        '{"id": "a", "text": "wave with your right hand", "seed": 7}\n{"id": "b", "text": "nod", "seconds": 2}\n'
    )
    with loaded_once():
        assert main(["generate", "--batch", str(prompts), "--out", str(tmp_path / "many")]) == 0
    with np.load(tmp_path / "many" / "a.npz") as again, np.load(tmp_path / "many" / "b.npz") as other:
        assert np.array_equal(again["joints"], joints)  # the same seed, the same motion
        assert len(other["joints"]) == 40


@needs_model
def test_a_command_that_is_terminated_takes_along_what_it_started():
    bench = subprocess.Popen([sys.executable, "-m", "daemon.cli", "bench", "stream", "--n", "500"], text=True)
    try:
        daemon = _started_by(bench.pid, "run")
        bench.terminate()
        assert bench.wait(20) == 128 + signal.SIGTERM
        end_s = time.monotonic() + 10
        while Path(f"/proc/{daemon}").exists():  # whoever adopted it may take a moment to bury it
            assert time.monotonic() < end_s
            time.sleep(0.05)
    finally:
        bench.kill()
        bench.wait()


def _started_by(pid: int, command: str) -> int:
    """A process with `command` among its arguments that `pid` has started."""
    end_s = time.monotonic() + 20
    while time.monotonic() < end_s:
        for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
            if command in Path(f"/proc/{child}/cmdline").read_text().split("\0"):
                return int(child)
        time.sleep(0.05)
    raise AssertionError(f"process {pid} started no {command}")
