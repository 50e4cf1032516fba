"""The recorder and the generator killed and frozen in states of the robot, as listed in docs/safety.md.

The recorder is lost in some of the states here and in all of them in the soak run; the generator in all in the soak run, and in
test_compositions.py it is killed in a story and frozen in a motion.
"""

from __future__ import annotations

import json
import os
import signal
import time

import pytest

from tests.end_to_end.test_start_and_end import child_pid
from tests.support.harness import RunningDaemon
from tests.support.robot_states import ALL_STATES, FAULT_WITHIN_S, STATES, STAYS, bring_to, within
from tests.support.sizes import some_and_all

pytestmark = [pytest.mark.timeout(180), pytest.mark.realtime]


@pytest.mark.parametrize(
    "states", [*some_and_all(("moving",), STATES), pytest.param(("idle",), id="idle", marks=pytest.mark.long)]
)
def test_the_recorder_killed_and_frozen_changes_nothing_for_the_robot(tmp_path, states):
    daemon = RunningDaemon("--log", str(tmp_path / "run.mcap")).until_ready()
    try:
        with daemon.client() as client:
            recorder = child_pid(daemon, "daemon.recording.recorder")
            os.kill(recorder, signal.SIGSTOP)
            for state in states:
                bring_to(client, state)
            os.kill(recorder, signal.SIGCONT)
            bring_to(client, "moving")
            os.kill(recorder, signal.SIGKILL)
            assert client.say("wave", seconds=0.8).done
            within(3, "said", lambda: "stopped" in client.status().recording)
            within(5, "reported", lambda: "recording ended" in daemon.said)
        assert daemon.terminate() == 0
        assert json.loads(daemon.audit.read_text())["violations"] == 0
    finally:
        daemon.close()


@pytest.mark.soak  # test_compositions.py kills it in a story and, in `make test-long`, freezes it in a motion
def test_the_generator_killed_and_frozen_in_each_state_is_started_again():
    """Frozen for good in the first state, killed in the others.

    On servos in the bus process: loading a model again and again takes the processor from others.
    """
    daemon = RunningDaemon(model=True).until_ready()
    try:
        with daemon.client() as client:
            for k, state in enumerate(("idle", *ALL_STATES)):
                within(60, "ready", lambda: client.status().generator.startswith("ready"))
                if state == "fault":
                    bring_to(client, "idle")
                    os.kill(child_pid(daemon, "daemon.control.process"), signal.SIGKILL)
                    within(FAULT_WITHIN_S, "named", lambda: "reset" in client.status().reason)
                else:
                    bring_to(client, state)
                for number in (signal.SIGSTOP, signal.SIGCONT, signal.SIGKILL) if k else (signal.SIGSTOP,):
                    os.kill(child_pid(daemon, "daemon.generator.process"), number)
                    time.sleep(0.1)
                    assert client.status().state in STAYS[state]
                within(12, "noticed", lambda: not client.status().generator.startswith("ready"))
                if state in ("limp", "idle", "moving", "holding"):
                    assert client.gesture("nod").done  # the library needs no generator
            bring_to(client, "limp")
            within(60, "back", lambda: client.status().generator.startswith("ready"))
            client.arm()
            assert client.say("nod twice").done
        assert daemon.terminate() == 0
        assert json.loads(daemon.audit.read_text())["violations"] == 0
    finally:
        daemon.close()
