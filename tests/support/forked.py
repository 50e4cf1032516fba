"""`mmmd run` in a process that is forked from one in which the daemon's modules and tables of words are loaded already.

To load them takes 1.4 s of processor time, more than the rest of a daemon's start, and `make test` starts some thirty daemons.
The bus process and the other children of the daemon are new Python programs as ever; the whole of `mmmd run` is one where a test
chooses it (`RunningDaemon(fresh=True)`).
"""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from multiprocessing.process import BaseProcess
from pathlib import Path

_FORKS = multiprocessing.get_context("forkserver")
_FORKS.set_forkserver_preload(["tests.support.loaded_daemon"])


class ForkedCommand:
    """A command of `mmmd` that runs; the methods that tests need are named as those of `subprocess.Popen`.

    Args:
        arguments: of `mmmd`.
        output: file to which it prints.
        environment: variables of the process, in place of those of this one.
    """

    def __init__(self, arguments: Sequence[str], output: Path, environment: Mapping[str, str]) -> None:
        output.touch()
        self._process: BaseProcess = _FORKS.Process(target=_run, args=(list(arguments), output, dict(environment)))
        self._process.start()
        pid = self._process.pid
        assert pid is not None
        self.pid = pid

    def poll(self) -> int | None:
        """The exit status; None while it runs."""
        return self._process.exitcode

    def wait(self, timeout_s: float | None = None) -> int:
        self._process.join(timeout_s)
        status = self._process.exitcode
        if status is None:
            raise subprocess.TimeoutExpired(self._process.name, timeout_s or 0.0)
        return status

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        self._process.kill()


def _run(arguments: list[str], output: Path, environment: dict[str, str]) -> None:
    with output.open("ab") as file:
        for stream in (sys.stdout, sys.stderr):
            os.dup2(file.fileno(), stream.fileno())
    # Buffered as Python's own are for a file.
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)
    sys.stderr = open(2, "w", encoding="utf-8", buffering=1, closefd=False)
    sys.argv = ["mmmd", *arguments]
    os.environ.clear()
    os.environ.update(environment)

    from daemon.cli import main

    sys.exit(main(arguments))
