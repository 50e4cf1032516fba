"""Texts over the front's sockets, with a real bus process, simulated servos and a generator whose answers are known."""

from __future__ import annotations

import contextlib
import json
import time

import pytest
import zmq

from daemon.client import RefusedError
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire import requests
from tests.support.front_sockets import dealer, hear, kinds
from tests.support.harness import RATE_HZ, plays_well
from tests.support.kinematic import LET_GO
from tests.support.sizes import few_and_long

pytestmark = pytest.mark.realtime


def test_say_is_accepted_moves_and_is_done(robot):
    said = robot.say("wave with your right hand")
    assert kinds(said.events) == ["accepted", "progress", "done"]
    done = said.done
    accepted = said.events[0]
    assert accepted.nearest == "raise the right arm (0.90)" and accepted.lacks == ""
    assert accepted.understood == "moves the right hand to the side", "what the motion shows, whatever the text was"
    assert (done.shown, done.seen, done.missing) == ("shown", accepted.understood, "")
    assert 0 < done.first_motion_ms < 2000
    assert done.gate_clipped_frames == 0 or done.underruns, "the gate changes a goal only after frames that came late"
    assert 0 < done.peak_speed_share <= 1
    assert done.duration_s == pytest.approx(done.frames / RATE_HZ, abs=0.2)


def test_plain_text_from_a_dealer(robot, running, context):
    socket = dealer(context, running.endpoints.cmd)
    socket.send(b"wave with your right hand")
    events = hear(socket, ev.Done)
    assert kinds(events) == ["accepted", "progress", "done"]
    assert len({e.id for e in events}) == 1 and [e.seq for e in events] == sorted(e.seq for e in events)


def test_a_req_socket_gets_exactly_one_reply_for_each_request(robot, running, context):
    socket = dealer(context, running.endpoints.cmd, zmq.REQ)
    replies = []
    for text in (b"wave", b'{"type": "status"}', b"do a somersault", b"", b'{"type": "x"}', b"left wave"):
        socket.send(text)
        replies.append(wire.decode_event(socket.recv()))
    assert kinds(replies) == ["accepted", "state", "rejected", "error", "error", "accepted"]
    time.sleep(0.1)
    assert socket.poll(0) == 0
    robot.wait_for("idle", timeout_s=10)


def test_a_text_during_a_motion_takes_over(robot, running, context):
    socket = dealer(context, running.endpoints.cmd)
    socket.send(json.dumps({"type": "say", "id": "one", "text": "wave", "seconds": 3.0}).encode())
    while not isinstance(event := wire.decode_event(socket.recv()), ev.Progress):
        assert event.id == "one"
    socket.send(json.dumps({"type": "say", "id": "two", "text": "left wave"}).encode())
    events = hear(socket, ev.Done)
    assert [(e.id, k) for e, k in zip(events, kinds(events), strict=True)] == [
        ("two", "accepted"), ("one", "cancelled"), ("two", "progress"), ("two", "done")
    ]  # fmt: skip
    assert events[1].by == "say two"


@pytest.mark.long
def test_a_draft_is_played_at_once_and_its_motion_takes_its_place(robot, running, context):
    LET_GO.clear()
    socket = dealer(context, running.endpoints.cmd)
    text = "drafted and held: lift your right arm"
    socket.send(json.dumps({"type": "say", "id": "drafted", "text": text, "seconds": 3.0}).encode())
    events = hear(socket, ev.Progress)
    LET_GO.set()  # the robot moves, and there is nothing but the draft yet
    events += hear(socket, ev.Done)
    assert kinds(events) == ["accepted", "progress", "done"]
    # The draft alone lasts 1.5 s; of the motion at most 0.15 s are left out, in which the person still stands.
    assert events[0].duration_s == 3.0 and 2.8 < events[-1].duration_s < 4.0
    assert plays_well(events[-1])


@pytest.mark.long
def test_a_draft_whose_motion_never_comes_is_played_to_its_end(robot):
    said = robot.say("drafted and lost: lift your right arm", seconds=3.0)
    assert 1.4 < said.done.duration_s < 2.5


@pytest.mark.long
@pytest.mark.parametrize(("mirror", "up"), few_and_long([(True, "left")], [(False, "right")]))
def test_a_text_with_a_prefix_continues_from_the_frames_before_it(robot, running, mirror, up):
    """The generator is shown the last 1.6 s; of a motion that is to be mirrored, their mirror image."""
    with running.client() as other:
        events = other.events_of(requests.Say(id=f"before {up}", text="raise your right arm", seconds=6.0))
        while getattr(next(events), "stage", "") != "moving":
            pass
        time.sleep(1.5)
        said = robot.say("raise your left arm", prefix_s=0.8, mirror=mirror)
        assert isinstance(list(events)[-1], ev.Cancelled)
    assert said.events[0].nearest.endswith(f"after 32 frames, {up} arm up, 0.8 s of them")
    assert said.done is not None and plays_well(said.done)


