"""A motion ends by a request on the front's sockets: stop, cancel, e-stop, torque off, park, or a text that means to stop."""

from __future__ import annotations

import json
import threading

import pytest

from daemon.client import CancelledByError, Client, RefusedError
from daemon.front.late_requests import OLDEST_STATE_S
from daemon.wire import codec as wire
from daemon.wire import events as ev
from daemon.wire import requests
from tests.support.front_sockets import dealer, hear, kinds, stamped
from tests.support.harness import RunningDaemon

pytestmark = pytest.mark.realtime


def say_in_thread(robot: Client, running: RunningDaemon, text: str, seconds: float) -> tuple[threading.Thread, list]:
    """Say it from another client; the list will hold what came of it."""
    outcome: list = []

    def run() -> None:
        with running.client() as client:
            try:
                outcome.append(client.say(text, seconds=seconds))
            except (CancelledByError, RefusedError) as error:
                outcome.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    robot.wait_for("moving", timeout_s=5)
    return thread, outcome


def test_stop_holds_and_cancels(robot, running):
    thread, outcome = say_in_thread(robot, running, "wave", 4.0)
    robot.stop()
    thread.join(5)
    assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "stop"
    assert robot.wait_for("holding", timeout_s=3).command is None
    assert robot.say("wave").done  # no arming needed


def test_a_stop_right_after_a_text_stops_it(robot, running, context):
    """No lost stop: the text may still be on its way in another socket when the stop is served."""
    socket = dealer(context, running.endpoints.cmd)
    for _ in range(10):
        socket.send(stamped(requests.Say(text="wave")))
        robot.stop()
        assert kinds(hear(socket, ev.Cancelled))[-1] == "cancelled"
    assert robot.status().command is None


def test_cancel_by_id(robot, running, context):
    socket = dealer(context, running.endpoints.cmd)
    socket.send(stamped(requests.Say(id="c1", text="wave", seconds=4)))
    hear(socket, ev.Progress)
    with running.client() as client:
        with pytest.raises(RefusedError, match="c1"):
            client.cancel("another")
        client.cancel("c1")
        assert hear(socket, ev.Cancelled)[-1].by == "cancel"
        with pytest.raises(RefusedError, match="nothing is running"):
            client.cancel()
    robot.wait_for("holding", timeout_s=3)


def test_estop_latches_until_reset_and_arm(robot, running):
    thread, outcome = say_in_thread(robot, running, "wave", 4.0)
    robot.estop()
    thread.join(5)
    assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "estop"
    status = robot.wait_for("estop", timeout_s=3)
    assert status.must_arm
    for refused in (lambda: robot.say("wave"), robot.arm, robot.park):
        with pytest.raises(RefusedError, match="mmmd reset"):
            refused()
    robot.reset()
    with pytest.raises(RefusedError, match="mmmd arm"):
        robot.say("wave")
    assert robot.status().state == "limp"
    robot.arm()
    assert robot.say("wave").done


def test_torque_off_goes_limp_and_waits_for_an_arm(robot, running):
    thread, outcome = say_in_thread(robot, running, "wave", 4.0)
    robot.torque_off()
    thread.join(5)
    assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "torque off"
    status = robot.status()
    assert status.state == "limp" and status.must_arm
    with pytest.raises(RefusedError, match="mmmd arm"):
        robot.say("wave")
    robot.arm()
    assert robot.say("wave").done


def test_an_arm_counts_only_with_a_new_state_of_this_daemon(robot, running, context):
    """The time in a `state` event is of the clock that the daemon compares it with."""
    robot.torque_off()
    ctl = dealer(context, running.endpoints.ctl)

    def ask(verb: str, age_s: float) -> ev.Event:
        state_s = robot.status().t_mono - age_s
        ctl.send(json.dumps({"type": verb, "id": verb, "state_t_mono": state_s}).encode())
        return wire.decode_event(ctl.recv())

    for verb, age_s in (("arm", OLDEST_STATE_S + 1), ("reset", 1e9), ("park", -1e9)):
        refused = ask(verb, age_s)
        assert isinstance(refused, ev.Rejected) and (refused.id, refused.code) == (verb, "stale_state")
    assert robot.status().state == "limp"
    assert isinstance(ask("arm", 0), ev.Ack)
    robot.wait_for("idle", timeout_s=20)
    assert isinstance(ask("stop", 1e9), ev.Ack)


def test_a_late_text_does_not_arm_a_limp_robot_and_a_late_stop_stops(robot, running, context):
    """A text that a stalled connection held back armed a limp robot by itself."""
    robot.park()
    robot.wait_for("limp", timeout_s=20)
    cmd = dealer(context, running.endpoints.cmd)

    def ask(text: str, age_s: float) -> ev.Event:
        request = requests.Say(text=text, seconds=4.0, state_t_mono=robot.status().t_mono - age_s)
        cmd.send(stamped(request))
        return wire.decode_event(cmd.recv())

    for age_s in (OLDEST_STATE_S + 1, 1e9, -1e9):
        refused = ask("wave", age_s)
        assert isinstance(refused, ev.Rejected) and (refused.code, refused.asked) == ("stale_state", "say 'wave'")
    status = robot.status()
    assert (status.state, status.command, status.waiting, status.must_arm) == ("limp", None, [], False)
    assert isinstance(ask("wave", 0), ev.Accepted)
    robot.wait_for("moving", timeout_s=20)
    cmd.send(stamped(requests.Say(text="stop moving", state_t_mono=-1.0)))
    events = hear(cmd, ev.Ack)
    assert [e.by for e in events if isinstance(e, ev.Cancelled)] == ["stop"]
    assert robot.wait_for("holding", timeout_s=3).command is None


@pytest.mark.long
def test_park_goes_limp_and_the_next_text_arms(robot, running):
    thread, outcome = say_in_thread(robot, running, "wave", 4.0)
    robot.park()
    thread.join(5)
    assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "park"
    assert robot.status().state == "limp"
    said = robot.say("wave")
    assert kinds(said.events) == ["accepted", "progress", "progress", "done"]
    assert said.events[1].stage == "arming"


def test_the_word_stop_brakes_and_is_no_gesture(robot, running):
    """The model took such a text for the gesture of a stop sign: the hand rose 0.7 m, and the voice assistant was told `done`."""
    thread, outcome = say_in_thread(robot, running, "wave", 4.0)
    with running.client() as other:
        said = other.say("please stop waving")
    thread.join(5)
    assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "stop"
    assert [type(e) for e in said.events] == [ev.Ack]
    assert (
        said.events[0].verb == "stop" and "means to stop" in said.events[0].note and "ended: 1" in said.events[0].note
    )
    assert robot.wait_for("holding", timeout_s=3).command is None


@pytest.mark.parametrize(
    "frame",
    [
        b"Stop!!!",
        b'{"type": "say", "text": "don\'t move", "when": "after"}',
        b'{"type": "story", "scenes": [{"text": "wave"}, {"text": "emergency stop"}]}',
        b'{"type": "edit", "text": "halt", "gesture": "wave_left"}',
    ],
)
def test_a_stop_in_any_frame_of_cmd_brakes(robot, running, context, frame):
    thread, outcome = say_in_thread(robot, running, "wave", 4.0)
    socket = dealer(context, running.endpoints.cmd)
    socket.send(frame)
    assert isinstance(wire.decode_event(socket.recv()), ev.Ack)
    thread.join(5)
    assert isinstance(outcome[0], CancelledByError) and outcome[0].by == "stop"
    assert robot.wait_for("holding", timeout_s=3).command is None
