"""Runs one command in a fresh process: ended at its time limit, with the share of the processors that other processes took."""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from daemon.host.worker_threads import WORKER_THREADS
from sim.steal_time import STAT, stolen_s

GRACE_S = 30.0
"""Seconds that a command has to end its own processes before its whole session is killed."""
LAST_LINES = 2
"""Lines of stderr that are kept of a failed command."""
_TICK_S = 1 / os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class Outcome:
    """The outcome of a command.

    Attributes:
        status: exit status; None where the command exceeded its time limit.
        said: stdout.
        last_lines: the end of stderr.
        seconds: wall time.
        others_took: share of all processors' time that other processes took; None where unknown.
        host_took: share that the host of a virtual machine took; None where unknown.
    """

    status: int | None
    said: str
    last_lines: str
    seconds: float
    others_took: float | None
    host_took: float | None


def run_command(
    words: Sequence[str], limit_s: float, folder: Path, tell: Callable[[str], None] = lambda _line: None
) -> Outcome:
    """Run a command to its end, or for `limit_s` seconds; no process that it started outlives it.

    Args:
        words: the command line; "mmmd" and "python" are those of this installation.
        limit_s: seconds.
        folder: folder to run it in.
        tell: called with each line of its stderr, from another thread.
    """
    last = deque[str](maxlen=LAST_LINES)
    busy_s, stolen, began_s, own_s = _busy_s(), sum(stolen_s()), time.monotonic(), _children_s()
    with tempfile.TemporaryFile("w+", encoding="utf-8") as out:
        process = subprocess.Popen(
            _argv(words), cwd=folder, env={**WORKER_THREADS, **os.environ}, stdin=subprocess.DEVNULL, stdout=out,
            stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True,
        )  # fmt: skip
        reader = threading.Thread(target=_read, args=(process, last, tell), daemon=True)
        reader.start()
        status: int | None = None
        try:
            with contextlib.suppress(subprocess.TimeoutExpired):
                status = process.wait(limit_s)
        finally:
            _end(process)
        reader.join(1.0)
        out.seek(0)
        said = out.read()
    wall_s = time.monotonic() - began_s
    processors_s = wall_s * (os.cpu_count() or 1)
    others = None if busy_s is None else max(0.0, (_busy_s() or 0.0) - busy_s - (_children_s() - own_s)) / processors_s
    host = (sum(stolen_s()) - stolen) / processors_s if stolen_s() else None
    return Outcome(status, said, " | ".join(last), wall_s, others, host)


def _argv(words: Sequence[str]) -> list[str]:
    if words[0] == "mmmd":
        return [sys.executable, "-m", "daemon.cli", *words[1:]]
    return [sys.executable, *words[1:]] if words[0] == "python" else list(words)


def _read(process: subprocess.Popen[str], last: deque[str], tell: Callable[[str], None]) -> None:
    assert process.stderr is not None
    with process.stderr:
        for line in process.stderr:
            if line.strip():
                last.append(line.strip())
                tell(line.strip())


def _end(process: subprocess.Popen[str]) -> None:
    """Let a command end itself, then kill the rest of its session's first process group."""
    if process.poll() is None:
        process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(GRACE_S)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait(10)


def _busy_s(stat: Path = STAT) -> float | None:
    """Seconds that all processors have worked since the machine's start, without the host's share (proc_stat(5))."""
    try:
        user, nice, system, _idle, _io, irq, soft = map(int, stat.read_text("ascii").split("\n", 1)[0].split()[1:8])
    except (OSError, ValueError):
        return None
    return (user + nice + system + irq + soft) * _TICK_S


def _children_s() -> float:
    """Processor seconds of all child processes that have ended, their own children included."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
