"""Commands to a running daemon: what they print, their exit statuses, and that each message is one line that leads on."""

from __future__ import annotations

import json
import subprocess
import time

import pytest

from tests.support.harness import MMMD, running_daemon

pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def running():
    with running_daemon() as daemon:
        yield daemon


def test_the_session_of_the_readme(running):
    said = running.mmmd("say", "wave with your right hand")
    assert said.returncode == 0
    assert said.stdout.splitlines()[0].startswith("accepted: moves the right hand to the side")
    assert said.stdout.splitlines()[-1].startswith("done: shown: moves the right hand to the side")
    assert "reference on sim://" in running.mmmd("status").stdout
    end = time.monotonic() + 20
    while (
        json.loads(running.mmmd("status", "--json").stdout)["state"] != "idle"
    ):  # on a busy machine the motion fades later
        assert time.monotonic() < end, running.mmmd("status").stdout
    for verb, after in (("stop", "idle"), ("estop", "in e-stop"), ("reset", "limp"), ("arm", "idle"), ("park", "limp")):
        result = running.mmmd(verb)
        assert result.returncode == 0, result.stderr
        assert f"is {after}" in result.stdout, result.stdout


@pytest.mark.long
def test_json_of_the_commands(running):
    status = json.loads(running.mmmd("status", "--json").stdout)
    assert status["type"] == "state" and status["v"] == 1 and status["robot"] == "reference"
    lines = [json.loads(line) for line in running.mmmd("say", "left wave", "--json").stdout.splitlines()]
    assert lines[0]["type"] == "accepted" and lines[-1]["type"] == "done"
    watched = running.mmmd("watch", "--json", "--n", "3")
    assert watched.returncode == 0 and len([json.loads(line) for line in watched.stdout.splitlines()]) == 3


def test_a_refused_text_is_one_message_and_status_1(running):
    result = running.mmmd("say", "do a somersault")
    assert result.returncode == 1 and result.stdout == ""
    assert "legs" in result.stderr and result.stderr.count("\n") == 1
    event = json.loads(running.mmmd("say", "do a somersault", "--json").stdout)
    assert event["type"] == "rejected" and event["code"] == "out_of_scope"


def mmmd(*arguments: str, text: str | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*MMMD, *arguments], input=text, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.long
def test_a_port_in_use_is_status_1_so_that_a_service_tries_again(running):
    again = mmmd("run", *running.at, "--stream", running.endpoints.stream)
    assert again.returncode == 1 and running.endpoints.cmd in again.stderr and "already in use" in again.stderr


def test_a_look_says_that_it_is_held_and_status_shows_it(running):
    """After a `look` the head did not follow texts any more, and plain `status` did not say why."""
    told = running.mmmd("look", "--yaw", "30", "--pitch", "-10")
    assert told.stdout.startswith("look: 30 degrees left, 10 degrees up, held until `mmmd look` without angles")
    assert "30 degrees left, 10 degrees up, held until `mmmd look`" in running.mmmd("status").stdout
    assert running.mmmd("look").stdout.startswith("look: the head is free again")
    assert running.mmmd("look", "--yaw", "500").returncode == 2


def test_answers_say_what_became_of_the_robot(running):
    with running.armed():
        pass
    assert running.mmmd("stop").stdout.startswith("stop: the robot ")
    assert "any more; the robot is " in running.mmmd("idle", "off").stdout
    assert running.mmmd("gesture", "play", "nosuch").returncode == 2


def test_a_fault_is_left_by_reset_and_then_arm(running):
    """`status` in an e-stop or fault named `arm`, which is refused there."""
    with running.armed() as client:
        client.estop()
        client.wait_for("estop", timeout_s=20)
        assert "needs `mmmd reset`, then `mmmd arm`" in " ".join(running.mmmd("status").stdout.split())
        client.reset()
        client.wait_for("limp", timeout_s=20)
        assert "(needs `mmmd arm`)" in " ".join(running.mmmd("status").stdout.split())


@pytest.mark.long
def test_a_stream_of_wrong_joints_alone_is_status_1(running):
    with running.armed():
        done = mmmd("stream", *running.at, text='{"nojoint": 1}\n' * 3)
    assert done.returncode == 1 and "nojoint" in done.stdout, done
