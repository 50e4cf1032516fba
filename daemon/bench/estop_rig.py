"""A daemon on simulated servos that outlive it, whose processes may be frozen and killed, and a person with an e-stop button."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Self

import zmq

from daemon.bench.daemon_rig import HALTED, arm_again
from daemon.bench.tty_servos import TtyServos
from daemon.client import Client
from daemon.demo.main_job import child
from daemon.errors import DaemonError
from daemon.host.realtime import may_fifo
from daemon.network.probe import listening
from daemon.settings.config import Endpoints
from daemon.wire.codec import decode_event, encode
from daemon.wire.events import Ack, CarriedOut
from daemon.wire.requests import Estop
from retarget.robot.loading import load_robot

BUS, CTL = "daemon.control.process", "daemon.ctl.process"
CLIENT_PRIORITY = 20
READY_TIMEOUT_S = 60.0
STATE_TIMEOUT_S = 20.0
_LEAD_TRIES = 4
"""Attempts to lead the robot to a state: when the machine stands still for a moment, servos fall silent and one fails."""
_LOG_LINES = 40
"""Lines of the daemon's log that an error shows."""


class EstopRig:
    """Starts the daemon when needed, and leads the robot to a state. Ends all processes that it started on exit.

    Attributes:
        servos: simulated servos of the robot.
        endpoints: endpoints of the daemon, TCP on this machine.
        has_fifo: whether a button may have FIFO priority.

    Args:
        robot: name of the robot.
        folder: folder for the servos' tty and the daemon's log.
    """

    def __init__(self, robot: str, folder: Path) -> None:
        self.has_fifo = may_fifo(CLIENT_PRIORITY)
        self.servos = TtyServos(load_robot(robot), folder)
        cmd, ctl, pub, stream = (f"tcp://127.0.0.1:{port}" for port in _free_ports(4))
        self.endpoints = Endpoints(cmd, ctl, pub, stream=stream)
        self._log = folder / "daemon.log"
        self._arguments = [
            "run", "--robot", robot, "--bus", self.servos.url, "--cmd", cmd, "--ctl", ctl, "--pub", pub, "--stream", stream,
            "--generator", f"ipc://{folder}/nobody",  # gestures need none
        ]  # fmt: skip
        self._child = contextlib.ExitStack()
        self._process: subprocess.Popen[bytes] | None = None
        self._known: dict[int, str] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            self._remember_children()
            self._child.close()  # parks the robot; killed only if it does not end
        finally:
            self.kill_all()
            self.servos.close()

    @property
    def front(self) -> int:
        """Process id of the front."""
        assert self._process is not None, "not started"
        return self._process.pid

    @property
    def said(self) -> str:
        """The last lines of the daemon's log."""
        return "\n".join(self._log.read_text("utf-8", "replace").splitlines()[-_LOG_LINES:])

    def child(self, module: str) -> int:
        """Process id of the daemon's child that runs a module.

        Raises:
            DaemonError: there is none.
        """
        self._remember_children()
        for pid, known in self._known.items():
            if known == module and _runs(pid, module):
                return pid
        raise DaemonError(f"the daemon has no process that runs {module}; its log ends with:\n{self.said}")

    def start(self) -> None:
        """Start a daemon in the place of the one that was killed."""
        self._child.close()
        self._process = self._child.enter_context(child(self._arguments, self._log))

    def kill_front(self) -> None:
        """Kill the front; its child processes live on."""
        self._remember_children()
        os.kill(self.front, signal.SIGKILL)
        if self._process is not None:
            self._process.wait(5)

    def kill_all(self) -> None:
        """Kill the front and every process that it started, so that servos keep their torque."""
        self._remember_children()
        if self._process is not None and self._process.poll() is None:
            self.kill_front()
        for pid, module in self._known.items():
            if _runs(pid, module):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        end_s = time.monotonic() + 5
        while any(_runs(*known) for known in self._known.items()) and time.monotonic() < end_s:
            time.sleep(0.01)
        self._known.clear()

    def bring_to(self, state: str) -> None:
        """Lead the robot to "moving", "arming" or "parking", from any state of the daemon and the robot.

        Raises:
            DaemonError: the daemon does not get ready, or the robot does not reach the state; with the end of the log.
        """
        for tries_left in reversed(range(_LEAD_TRIES)):
            if self._process is None or self._process.poll() is not None:
                self.kill_all()
                self.start()
            try:
                self._until_ready()
                with Client(self.endpoints) as client:
                    _lead_to(client, state)
                return
            except DaemonError as error:
                if not tries_left:
                    raise DaemonError(f"{error}; the daemon's log ends with:\n{self.said}") from error
                sys.stderr.write(f"led to {state} again: {error}\n")

    def until_listening(self) -> None:
        """Wait until `ctl` accepts connections, even if the daemon is not ready otherwise."""
        self._until("ctl takes connections", lambda: listening(self.endpoints.ctl))

    def _until_ready(self) -> None:
        self.until_listening()
        with Client(self.endpoints) as client:
            self._until("its bus process cycles", lambda: bool(_cycles(client)))

    def _until(self, what: str, condition: Callable[[], bool]) -> None:
        end_s = time.monotonic() + READY_TIMEOUT_S
        while not condition():
            if time.monotonic() > end_s or (self._process is not None and self._process.poll() is not None):
                raise DaemonError(f"the daemon has not got so far that {what}")
            time.sleep(0.02)

    def _remember_children(self) -> None:
        if self._process is not None and self._process.poll() is None:
            self._known |= _children(self.front)


