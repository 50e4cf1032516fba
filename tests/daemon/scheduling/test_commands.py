"""Commands and their options, through a running daemon: what is played, in which order, and how each ends."""

from __future__ import annotations

import asyncio
import time

import pytest

from daemon.client import AsyncClient
from daemon.wire import events as ev
from daemon.wire.requests import Gesture, Say, tag_of
from tests.support.harness import RATE_HZ

pytestmark = [pytest.mark.timeout(120), pytest.mark.realtime]


def test_tempo_repeat_and_hold_change_what_is_played(robot):
    before = robot.status().goal_rad
    plain, slow, fast = (robot.say("wave", seconds=1.0, amplitude=0.5, tempo=tempo).done for tempo in (1.0, 0.5, 2.0))
    assert slow.frames > 1.7 * plain.frames and fast.frames < 0.7 * plain.frames
    assert robot.say("wave", seconds=1.0, amplitude=0.5, tempo=2.0, repeat=3, hold=True).done.frames > 2 * fast.frames
    held = robot.wait_for("idle", timeout_s=3)
    assert max(abs(a - b) for a, b in zip(held.goal_rad, before, strict=True)) > 0.3


@pytest.mark.long
def test_mirror_moves_the_other_arm(robot):
    robot.say("wave with your right hand", seconds=1.0, hold=True)
    right = dict(zip((s := robot.status()).joint_names, s.goal_rad, strict=True))
    robot.say("wave with your right hand", seconds=1.0, hold=True, mirror=True)
    left = dict(zip((s := robot.status()).joint_names, s.goal_rad, strict=True))
    for name, value in right.items():
        if name.startswith("r_") and abs(value) > 0.5:
            assert abs(left[name]) < abs(value) / 2
    robot.say("wave", seconds=1.0)


@pytest.mark.long
def test_amplitude_scales_the_movement(robot):
    full = robot.say("wave", seconds=1.0).done
    small = robot.say("wave", seconds=1.0, amplitude=0.4).done
    assert small.peak_speed_share < 0.6 * full.peak_speed_share


def test_status_says_whether_a_halted_robot_has_torque(robot):
    """With `--estop hold` nothing told the first e-stop, which holds, from the second, which cuts torque."""
    assert robot.status().torque is True and robot.status().with_torque == ""
    robot.estop()
    stopped = robot.status()
    assert (stopped.torque, stopped.with_torque) == (False, "without torque")
    stopped.torque = True
    assert stopped.with_torque == "with torque on: keep your hands out"
    stopped.torque = None
    assert stopped.with_torque == "perhaps with torque: keep your hands out"
    assert "in e-stop: it looks there once it moves" in robot.look(10.0).note
    robot.look()
    robot.reset()
    assert robot.status().torque is False
    robot.arm()


def test_a_text_without_end_goes_round_until_something_else_is_said(robot, running):
    """A client that waits for the end of a motion without one gets its acceptance."""
    said = robot.say("keep waving", command_id="endless")
    accepted = said.events[-1]
    assert isinstance(accepted, ev.Accepted) and accepted.goes_on and accepted.text == "keep waving"

    async def ask() -> ev.AnyEvent:
        async with AsyncClient(running.endpoints) as other:
            return (await other.say("keep clapping")).events[-1]

    assert robot.status().command.id == "endless"
    begun = asyncio.run(ask())
    assert isinstance(begun, ev.Accepted) and begun.goes_on
    assert robot.status().command.id == begun.id
    assert not robot.say("wave", seconds=1.0).events[0].goes_on  # ends it, and ends itself


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


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
def test_the_same_id_is_one_gesture_and_never_another_command(robot, talk):
    for _ in range(2):
        talk.send(Gesture(id="g", name="nod"))
    talk.until("g", ev.Done)
    talk.send(Say(id="g", text="wave"))
    assert talk.until("g", ev.ErrorEvent).code == "id_in_use"


def test_say_in_another_state_is_refused_with_what_is_allowed(robot, talk):
    robot.estop()
    for request in (Say(id="e1", text="wave", when="after"), Gesture(id="e2", name="nod")):
        talk.send(request)
        refused = talk.until(request.id, ev.Rejected)
        assert (refused.code, refused.asked) == ("wrong_state", tag_of(request))
    robot.reset()
    robot.arm()
