"""Whole daemons: an e-stop is carried out whichever process is frozen or dead, and the loss of who takes e-stops is one.

The servos are behind a real tty and outlive the daemon's processes; their audit watches all the time.
"""

from __future__ import annotations

import contextlib
import os
import signal
import time
import uuid

import pytest
import zmq

from daemon.bench.floods import flooded
from daemon.client import NoAnswerError, RefusedError
from daemon.host.realtime import CONTROL_PRIORITY, may_fifo
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire.requests import Estop
from tests.end_to_end.test_start_and_end import child_pid
from tests.support.harness import RunningDaemon
from tests.support.robot_states import SharedDaemon, assert_works, bring_to, daemon_on, gone, lead_to, within
from tests.support.sizes import some_and_all

pytestmark = [pytest.mark.timeout(240), pytest.mark.realtime]
BACK_WITHIN_S = 40.0
"""Until a process that was lost serves again, on a machine that has much else to do."""


class Person:
    """Presses the button: one socket to `ctl`, which was connected before anything went wrong."""

    def __init__(self, daemon: RunningDaemon) -> None:
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.connect(daemon.endpoints.ctl)

    def estop(self) -> str:
        name = uuid.uuid4().hex
        self._socket.send(wire.encode(Estop(id=name)))
        return name

    def hears(self, kind: type[ev.Event], name: str, within_s: float) -> ev.AnyEvent:
        end_s = time.monotonic() + within_s
        while self._socket.poll(max(0, int(1000 * (end_s - time.monotonic())))):
            event = wire.decode_event(self._socket.recv())
            if event.id == name and isinstance(event, kind):
                return event
        raise AssertionError(f"no {kind.__name__} within {within_s} s")

    def close(self) -> None:
        self._context.destroy(linger=0)


@pytest.mark.long
def test_a_killed_front_keeps_no_estop_from_the_bus_process(servos):
    daemon = daemon_on(servos)
    person = Person(daemon)
    try:
        with daemon.client() as client:
            lead_to(client, servos, "moving")
        bus, ctl = child_pid(daemon, "daemon.control.process"), child_pid(daemon, "daemon.ctl.process")
        daemon.process.kill()
        assert person.hears(ev.Ack, person.estop(), 5.0).carried_out
        within(1.0, "no torque", lambda: not servos.torque)
        daemon.process.wait(5)
        within(40.0, "no process is left", lambda: gone(bus) and gone(ctl))
        servos.assert_kept()
    finally:
        person.close()
        daemon.close()


def test_a_frozen_front_keeps_no_estop_from_the_bus_process(shared: SharedDaemon):
    daemon, person = shared.daemon, Person(shared.daemon)
    try:
        with shared.client() as client:
            lead_to(client, shared.servos, "moving")
        daemon.process.send_signal(signal.SIGSTOP)
        assert person.hears(ev.Ack, person.estop(), 5.0).carried_out
        within(1.0, "no torque", lambda: not shared.servos.torque)
        daemon.process.send_signal(signal.SIGCONT)
        with shared.client() as client:
            client.wait_for("estop", timeout_s=5)
            within(3.0, "its command ends", lambda: client.status().command is None)
            client.reset()
            client.wait_for("limp", timeout_s=5)
            assert_works(client)
    finally:
        daemon.process.send_signal(signal.SIGCONT)
        person.close()


def test_a_bus_process_frozen_in_its_start_keeps_no_estop_undone(shared: SharedDaemon):
    """The daemon once gave such a process up after 20 s, in which the servos kept their torque."""
    daemon, person = shared.daemon, Person(shared.daemon)
    try:
        with shared.client() as client:
            lead_to(client, shared.servos, "moving")
        lost, frozen = child_pid(daemon, "daemon.control.process"), list[int]()
        os.kill(lost, signal.SIGKILL)

        def is_frozen_in_its_start() -> bool:
            with contextlib.suppress(AssertionError):  # none runs yet
                frozen.append(child_pid(daemon, "daemon.control.process"))
                os.kill(frozen[-1], signal.SIGSTOP)
            return bool(frozen) and frozen[-1] != lost

        within(BACK_WITHIN_S, "it starts again", is_frozen_in_its_start)
        name = person.estop()
        within(BACK_WITHIN_S, "it is killed", lambda: gone(frozen[-1]))
        within(BACK_WITHIN_S, "it says why", lambda: "frozen for" in daemon.said)
        assert person.hears(ev.CarriedOut, name, BACK_WITHIN_S)
        within(1.0, "no torque", lambda: not shared.servos.torque)
        with shared.client() as client:

            def is_reset() -> bool:
                with contextlib.suppress(RefusedError):  # "the bus process is being started again; wait a second"
                    client.reset()
                    return True
                return False

            within(BACK_WITHIN_S, "it is reset", is_reset)
            client.wait_for("limp", timeout_s=5)
            assert_works(client)
    finally:
        person.close()


