"""Streaming programs that are silent, killed, wrong, thieves or adversaries: the robot brakes, holds and touches nothing."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import zmq

from daemon.client import Client, RefusedError
from daemon.client.streams import Stream
from daemon.wire import events as ev
from tests.support.robot_states import within
from tests.support.streaming import LIMP_S, PARK_S, PERIOD_S, fed, lease_is, stages, until_still, wave

pytestmark = pytest.mark.realtime


def test_silence_brakes_and_holds_then_parks_then_limp(robot):
    rest = robot.status().goal_rad
    with pytest.raises(RefusedError) as caught, robot.stream("sleepy") as stream:
        wave(robot, stream, 0.4)
        within(10, "silent", lambda: lease_is(robot, "silent"))
        held = until_still(robot)
        assert robot.status().stream.lease.held_by == "silence"

        def goes_on() -> bool:
            stream.send([q + 0.1 for q in rest])
            return lease_is(robot, "streaming") and robot.status().goal_rad != held

        within(10, "a target after silence moves it again", goes_on)
        silent_s = time.monotonic()
        parking = robot.wait_for("parking", timeout_s=20)
        assert parking.stream.lease is None and parking.command is None
        robot.wait_for("limp", timeout_s=20)
        assert time.monotonic() - silent_s > LIMP_S
        stream.send(rest)
    assert caught.value.code == "lease_silent"
    assert "silent" in stages(stream)


@pytest.mark.long
def test_a_command_waiting_for_a_silent_lease_is_played_before_parking(robot, running):
    with pytest.raises(RefusedError) as caught, robot.stream("in the way") as stream, running.client() as other:
        stream.send(robot.status().goal_rad)
        said = other.say("wave", when="after", timeout_s=PARK_S + 20)
        assert said.done
        stream.send(robot.status().goal_rad)
    assert caught.value.code == "lease_silent"
    robot.wait_for("idle", "holding", timeout_s=3)


def test_a_lease_may_name_a_shorter_silence(robot):
    ends = robot.endpoints
    with contextlib.suppress(RefusedError), robot.stream("quick", silence_s=0.05) as stream:  # over, where all is slow
        stream.send(robot.status().goal_rad)
        stream.until(lambda event: isinstance(event, ev.Progress) and event.stage == "silent", 10, ends.cmd)
    assert stream.news.events[0].silence_s == 0.05
    silent = [e.reason for e in stream.news.events if isinstance(e, ev.Progress) and e.stage == "silent"]
    assert silent and "no target for 0.05 s" in silent[0]


def send_bad_ones(robot: Client, raw: zmq.Socket[bytes], stream: Stream) -> None:
    """One frame of each kind, until it is counted."""
    rest, names = robot.status().goal_rad, robot.status().joint_names
    good = {"type": "target", "id": stream.news.id, "secret": stream.news.secret}
    for frame in (
        b"wave", b'{"type": "target"}', {**good, "q_rad": [0.0] * (len(rest) + 1)}, {**good, "q_rad": {"tail": 1.0}},
        {**good, "q_rad": {names[0]: 5000.0}}, {**good, "id": "stolen", "q_rad": rest},
    ):  # fmt: skip
        data = frame if isinstance(frame, bytes) else json.dumps(frame).encode()
        before = dict(robot.status().stream.bad)

        def counted(data: bytes = data, before: dict[str, int] = before) -> bool:
            raw.send(data)
            return robot.status().stream.bad != before

        within(20, f"{data!r} is counted", counted)


def test_bad_messages_are_counted_and_named_and_move_nothing(robot, running):
    context = zmq.Context()
    raw = context.socket(zmq.PUB)
    raw.connect(running.endpoints.stream)
    try:
        before = dict(robot.status().stream.bad)
        with robot.stream("careful") as stream:
            rest = until_still(robot)
            with fed(stream, rest):  # bad messages are no sign of life
                send_bad_ones(robot, raw, stream)
            assert robot.status().goal_rad == pytest.approx(rest, abs=1e-6)

            def told() -> set[str]:
                stream.send(rest)  # which also hears what has come
                return {e.status for e in stream.news.events if isinstance(e, ev.Progress) and e.stage == "bad_target"}

            within(20, "told", lambda: told() >= {"wrong_number", "unknown_joint", "not_finite"})
        bad = robot.status().stream.bad
        for code in ("bad_json", "bad_value", "wrong_number", "unknown_joint", "not_finite", "no_lease"):
            assert bad.get(code, 0) > before.get(code, 0), (code, bad)
        assert all(e.reason for e in stream.news.events if isinstance(e, ev.Progress) and e.stage == "bad_target")
    finally:
        context.destroy(linger=0)


def test_who_reads_the_id_of_a_lease_on_pub_cannot_lead_the_robot(robot, running):
    """Ids of leases are published, and a target needed no more than that: anybody who reads `pub` could steer."""
    context = zmq.Context()
    thief, listener = context.socket(zmq.PUB), context.socket(zmq.SUB)
    thief.connect(running.endpoints.stream)
    listener.connect(running.endpoints.pub)
    listener.subscribe(b"")
    heard = b""
    try:
        with robot.stream("owner") as stream, fed(stream, rest := robot.status().goal_rad):
            away, secret = [q + 0.3 for q in rest], stream.news.secret
            before, tries = robot.status().stream.bad.get("wrong_secret", 0), 0
            while robot.status().stream.bad.get("wrong_secret", 0) < before + 20:
                status = robot.status()
                guess = f"guess-number-{tries:08}"
                frame = {"type": "target", "id": status.stream.lease.id, "secret": guess, "q_rad": away}
                thief.send(json.dumps(frame).encode())
                tries += 1
                assert tries < 5000
                time.sleep(0.005)
            assert robot.status().goal_rad == pytest.approx(rest, abs=1e-3)
            while listener.poll(0):
                heard += b"".join(listener.recv_multipart())
            assert stream.news.id.encode() in heard and secret.encode() not in heard
            assert secret not in running.said
    finally:
        context.destroy(linger=0)


def test_bad_messages_are_no_sign_of_life(robot):
    with robot.stream("noisy") as stream:
        stream.send(robot.status().goal_rad)
        end_s = time.monotonic() + 0.5
        while time.monotonic() < end_s:
            stream.send({"no such joint": 1.0})
            time.sleep(PERIOD_S)
        assert robot.status().stream.lease.state == "silent"


@pytest.mark.long
def test_random_jumping_streams_stay_off_the_body(robot):
    """The audit at the end of the module is the judge; here it only has to be told when it held."""
    draw = np.random.default_rng(7)
    capabilities = robot.capabilities()
    low = np.array([j.position_min_rad for j in capabilities.joints])
    high = np.array([j.position_max_rad for j in capabilities.joints])
    with robot.stream("adversary") as stream:
        for _ in range(25):
            target = np.where(draw.random(len(low)) < 0.5, draw.uniform(2 * low, 2 * high), draw.uniform(low, high))
            for _ in range(int(draw.integers(1, 12))):
                stream.send(target.tolist())
                time.sleep(PERIOD_S)
        held = [e.reason for e in stream.news.events if isinstance(e, ev.Progress) and e.stage == "held"]
        for _ in range(80):  # back to where parking is short
            stream.send([0.0 if a < 0.0 < b else (a + b) / 2 for a, b in zip(low, high, strict=True)])
            time.sleep(PERIOD_S)
    assert isinstance(stream.news.end, ev.Done)
    assert stream.news.end.clipped_frames > 0
    assert all("self-collision" in reason for reason in held)


KILLED = """
import math, os, sys, time
from daemon.client import Client
from daemon.settings.config import Endpoints
with Client(Endpoints(*sys.argv[1:4])) as robot, robot.stream("doomed") as stream:
    rest, began_s = robot.status().goal_rad, time.monotonic()
    while True:
        t_s = time.monotonic() - began_s
        stream.send([q + 0.4 * math.sin(5 * t_s) for q in rest])
        if t_s > 0.5:
            print("streaming", flush=True)
        time.sleep(0.01)
"""


@pytest.mark.long
def test_a_client_that_is_killed_leaves_no_arm_moving(robot, running):
    ends = running.endpoints
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, ends.cmd, ends.ctl, ends.pub], stdout=subprocess.PIPE, text=True, env=os.environ
    ) as child:
        assert child.stdout is not None and child.stdout.readline() == "streaming\n"
        assert robot.status().state == "moving"
        child.send_signal(signal.SIGKILL)
        child.wait(5)

    def is_held() -> bool:
        lease = robot.status().stream.lease
        return lease is None or lease.held_by == "silence"

    within(1.5, "the arm is held: lease_s is 0.2", is_held)
    goal = until_still(robot)
    time.sleep(0.2)
    now = robot.status()
    assert now.goal_rad == goal or now.stream.lease is None, "it moves, and not on the way to park"
    robot.wait_for("limp", timeout_s=20)
    assert robot.status().stream.lease is None
