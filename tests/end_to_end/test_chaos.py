"""Processes killed and frozen in states of the robot, as listed in docs/safety.md: a named safe state in time, every limit kept.

The servos are behind a real tty and outlive the daemon's processes; their audit watches all the time.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import time
from collections.abc import Callable

import numpy as np
import pytest

from daemon.bench.tty_servos import TtyServos
from daemon.client import CancelledByError, Client, NoAnswerError, RefusedError
from daemon.wire import events as ev
from retarget.robot.loading import load_robot
from tests.end_to_end.test_start_and_end import child_pid
from tests.support.harness import RunningDaemon, mmmd

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]
ROBOT = load_robot("reference")
STATES = ("limp", "arming", "idle", "moving", "holding", "parking", "estop")
STAYS = {state: (state,) for state in (*STATES, "fault")} | {
    "arming": ("arming", "idle"),
    "parking": ("parking", "limp"),
}
"""What the robot may be in a moment later when nothing touches it."""
FAULT_WITHIN_S = 6.0
"""From the signal to a robot in a latched fault that can be reset: 1 s of silence, 2.5 s to the kill, the restart."""


class Servos(TtyServos):
    """The simulated robot behind a tty, its audit at hand."""

    def __init__(self, folder) -> None:
        super().__init__(ROBOT, folder)

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
        client.wait_for("parking", timeout_s=3)


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


@pytest.fixture
def servos(tmp_path):
    made = Servos(tmp_path)
    yield made
    made.close()


def daemon_on(servos: Servos, *options: str, model: bool = False) -> RunningDaemon:
    return RunningDaemon(*options, bus=servos.url, model=model).until_ready()


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP], ids=["killed", "frozen"])
def test_the_bus_process_in_any_state_ends_in_a_fault_that_can_be_reset(servos, number):
    daemon = daemon_on(servos)
    try:
        with daemon.client() as client:
            for state in (*STATES, "fault"):
                lead_to(client, servos, state)
                bus = child_pid(daemon, "daemon.control.process")
                os.kill(bus, number)
                began_s = time.monotonic()
                within(FAULT_WITHIN_S, f"{state}: fault", lambda: client.status().state == "fault")
                within(FAULT_WITHIN_S, f"{state}: its command ends", lambda: client.status().command is None)
                assert client.status().must_arm
                within(FAULT_WITHIN_S, f"{state}: named", lambda: "reset" in client.status().reason)
                with pytest.raises(RefusedError, match="mmmd reset"):
                    client.say("wave")
                client.reset()
                client.wait_for("limp", timeout_s=3)
                assert time.monotonic() - began_s < 2 * FAULT_WITHIN_S
                within(2, f"{state}: no torque", lambda: not servos.torque)
                servos.assert_kept()
            assert_works(client)
        assert daemon.terminate() == 0
        servos.assert_kept()
    finally:
        daemon.close()


@pytest.mark.parametrize("state", (*STATES, "fault"))
def test_a_bus_unplugged_in_each_state_is_a_named_fault_and_comes_back(servos, state, tmp_path):
    """A recorder that is killed in that state before is said, and changes nothing."""
    daemon = daemon_on(servos, "--log", str(tmp_path / "run.mcap"))
    try:
        with daemon.client() as client:
            lead_to(client, servos, state)
            os.kill(child_pid(daemon, "daemon.recording.recorder"), signal.SIGKILL)
            time.sleep(0.1)
            assert client.status().state in STAYS[state]
            servos.unplugged(True)
            if state == "estop":
                time.sleep(1.0)
                assert client.status().state in ("estop", "fault")  # both latch, without torque
            else:
                within(FAULT_WITHIN_S, "fault", lambda: client.status().state == "fault")
                assert client.status().reason
            servos.unplugged(False)
            client.reset()
            client.wait_for("limp", timeout_s=5)
            assert_works(client)
            assert "stopped" in client.status().recording
        assert daemon.terminate() == 0
        servos.assert_kept()
    finally:
        daemon.close()


def test_the_front_frozen_in_each_state_leaves_a_robot_that_stands_and_goes_on_with_it(servos):
    """After 0.5 s the bus process brings to rest what moves; what is being parked is parked."""
    daemon = daemon_on(servos)
    try:
        with daemon.client() as client:
            for state in (*STATES, "fault"):
                lead_to(client, servos, state)
                had_torque = servos.torque
                daemon.process.send_signal(signal.SIGSTOP)
                try:
                    time.sleep(1.2)
                    assert state in ("arming", "parking", "fault") or servos.torque == had_torque, state
                    assert state == "parking" or not servos.moves, f"{state}: it moves and nobody leads it"
                finally:
                    daemon.process.send_signal(signal.SIGCONT)
                after = ("idle", "moving", "holding") if state in ("idle", "moving", "holding") else STAYS[state]
                after = ("limp", "holding", "idle") if state == "arming" else after
                assert client.wait_for(*after, timeout_s=5).state in after
                servos.assert_kept()
            client.reset()
            client.wait_for("limp", timeout_s=5)
            assert_works(client)
        assert daemon.terminate() == 0
        servos.assert_kept()
    finally:
        daemon.close()


@pytest.mark.parametrize(
    "states",
    [("idle", "moving", "holding", "parking"), ("fault", "limp", "arming", "estop")],
    ids=["moving on", "other"],
)
def test_the_front_killed_in_each_state_leaves_a_limp_robot_and_no_process(tmp_path, states):
    """Several daemons at once: hold after 0.5 s, park after 5 s, then the port is given back: of one that is limp after 5 s too."""
    rigs: list[tuple[Servos, RunningDaemon, int]] = []
    try:
        for state in states:
            folder = tmp_path / state
            folder.mkdir()
            servos = Servos(folder)
            daemon = daemon_on(servos)
            rigs.append((servos, daemon, child_pid(daemon, "daemon.control.process")))
            with daemon.client() as client:
                lead_to(client, servos, state)
            daemon.process.kill()
        for servos, daemon, bus in rigs:
            within(25, "limp", lambda servos=servos: not servos.torque)
            within(15, "bus process gone", lambda bus=bus: _gone(bus))
            daemon.process.wait(5)
            servos.assert_kept()
    finally:
        for servos, daemon, _ in rigs:
            daemon.close()
            servos.close()


def test_a_second_daemon_names_the_process_that_has_the_port_and_ends_with_a_status_that_systemd_tries_again(
    servos, tmp_path
):
    daemon = daemon_on(servos)
    try:
        ends = [f"--{name}=ipc://{tmp_path}/{name}" for name in ("cmd", "ctl", "pub")]
        second = mmmd("run", "--bus", servos.url, *ends)
        assert second.returncode == 1
        assert f"in use by process {child_pid(daemon, 'daemon.control.process')}" in second.stderr
        assert daemon.terminate() == 0
    finally:
        daemon.close()


def test_the_recorder_killed_and_frozen_changes_nothing_for_the_robot(tmp_path):
    daemon = RunningDaemon("--log", str(tmp_path / "run.mcap")).until_ready()
    try:
        with daemon.client() as client:
            recorder = child_pid(daemon, "daemon.recording.recorder")
            os.kill(recorder, signal.SIGSTOP)
            for state in STATES:
                bring_to(client, state)
            os.kill(recorder, signal.SIGCONT)
            bring_to(client, "moving")
            os.kill(recorder, signal.SIGKILL)
            assert client.say("wave", seconds=0.8).done
            within(3, "said", lambda: "stopped" in client.status().recording)
        assert daemon.terminate() == 0
        assert json.loads(daemon.audit.read_text())["violations"] == 0
    finally:
        daemon.close()


def test_the_generator_killed_and_frozen_in_each_state_is_started_again():
    """On servos in the bus process: loading a model again and again takes the processor from others."""
    daemon = RunningDaemon(model=True).until_ready()
    try:
        with daemon.client() as client:
            bring_to(client, "idle")
            os.kill(child_pid(daemon, "daemon.generator.process"), signal.SIGSTOP)
            within(12, "noticed", lambda: not client.status().generator.startswith("ready"))
            for state in (*STATES, "fault"):
                within(60, "ready", lambda: client.status().generator.startswith("ready"))
                if state == "fault":
                    bring_to(client, "idle")
                    os.kill(child_pid(daemon, "daemon.control.process"), signal.SIGKILL)
                    within(FAULT_WITHIN_S, "named", lambda: "reset" in client.status().reason)
                else:
                    bring_to(client, state)
                for number in (signal.SIGSTOP, signal.SIGCONT, signal.SIGKILL):
                    os.kill(child_pid(daemon, "daemon.generator.process"), number)
                    time.sleep(0.1)
                    assert client.status().state in STAYS[state]
                within(12, "noticed", lambda: not client.status().generator.startswith("ready"))
                if state in ("limp", "idle", "moving", "holding"):
                    assert client.gesture("nod").done  # the library needs no generator
            client.reset()
            client.wait_for("limp", timeout_s=5)
            within(60, "back", lambda: client.status().generator.startswith("ready"))
            client.arm()
            assert client.say("nod twice").done
        assert daemon.terminate() == 0
        assert json.loads(daemon.audit.read_text())["violations"] == 0
    finally:
        daemon.close()


def test_a_command_under_way_when_the_bus_process_dies_ends_once(servos):
    daemon = daemon_on(servos)
    try:
        with daemon.client() as client, daemon.client() as watcher, contextlib.closing(
            watcher.watch("v1/event")
        ) as watched:  # fmt: skip
            client.arm()
            client.say("wave", seconds=5.0, wait=False, command_id="dying")
            client.wait_for("moving", timeout_s=5)
            os.kill(child_pid(daemon, "daemon.control.process"), signal.SIGKILL)
            heard = []
            with contextlib.suppress(NoAnswerError, CancelledByError):
                end_s = time.monotonic() + 4
                while time.monotonic() < end_s:
                    _, event = next(watched)
                    heard += [event] if event.id == "dying" and event.terminal else []
                    if heard and time.monotonic() > end_s - 2:
                        break
                    client.status()
            assert [type(e) for e in heard] == [ev.Failed] and heard[0].code == "fault"
    finally:
        daemon.close()


def _gone(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat") as f:
            return f.read().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True
