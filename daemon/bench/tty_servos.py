"""Simulated servos behind a real tty: they outlive the daemon's processes, and report at any time which of them has torque."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections.abc import Generator
from pathlib import Path

from daemon.errors import DaemonError
from daemon.host.realtime import BUS_PRIORITY, give_back_fifo
from retarget.robot.robot import RobotModel
from sim.bus import SimBus
from sim.faults import Fault, FaultSchedule
from sim.pty import PtyServer

_PLUG_TIMEOUT_S = 5.0
_CALLER_PRIORITY = 20
"""FIFO priority of the thread that has servos served: below bus processes and the threads that take stops, which need not wait then
while it imports or computes."""


class ListeningBus(SimBus):
    """A simulated bus that records when it first received bytes since `listen_anew`.

    Attributes:
        first_bytes_s: monotonic time of these bytes; None before any.
    """

    first_bytes_s: float | None = None

    def listen_anew(self) -> None:
        """Forget the recorded time and wait for the next bytes."""
        self.first_bytes_s = None

    def receive(self, data: bytes, t_s: float, baud: int, *, patient: bool = False) -> None:
        """Receive the client's bytes, as `SimBus` does."""
        if self.first_bytes_s is None:
            self.first_bytes_s = time.monotonic()
        super().receive(data, t_s, baud, patient=patient)


class TtyServos:
    """The simulated servos of a robot behind a tty, served by a thread of this process until `close`.

    Attributes:
        bus: the simulated bus.
        server: its tty.
        url: URL of the bus, for `mmmd run --bus`.

    Args:
        robot: the robot.
        folder: folder for the link to the tty.
    """

    def __init__(self, robot: RobotModel, folder: Path) -> None:
        self._link = folder / "servos"
        self.bus = ListeningBus(robot)
        self.server = PtyServer(self.bus, self._link)
        self.url = f"dxl://{self._link}?baud={robot.bus.baud}"
        self._served = contextlib.ExitStack()
        self._served.enter_context(served(self.server))

    @property
    def torque(self) -> bool:
        """Whether any servo has torque."""
        return any(servo.torque for servo in self.bus.servos.values())

    def unplugged(self, on: bool) -> None:
        """Remove the tty, or bring it back as another one under the same link.

        Raises:
            DaemonError: the tty did not go or come in time.
        """
        self.bus.faults = FaultSchedule((Fault("unplug"),) if on else ())
        end_s = time.monotonic() + _PLUG_TIMEOUT_S
        while self._link.exists() == on:
            if time.monotonic() > end_s:
                raise DaemonError(f"{self._link} is {'still' if on else 'not yet'} there after {_PLUG_TIMEOUT_S:g} s")
            time.sleep(0.01)

    def close(self) -> None:
        """End the thread and remove the tty."""
        self._served.close()


def go_first(pid: int, flags: int = 0, priority: int = BUS_PRIORITY) -> None:
    """Give FIFO priority to a process that plays servos (0: this thread), where the system allows this."""
    with contextlib.suppress(OSError):
        os.sched_setscheduler(pid, os.SCHED_FIFO | flags, os.sched_param(priority))


def go_last(pid: int) -> None:
    """Give a process normal priority again."""
    with contextlib.suppress(OSError):
        os.sched_setscheduler(pid, os.SCHED_OTHER, os.sched_param(0))


@contextlib.contextmanager
def pty_workers_first() -> Generator[None]:
    """Give FIFO priority to the kernel's workers that carry the bytes of a pty, where the system allows this.

    The drivers of serial adapters send a client's bytes when it writes them. The bytes of a pty wait for a worker of the kernel
    that has normal priority; on busy cores this took up to 50 ms, which are no delay of the daemon.
    """
    workers = _unbound_workers()
    for pid in workers:
        go_first(pid)
    try:
        yield
    finally:
        for pid in workers:
            go_last(pid)


def _unbound_workers() -> list[int]:
    """Process ids of the kernel's workers that belong to no core."""
    found: list[int] = []
    for path in Path("/proc").glob("[0-9]*/comm"):
        with contextlib.suppress(OSError):
            if path.read_text().startswith("kworker/u"):
                found.append(int(path.parent.name))
    return found


@contextlib.contextmanager
def served(server: PtyServer) -> Generator[PtyServer]:
    """Serve simulated servos behind a tty in a thread, with FIFO priority where allowed: late answers would count as silence.

    The calling thread gets FIFO priority as well, a lower one, because it sometimes holds the interpreter's lock; processes started
    meanwhile do not get it.
    """

    def serve() -> None:
        go_first(0)
        server.serve()

    thread = threading.Thread(target=serve, daemon=True)
    go_first(0, os.SCHED_RESET_ON_FORK, _CALLER_PRIORITY)
    try:
        thread.start()
        yield server
    finally:
        give_back_fifo()
        server.stop()
        thread.join(5)
        server.close()
