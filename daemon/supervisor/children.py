"""Child processes of the daemon: shielded from the terminal's signals, watched, and ended."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import sys
import time
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path

from daemon.host.cores import on_all_cores
from daemon.host.parent import PARENT_VARIABLE
from daemon.host.worker_threads import WORKER_THREADS

log = logging.getLogger(__name__)

FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S = 0.5, 30.0
NOT_STARTED = 126
"""Exit status of a process that the system could not start, as shells give it."""
GOOD_LIFE_S = 2.0
"""Seconds after which a start counts as successful: the wait before the next start is short again."""


class BackOff:
    """Computes the seconds to wait before a process starts again: twice as long after each failure, short after a success.

    Args:
        first_s: seconds to wait after a success.
        longest_s: seconds to wait at most.
        last_s: seconds that the first failure doubles; None takes half of `first_s`.
    """

    def __init__(self, first_s: float, longest_s: float, *, last_s: float | None = None) -> None:
        self._first_s, self._longest_s = first_s, longest_s
        self._last_s = first_s / 2 if last_s is None else last_s

    def after(self, *, good: bool) -> float:
        """Seconds to wait now that the process has ended; `good`: whether it had started well."""
        self._last_s = self._first_s if good else min(2 * self._last_s, self._longest_s)
        return self._last_s


class Child:
    """Runs a Python module as a process.

    Ctrl-C in a terminal goes to a whole process group; children have their own, so that the front alone decides.

    Attributes:
        name: name in the log.
        said: last lines of the process's stderr; empty unless `follow`.

    Args:
        name: name in the log.
        module: module to run.
        arguments: its arguments.
        environment: environment variables set for it, besides this process's own.
        follow: whether to read its stderr. False for a process that must run on when this one is frozen: the pipe could block it.
    """

    def __init__(
        self, name: str, module: str, arguments: Sequence[str], environment: Mapping[str, str], *, follow: bool = False
    ) -> None:
        self.name, self._follow, self._environment = name, follow, environment
        self._module, self._arguments = module, list(arguments)
        self._process: asyncio.subprocess.Process | None = None
        self._forward: asyncio.Task[None] | None = None
        self._is_refused = False
        self._started_s = self._ran_s = time.monotonic()
        self.said: deque[str] = deque(maxlen=5)

    @property
    def running(self) -> bool:
        """Whether the process was started and has not ended."""
        return self._process is not None and self._process.returncode is None

    @property
    def pid(self) -> int:
        """Process id."""
        assert self._process is not None, "not started"
        return self._process.pid

    @property
    def status(self) -> int | None:
        """Exit status; None while the process runs."""
        return None if self._process is None else self._process.returncode

    @property
    def lived_s(self) -> float:
        """Seconds since the last start."""
        return time.monotonic() - self._started_s

    def stopped_s(self) -> float:
        """Seconds since this method first found the process stopped by a signal; 0 without /proc.

        A process that waits for a processor on a busy machine does not count as stopped.
        """
        now_s, state = time.monotonic(), ""
        with contextlib.suppress(OSError, IndexError):
            state = Path(f"/proc/{self.pid}/stat").read_text().rpartition(")")[2].split()[0]
        if state not in ("T", "t"):
            self._ran_s = now_s
        return now_s - self._ran_s

    def add_argument(self, argument: str) -> None:
        """Add an argument from the next start on."""
        if argument not in self._arguments:
            self._arguments.append(argument)

    async def start(self, pass_fds: Sequence[int] = ()) -> None:
        """Start the process, or start it again; it inherits the descriptors `pass_fds`.

        One that the system cannot start (too many processes or open files, too little memory) counts as ended with `NOT_STARTED`.
        """
        environment = {**os.environ, **WORKER_THREADS, **self._environment}
        environment[PARENT_VARIABLE] = str(os.getpid())
        self.said.clear()
        self._started_s = self._ran_s = time.monotonic()
        self._process, self._is_refused = None, False
        try:
            with on_all_cores():
                self._process = await asyncio.create_subprocess_exec(
                    sys.executable, "-m", self._module, *self._arguments,
                    stdin=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.PIPE if self._follow else None, env=environment,
                    start_new_session=True, pass_fds=pass_fds,
                )  # fmt: skip
        except OSError as error:
            self._is_refused = True
            self.said.append(f"cannot be started: {error.strerror or error}")
            log.error("the %s %s", self.name, self.said[-1])
            return
        if self._follow:
            self._forward = asyncio.create_task(self._forward_stderr(self._process))

    async def ended(self) -> int:
        """Wait for the end of the process; returns its exit status, negative for a signal."""
        if self._is_refused:
            return NOT_STARTED
        assert self._process is not None, "not started"
        status = await self._process.wait()
        if self._forward is not None:
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(asyncio.shield(self._forward), 1.0)
        return status

    def kill(self) -> None:
        """Kill the process at once."""
        if self.running and self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()

    async def end(self, grace_s: float, *, terminate: bool = True) -> None:
        """Wait for the process to end, after SIGTERM when `terminate`, and kill it after `grace_s` seconds."""
        if not self.running or self._process is None:
            return
        if terminate:
            with contextlib.suppress(ProcessLookupError):
                self._process.terminate()
        try:
            await asyncio.wait_for(self.ended(), grace_s)
        except TimeoutError:
            log.warning("%s did not end in %g s and is killed", self.name, grace_s)
            self.kill()
            await self.ended()

    async def _forward_stderr(self, process: asyncio.subprocess.Process) -> None:
        assert process.stderr is not None, "stderr is a pipe"
        while line := await process.stderr.readline():
            text = line.decode("utf-8", "replace")
            self.said.append(text.rstrip())
            sys.stderr.write(text)
