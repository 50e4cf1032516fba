"""Joint targets from other programs: a lease is asked for, held, shown, taken over and given back, on a whole daemon."""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import subprocess
import sys
import time
from pathlib import Path

import pytest
import zmq

from daemon.client import AsyncClient, CancelledByError, RefusedError
from daemon.wire import events as ev
from daemon.wire.codec import decode_event, encode
from daemon.wire.requests import Release, Say
from tests.support.harness import MMMD, keeps_to_its_path
from tests.support.sizes import few_and_long
from tests.support.streaming import PERIOD_S, fed, until_still, wave

pytestmark = pytest.mark.realtime
EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "stream_sine.py"


def test_a_stream_moves_the_robot_and_is_released_with_its_figures(robot):
    with robot.stream("sine") as stream:
        accepted = stream.news.events[0]
        assert isinstance(accepted, ev.Accepted) and accepted.silence_s == 0.2
        sent = wave(robot, stream, 1.0)
        now = robot.status()
        assert now.state == "moving" and now.command.id == stream.news.id
        assert now.stream.lease.holder == "sine" and now.stream.lease.state == "streaming"
        assert 1 < now.stream.lease.targets <= sent and now.stream.bad == {}  # the newest is taken of those that wait
    done = stream.news.end
    assert isinstance(done, ev.Done) and keeps_to_its_path(done) and done.peak_speed_share > 0.02
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


def test_a_text_that_cannot_be_made_leaves_the_stream_going(robot):
    with robot.stream("undisturbed") as stream:
        wave(robot, stream, 0.3)
        with pytest.raises(RefusedError):
            robot.say("do a somersault")
        wave(robot, stream, 0.3)
        assert robot.status().stream.lease.state == "streaming"
    assert isinstance(stream.news.end, ev.Done)


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
    assert end.gate_clipped_frames <= 2 or end.underruns


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


@pytest.mark.long
def test_the_example_runs(robot, running):
    ends = running.endpoints
    ran = subprocess.run(
        [sys.executable, str(EXAMPLE), "", "1", ends.cmd, ends.ctl, ends.pub], capture_output=True, text=True, timeout=30,
        check=False,
    )  # fmt: skip
    assert ran.returncode == 0 and ran.stdout.startswith("Done("), ran.stderr


@pytest.mark.long
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