@pytest.mark.long
def test_a_flood_of_subscriptions_keeps_no_estop_from_the_robot(shared: SharedDaemon):
    """One such subscriber kept an e-stop from the robot for 12 s and more."""
    person = Person(shared.daemon)
    try:
        with shared.client() as client:
            lead_to(client, shared.servos, "moving")
        with flooded("pub", shared.daemon.endpoints.pub):
            time.sleep(1.0)
            assert person.hears(ev.Ack, person.estop(), 5.0).carried_out
            within(1.0, "no torque", lambda: not shared.servos.torque)
    finally:
        person.close()


@pytest.mark.skipif(not may_fifo(CONTROL_PRIORITY), reason="this user may not have FIFO priority")
def test_no_thread_of_ctl_waits_for_a_core_while_it_has_the_interpreter(shared: SharedDaemon):
    """The thread that watches connections had normal priority: on a busy machine ctl fell silent with it, an e-stop."""
    threads = os.listdir(f"/proc/{child_pid(shared.daemon, 'daemon.ctl.process')}/task")
    assert len(threads) > 2
    assert {os.sched_getparam(int(thread)).sched_priority for thread in threads} == {CONTROL_PRIORITY}


@pytest.mark.parametrize(
    "number",
    [pytest.param(signal.SIGKILL, id="killed"), pytest.param(signal.SIGSTOP, id="frozen", marks=pytest.mark.long)],
)
@pytest.mark.parametrize("states", some_and_all(("moving",), ("moving", "limp")))
def test_the_loss_of_the_ctl_process_is_an_estop_and_it_is_restarted(shared: SharedDaemon, number, states):
    with shared.client() as client:
        for state in states:
            bring_to(client, state)
            os.kill(child_pid(shared.daemon, "daemon.ctl.process"), number)
            within(1.0, "no torque", lambda: not shared.servos.torque)
            within(BACK_WITHIN_S, "estop", lambda: _state(client) == "estop")
            assert "nobody took e-stops" in client.status().reason
            client.reset()
            client.wait_for("limp", timeout_s=5)
            shared.servos.assert_kept()
        assert_works(client)


@pytest.mark.parametrize(
    ("number", "after_s"),
    [
        pytest.param(signal.SIGKILL, 0.6, marks=pytest.mark.long),
        pytest.param(signal.SIGSTOP, 0.02, marks=pytest.mark.long),
        pytest.param(signal.SIGKILL, 0.02, marks=pytest.mark.soak),
        pytest.param(signal.SIGSTOP, 0.6, marks=pytest.mark.soak),
    ],
)
def test_an_estop_without_a_bus_process_is_owed_to_the_next_one(shared: SharedDaemon, number, after_s):
    """Of nine e-stops given so all nine were acknowledged, and none was carried out."""
    person = Person(shared.daemon)
    try:
        with shared.client() as client:
            lead_to(client, shared.servos, "moving")
            os.kill(child_pid(shared.daemon, "daemon.control.process"), number)
            time.sleep(after_s)
            name = person.estop()
            assert person.hears(ev.Ack, name, 5.0).carried_out is False
            assert shared.servos.torque, "nobody is there to cut it"
            done = person.hears(ev.CarriedOut, name, BACK_WITHIN_S)
            assert done.verb == "estop" and not shared.servos.torque
            client.wait_for("estop", timeout_s=5)
            client.reset()
            client.wait_for("limp", timeout_s=5)
            assert_works(client)
    finally:
        person.close()


def test_a_latched_estop_at_the_end_is_status_3(shared: SharedDaemon):
    """Last of the module: ends the daemon."""
    assert shared.daemon.mmmd("estop").returncode == 0
    assert shared.daemon.terminate() == 3


def _state(client) -> str:
    try:
        return client.status().state
    except NoAnswerError:
        return "no answer"
