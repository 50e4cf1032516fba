"""Every command with its options, through a running daemon: what is played, in which order, and how each ends."""

from __future__ import annotations

import contextlib
import json
import time

import pytest
import zmq

from daemon.client import RefusedError
from daemon.client.errors import stamp
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire.requests import Gesture, Say, tag_of
from tests.support.harness import RATE_HZ, RunningDaemon

pytestmark = [pytest.mark.timeout(120), pytest.mark.realtime]


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    daemon = RunningDaemon("--gestures", str(tmp_path_factory.mktemp("own")))
    try:
        yield daemon.until_ready()
        assert daemon.terminate() == 0
        assert json.loads(daemon.audit.read_text())["violations"] == 0
    finally:
        daemon.close()


@pytest.fixture
def robot(running):
    with running.armed() as client:
        yield client


class Talk:
    """One DEALER: sends requests, gathers what comes back by command."""

    def __init__(self, endpoint: str) -> None:
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.connect(endpoint)
        self.heard: dict[str, list[ev.Event]] = {}

    def send(self, request) -> None:
        stamp(request)
        self._socket.send(wire.encode(request))

    def until(self, command: str, kind: type, timeout_s: float = 15.0):
        end_s = time.monotonic() + timeout_s
        while not any(isinstance(e, kind) for e in self.heard.get(command, [])):
            left_s = end_s - time.monotonic()
            assert left_s > 0 and self._socket.poll(int(1000 * left_s)), f"{command}: no {kind}; heard {self.heard}"
            event = wire.decode_event(self._socket.recv())
            self.heard.setdefault(event.id, []).append(event)
        return next(e for e in self.heard[command] if isinstance(e, kind))

    def last(self, command: str) -> ev.Event:
        return self.heard[command][-1]

    def close(self) -> None:
        self._context.destroy(linger=0)


@pytest.fixture
def talk(running):
    made = Talk(running.endpoints.cmd)
    yield made
    made.close()


def test_tempo_repeat_and_hold_change_what_is_played(robot):
    plain = robot.say("wave", seconds=2.0).done
    slow = robot.say("wave", seconds=2.0, tempo=0.5).done
    fast = robot.say("wave", seconds=2.0, tempo=2.0).done
    assert slow.frames > 1.7 * plain.frames and fast.frames < 0.7 * plain.frames
    assert robot.say("wave", seconds=2.0, tempo=2.0, repeat=3).done.frames > 2 * fast.frames
    before = robot.status().goal_rad
    robot.say("wave", seconds=1.0, hold=True)
    held = robot.wait_for("idle", timeout_s=3)
    assert max(abs(a - b) for a, b in zip(held.goal_rad, before, strict=True)) > 0.3
    robot.say("wave", seconds=1.0)


def test_mirror_moves_the_other_arm(robot):
    robot.say("wave with your right hand", seconds=1.0, hold=True)
    right = dict(zip((s := robot.status()).joint_names, s.goal_rad, strict=True))
    robot.say("wave with your right hand", seconds=1.0, hold=True, mirror=True)
    left = dict(zip((s := robot.status()).joint_names, s.goal_rad, strict=True))
    for name, value in right.items():
        if name.startswith("r_") and abs(value) > 0.5:
            assert abs(left[name]) < abs(value) / 2
    robot.say("wave", seconds=1.0)


def test_amplitude_scales_the_movement(robot):
    full = robot.say("wave", seconds=1.0).done
    small = robot.say("wave", seconds=1.0, amplitude=0.4).done
    assert small.peak_speed_share < 0.6 * full.peak_speed_share


@pytest.mark.long
def test_a_loop_goes_on_until_it_is_cancelled(robot, talk):
    talk.send(Say(id="round", text="wave", seconds=1.0, loop=True))
    talk.until("round", ev.Progress)
    before = now = robot.status().bus_info
    while now["cycles"] < before["cycles"] + 2.5 * RATE_HZ:  # more than two rounds
        time.sleep(0.1)
        status = robot.status()
        assert status.state == "moving" and status.command.id == "round"
        now = status.bus_info
    assert 20 * (now["underruns"] - before["underruns"]) < now["cycles"] - before["cycles"]
    robot.cancel("round")
    assert talk.until("round", ev.Cancelled).by == "cancel"
    robot.wait_for("holding", timeout_s=20)


def test_after_waits_for_its_turn_and_ends_a_loop_gracefully(robot, talk):
    talk.send(Say(id="a", text="wave", seconds=1.0, loop=True))
    talk.until("a", ev.Progress)
    talk.send(Say(id="b", text="wave", seconds=0.8, when="after"))
    talk.send(Say(id="c", text="left wave", seconds=0.8, when="after"))
    talk.until("c", ev.Accepted)
    assert robot.status().waiting == ["b", "c"]
    talk.until("c", ev.Done)
    done = [talk.until(x, ev.Done) for x in "abc"]
    assert done[0].seq < done[1].seq < done[2].seq
    assert [talk.until(x, ev.Progress).seq > done[k].seq for k, x in enumerate("bc")] == [True, True]