class Button:
    """A client of `ctl` that only gives e-stops.

    Args:
        endpoint: `ctl` of the daemon.
        has_fifo: give its I/O thread FIFO priority, as its own wait for a core is not the daemon's.
    """

    def __init__(self, endpoint: str, *, has_fifo: bool) -> None:
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        if has_fifo:  # libzmq aborts where it is not permitted
            self._context.set(zmq.THREAD_SCHED_POLICY, os.SCHED_FIFO)
            self._context.set(zmq.THREAD_PRIORITY, CLIENT_PRIORITY)
        self._socket = self._context.socket(
            zmq.DEALER
        )  # starts the I/O thread here: its wait for a core is not the daemon's
        self._endpoint = endpoint
        self._id = uuid.uuid4().hex

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._context.destroy(linger=0)

    def connect(self) -> None:
        """Begin to connect; `press` need not wait for it."""
        self._socket.connect(self._endpoint)

    def press(self) -> None:
        """Request an e-stop."""
        self._socket.send(encode(Estop(id=self._id)))

    def told(self) -> bool:
        """Whether a received message says that the e-stop was carried out."""
        while self._socket.poll(0):
            event = decode_event(self._socket.recv())
            if event.id == self._id and (
                isinstance(event, CarriedOut) or (isinstance(event, Ack) and event.carried_out)
            ):
                return True
        return False


def _lead_to(client: Client, state: str) -> None:
    if state == "arming":
        if client.status().state in HALTED:
            client.reset()
        elif client.status().state != "limp":
            client.park()
        client.arm(wait=False)
        _wait_for(client, "arming")
        return
    arm_again(client)
    client.gesture("wave_right", loop=True, wait=False)
    _wait_for(client, "moving")
    if state == "parking":
        client.park(wait=False)
        _wait_for(client, "parking")


def _wait_for(client: Client, state: str) -> None:
    status = client.wait_for(state, *HALTED, timeout_s=STATE_TIMEOUT_S)
    if status.state != state:
        raise DaemonError(f"the robot is in {status.state} instead of {state}: {status.reason}")


def _cycles(client: Client) -> int:
    try:
        return int(client.status().bus_info["cycles"])
    except DaemonError:
        return 0


def _children(pid: int) -> dict[int, str]:
    """The module that each child of a process runs."""
    found: dict[int, str] = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(path.read_text().rsplit(")", 1)[1].split()[1])
            words = (path.parent / "cmdline").read_bytes().decode("utf-8", "replace").split("\0")
        except OSError:
            continue
        if parent == pid and "-m" in words[:-1]:
            found[int(path.parent.name)] = words[words.index("-m") + 1]
    return found


def _runs(pid: int, module: str) -> bool:
    """Whether a process lives and runs a module; an ended process's id may belong to another one by now."""
    try:
        return module.encode() in (Path("/proc") / str(pid) / "cmdline").read_bytes().split(b"\0")
    except OSError:
        return False


def _free_ports(n: int) -> list[int]:
    """TCP ports of this machine on which no program listens at present."""
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(n)]
        return [s.getsockname()[1] for s in sockets]
