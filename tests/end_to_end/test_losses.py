"""Servos and a generator that fail under a running daemon: each ends in a named, safe state, and every command ends."""

from __future__ import annotations

import threading
import time

import pytest

from daemon.client import CancelledByError, RefusedError
from daemon.generator.generated import Generated
from sim.faults import Fault
from tests.support.harness import keeps_to_its_path
from tests.support.kinematic import generate
from tests.support.robot_states import SharedDaemon, assert_works, within

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime, pytest.mark.long]
FROZEN = threading.Event()
"""Set where the generator need not be frozen any longer."""


def answer(text: str, seed: int, seconds: float | None) -> Generated:
    if "frost" in text:
        FROZEN.wait(14)
    return generate(text, seed, seconds)


@pytest.fixture(scope="module")
def module_daemon(tmp_path_factory):
    made = SharedDaemon(tmp_path_factory.mktemp("shared"), answer=answer)
    yield made
    made.close()


def test_lost_and_broken_replies_change_nothing_that_people_see(shared: SharedDaemon):
    shared.servos.suffer(Fault("drop", probability=0.01))
    with shared.client() as client:
        client.arm()
        assert keeps_to_its_path(client.say("wave").done)
        assert client.status().state != "fault"
    assert shared.servos.bus.faults.struck["drop"]


def test_a_silent_servo_when_arming_is_a_fault_before_anything_moves(shared: SharedDaemon):
    before = shared.servos.bus.audit.report()["goals"]
    shared.servos.suffer(Fault("silent", servo_id=5))
    with shared.client() as client, pytest.raises(RefusedError) as caught:
        client.say("wave")
    assert caught.value.code == "fault" and "5" in str(caught.value)
    assert not shared.servos.torque and shared.servos.bus.audit.report()["goals"] == before


def test_a_frozen_generator_is_a_named_failure_and_is_noticed_again(shared: SharedDaemon):
    """The generator of somebody else: nothing to start again, but texts fail in bounded time and then work."""
    with shared.client() as client:
        client.arm()
        outcome: list[Exception] = []

        def freeze() -> None:
            with shared.client() as other:
                try:
                    other.say("wave through the frost")
                except (RefusedError, CancelledByError) as error:
                    outcome.append(error)

        thread = threading.Thread(target=freeze)
        thread.start()
        time.sleep(0.3)
        began_s = time.monotonic()
        client.stop()  # nothing waits behind the generator
        assert time.monotonic() - began_s < 1
        thread.join(20)
        assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "stop"
        FROZEN.set()
        within(15, "the generator answers", lambda: client.status().generator.startswith("ready"))
        assert client.say("wave").done


@pytest.mark.parametrize("kind", ["trip", pytest.param("unplug", marks=pytest.mark.soak)])
def test_a_servo_that_trips_and_a_bus_that_goes_end_the_command_in_fault(shared: SharedDaemon, kind):
    with shared.client() as client, shared.client() as other:
        client.arm()
        outcome: list[Exception] = []

        def wave() -> None:
            with pytest.raises(RefusedError) as caught:
                other.say("wave", seconds=9.0)
            outcome.append(caught.value)

        thread = threading.Thread(target=wave)
        thread.start()
        client.wait_for("moving", timeout_s=15)
        shared.servos.suffer(Fault(kind, servo_id=3 if kind == "trip" else None))
        thread.join(20)
        assert outcome[0].event.code == "fault" and outcome[0].exit_status == 3
        status = client.wait_for("fault", timeout_s=3)
        assert status.must_arm and status.reason
        with pytest.raises(RefusedError, match="mmmd reset"):
            client.say("wave")
        assert shared.daemon.mmmd("status").returncode == 3
        shared.servos.suffer()
        for servo in shared.servos.bus.servos.values():  # as after its supply was switched off and on
            servo.reboot()
        client.reset()
        client.wait_for("limp", timeout_s=5)
        assert_works(client)
