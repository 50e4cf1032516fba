"""How a daemon starts, refuses to start, and ends: real processes, a real tty where one is needed."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from daemon.bench.tty_servos import go_first, go_last
from daemon.cli import main
from daemon.supervisor.start_checks import log_file, log_path_error
from tests.support.harness import MMMD, RunningDaemon, mmmd
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]


class SimulatedTty:
    """`mmmd sim` on a link in a folder."""

    def __init__(self, folder: Path, robot: str = "op3") -> None:
        self.link = folder / "servos"
        self.audit = folder / "tty_audit.json"
        self.process = subprocess.Popen(
            [*MMMD, "sim", "--robot", robot, "--link", str(self.link), "--audit", str(self.audit), "--baud", str(baud_of(robot))],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        end_s = time.monotonic() + 20
        while not self.link.exists():
            assert time.monotonic() < end_s and self.process.poll() is None, "mmmd sim did not start"
            time.sleep(0.02)
        go_first(self.process.pid)  # not while it starts: the bus processes of other tests would wait for it

    def url(self, baud: int) -> str:
        return f"dxl://{self.link}?baud={baud}"

    def close(self) -> int:
        go_last(self.process.pid)  # it is about to count contacts
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(20)


@pytest.fixture
def tty(tmp_path):
    made = SimulatedTty(tmp_path)
    yield made
    if made.process.poll() is None:
        made.close()


def baud_of(robot: str) -> int:
    from retarget.robot.loading import load_robot

    return load_robot(robot).bus.baud


def refused(*options: str, here: bool = False) -> str:
    """What `mmmd run` says when it does not start: one message, no traceback, nothing left running.

    `here`: in this process, for what is refused before any other is started.
    """
    folder_options = []
    for name in ("cmd", "ctl", "pub"):
        folder_options += [f"--{name}", f"ipc:///tmp/mmmd-refused-{os.getpid()}-{name}"]
    words = ["run", "--quiet", "--generator", "ipc:///tmp/mmmd-none", *folder_options, *options]
    if here:
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            status, message = main(words), said.getvalue()
    else:
        result = mmmd(*words, timeout_s=60)
        status, message = result.returncode, result.stderr
    assert status in (1, 2), message
    assert "Traceback" not in message
    assert message.count("mmmd: ") == 1, message
    return message


def test_an_unknown_robot_names_the_known_ones():
    message = refused("--robot", "asimo", here=True)
    assert "asimo" in message and "reference" in message and "op3" in message


def test_a_robot_file_with_a_wrong_key_names_file_key_and_allowed(tmp_path):
    path = tmp_path / "robot.toml"
    path.write_text('format = 1\nname = "x"\ncolour = "red"\n', "utf-8")
    message = refused("--robot", str(path), here=True)
    assert str(path) in message and "colour" in message and "allowed" in message


@pytest.mark.long
def test_a_missing_tty():
    message = refused("--bus", "dxl:///dev/ttyNOTHERE?baud=1000000")
    assert "/dev/ttyNOTHERE" in message


def test_a_bus_that_is_none():
    assert "known" in refused("--bus", "can://x", here=True)


def test_a_log_that_exists_is_not_overwritten(tmp_path):
    path = tmp_path / "run.mcap"
    path.write_text("dear old log")
    assert "exists" in refused("--log", str(path), here=True)
    named = log_file(tmp_path)
    assert named.parent == tmp_path and named.suffix == ".mcap" and log_path_error(named) is None
    assert log_file(path) == path
    assert path.read_text() == "dear old log"
    assert "no folder" in refused("--log", str(tmp_path / "none" / "run.mcap"), here=True)
    assert "mkdir" in refused("--log", f"{tmp_path / 'none'}/", here=True)  # a file of that name was written


def test_an_endpoint_that_others_could_reach():
    message = refused("--cmd", "tcp://0.0.0.0:5871", here=True)
    assert "0.0.0.0" in message and "CURVE" in message and "ssh" in message


@pytest.mark.skipif(os.geteuid() == 0, reason="root may open everything")
def test_a_tty_without_permission(tty):
    os.chmod(tty.link.resolve(), 0)
    assert "usermod" in refused("--robot", "op3", "--bus", tty.url(baud_of("op3")))


@pytest.mark.long
def test_a_wrong_baud_and_other_servos_show_a_table(tty, tmp_path):
    wrong_baud = refused("--robot", "op3", "--bus", tty.url(57_600))
    assert "expected" in wrong_baud and "found" in wrong_baud and "baud" in wrong_baud
    other = refused("--robot", "reference", "--bus", tty.url(baud_of("op3")))
    assert "expected" in other and "found" in other


@pytest.mark.parametrize("ends", few_and_long([signal.SIGINT], [signal.SIGTERM]))
def test_a_text_moves_over_a_tty_and_a_signal_in_a_motion_parks(tty, ends):
    """SIGTERM ends every daemon of `running_daemon`, whose robot has to be parked then."""
    daemon = RunningDaemon(robot="op3", bus=tty.url(baud_of("op3")), fresh=True)
    try:
        daemon.until_ready()
        said = daemon.mmmd("say", "wave with your right hand")
        assert said.returncode == 0, said.stderr
        assert "first servo frame" in said.stdout and "done" in said.stdout
        with daemon.client() as client:
            client.wait_for("idle", timeout_s=20)
            going_on = subprocess.Popen(
                [*MMMD, "say", "wave", "--seconds", "5", *daemon.at], stdout=subprocess.PIPE, text=True
            )
            client.wait_for("moving", timeout_s=20)
        daemon.process.send_signal(ends)
        out, _ = going_on.communicate(timeout=20)
        assert "cancelled by shutdown" in out and going_on.returncode == 1
        assert daemon.ended() == 0
        assert "parking -> limp" in daemon.said
    finally:
        daemon.close()
    assert tty.close() == 0  # its audit found no violation
    assert tty.audit.exists()


def child_pid(daemon: RunningDaemon, module: str) -> int:
    """The daemon's child that runs `module`."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rsplit(")", 1)[1].split()
            command = (path.parent / "cmdline").read_bytes().replace(b"\0", b" ").decode()
        except OSError:
            continue
        if int(fields[1]) == daemon.process.pid and module in command:
            return int(path.parent.name)
    raise AssertionError(f"no child runs {module}")