def test_a_now_overtakes_those_that_wait(robot, talk):
    talk.send(Say(id="long", text="wave", seconds=3.0))
    talk.until("long", ev.Progress)
    talk.send(Say(id="later", text="wave", when="after"))
    talk.until("later", ev.Accepted)
    talk.send(Say(id="new", text="left wave", seconds=0.8))
    talk.until("new", ev.Done)
    assert talk.until("later", ev.Cancelled).by == talk.until("long", ev.Cancelled).by == "say new"


def test_at_begins_at_its_time_and_not_before(robot, talk):
    at_s = time.monotonic() + 1.2
    talk.send(Say(id="timed", text="wave", seconds=0.8, when="at", at_s=at_s))
    assert talk.until("timed", ev.Accepted).t_mono < at_s - 0.3
    talk.send(Say(id="meanwhile", text="left wave", seconds=4.0))
    assert talk.until("timed", ev.Progress).t_mono > at_s
    assert talk.until("meanwhile", ev.Cancelled).by == "say timed"
    talk.until("timed", ev.Done)


def test_a_stop_ends_what_waits_too(robot, talk):
    talk.send(Say(id="s1", text="wave", seconds=3.0))
    talk.until("s1", ev.Progress)
    talk.send(Say(id="s2", text="wave", when="after"))
    talk.send(Say(id="s3", text="wave", when="at", at_s=time.monotonic() + 60))
    talk.until("s3", ev.Accepted)
    robot.stop()
    for command in ("s1", "s2", "s3"):
        assert talk.until(command, ev.Cancelled).by == "stop"
    assert robot.status().waiting == [] and robot.status().command is None


def test_cancelling_what_is_played_lets_the_next_one_begin(robot, talk):
    talk.send(Say(id="one", text="wave", seconds=4.0))
    talk.until("one", ev.Progress)
    talk.send(Say(id="two", text="left wave", seconds=0.8, when="after"))
    talk.until("two", ev.Accepted)
    robot.cancel("one")
    assert talk.until("one", ev.Cancelled).by == "cancel"
    talk.until("two", ev.Done)


@pytest.mark.parametrize(
    "request_",
    [
        Say(id="d0", text="slow wave", deadline_s=0.01),
        Say(id="d1", text="wave", when="at", at_s=1e9, deadline_s=1.0),
        Say(id="d2", text="wave", when="after", deadline_s=0.5),
    ],
    ids=lambda r: r.id,
)
def test_what_cannot_begin_in_time_is_rejected(robot, talk, request_):
    talk.send(Say(id=f"before-{request_.id}", text="wave", seconds=4.0))
    talk.until(f"before-{request_.id}", ev.Progress)
    talk.send(request_)
    rejected = talk.until(request_.id, ev.Rejected)
    assert rejected.code == "deadline" and "deadline" in rejected.do
    assert robot.status().command.id == f"before-{request_.id}"  # which goes on
    robot.stop()


def test_too_many_waiting_are_refused(robot, talk):
    for i in range(70):
        talk.send(Say(id=f"q{i}", text="wave", when="at", at_s=time.monotonic() + 100))
    assert talk.until("q69", ev.Rejected).code == "queue_full"
    robot.cancel()
    talk.until("q0", ev.Cancelled)
    assert robot.status().waiting == []


def test_the_same_id_is_one_gesture_and_never_another_command(robot, talk):
    for _ in range(2):
        talk.send(Gesture(id="g", name="nod"))
    talk.until("g", ev.Done)
    talk.send(Say(id="g", text="wave"))
    assert talk.until("g", ev.ErrorEvent).code == "id_in_use"


def test_gestures_need_no_generator_words(robot):
    done = robot.gesture("nod_twice", tempo=1.2)
    assert tag_of(done.events[-1]) == "done" and "nod_twice" in done.events[0].nearest
    assert done.events[0].understood == "nods twice" and (done.done.shown, done.done.seen) == ("shown", "nods twice")
    with pytest.raises(RefusedError) as caught:
        robot.gesture("nodd")
    assert caught.value.code == "unknown_gesture" and "nod" in caught.value.event.allowed


def test_record_keeps_the_newest_motion_as_a_gesture(robot):
    robot.say("wave with your right hand", seconds=1.0)
    assert "my_wave" in robot.record("my_wave").note
    assert any(g.name == "my_wave" and g.own for g in robot.capabilities().gestures)
    assert robot.gesture("my_wave").done.frames == pytest.approx(robot.say("wave", seconds=1.0).done.frames, abs=30)
    with pytest.raises(RefusedError, match="no motion of command"):
        robot.record("other", "never said")


