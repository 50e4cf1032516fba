"""Processes of the daemon: started apart from the terminal's signals, watched, ended."""

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

log = logging.getLogger(__name__)

FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S = 0.5, 30.0
GOOD_LIFE_S = 2.0
"""Seconds after which a process did not fail to start: the wait before its next start is short again."""


class BackOff:
    """Seconds to wait before the next start of a process: twice as long after each failure, short again after a success.

    Args:
        first_s: the wait after a success.
        longest_s: the longest wait.
        last_s: the wait that the first failure doubles; None: half of `first_s`.
    """

    def __init__(self, first_s: float, longest_s: float, *, last_s: float | None = None) -> None:
        self._first_s, self._longest_s = first_s, longest_s
        self._last_s = first_s / 2 if last_s is None else last_s

    def after(self, *, good: bool) -> float:
        """Seconds to wait now that the process has ended; `good` says whether it had started well."""
        self._last_s = self._first_s if good else min(2 * self._last_s, self._longest_s)
        return self._last_s


class Child:
    """A Python module as a process of its own.

    Ctrl-C in a terminal goes to a whole process group; children have their own, so that the front alone decides.

    Attributes:
        name: for the log.
        said: the last lines of its stderr, when that is followed.

    Args:
        name: for the log.
        module: what to run.
        arguments: its arguments.
        environment: set for it, beside what this process has.
        follow: read its stderr. Not for a process that must go on when this one is frozen: it could block on the pipe.
    """

    def __init__(
        self, name: str, module: str, arguments: Sequence[str], environment: Mapping[str, str], *, follow: bool = False
    ) -> None:
        self.name, self._follow, self._environment = name, follow, environment
        self._module, self._arguments = module, list(arguments)
        self._process: asyncio.subprocess.Process | None = None
        self._forward: asyncio.Task[None] | None = None
        self._started_s = self._ran_s = time.monotonic()
        self.said: deque[str] = deque(maxlen=5)

    @property
    def running(self) -> bool:
        """Whether it was started and has not ended."""
        return self._process is not None and self._process.returncode is None

    @property
    def pid(self) -> int:
        """Its process id."""
        assert self._process is not None, "not started"
        return self._process.pid

    @property
    def status(self) -> int | None:
        """Its exit status; None while it runs."""
        return None if self._process is None else self._process.returncode

    @property
    def lived_s(self) -> float:
        """Seconds since it was started last."""
        return time.monotonic() - self._started_s

    def stopped_s(self) -> float:
        """Seconds since a call of this method first found it stopped by a signal; 0 where there is no /proc.

        A process that starves on a busy machine does not count: it waits for a processor.
        """
        now_s, state = time.monotonic(), ""
        with contextlib.suppress(OSError, IndexError):
            state = Path(f"/proc/{self.pid}/stat").read_text().rpartition(")")[2].split()[0]
        if state not in ("T", "t"):
            self._ran_s = now_s
        return now_s - self._ran_s

    def add_argument(self, argument: str) -> None:
        """Give it one more argument at its next start."""
        if argument not in self._arguments:
            self._arguments.append(argument)

    async def start(self, pass_fds: Sequence[int] = ()) -> None:
        """Start it (again); it inherits `pass_fds`."""
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive", **self._environment}
        environment[PARENT_VARIABLE] = str(os.getpid())
        self.said.clear()
        self._started_s = self._ran_s = time.monotonic()
        with on_all_cores():
            self._process = await asyncio.create_subprocess_exec(
                sys.executable, "-m", self._module, *self._arguments,
                stdin=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.PIPE if self._follow else None, env=environment,
                start_new_session=True, pass_fds=pass_fds,
            )  # fmt: skip
        if self._follow:
            self._forward = asyncio.create_task(self._forward_stderr(self._process))

    async def ended(self) -> int:
        """Wait for its end; its exit status, negative for a signal."""
        assert self._process is not None, "not started"
        status = await self._process.wait()
        if self._forward is not None:
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(asyncio.shield(self._forward), 1.0)
        return status

    def kill(self) -> None:
        """End it at once."""
        if self.running and self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()

    async def end(self, grace_s: float, *, terminate: bool = True) -> None:
        """Let it end by itself (asked by SIGTERM, with `terminate`), kill it after `grace_s`."""
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
