"""The main job with the shipped model: texts over ZeroMQ move simulated servos, are recorded and replayed."""

from __future__ import annotations

import contextlib
import io
import json
import socket
import subprocess
import sys
import time

import pytest

from daemon.cli import main
from daemon.client import RefusedError
from daemon.scheduling.command_queue import SHADOW_S
from daemon.wire.events import Accepted, Ack, Cancelled, Done, Progress
from daemon.wire.requests import Say
from mmm_core.inference.checkpoint import MODEL_FILE
from tests.support.harness import RATE_HZ, START_TIMEOUT_S, RunningDaemon, keeps_to_its_path, mmmd, slow_reference

pytestmark = [
    pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout"),
    pytest.mark.timeout(240),
    pytest.mark.realtime,
]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A recorded run of the shipped model; the tests of this module share it."""
    log = tmp_path_factory.mktemp("run") / "run.mcap"
    daemon = RunningDaemon("--log", str(log), model=True)
    daemon.log = log
    try:
        daemon.said_early = said_early(daemon)
        yield daemon.until_ready()
    finally:
        daemon.close()


def said_early(daemon):
    """A text that is said as soon as the daemon takes texts, while its generator loads the model."""
    end_s = time.monotonic() + START_TIMEOUT_S
    while "ready: robot" not in daemon.said:
        assert daemon.process.poll() is None and time.monotonic() < end_s, daemon.said
        time.sleep(0.05)
    return daemon.mmmd("say", "nod", "--no-wait")


def test_a_text_that_waits_for_the_model_says_so(run):
    """`mmmd say` right after the start wrote nothing for six seconds."""
    assert "the motion model is being loaded" in run.said_early.stderr
    assert "being loaded" not in run.mmmd("say", "nod", "--no-wait").stderr


def test_three_texts_one_of_them_during_a_motion(run):
    with run.client() as robot:
        first = robot.say("wave with your right hand", seconds=2.0)
        assert first.events[0].status == "accepted" and "wave" in first.events[0].understood
        assert isinstance(first.done, Done) and keeps_to_its_path(first.done)
        overtaken = robot.events_of(Say(id="overtaken", text="raise your left arm"))
        events = [next(overtaken) for _ in range(2)]
        assert [type(e) for e in events] == [Accepted, Progress]
        with run.client() as other:
            second = other.say("nod twice", seconds=1.6)
        assert second.done is not None and keeps_to_its_path(second.done)
        last = next(overtaken)
        assert isinstance(last, Cancelled) and last.by == f"say {second.id}"


@pytest.mark.long
def test_talking_on_is_done_by_the_client_who_has_talked(run):
    with run.client() as anna, run.client() as bert:
        assert "right" in anna.say("wave with your right hand").events[0].understood
        bert.say("nod twice")
        other = anna.say("again, with the other hand")
        accepted = other.events[0]
        assert accepted.commands == ("wave with your left hand",) and accepted.refers_to
        assert "left" in accepted.understood and "right" not in accepted.understood  # as the motion shows it
        assert "nod" in bert.say("once more").events[0].understood
        going_on = anna.say("keep going", wait=False)
        assert going_on.events[0].commands == ("wave with your left hand",)
        assert isinstance(anna.say("stop that").events[-1], Ack)
        time.sleep(
            2 * SHADOW_S
        )  # the next test's text, which cannot say when it was sent, would count as one from before it
    with run.client() as carla, pytest.raises(RefusedError) as refused:
        carla.say("again")
    assert refused.value.event.code == "nothing_to_refer_to"


def test_out_of_scope_is_rejected_with_a_reason_and_a_score(run):
    result = run.mmmd("say", "walk to the window", "--json")
    event = json.loads(result.stdout)
    assert result.returncode == 1 and event["code"] == "out_of_scope" and event["found"] and event["scope_score"] < 1


def test_three_lines_of_any_language(run):
    """As in the README: a REQ socket, the plain text, an answer."""
    lines = (
        "import zmq, sys; s = zmq.Context().socket(zmq.REQ); s.connect(sys.argv[1])\n"
        "s.send(b'wave with your right hand')\n"
        "print(s.recv().decode())\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", lines, run.endpoints.cmd], capture_output=True, text=True, timeout=30, check=True
    )
    assert json.loads(result.stdout)["type"] == "accepted", result.stdout


def test_the_log_replays_to_the_same_goals(run):
    """Last of the module: ends the daemon, whose audit must be clean, and replays its log."""
    with run.client() as robot:
        robot.wait_for("idle", "holding", timeout_s=20)
    assert run.terminate() == 0
    audit = json.loads(run.audit.read_text())
    assert audit["goals"] > 0 and audit["violations"] == 0 and audit["self_contacts"] == 0
    replayed = mmmd("replay", str(run.log), "--robot", slow_reference(), "--bus", "sim://", "--json", timeout_s=120)
    assert replayed.returncode == 0, replayed.stderr + replayed.stdout
    report = json.loads(replayed.stdout)
    assert report["identical"] and report["goals"] > 5 * RATE_HZ and report["audit"]["violations"] == 0


def free_ports(n: int) -> list[int]:
    sockets = [socket.socket() for _ in range(n)]
    try:
        for s in sockets:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in sockets]
    finally:
        for s in sockets:
            s.close()


def test_a_checkpoint_that_is_none_is_told_before_anything_starts(tmp_path):
    """Nothing stands in for the model: it was restarted for ever, and the daemon said that it was ready."""
    broken = tmp_path / "model.safetensors"
    broken.write_bytes(b"no weights")
    said, complaints = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complaints):
        status = main(["run", "--model", str(broken)])
    assert status == 2 and str(broken) in complaints.getvalue() and "no safetensors file" in complaints.getvalue()
    assert "ready" not in said.getvalue() + complaints.getvalue().replace("no safetensors", "")
