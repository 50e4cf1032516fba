"""Gestures that ship, are recorded and listed, looks and idle movements, through a running daemon and the shell."""

from __future__ import annotations

import contextlib
import json
import time

import pytest

from daemon.client import RefusedError
from daemon.wire.requests import tag_of

pytestmark = [pytest.mark.timeout(120), pytest.mark.realtime]


def test_gestures_need_no_generator_words(robot):
    done = robot.gesture("nod_twice", tempo=1.2)
    assert tag_of(done.events[-1]) == "done" and "nod_twice" in done.events[0].nearest
    assert done.events[0].understood == "nods twice" and (done.done.shown, done.done.seen) == ("shown", "nods twice")
    with pytest.raises(RefusedError) as caught:
        robot.gesture("nodd")
    assert caught.value.code == "unknown_gesture" and "nod" in caught.value.event.allowed


@pytest.mark.long
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


@pytest.mark.long
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
