"""A folder with a simulated robot, in which the commands of the pages are typed."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from daemon.client import Client, NoAnswerError
from daemon.settings.config import Endpoints
from tests.support.harness import free_ports

CLIENTS = (
    "say", "story", "inbetween", "gesture", "look", "idle", "stream", "cancel", "capabilities", "status", "watch", "stop", "estop",
    "reset", "arm", "park", "torque",
)  # fmt: skip
"""Commands that talk to a daemon, and take its endpoints."""
TTY, SERVO_BAUD = "/dev/ttyUSB0", 1_000_000
"""The adapter of pages and help, and the baud that `mmmd servo` takes where none is given."""
LONGEST_S = 300.0


class Terminal:
    """A folder in which commands are typed, and what runs behind them.

    Attributes:
        printed: what each command has printed, by its line.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        cmd, ctl, pub, stream = (f"tcp://127.0.0.1:{port}" for port in free_ports(4))
        self.endpoints = Endpoints(cmd, ctl, pub, stream=stream)
        self.at = f"--cmd {cmd} --ctl {ctl} --pub {pub}"
        self.printed = dict[str, str]()
        self._behind: dict[str, subprocess.Popen[bytes]] = {}
        self._adapter = ""
        (folder / "bin").mkdir()
        script = folder / "bin" / "mmmd"
        script.write_text(f'#!/bin/sh\nexec {sys.executable} -P -m daemon.cli "$@"\n')
        script.chmod(0o755)
        self.environment = os.environ | {"PATH": f"{folder / 'bin'}:{Path(sys.executable).parent}:{os.environ['PATH']}",
                                         "HOME": str(folder), "PYTHONSAFEPATH": "1", "COLUMNS": "120"}  # fmt: skip

    def type(self, command: str) -> str:
        """Run a command as it stands on a page; its output. What serves others goes on behind.

        Raises:
            AssertionError: it ended with another status than 0.
        """
        began_s = time.monotonic()
        try:
            self.printed[command] = self._type(self._on_this_machine(command))
            return self.printed[command]
        finally:
            sys.stdout.write(f"{time.monotonic() - began_s:6.1f} s  {command}\n")

    def _type(self, command: str) -> str:
        words = command.split()
        verb = words[1] if words[0] == "mmmd" and len(words) > 1 else ""
        if verb in ("run", "sim", "generator") and "--replay" not in words:
            return self._start(verb, command)
        if "run.mcap" in command:  # it is whole once the daemon has ended
            self._end("run")
        if verb == "watch":
            return self._watch(command)
        done = subprocess.run(command, shell=True, cwd=self.folder, env=self.environment, timeout=LONGEST_S, check=False,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)  # fmt: skip
        said = done.stdout + done.stderr
        assert done.returncode == 0, f"{command}: status {done.returncode}\n{said}\n{self.said('run')}"
        return said

    def python(self, code: str) -> str:
        """Run a snippet, at this terminal's daemon."""
        code = code.replace("tcp://127.0.0.1:5871", self.endpoints.cmd)
        done = subprocess.run([sys.executable, "-c", code], cwd=self.folder, timeout=LONGEST_S, check=False, capture_output=True,
                              text=True, env=self.environment)  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    def said(self, verb: str) -> str:
        """What a command behind has printed."""
        path = self.folder / f"{verb}.out"
        return path.read_text("utf-8", "replace")[-3000:] if path.exists() else ""

    def leave_safe_states(self) -> None:
        """Arm the robot, whatever the command before has left."""
        with Client(self.endpoints) as client:
            if client.status().state in ("fault", "estop"):
                client.reset()
                client.wait_for("limp", timeout_s=20)
            client.idle(False)
            client.stop()
            client.wait_for("idle", "holding", "limp", timeout_s=20)
            if client.status().state == "limp":
                client.arm()
                client.wait_for("idle", "holding", timeout_s=20)

    def close(self) -> None:
        """End what runs behind."""
        for verb in list(self._behind):
            self._end(verb)

    def _on_this_machine(self, command: str) -> str:
        if command.startswith("mmmd servo ") and "--bus" not in command:
            command += f' --bus "dxl://{TTY}?baud={SERVO_BAUD}"'
        if TTY in command:
            self._plug(re.search(r"(?:\?baud=|--baud )(\d+)", command))
            command = command.replace(TTY, "./ttyUSB0")
        parts: list[str] = []
        for part in re.split(r"( && )", command):
            words = part.split()
            if words[:1] == ["mmmd"] and len(words) > 1 and (words[1] in CLIENTS or _edits_on_robot(words)):
                parts.append(f"{part} {self.at}")
            elif words[:2] == ["mmmd", "run"]:
                parts.append(f"{part} {self.at} --stream {self.endpoints.stream}")
            else:
                parts.append(part)
        return "".join(parts)

    def _plug(self, baud: re.Match[str] | None) -> None:
        """Put OP3's servos behind the adapter, set to the baud that a command names, or to the robot's own."""
        command = "mmmd sim --robot op3 --link ./ttyUSB0" + (f" --baud {baud[1]}" if baud else "")
        if self._adapter != command:
            self._start("adapter", command)
            self._adapter = command

    def _start(self, verb: str, command: str) -> str:
        self._end(verb)
        with (self.folder / f"{verb}.out").open("wb") as out:
            self._behind[verb] = subprocess.Popen(
                f"exec {command}", shell=True, cwd=self.folder, env=self.environment, stdout=out, stderr=out
            )
        end_s = time.monotonic() + LONGEST_S
        while not self._is_ready(verb, command):
            status = self._behind[verb].poll()
            assert status is None, f"{command}: status {status}\n{self.said(verb)}"
            assert time.monotonic() < end_s, f"{command}: not ready\n{self.said(verb)}"
            time.sleep(0.1)
        return self.said(verb)

    def _is_ready(self, verb: str, command: str) -> bool:
        if verb == "run" and "--keys" in command:  # it answers nobody without one
            return "ready: robot" in self.said(verb)
        if verb == "run":
            with contextlib.suppress(NoAnswerError), Client(self.endpoints) as client:
                now = client.status()
                return now.generator.startswith("ready") and bool(now.bus_info["cycles"])
            return False
        if verb == "generator":
            return "ready" in self.said(verb) or "bind" in self.said(verb)
        links = re.findall(r"(?:--link|--port) (\S+?)(?:=|\s|$)", command)
        return all((self.folder / link).exists() for link in links) and bool(self.said(verb))

    def _watch(self, command: str) -> str:
        with subprocess.Popen(f"exec {command}", shell=True, cwd=self.folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:  # fmt: skip
            assert process.stdout is not None
            first = process.stdout.readline()
            process.send_signal(signal.SIGINT)
            rest = process.stdout.read()
        assert first, f"{command}: it prints nothing"
        return first + rest

    def _end(self, verb: str) -> None:
        process = self._behind.pop(verb, None)
        if process is None:
            return
        process.send_signal(signal.SIGTERM if process.poll() is None else 0)
        try:
            process.wait(40)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait(10)


def _edits_on_robot(words: list[str]) -> bool:
    return words[1] == "edit" and "--out" not in words


@contextlib.contextmanager
def terminal(folder: Path) -> Iterator[Terminal]:
    """A terminal; what runs behind it is ended."""
    opened = Terminal(folder)
    try:
        yield opened
    finally:
        opened.close()
