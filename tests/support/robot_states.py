"""A robot led to a state by commands, on servos behind a real tty that outlive the daemon's processes and audit every goal."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from daemon.bench.tty_servos import TtyServos
from daemon.client import Client, NoAnswerError, RefusedError
from retarget.robot.loading import load_robot
from sim.faults import Fault, FaultSchedule
from tests.support.harness import Answer, RunningDaemon, slow_reference
from tests.support.kinematic import generate

ROBOT = load_robot(slow_reference())
STATES = ("limp", "arming", "idle", "moving", "holding", "parking", "estop")
ALL_STATES = (*STATES, "fault")
STAYS = {state: (state,) for state in ALL_STATES} | {
    "arming": ("arming", "idle"),
    "parking": ("parking", "limp"),
}
"""States in which the robot may be found a moment later, when nobody has touched it."""
FAULT_WITHIN_S = 30.0
"""Longest wait from the signal to a robot in a latched fault that can be reset, on a machine that has much else to do.

Left alone it takes 1 s of silence, 2.5 s to the kill, and the restart.
"""


class Servos(TtyServos):
    """The simulated robot behind a tty, its audit at hand."""

    def __init__(self, folder: Path) -> None:
        super().__init__(ROBOT, folder)

    def suffer(self, *faults: Fault) -> None:
        """Faults from now on, in place of those before."""
        self.bus.faults = FaultSchedule(faults)

    def assert_kept(self) -> None:
        report = self.bus.audit.report()
        assert report["violations"] == 0, report["details"]

    @property
    def moves(self) -> bool:
        """Whether a shaft turns, by more than the creep of friction."""
        return bool((np.abs(self.bus.world.drives.velocity_tick_s) > 20).any())


def within(seconds: float, what: str, condition: Callable[[], bool]) -> None:
    end_s = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end_s, f"not within {seconds} s: {what}"
        time.sleep(0.03)


def bring_to(client: Client, state: str) -> None:
    """Lead the robot from anywhere to a state."""
    status = client.status()
    now = status.state
    if now in ("moving", "holding") or status.command:  # what moves without end, or is held up in it and about to go on
        client.stop()
    if now in ("fault", "estop"):
        client.reset()
        client.wait_for("limp", timeout_s=5)
    if state in ("limp", "estop", "arming"):
        client.park()
        if state == "estop":
            client.estop()
        elif state == "arming":
            client.arm(wait=False)
            client.wait_for("arming", timeout_s=5)
        return
    client.arm()
    status = client.wait_for("idle", "holding", "fault", timeout_s=10)
    assert status.state != "fault", status.reason
    if state == "idle":
        client.gesture("nod")
        client.wait_for("idle", timeout_s=3)
        return
    client.gesture("wave_right", loop=True, wait=False)  # needs no generator; ended by nothing but what is done to it
    client.wait_for("moving", timeout_s=5)
    time.sleep(0.3)
    if state == "holding":
        client.stop()
        client.wait_for("holding", timeout_s=3)
    elif state == "parking":
        client.park(wait=False)
        client.wait_for(*STAYS["parking"], timeout_s=10)  # on a busy machine it may be over before its state is read


def bring_to_fault(client: Client, servos: Servos) -> None:
    """The bus is unplugged in a motion, and plugged in again: the fault stays."""
    bring_to(client, "moving")
    servos.unplugged(True)
    within(FAULT_WITHIN_S, "fault", lambda: client.status().state == "fault")
    servos.unplugged(False)


def lead_to(client: Client, servos: Servos, state: str) -> None:
    """To any state, the fault of a bus that was gone for a while too."""
    bring_to_fault(client, servos) if state == "fault" else bring_to(client, state)


def assert_works(client: Client) -> None:
    client.arm()
    status = client.wait_for("idle", "holding", "fault", timeout_s=10)
    assert status.state != "fault", status.reason
    assert client.say("wave", seconds=0.8).done


def daemon_on(servos: Servos, *options: str) -> RunningDaemon:
    return RunningDaemon(*options, bus=servos.url).until_ready()


@contextmanager
def working_daemon(servos: Servos) -> Iterator[tuple[RunningDaemon, Client]]:
    """A daemon that still works when the block ends, ends well, and has kept every limit."""
    daemon = daemon_on(servos)
    try:
        with daemon.client() as client:
            yield daemon, client
            assert_works(client)
        assert daemon.terminate() == 0
        servos.assert_kept()
    finally:
        daemon.close()


class SharedDaemon:
    """A daemon on servos behind a tty for all tests of a module, since a start takes longer than most tests.

    A test may end it, and a failed test may leave it unwell: the next test then gets a new one.

    Attributes:
        servos, daemon: those of the moment, after the first `ready`.

    Args:
        folder: for ttys and files.
        options: of `mmmd run`.
        answer: of the generator peer to a text.
    """

    servos: Servos
    daemon: RunningDaemon

    def __init__(self, folder: Path, *options: str, answer: Answer = generate) -> None:
        self._folder, self._options, self._answer = folder, options, answer
        self._runs = False
        self._n_started = 0

    def ready(self) -> SharedDaemon:
        """This, with a daemon that runs and a limp robot."""
        if self._runs and not self._led_to_limp():
            self._stop()
        if not self._runs:
            self._n_started += 1
            folder = self._folder / str(self._n_started)
            folder.mkdir()
            self.servos = Servos(folder)
            self._runs = True
            self.daemon = RunningDaemon(*self._options, bus=self.servos.url, answer=self._answer)
            self.daemon.until_ready()
        return self

    def client(self) -> Client:
        return self.daemon.client()

    def close(self) -> None:
        """End the daemon; one that still runs must work, end well and have kept every limit."""
        if not self._runs:
            return
        try:
            if self.daemon.process.poll() is None and self._led_to_limp():
                with self.client() as client:
                    assert_works(client)
                assert self.daemon.terminate() == 0, self.daemon.said
                self.servos.assert_kept()
        finally:
            self._stop()

    def _led_to_limp(self) -> bool:
        if self.daemon.process.poll() is not None:
            return False
        self.servos.suffer()
        with contextlib.suppress(NoAnswerError, RefusedError, AssertionError, TimeoutError), self.client() as client:
            bring_to(client, "limp")
            return client.wait_for("limp", timeout_s=10).state == "limp"
        return False

    def _stop(self) -> None:
        self._runs = False
        self.daemon.close()
        self.servos.close()


def gone(pid: int) -> bool:
    """Whether a process has ended, buried by its parent or not."""
    try:
        with open(f"/proc/{pid}/stat") as f:
            return f.read().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True
