"""A daemon as a person starts it: real processes, local sockets of its own, ended at the end."""

from __future__ import annotations

import atexit
import contextlib
import functools
import io
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal

from daemon.cli import main
from daemon.client import Client, NoAnswerError
from daemon.generator.generated import Generated
from daemon.scheduling.command_queue import SHADOW_S
from daemon.settings.config import Endpoints
from daemon.wire.events import Done
from retarget.robot.loading import ROBOTS_DIR
from tests.support.forked import ForkedCommand
from tests.support.kinematic import KinematicGenerator, generate

Answer = Callable[[str, int, float | None], Generated]
MMMD = [sys.executable, "-m", "daemon.cli"]
START_TIMEOUT_S = 80.0
RATE_HZ = 50
"""Bus cycles per second of test daemons: half the rate of `reference`, since the bus process is a daemon's dearest."""
PATIENT = {"MMMD_GENERATE_TIMEOUT_S": "20"}
"""Seconds until a silent generator is restarted, for a daemon with a model: beside other tests the model may be slow to answer."""


class RunningDaemon:
    """`mmmd run` on sockets in a folder of its own, with a generator peer whose answers are known unless `model`.

    Args:
        options: of `mmmd run`.
        bus: where the servos are.
        robot: name or folder; None for `slow_reference`.
        model: whether the daemon starts its own generator, with the shipped model.
        answer: of the generator peer to a text.
        tcp: sockets on free ports of this machine instead; "but ctl" for all but the one that takes e-stops.
        fresh: whether its front is a new Python program, as when a person starts it, and not forked from one that has loaded
            the daemon's modules.
    """

    def __init__(
        self,
        *options: str,
        bus: str = "sim://",
        robot: str | None = None,
        model: bool = False,
        answer: Answer = generate,
        tcp: bool | Literal["but ctl"] = False,
        fresh: bool = False,
    ) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="mmmd-test-")
        self.folder = Path(self._folder.name)
        self.endpoints = Endpoints(*(f"ipc://{self.folder}/{name}" for name in ("cmd", "ctl", "pub")))
        if tcp:
            cmd, ctl, pub, stream = (f"tcp://127.0.0.1:{port}" for port in free_ports(4))
            self.endpoints = Endpoints(cmd, self.endpoints.ctl if tcp == "but ctl" else ctl, pub, stream=stream)
            options = ("--stream", stream, *options)
        self.peer = None if model else KinematicGenerator(f"ipc://{self.folder}/gen", answer)
        self.audit = self.folder / "audit.json"
        if bus == "sim://":
            bus = f"sim://?audit={self.audit}"
        generator = [] if model else ["--generator", f"ipc://{self.folder}/gen"]
        self.output = self.folder / "output"
        self._fresh = fresh
        self._arguments = [
            "run",
            "--robot",
            robot or slow_reference(),
            "--bus",
            bus,
            *generator,
            *self.at,
            "--stream",
            self.endpoints.stream,
            *options,
        ]
        # A daemon draws nothing, and MuJoCo would load GLFW in two of its processes.
        self._environment = {**os.environ, "MUJOCO_GL": "disable", **(PATIENT if model else {})}
        self.start()

    def start(self) -> None:
        """Start it, once more where it has ended: at the same sockets, with the same generator peer."""
        self.process: subprocess.Popen[bytes] | ForkedCommand
        if self._fresh:
            with self.output.open("ab") as out:
                self.process = subprocess.Popen(
                    [*MMMD, *self._arguments], stdout=out, stderr=out, env=self._environment
                )
        else:
            self.process = ForkedCommand(self._arguments, self.output, self._environment)

    @property
    def at(self) -> list[str]:
        """Options that lead the other commands to this daemon."""
        return ["--cmd", self.endpoints.cmd, "--ctl", self.endpoints.ctl, "--pub", self.endpoints.pub]

    @property
    def said(self) -> str:
        """What it has printed."""
        return self.output.read_text("utf-8", "replace")

    def client(self) -> Client:
        return Client(self.endpoints)

    @contextlib.contextmanager
    def armed(self) -> Iterator[Client]:
        """A client of a robot that is armed and still, whatever the test before has left. A fault must not be left behind."""
        with self.client() as client:
            state = client.status().state
            if state == "moving":
                client.stop()
                time.sleep(2 * SHADOW_S)  # a text that cannot say when it was sent would count as one from before it
            elif state in ("fault", "estop"):
                client.reset()
            if state in ("fault", "estop", "parking"):
                client.wait_for("limp", timeout_s=20)
            client.arm()
            client.wait_for("idle", "holding", timeout_s=20)
            yield client
            status = client.status()
            assert status.state != "fault", status.reason

    def until_ready(self) -> RunningDaemon:
        """Wait until it answers, its generator does, and its bus process cycles."""
        end_s = time.monotonic() + START_TIMEOUT_S
        while time.monotonic() < end_s and self.process.poll() is None:
            with contextlib.suppress(NoAnswerError), self.client() as client:
                while time.monotonic() < end_s:
                    now = client.status()
                    if now.generator.startswith("ready") and now.bus_info["cycles"]:
                        return self
                    time.sleep(0.05)
            time.sleep(0.05)
        raise AssertionError(f"the daemon did not get ready (status {self.process.poll()}):\n{self.said}")

    def ended(self, timeout_s: float = 30.0) -> int:
        """Wait for its end; its exit status."""
        try:
            return self.process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"the daemon did not end in {timeout_s} s:\n{self.said}") from None

    def terminate(self) -> int:
        self.process.send_signal(signal.SIGTERM)
        return self.ended()

    def mmmd(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run another command at this daemon, in this process: to start one takes longer than most commands do."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = main([*arguments, *self.at])
        return subprocess.CompletedProcess([*MMMD, *arguments], status, out.getvalue(), err.getvalue())

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(30)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait(5)
        if self.peer is not None:
            self.peer.close()
        self._folder.cleanup()


@contextlib.contextmanager
def running_daemon(*options: str, **how: Any) -> Iterator[RunningDaemon]:
    """A daemon that answers; after the block it must park its robot and end well, without a traceback, having kept every limit.

    Args:
        options: of `mmmd run`.
        how: further arguments of `RunningDaemon`.
    """
    daemon = RunningDaemon(*options, **how)
    try:
        yield daemon.until_ready()
        parks = False
        if daemon.process.poll() is None:  # a test may have ended it
            with daemon.client() as client:
                parks = client.status().state in ("idle", "holding")
        n_parked = daemon.said.count("parking -> limp")
        assert daemon.terminate() == 0, daemon.said
        assert not parks or daemon.said.count("parking -> limp") > n_parked, daemon.said
        assert "Traceback" not in daemon.said, daemon.said
        if "bus" not in how:  # servos behind a tty keep their own audit
            report = json.loads(daemon.audit.read_text())
            assert report["goals"] > 0 and report["violations"] == 0 and report["self_contacts"] == 0, report
    finally:
        daemon.close()


def slow_reference() -> str:
    """Folder of the robot `reference` at `RATE_HZ`."""
    return slowed("reference")


@functools.cache
def slowed(robot: str) -> str:
    """Folder of a copy of a packaged robot at `RATE_HZ`, which is removed when this process ends."""
    folder = Path(tempfile.mkdtemp(prefix="mmmd-test-robot-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    shutil.copytree(ROBOTS_DIR / robot, folder, dirs_exist_ok=True)
    file = folder / "robot.toml"
    slow, n_rates = re.subn(r"^rate_hz = \d+", f"rate_hz = {RATE_HZ}", file.read_text("utf-8"), flags=re.MULTILINE)
    assert n_rates == 1
    file.write_text(slow, "utf-8")
    return str(folder)


def free_ports(n: int) -> list[int]:
    """TCP ports that nobody listens at just now."""
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(n)]
        return [s.getsockname()[1] for s in sockets]


def mmmd(*arguments: str, timeout_s: float = 30.0, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    return subprocess.run(
        [*MMMD, *arguments], capture_output=True, text=True, timeout=timeout_s, check=False,
        env={**os.environ, **environment},
    )  # fmt: skip


def plays_well(done: Done) -> bool:
    """Whether a motion ran dry in less than a twentieth of its frames, and the gate changed none of them without that."""
    return 20 * done.underruns <= done.frames and keeps_to_its_path(done)


def keeps_to_its_path(done: Done) -> bool:
    """Whether the gate changed no frame of a motion, or some frames were late.

    Where the machine holds the front up, the bus process brakes, and then the gate leads the robot back to the moving path: after
    a single late frame at half of a joint's top speed this takes 35 frames. Beside a model that computes, or a client of the test
    that is held up itself, the number of late frames tells of the machine; that none is late where nothing holds the front up is
    tested in virtual time (tests/daemon/playback).
    """
    return done.underruns > 0 or done.gate_clipped_frames == 0