@pytest.mark.long
def test_a_recorded_gesture_is_not_overwritten_and_keeps_its_text(robot):
    """One's own gesture was replaced without a word, and recording what was played from a gesture kept its name for a text."""
    robot.say("wave with your right hand", seconds=1.0)
    robot.record("shown", replace=True)
    with pytest.raises(RefusedError) as caught:
        robot.record("shown")
    assert caught.value.code == "gesture_exists" and "replace" in caught.value.event.do
    robot.gesture("shown")
    assert robot.record("shown_again", replace=True).note == "shown_again: wave with your right hand"
    robot.gesture("shown", mirror=True)
    assert robot.record("shown_left", replace=True).note == "shown_left: wave with your left hand"


def test_look_turns_the_head_while_the_arm_moves_and_lets_go(robot):
    names = robot.status().joint_names
    head = next(i for i, n in enumerate(names) if "head" in n and ("yaw" in n or "pan" in n))
    robot.look(yaw_deg=40)

    def head_is(value: float) -> bool:
        end_s = time.monotonic() + 4
        while abs(abs(robot.status().goal_rad[head]) - value) > 0.05:
            if time.monotonic() > end_s:
                return False
            time.sleep(0.05)
        return True

    assert head_is(0.698)
    assert robot.status().gaze_deg == (40.0, 0.0)
    robot.say("wave", seconds=2.0)
    assert head_is(0.698)
    assert "reaches" in robot.look(yaw_deg=119).note
    robot.look()
    assert head_is(0.0) and robot.status().gaze_deg is None


@pytest.mark.long
def test_idle_movements_begin_yield_at_once_and_end(robot):
    robot.say("wave", seconds=0.8)
    robot.wait_for("idle", timeout_s=3)
    robot.idle(True, "lively")
    try:
        seen = set()
        end_s = time.monotonic() + 8
        while len(seen) < 20 and time.monotonic() < end_s:
            status = robot.status()
            seen.add(tuple(status.goal_rad))
            assert status.state == "idle" and status.command is None
            time.sleep(0.1)
        assert len(seen) >= 20  # it moves, and is idle all the same
        assert robot.say("wave", seconds=0.8).done.first_motion_ms < 1000
        assert robot.status().idle == "lively"
        robot.stop()
        robot.wait_for(
            "holding", "idle", timeout_s=3
        )  # idle: the stop came between two movements, when nothing had to brake
        still = robot.status().goal_rad
        time.sleep(1.5)
        assert robot.status().goal_rad == still  # a person stopped it: no idling until the next command
    finally:
        robot.idle(False)


def test_capabilities_name_everything_that_can_be_asked(robot, running):
    found = robot.capabilities()
    assert set(found.requests["cmd"]) >= {
        "say",
        "gesture",
        "record",
        "look",
        "idle",
        "cancel",
        "status",
        "capabilities",
    }
    assert set(found.requests["ctl"]) >= {"stop", "estop", "reset", "arm", "park", "status"}
    assert len(found.gestures) >= 60 and len(found.joints) == len(robot.status().joint_names)
    assert found.checkpoint_hash == "kinematic" and found.options["tempo"] == [0.5, 2.0]
    for topic in found.topics:
        with running.client() as client, contextlib.closing(client.watch(topic)) as watched:
            assert next(watched)[0] == topic


@pytest.mark.long
def test_commands_of_the_shell(running, robot, tmp_path):
    said = running.mmmd("say", "wave", "--tempo", "2", "--repeat", "2")
    assert said.returncode == 0 and "done" in said.stdout
    assert running.mmmd("say", "wave", "--tempo", "5").returncode == 2
    assert running.mmmd("say", "wave", "--loop", "--hold").returncode == 2
    assert running.mmmd("gesture", "play", "nod").returncode == 0
    assert "nod" in running.mmmd("gesture", "play", "nodd").stderr
    assert running.mmmd("gesture", "record", "kept", "--replace").stdout.startswith("recorded kept")
    again = running.mmmd("gesture", "record", "kept")
    assert again.returncode == 1 and "--replace" in again.stderr
    assert running.mmmd("look", "--yaw", "10").returncode == 0 and running.mmmd("look").returncode == 0
    assert running.mmmd("idle", "off").returncode == 0
    assert "nothing is running" in running.mmmd("cancel").stderr
    assert json.loads(running.mmmd("capabilities", "--json").stdout)["type"] == "capabilities"


def test_say_in_another_state_is_refused_with_what_is_allowed(robot, talk):
    robot.estop()
    for request in (Say(id="e1", text="wave", when="after"), Gesture(id="e2", name="nod")):
        talk.send(request)
        assert talk.until(request.id, ev.Rejected).code == "wrong_state"
    robot.reset()
    robot.arm()
