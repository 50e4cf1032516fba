"""A daemon for a measurement: simulated robot, local sockets, a second process that keeps the cores busy."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator, Sequence
from dataclasses import replace
from pathlib import Path

from daemon.client import Client
from daemon.demo.main_job import child, free_endpoints, wait_until_ready
from daemon.errors import DaemonError

HALTED = ("fault", "estop")
"""States after the machine stood still: servos stopped by their watchdogs; a bus process that was silent for a second and came
back."""
_NOT_ARMED = (*HALTED, "limp")
ARM_TRIES = 5
ARM_PAUSE_S = 1.0

_BUSY = "x = 1\nwhile True:\n    x = x * 3 % 1000003\n"


@contextlib.contextmanager
def running_daemon(robot: str, *options: str, audit: Path | None = None) -> Generator[tuple[Client, Path]]:
    """A client of a daemon that is armed and ready, and the path of the daemon's output; the robot is parked at the end."""
    endpoints = free_endpoints()
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "daemon.log"
        ends = ["--cmd", endpoints.cmd, "--ctl", endpoints.ctl, "--pub", endpoints.pub]
        bus = "sim://" if audit is None else f"sim://?audit={audit}"
        with (
            child(["run", "--robot", robot, "--bus", bus, *ends, *options], log) as process,
            Client(replace(endpoints, keys=_keys_among(options))) as client,
        ):
            wait_until_ready(client, process, log)
            arm_again(client)
            yield client, log
            if client.status().state not in _NOT_ARMED:
                client.park()


def arm_again(client: Client) -> None:
    """Arm from limp or `HALTED` as a person would: reset, arm, and again where the machine stands still once more meanwhile.

    Raises:
        DaemonError: the robot is still not armed after the last try.
    """
    for tries_left in reversed(range(ARM_TRIES)):
        try:
            client.reset()
            client.arm()
        except DaemonError:
            if not tries_left or client.status().state not in _NOT_ARMED:
                raise
        if client.status().state not in _NOT_ARMED:
            return
        time.sleep(ARM_PAUSE_S)
    status = client.status()
    raise DaemonError(f"not armed after {ARM_TRIES} tries: the robot is in {status.state}: {status.reason}")


def _keys_among(options: Sequence[str]) -> Path | None:
    return Path(options[options.index("--keys") + 1]) if "--keys" in options else None


@contextlib.contextmanager
def busy_cores() -> Generator[None]:
    """Run one process without pauses for each core, at normal priority."""
    n = len(os.sched_getaffinity(0))
    hogs = [subprocess.Popen([sys.executable, "-c", _BUSY]) for _ in range(n)]
    try:
        yield
    finally:
        for hog in hogs:
            hog.send_signal(signal.SIGKILL)
            hog.wait(5)


def percentile(values: Sequence[float], share: float) -> float | None:
    """The value that `share` percent of the values do not exceed; None without values."""
    import numpy as np

    return round(float(np.percentile(values, share)), 2) if len(values) else None
