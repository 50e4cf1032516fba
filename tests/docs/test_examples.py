"""The examples of docs/examples do what they say, beside a whole daemon with simulated servos."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.harness import RunningDaemon

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
TIMEOUT_S = 60.0
pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningDaemon]:
    """A daemon with HTTP that records into `daemon.log`, which is whole once it has ended."""
    running = RunningDaemon("--http", "127.0.0.1:0", "--log", str(tmp_path_factory.mktemp("log") / "run.mcap"))
    try:
        yield running.until_ready()
    finally:
        running.close()


@pytest.fixture
def port(daemon: RunningDaemon) -> str:
    end_s = time.monotonic() + TIMEOUT_S
    while not (found := re.search(r"at http://127\.0\.0\.1:(\d+)/", daemon.said)):
        assert time.monotonic() < end_s, daemon.said
        time.sleep(0.05)
    return found[1]


def run(program: str, *arguments: str) -> str:
    """What a program prints, which must end well; skipped where it is not installed."""
    if shutil.which(program) is None:
        pytest.skip(f"no {program} here")
    done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_hello_by_curl(port: str) -> None:
    accepted, stopped = run("sh", str(EXAMPLES / "hello.sh"), f"http://127.0.0.1:{port}").splitlines()
    assert '"type":"accepted"' in accepted and '"verb":"stop"' in stopped


def test_hello_in_python(daemon: RunningDaemon) -> None:
    said = run(sys.executable, str(EXAMPLES / "hello.py"), *daemon.at).split()
    assert said[0] == "accepted" and "done" in said and "stopped," in said


def test_hello_in_node(port: str) -> None:
    lines = run("node", str(EXAMPLES / "hello.mjs"), f"http://127.0.0.1:{port}").splitlines()
    assert lines[0].startswith("accepted") and lines[-1] == "ack stop"
    assert any(line.startswith("done") for line in lines)


def test_hello_in_c(port: str, tmp_path: Path) -> None:
    run("cc", "-Wall", "-Wextra", "-Werror", "-o", str(tmp_path / "hello"), str(EXAMPLES / "hello.c"))
    accepted, stopped = run(str(tmp_path / "hello"), port).splitlines()
    assert '"type":"accepted"' in accepted and '"verb":"stop"' in stopped


def test_an_assistant_is_interrupted_and_stopped_by_voice(daemon: RunningDaemon) -> None:
    with daemon.armed():
        said = run(sys.executable, str(EXAMPLES / "assistant.py"), str(EXAMPLES / "transcript.txt"), *daemon.at)
    told = dict(re.findall(r"'(.+?)': (.+)", said))
    assert "was cancelled by" in told["wave with your right hand"]
    assert told["please stop"] == "ack"
    assert told["nod twice"] == "done"


def test_figures_of_a_log(daemon: RunningDaemon) -> None:
    """Last, as it ends the daemon."""
    with daemon.armed() as robot:
        robot.gesture("wave_right")
        log = robot.status().recording
    assert daemon.terminate() == 0
    table = run(sys.executable, str(EXAMPLES / "log_figures.py"), log)
    assert table.startswith("reference, ") and table.count("\n") == 2 + 16
    right, left = (float(re.search(rf"{side}_elbow +([\d.]+)", table)[1]) for side in ("right", "left"))
    assert right > left
