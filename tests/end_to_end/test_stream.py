"""Joint targets from other programs: a whole daemon, its simulated servos and their audit, clients that behave or do not."""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest
import zmq

from daemon.client import AsyncClient, CancelledByError, Client, RefusedError
from daemon.client.streams import Stream
from daemon.wire import events as ev
from daemon.wire.codec import decode_event, encode
from daemon.wire.requests import Release, Say
from tests.support.harness import MMMD, MOST_CLIPPED_IN_AN_UNDERRUN, RunningDaemon
from tests.support.robot_states import within
from tests.support.sizes import few_and_long

pytestmark = pytest.mark.realtime

PARK_S, LIMP_S = 2.0, 0.4
EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "stream_sine.py"
PERIOD_S = 0.02


@pytest.fixture(scope="module")
def running():
    """One daemon for all; at its end the audit of everything that these tests sent to its servos."""
    daemon = RunningDaemon("--lease-park-s", str(PARK_S), "--lease-limp-s", str(LIMP_S))
    try:
        yield daemon.until_ready()
        assert daemon.terminate() == 0
        report = json.loads(daemon.audit.read_text())
        assert report["goals"] > 0
        assert report["violations"] == 0 and report["self_contacts"] == 0, report
    finally:
        daemon.close()


@pytest.fixture
def robot(running):
    with running.armed() as client:
        yield client


def wave(robot: Client, stream: Stream, seconds: float, rad: float = 0.3) -> int:
    """Send a sine of the first joints about the robot's rest; the number of targets."""
    rest, began_s, n = robot.status().goal_rad, time.monotonic(), 0
    while (t_s := time.monotonic() - began_s) < seconds:
        stream.send([q + rad * math.sin(3 * t_s) for q in rest])
        n += 1
        time.sleep(PERIOD_S)
    return n


@contextlib.contextmanager
def fed(stream: Stream, target_rad: Sequence[float]) -> Iterator[None]:
    """A client that goes on sending, however long the body takes."""
    over = threading.Event()

    def feed() -> None:
        while not over.wait(PERIOD_S):
            stream.send(target_rad)

    thread = threading.Thread(target=feed)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def stages(stream: Stream) -> list[str]:
    return [e.stage for e in stream.news.events if isinstance(e, ev.Progress)]


def lease_is(robot: Client, state: str) -> bool:
    lease = robot.status().stream.lease
    return lease is not None and lease.state == state


def until_still(robot: Client, within_s: float = 3.0) -> list[float]:
    """Wait until two looks show the same goal; the goal."""
    end_s, before = time.monotonic() + within_s, [math.nan]
    while (now := robot.status().goal_rad) != before:
        assert time.monotonic() < end_s, "it still moves"
        before = now
        time.sleep(0.05)
    return before


def test_a_stream_moves_the_robot_and_is_released_with_its_figures(robot):
    with robot.stream("sine") as stream:
        accepted = stream.news.events[0]
        assert isinstance(accepted, ev.Accepted) and accepted.silence_s == 0.2
        sent = wave(robot, stream, 1.0)
        now = robot.status()
        assert now.state == "moving" and now.command.id == stream.news.id
        assert now.stream.lease.holder == "sine" and now.stream.lease.state == "streaming"
        assert 0.5 * sent < now.stream.lease.targets <= sent and now.stream.bad == {}
    done = stream.news.end
    assert isinstance(done, ev.Done) and done.gate_clipped_frames == 0 and done.peak_speed_share > 0.02
    assert 0 < done.first_motion_ms < 1000
    assert robot.status().stream.lease is None


def test_the_asyncio_client_has_the_same(robot, running):
    async def play() -> ev.AnyEvent | None:
        async with AsyncClient(running.endpoints) as other, other.stream("async") as stream:
            rest = (await other.status()).goal_rad
            for k in range(20):
                await stream.send({robot.status().joint_names[0]: rest[0] + 0.01 * k})
                await asyncio.sleep(PERIOD_S)
        return stream.news.end

    assert isinstance(asyncio.run(play()), ev.Done)


def test_a_second_asker_is_told_who_holds_it(robot, running):
    with robot.stream("the first") as stream, running.client() as other:
        stream.send(robot.status().goal_rad)
        with pytest.raises(RefusedError) as caught, other.stream("the second"):
            raise AssertionError("two leases at once")
        assert caught.value.code == "lease_held"
        assert "the first" in str(caught.value) and stream.news.id in str(caught.value)
    with running.client() as other, other.stream("the second"):
        assert other.status().stream.lease.holder == "the second"


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


def test_a_text_that_cannot_be_made_leaves_the_stream_going(robot):
    with robot.stream("undisturbed") as stream:
        wave(robot, stream, 0.3)
        with pytest.raises(RefusedError):
            robot.say("do a somersault")
        wave(robot, stream, 0.3)
        assert robot.status().stream.lease.state == "streaming"
    assert isinstance(stream.news.end, ev.Done)


def test_a_lease_may_name_a_shorter_silence(robot):
    ends = robot.endpoints
    with contextlib.suppress(RefusedError), robot.stream("quick", silence_s=0.05) as stream:  # over, where all is slow
        stream.send(robot.status().goal_rad)
        stream.until(lambda event: isinstance(event, ev.Progress) and event.stage == "silent", 10, ends.cmd)
    assert stream.news.events[0].silence_s == 0.05
    silent = [e.reason for e in stream.news.events if isinstance(e, ev.Progress) and e.stage == "silent"]
    assert silent and "no target for 0.05 s" in silent[0]


