"""Processes and servos that fail under a running daemon: each ends in a named, safe state, and every command ends."""

from __future__ import annotations

import json
import signal
import threading
import time
from pathlib import Path

import pytest

from daemon.client import CancelledByError, RefusedError
from tests.support.harness import RunningDaemon
from tests.support.robot_states import within

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]


def faulty(tmp_path: Path, **fault: object) -> str:
    """A bus URL with one fault; its time runs from the simulator's start."""
    path = tmp_path / "faults.toml"
    path.write_text("[[fault]]\n" + "".join(f"{k} = {json.dumps(v)}\n" for k, v in fault.items()))
    return f"sim://?faults={path}&audit={tmp_path / 'audit.json'}"


def test_a_frozen_front_means_hold_then_park_and_it_goes_on_when_it_is_back():
    daemon = RunningDaemon()
    try:
        daemon.until_ready()
        assert daemon.mmmd("say", "wave", "--seconds", "9", "--no-wait").returncode == 0
        with daemon.client() as client:
            client.wait_for("moving", timeout_s=10)
        daemon.process.send_signal(signal.SIGSTOP)
        within(15, "parked", lambda: "PARKING -> LIMP" in daemon.said)
        daemon.process.send_signal(signal.SIGCONT)
        with daemon.client() as client:
            client.wait_for("limp", timeout_s=5)
            within(3, "the command has ended", lambda: client.status().command is None)
            assert client.say("wave").done
        assert daemon.terminate() == 0
        assert json.loads(daemon.audit.read_text())["violations"] == 0
    finally:
        daemon.process.send_signal(signal.SIGCONT)
        daemon.close()


@pytest.mark.parametrize("kind", ["trip", pytest.param("unplug", marks=pytest.mark.soak)])
def test_a_servo_that_trips_and_a_bus_that_goes_end_the_command_in_fault(tmp_path, kind):
    fault = {"kind": kind, "start_s": 6.0} | ({"servo_id": 3} if kind == "trip" else {})
    daemon = RunningDaemon(bus=faulty(tmp_path, **fault))
    try:
        daemon.until_ready()
        with daemon.client() as client:
            with pytest.raises(RefusedError) as caught:
                for _ in range(20):
                    client.say("wave", seconds=2.0)
            assert caught.value.event.code == "fault" and caught.value.exit_status == 3
            status = client.wait_for("fault", timeout_s=3)
            assert status.must_arm and status.reason
            with pytest.raises(RefusedError, match="mmmd reset"):
                client.say("wave")
        assert daemon.mmmd("status").returncode == 3
        assert daemon.terminate() == 3
        assert json.loads((tmp_path / "audit.json").read_text())["violations"] == 0
    finally:
        daemon.close()


def test_a_servo_that_does_not_answer_when_arming_is_a_fault_before_anything_moves(tmp_path):
    daemon = RunningDaemon(bus=faulty(tmp_path, kind="silent", servo_id=5, start_s=4.0))
    try:
        daemon.until_ready()
        time.sleep(4.0)  # the simulator's own clock: the servo is silent from here on
        with daemon.client() as client, pytest.raises(RefusedError) as caught:
            client.say("wave")
        assert caught.value.code == "fault" and "5" in str(caught.value)
        assert daemon.terminate() == 3
    finally:
        daemon.close()


def test_lost_and_broken_replies_change_nothing_that_people_see(tmp_path):
    daemon = RunningDaemon(bus=faulty(tmp_path, kind="drop", probability=0.01))
    try:
        daemon.until_ready()
        with daemon.client() as client:
            assert client.say("wave").done.gate_clipped_frames == 0
        assert daemon.terminate() == 0
        assert json.loads((tmp_path / "audit.json").read_text())["violations"] == 0
    finally:
        daemon.close()


def test_a_frozen_generator_is_a_named_failure_and_is_noticed_again():
    """The generator of somebody else: nothing to start again, but texts fail in bounded time and then work."""
    frozen = threading.Event()

    def answer(text, seed, seconds):
        from tests.support.kinematic import generate

        if "frost" in text:
            frozen.wait(14)
        return generate(text, seed, seconds)

    daemon = RunningDaemon(answer=answer)
    try:
        daemon.until_ready()
        with daemon.client() as client:
            client.arm()
            outcome: list[Exception] = []

            def freeze() -> None:
                with daemon.client() as other:
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
            frozen.set()
            within(15, "the generator answers", lambda: client.status().generator.startswith("ready"))
            assert client.say("wave").done
        assert daemon.terminate() == 0
    finally:
        daemon.close()
