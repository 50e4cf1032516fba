"""The bus process killed and frozen, the bus unplugged, in states of the robot, as listed in docs/safety.md.

Each ends in a named safe state in time, every limit kept: some states each in `make test`, more in `make test-long`, all eight in
the soak run.
"""

from __future__ import annotations

import contextlib
import os
import signal
import time
from pathlib import Path

import pytest

from daemon.client import CancelledByError, NoAnswerError, RefusedError
from daemon.wire import events as ev
from tests.end_to_end.test_start_and_end import child_pid
from tests.support.harness import mmmd
from tests.support.robot_states import (
    ALL_STATES,
    FAULT_WITHIN_S,
    STAYS,
    SharedDaemon,
    assert_works,
    daemon_on,
    lead_to,
    within,
)
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]


def unplug_and_plug_in(client, servos, state: str) -> None:
    """In this state: a named fault, and after `reset` a robot that works."""
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
    servos.assert_kept()


@pytest.mark.long
@pytest.mark.parametrize(
    "state", [pytest.param(s, marks=() if s == "moving" else pytest.mark.soak) for s in ALL_STATES]
)
def test_a_recorder_killed_before_the_bus_is_unplugged_changes_nothing(servos, state, tmp_path):
    daemon = daemon_on(servos, "--log", str(tmp_path / "run.mcap"))
    try:
        with daemon.client() as client:
            lead_to(client, servos, state)
            os.kill(child_pid(daemon, "daemon.recording.recorder"), signal.SIGKILL)
            within(3, "said", lambda: "stopped" in client.status().recording)
            assert client.status().state in STAYS[state]
            unplug_and_plug_in(client, servos, state)
            assert "stopped" in client.status().recording
        assert daemon.terminate() == 0
    finally:
        daemon.close()


@pytest.mark.parametrize(
    ("number", "states"),
    [
        pytest.param(signal.SIGKILL, ("arming", "moving"), id="killed", marks=pytest.mark.long),
        pytest.param(signal.SIGSTOP, ("moving",), id="frozen"),
        pytest.param(signal.SIGSTOP, ("fault",), id="frozen in a fault", marks=pytest.mark.long),
        pytest.param(signal.SIGKILL, ALL_STATES, id="killed in all", marks=pytest.mark.soak),
        pytest.param(signal.SIGSTOP, ALL_STATES, id="frozen in all", marks=pytest.mark.soak),
    ],
)
def test_the_bus_process_in_any_state_ends_in_a_fault_that_can_be_reset(shared: SharedDaemon, number, states):
    with shared.client() as client:
        for state in states:
            lead_to(client, shared.servos, state)
            bus = child_pid(shared.daemon, "daemon.control.process")
            os.kill(bus, number)
            within(FAULT_WITHIN_S, f"{state}: fault", lambda: client.status().state == "fault")
            within(FAULT_WITHIN_S, f"{state}: its command ends", lambda: client.status().command is None)
            assert client.status().must_arm
            within(FAULT_WITHIN_S, f"{state}: named", lambda: "reset" in client.status().reason)
            with pytest.raises(RefusedError, match="mmmd reset"):
                client.say("wave")
            client.reset()
            client.wait_for("limp", timeout_s=3)
            within(2, f"{state}: no torque", lambda: not shared.servos.torque)
            shared.servos.assert_kept()
        assert_works(client)


@pytest.mark.parametrize("state", few_and_long(["moving"], ["limp", "parking"]))
def test_a_bus_unplugged_is_a_named_fault_and_comes_back(shared: SharedDaemon, state):
    with shared.client() as client:
        lead_to(client, shared.servos, state)
        unplug_and_plug_in(client, shared.servos, state)


@pytest.mark.long
def test_a_second_daemon_is_told_which_process_has_the_port(shared: SharedDaemon, tmp_path):
    """And which port; it ends with a status that systemd tries again."""
    ends = [f"--{name}=ipc://{tmp_path}/{name}" for name in ("cmd", "ctl", "pub")]
    second = mmmd("run", "--bus", shared.servos.url, "--generator", f"ipc://{tmp_path}/gen", *ends, timeout_s=60)
    assert second.returncode == 1
    link = Path(shared.servos.url.removeprefix("dxl://").partition("?")[0])
    assert str(link) in second.stderr or str(link.resolve()) in second.stderr
    assert f"in use by process {child_pid(shared.daemon, 'daemon.control.process')}" in second.stderr


@pytest.mark.long
def test_a_bus_process_that_dies_ends_the_command_once_and_is_status_3(shared: SharedDaemon):
    """Last of the module: ends the daemon."""
    daemon = shared.daemon
    with shared.client() as client, daemon.client() as watcher, contextlib.closing(
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
        assert "bus process" in client.wait_for("fault", timeout_s=5).reason
    refused = daemon.mmmd("say", "wave")
    assert refused.returncode == 3 and "fault" in refused.stderr
    assert daemon.mmmd("status").returncode == 3
    assert daemon.terminate() == 3