def test_a_text_takes_over_and_the_stream_says_no_more(robot):
    with pytest.raises(CancelledByError, match="say"), robot.stream("talkative") as stream:
        wave(robot, stream, 0.5)
        said = robot.say("wave with your right hand", wait=False)
        while True:
            stream.send(robot.status().goal_rad)
            time.sleep(PERIOD_S)
    assert stream.news.end.by == f"say {said.id}"
    robot.wait_for("idle", timeout_s=15)


@pytest.mark.long
def test_a_lease_takes_over_from_a_text_without_a_jolt(robot, running):
    with running.client() as other:
        events = other.events_of(Say(id="barged", text="slow wave"))
        while not (isinstance(event := next(events), ev.Progress) and event.stage == "moving"):
            pass
        with robot.stream("barger") as stream:
            wave(robot, stream, 0.5)
        ended = list(events)
    assert isinstance(ended[-1], ev.Cancelled) and ended[-1].by == f"lease {stream.news.id}"
    end = stream.news.end
    assert isinstance(end, ev.Done)
    assert end.gate_clipped_frames <= 2 + MOST_CLIPPED_IN_AN_UNDERRUN * end.underruns


@pytest.mark.parametrize("verb", few_and_long(["stop", "estop"], ["cancel", "park"]))
def test_what_ends_a_motion_ends_a_lease(robot, verb):
    with pytest.raises(CancelledByError, match=verb), robot.stream("ended") as stream:
        wave(robot, stream, 0.4)
        began_s = time.monotonic()
        {"stop": robot.stop, "cancel": robot.cancel, "park": robot.park, "estop": robot.estop}[verb]()
        assert time.monotonic() - began_s < 30
        time.sleep(0.05)
        goal = until_still(robot)
        for _ in range(10):
            with contextlib.suppress(CancelledByError):
                stream.send([q + 0.2 for q in goal])
            time.sleep(PERIOD_S)
        assert robot.status().goal_rad == goal, "targets of a lease that has ended move nothing"
        stream.send(goal)
    terminal = [e for e in stream.news.events if e.terminal]
    assert len(terminal) == 1


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
            rest = robot.status().goal_rad
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


@pytest.mark.long
def test_the_example_runs(robot, running):
    ends = running.endpoints
    ran = subprocess.run(
        [sys.executable, str(EXAMPLE), "", "1", ends.cmd, ends.ctl, ends.pub], capture_output=True, text=True, timeout=30,
        check=False,
    )  # fmt: skip
    assert ran.returncode == 0 and ran.stdout.startswith("Done("), ran.stderr


def test_the_command_streams_lines_from_its_input(robot, running):
    names, rest = robot.status().joint_names, robot.status().goal_rad
    lines = [json.dumps({names[0]: rest[0] + 0.01 * k}) for k in range(20)] + [json.dumps(rest)]
    command = [*MMMD, "stream", "--rate", "50", "--json", *running.at]
    ran = subprocess.run(command, input="\n".join(lines), capture_output=True, text=True, timeout=30, check=False)
    heard = [json.loads(line) for line in ran.stdout.splitlines()]
    assert ran.returncode == 0 and heard[0]["type"] == "accepted" and heard[-1]["type"] == "done", ran.stderr
    ran = subprocess.run(command, input='[1, 2, "x"]\n', capture_output=True, text=True, timeout=30, check=False)
    assert ran.returncode == 2 and "line 1" in ran.stderr
    assert robot.wait_for("idle", "holding", timeout_s=5).stream.lease is None


def test_status_tells_where_the_socket_is_and_who_holds_it(robot, running):
    assert f"stream     {running.endpoints.stream}, no lease" in running.mmmd("status").stdout.replace("\n", "")
    with robot.stream("teller") as stream, fed(stream, robot.status().goal_rad):
        assert "teller" in running.mmmd("status").stdout
    assert f"stream: {running.endpoints.stream}" in running.mmmd("capabilities").stdout


@pytest.mark.long
def test_look_holds_for_a_stream_too(robot):
    names = robot.status().joint_names
    yaw = next((k for k, name in enumerate(names) if "yaw" in name and ("head" in name or "neck" in name)), None)
    assert yaw is not None, names
    with robot.stream("looked at") as stream:
        rest = robot.status().goal_rad
        robot.look(yaw_deg=20)
        for _ in range(40):
            stream.send(rest)
            time.sleep(PERIOD_S)
        assert abs(robot.status().goal_rad[yaw] - rest[yaw]) > math.radians(15)
        robot.look()
        for _ in range(40):
            stream.send(rest)
            time.sleep(PERIOD_S)
        assert robot.status().goal_rad[yaw] == pytest.approx(rest[yaw], abs=1e-6)


def test_release_without_a_lease_is_refused(running):
    context = zmq.Context()
    socket = context.socket(zmq.REQ)
    try:
        socket.connect(running.endpoints.cmd)
        socket.setsockopt(zmq.RCVTIMEO, 5000)
        socket.send(encode(Release(lease="never")))
        event = decode_event(socket.recv())
        assert isinstance(event, ev.Rejected) and event.code == "no_lease"
    finally:
        context.destroy(linger=0)