@pytest.mark.long
def test_of_many_texts_at_once_the_newest_is_played_and_each_ends_once(robot, running, context):
    socket = dealer(context, running.endpoints.cmd)
    for i in range(30):
        socket.send(json.dumps({"type": "say", "id": f"t{i}", "text": "slow wave" if i % 3 else "wave"}).encode())
    last: dict[str, list[str]] = {}
    while "done" not in last.get("t29", []):
        event = wire.decode_event(socket.recv())
        last.setdefault(event.id, []).append(kinds([event])[0])
    terminal = {"done", "cancelled", "failed", "rejected"}
    assert len(last) == 30
    assert all(sum(k in terminal for k in heard) == 1 and heard[-1] in terminal for heard in last.values())
    assert sum("done" in heard for heard in last.values()) == 1


def test_the_same_id_twice_is_one_motion(robot, running, context):
    first, second = dealer(context, running.endpoints.cmd), dealer(context, running.endpoints.cmd)
    frame = json.dumps({"type": "say", "id": "once", "text": "wave"}).encode()
    first.send(frame)
    assert isinstance(wire.decode_event(first.recv()), ev.Accepted)
    second.send(frame)
    events, others = hear(first, ev.Done), hear(second, ev.Done)
    assert {e.plan_id for e in [*events, *others]} == {events[-1].plan_id}
    second.send(json.dumps({"type": "say", "id": "once", "text": "bow"}).encode())
    assert wire.decode_event(second.recv()).code == "id_in_use"


def test_out_of_scope_is_rejected_and_nothing_moves(robot):
    before = robot.status().goal_rad
    with pytest.raises(RefusedError) as caught:
        robot.say("do a somersault")
    assert caught.value.event.code == "out_of_scope" and "legs" in str(caught.value)
    assert robot.status().goal_rad == before


@pytest.mark.parametrize(("text", "code"), few_and_long([("broken", "generator_error")], [("short", "bad_motion")]))
def test_a_generator_that_fails_is_a_named_failure(robot, text, code):
    with pytest.raises(RefusedError) as caught:
        robot.say(text)
    assert caught.value.code == code
    assert robot.say("wave").done


@pytest.mark.parametrize(
    ("frame", "code"),
    [
        (b"", "empty_text"),
        (b"a" * 10_000, "text_too_long"),
        (b"\xff\xfe\x00", "not_utf8"),
        (b"a" * 200_000, "too_large"),
        (b'{"type": "say", "text": "wave", "colour": "red"}', "unknown_field"),
        (b'{"v": 7, "type": "say", "text": "wave"}', "version"),
    ],
)
def test_bad_frames_get_one_error_and_the_daemon_goes_on(robot, running, context, frame, code):
    socket = dealer(context, running.endpoints.cmd)
    socket.send(frame)
    event = wire.decode_event(socket.recv())
    assert isinstance(event, ev.ErrorEvent) and event.code == code
    socket.send(b'{"type": "status"}')
    assert isinstance(wire.decode_event(socket.recv()), ev.StateEvent)  # nothing else came for the bad frame
    ctl = dealer(context, running.endpoints.ctl)
    ctl.send(frame)
    assert isinstance(wire.decode_event(ctl.recv()), ev.ErrorEvent)


def test_several_frames_are_an_error(running, context):
    for endpoint in (running.endpoints.cmd, running.endpoints.ctl):
        socket = dealer(context, endpoint)
        socket.send_multipart([b"wave", b"twice"])
        assert wire.decode_event(socket.recv()).code == "frames"


def test_late_subscribers_get_the_last_state_at_once_and_20_a_second(robot, running):
    began_s = time.monotonic()
    with running.client() as client, contextlib.closing(client.watch("v1/state")) as states:
        _, first = next(states)
        assert first.state in ("idle", "holding", "moving") and len(first.joint_names) == len(first.goal_rad)
        for _ in range(20):
            next(states)
    assert 0.5 < time.monotonic() - began_s < 4


def test_what_the_processes_log_is_published(robot, running):
    with running.client() as client, contextlib.closing(client.watch("v1/log")) as told:
        next(told)  # the last line, on subscribing
        robot.stop()
        line = next(e for _, e in told if isinstance(e, ev.LogEvent) and e.process == "bus" and "STOP" in e.text)
    assert (
        line.level == "info"
        and line.module == "daemon.control.bus_state_machine"
        and 0 <= time.monotonic() - line.t_mono < 10
    )


def test_events_are_published_to_all(robot, running):
    heard: list = []
    with running.client() as watcher, contextlib.closing(watcher.watch("v1/event")) as events:
        next(events)  # the last one of before: the subscription stands
        robot.say("wave", command_id="public")
        with contextlib.closing(robot.watch("v1/event")) as others:
            assert next(others)[1].id == "public"  # sent again, to all who have the topic
        robot.stop()
        while not heard or kinds(heard)[-1] != "ack":
            heard.append(next(events)[1])
    assert kinds(heard) == ["accepted", "progress", "done", "ack"]
    assert [e.id for e in heard[:3]] == ["public"] * 3


def test_a_client_that_never_reads_slows_nobody(robot, running, context):
    deaf = dealer(context, running.endpoints.cmd)
    deaf.setsockopt(zmq.RCVHWM, 1)
    for _ in range(3000):
        deaf.send(b'{"type": "status"}')
    began_s = time.monotonic()
    robot.stop()
    assert time.monotonic() - began_s < 1.0
    assert robot.say("wave", timeout_s=30).done
