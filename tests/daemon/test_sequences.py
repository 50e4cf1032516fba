"""Random sequences of commands against the table of states: what it allows is carried out, what it does not is refused."""

from __future__ import annotations

import json
import random
import time

import pytest

from daemon.client import Client, RefusedError
from daemon.state import TRANSITIONS, RobotState, Trigger
from tests.end_to_end.harness import RunningDaemon

pytestmark = pytest.mark.timeout(120)
VERBS = ("say", "gesture", "arm", "park", "stop", "estop", "reset", "look", "idle", "cancel")
LEADS_TO = {
    RobotState.ARMING: {"idle", "moving", "holding"},
    RobotState.MOVING: {"moving", "idle"},
    RobotState.PARKING: {"limp"},
    RobotState.HOLDING: {"holding"},
}
"""Where a state that does not last ends when nobody interferes; the others last."""
STEPS = 40


def settled(client: Client) -> str:
    """The state once arming, parking and braking are over."""
    end_s = time.monotonic() + 10
    while (state := client.status().state) in ("arming", "parking"):
        assert time.monotonic() < end_s, state
        time.sleep(0.02)
    return state


def give(client: Client, verb: str) -> None:
    """Give one command without waiting for its end."""
    if verb == "say":
        client.say("wave", seconds=1.5, wait=False)
    elif verb == "gesture":
        client.gesture("nod", wait=False)
    elif verb in ("look", "idle"):
        getattr(client, verb)()
    elif verb == "cancel":
        try:
            client.cancel()
        except RefusedError as error:
            assert error.code == "not_running"
    else:
        getattr(client, verb)(wait=False)


@pytest.mark.parametrize("seed", [1, 2])
def test_random_sequences_keep_to_the_table(seed):
    rng = random.Random(seed)
    daemon = RunningDaemon("--idle", "calm")
    told: list[str] = []
    try:
        daemon.until_ready()
        with daemon.client() as client:
            for _ in range(STEPS):
                verb = rng.choice(VERBS)
                before = settled(client)
                status = client.status()
                told.append(f"{verb} in {before}")
                trigger = {"gesture": Trigger.SAY}.get(verb) or next((t for t in Trigger if t.value == verb), None)
                must_arm = status.must_arm and before == "limp" and trigger is Trigger.SAY
                allowed = trigger is None or (trigger in TRANSITIONS[RobotState(before)] and not must_arm)
                try:
                    give(client, verb)
                    assert allowed, told
                except RefusedError as error:
                    assert not allowed and error.code == "wrong_state", (told, str(error))
                    assert client.status().state == before, told
                    continue
                if trigger is None:
                    assert settled(client) in (before, "idle", "moving", "holding"), told
                    continue
                following = TRANSITIONS[RobotState(before)][trigger]
                expected = LEADS_TO.get(following, {following.value}) | ({"idle"} if before == "moving" else set())
                if trigger is Trigger.SAY:
                    expected |= {"moving", "idle"}
                end_s = time.monotonic() + 5
                while settled(client) not in expected:
                    assert time.monotonic() < end_s, (
                        told[-8:],
                        settled(client),
                        expected,
                        "".join(daemon.said)[-1500:],
                    )
                    time.sleep(0.02)
                if rng.random() < 0.3:
                    time.sleep(rng.uniform(0, 1.5))
            client.estop()
            client.reset()
        assert daemon.terminate() == 0

        assert json.loads(daemon.audit.read_text())["violations"] == 0
        assert "Traceback" not in daemon.said and "cannot follow" not in daemon.said
    finally:
        daemon.close()
