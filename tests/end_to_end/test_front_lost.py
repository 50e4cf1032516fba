"""The front frozen and killed in states of the robot, as listed in docs/safety.md: a safe state in time, every limit kept.

Killed in one of the states in `make test`; in two, and frozen in four, in `make test-long`; in all eight in the soak run. In
`make test` a front is frozen in `test_stops.py`.
"""

from __future__ import annotations

import signal
import time

import pytest

from tests.end_to_end.test_start_and_end import child_pid
from tests.support.harness import RunningDaemon
from tests.support.robot_states import (
    ALL_STATES,
    STAYS,
    Servos,
    SharedDaemon,
    assert_works,
    daemon_on,
    gone,
    lead_to,
    within,
)

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]


@pytest.mark.parametrize(
    "states",
    [
        pytest.param(("moving",), id="one"),
        pytest.param(("moving", "estop"), id="two", marks=pytest.mark.long),
        pytest.param(("idle", "moving", "holding", "parking"), id="moving on", marks=pytest.mark.soak),
        pytest.param(("fault", "limp", "arming", "estop"), id="other", marks=pytest.mark.soak),
    ],
)
def test_a_front_killed_in_each_state_leaves_a_limp_robot_no_process(tmp_path, states):
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
            within(15, "bus process gone", lambda bus=bus: gone(bus))
            daemon.process.wait(5)
            servos.assert_kept()
        assert "moving" not in states or any("PARKING -> LIMP" in daemon.said for _, daemon, _ in rigs)
    finally:
        for servos, daemon, _ in rigs:
            daemon.close()
            servos.close()


@pytest.mark.long
@pytest.mark.parametrize(
    "states",
    [
        pytest.param(("moving",), id="moving"),
        pytest.param(("arming", "parking", "estop"), id="some", marks=pytest.mark.long),
        pytest.param(ALL_STATES, id="all", marks=pytest.mark.soak),
    ],
)
def test_the_front_frozen_in_each_state_leaves_a_robot_that_stands(shared: SharedDaemon, states):
    """After 0.5 s the bus process brings to rest what moves; what is being parked is parked."""
    daemon, servos = shared.daemon, shared.servos
    with shared.client() as client:
        for state in states:
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
        lead_to(client, servos, "limp")
        assert_works(client)


@pytest.mark.long
def test_a_frozen_front_means_hold_then_park_and_it_resumes_afterwards(shared: SharedDaemon):
    daemon = shared.daemon
    parked = daemon.said.count("PARKING -> LIMP")
    with shared.client() as client:
        client.arm()
        client.say("wave", seconds=9.0, wait=False)
        client.wait_for("moving", timeout_s=10)
    daemon.process.send_signal(signal.SIGSTOP)
    try:
        within(15, "parked", lambda: daemon.said.count("PARKING -> LIMP") > parked)
    finally:
        daemon.process.send_signal(signal.SIGCONT)
    with shared.client() as client:
        client.wait_for("limp", timeout_s=5)
        within(3, "the command has ended", lambda: client.status().command is None)
        assert client.say("wave").done
