"""Blocks of the pages that people read, and a folder with a simulated robot in which their commands are run.

A block is fenced, or indented by four spaces. What it is follows from its lines: commands, Python, JSON messages, TOML, or text (a
drawing, a formula). Comments before a block say what cannot be told from it:

    <!-- not run: REASON -->              nothing of the next block is run
    <!-- not run: PREFIX: REASON -->      of the next block the commands are not run that begin so
    <!-- output of: COMMAND -->           the next block is what COMMAND prints; a line "..." stands for any lines
"""

from __future__ import annotations

import ast
import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from daemon.client import Client, NoAnswerError
from daemon.settings.config import Endpoints
from tests.support.harness import free_ports

ROOT = Path(__file__).parents[2]
PROGRAMS = ("mmmd", "make", "pip", "python", "python3", "cp", "mkdir", "cd", "source", "sudo", "torchrun", "npm")
CLIENTS = (
    "say", "story", "inbetween", "gesture", "look", "idle", "stream", "cancel", "capabilities", "status", "watch", "stop", "estop",
    "reset", "arm", "park", "torque",
)  # fmt: skip
"""Commands that talk to a daemon, and take its endpoints."""
TTY, SERVO_BAUD = "/dev/ttyUSB0", 1_000_000
"""The adapter of pages and help, and the baud that `mmmd servo` takes where none is given."""
LONGEST_S = 300.0
_NOT_RUN = re.compile(r"<!-- not run: (?:(mmmd [\w -]+): )?(.+?) -->")
_COMMENT = re.compile(r"^<!-- .* -->$")
_OUTPUT = re.compile(r"<!-- output of: (.+?) -->")


@dataclass
class Block:
    """A block of a page.

    Attributes:
        page: its path below the repository.
        line: of its first line in the page, from 1.
        kind: commands, python, json, toml, output or text.
        lines: without indentation.
        skipped: reasons by the beginning of the commands that are not run; "" for all.
        command: what prints it (output).
    """

    page: str
    line: int
    kind: str
    lines: list[str]
    skipped: dict[str, str] = field(default_factory=dict[str, str])
    command: str = ""

    def __str__(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def commands(self) -> list[str]:
        """Command lines, joined where they go on, without comments."""
        joined = "\n".join(self.lines).replace("\\\n", " ")
        return [c for line in joined.splitlines() if (c := _without_comment(line)) and c.split()[0] in PROGRAMS]

    def why_not(self, command: str) -> str:
        """Why a command of the block is not run; "" if it is."""
        return next((why for prefix, why in self.skipped.items() if command.startswith(prefix)), "")


def blocks(page: str) -> list[Block]:
    """The blocks of a page, in order."""
    found: list[Block] = []
    skipped, output = dict[str, str](), ""
    lines = (ROOT / page).read_text("utf-8").splitlines()
    i = 0
    while i < len(lines):
        if match := _NOT_RUN.search(lines[i]):
            skipped[match[1] or ""] = match[2]
        elif match := _OUTPUT.search(lines[i]):
            output = match[1]
        fence = re.match(r"^```(\w*)", lines[i])
        indented = lines[i].startswith("    ") and (i == 0 or not _COMMENT.sub("", lines[i - 1]).strip())
        if not fence and not indented:
            i += 1
            continue
        start = i + 1 if fence else i
        end = start
        while end < len(lines) and (not lines[end].startswith("```") if fence else _goes_on(lines, end)):
            end += 1
        body = [line if fence else line[4:] for line in lines[start:end]]
        kind = "output" if output else _kind(fence[1] if fence else "", body)
        found.append(Block(page, start + 1, kind, body, skipped, output))
        skipped, output = {}, ""
        i = end + 1
    return found


def _goes_on(lines: list[str], i: int) -> bool:
    """Whether an indented block goes on at line `i`: an empty line ends it unless an indented one follows."""
    return lines[i].startswith("    ") or (
        not lines[i].strip() and i + 1 < len(lines) and lines[i + 1].startswith("    ")
    )


def _kind(language: str, body: list[str]) -> str:
    if language in ("toml", "json", "python", "js", "mermaid"):
        return language
    words = [_without_comment(line).split() for line in body]
    if any(w and w[0] in PROGRAMS for w in words):
        return "commands"
    text = "\n".join(body)
    if text.lstrip().startswith('{"type"'):
        return "json"
    if re.search(r"^\[\[?[\w.]+\]\]?", text, re.MULTILINE):
        return "toml"
    return "python" if re.search(r"^(import|with) .*", text, re.MULTILINE) else "text"


def _without_comment(line: str) -> str:
    """A command line without what follows a # outside of quotes."""
    with contextlib.suppress(ValueError):
        lexer = shlex.shlex(line, posix=False, punctuation_chars="")
        lexer.whitespace_split, lexer.commenters = True, "#"
        return " ".join(lexer)
    return line.split(" #", maxsplit=1)[0].strip()


_NEXT_EXAMPLE = re.compile(r",? (?:or|and|then)\b[^:\"]{0,30}: (?=mmmd )| && |, of lines .*| \.\.\.$")
"""What stands between the commands of an example, and after the last one."""


def help_examples() -> list[tuple[str, str]]:
    """(command, command line) of every example of `--help`, as the docstrings have them."""
    found: list[tuple[str, str]] = []
    for path in sorted((ROOT / "daemon/cli").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and (text := ast.get_docstring(node)):
                for match in re.finditer(r"^Example[^:\n]*: (.+(?:\n(?!Example)[^\n]+)*)", text, re.MULTILINE):
                    parts = _NEXT_EXAMPLE.split(" ".join(match[1].split()))
                    found += [(node.name.replace("_", "-"), part) for part in parts if part]
    return found


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


def assert_prints(said: str, promised: list[str]) -> None:
    """Each promised line stands in the output, in order; "..." stands for any lines, blanks count once."""
    lines = [" ".join(line.split()) for line in said.splitlines()]
    at = 0
    for line in promised:
        wanted = " ".join(line.split())
        if wanted in ("", "..."):
            continue
        start = wanted.removesuffix(" ...").removesuffix(", ...")
        places = [
            i for i in range(at, len(lines)) if lines[i] == wanted or (start != wanted and lines[i].startswith(start))
        ]
        assert places, f"not printed: {wanted!r} in\n{said}"
        at = places[0] + 1
