"""What commands write: names of pictures refused before any work, and terminals that know few characters."""

from __future__ import annotations

import os
import subprocess

import pytest

from daemon.cli import main
from tests.support.harness import MMMD
from tests.support.sizes import few_and_long


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["robot", "show", "op3", "--out", "x.xyz"], "--out x.xyz: found '.xyz'; allowed: .png, .svg, .pdf, .jpg"),
        (["robot", "show", "op3", "--out", "x"], "found no ending"),
        (["robot", "show", "op3", "--out", "nofolder/x.png"], "no folder 'nofolder'"),
        (["render", "wave.npz", "--out", "x.avi"], "allowed: .png, .gif, .mp4"),
        (["plot", "run.mcap", "--out", "x.xyz"], "allowed: .png, .svg"),
        (["calibrate", "--limp", "--picture", "x.xyz"], "--picture x.xyz"),
    ],
)
def test_a_picture_that_cannot_be_written_is_bad_use(arguments, says, capsys, tmp_path, monkeypatch):
    """`robot show op3 --out x.xyz` ended in `internal error (ValueError: Format 'xyz' ...)`, after a minute of work."""
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert says in capsys.readouterr().err.replace("\n", " ")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "status"),
    few_and_long(
        [(["robot", "check", "挥手"], 2)],
        [(["gesture", "list"], 0), (["robot", "check", "op3"], 0), (["scan", "挥手"], 1)],
    ),
)
def test_a_terminal_of_ascii_is_served(arguments, status, tmp_path):
    """`gesture list` and errors that name Chinese text ended in `internal error (UnicodeEncodeError ...)`."""
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    done = subprocess.run(
        [*MMMD, *arguments], env=environment, cwd=tmp_path, capture_output=True, timeout=60, check=False
    )
    assert done.returncode == status, done.stderr
    assert b"internal" not in done.stderr and (done.stdout + done.stderr).isascii()
