"""Story, inbetween and edit with the shipped model, from the socket to the simulated servos and their audit."""

from __future__ import annotations

import os
import signal
import time

import pytest

from daemon.cli import main
from daemon.client import CancelledByError, RefusedError
from daemon.wire import events as ev
from daemon.wire.requests import KeyPoseOf, Say, SceneOf, Story
from mmm_core.inference.checkpoint import MODEL_FILE
from tests.end_to_end.test_start_and_end import child_pid
from tests.support.harness import RATE_HZ, keeps_to_its_path, running_daemon
from tests.support.robot_states import STAYS, bring_to, within
from tests.support.shipped import loaded_once

pytestmark = [
    pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout"),
    pytest.mark.timeout(180),
    pytest.mark.realtime,
]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The tests of this module share a daemon; its audit must be clean at the end."""
    motions = tmp_path_factory.mktemp("motions")
    with running_daemon("--motions", str(motions), model=True) as daemon:
        daemon.motions = motions
        yield daemon


@pytest.fixture(autouse=True)
def armed(run):
    with run.armed():
        yield


@pytest.mark.long
def test_a_story_moves_with_its_first_part_and_skips_rejected_ones(run):
    with run.client() as robot:
        said = robot.story([("wave with your right hand", 1.6), "walk to the window", ("nod twice", 1.6), ("bow", 2.0)])
        done = said.done
        assert done is not None and keeps_to_its_path(done)
        seconds = 1.6 + 1.6 + 2.0 + 2 * 0.4  # two transitions
        assert done.frames == pytest.approx(seconds * RATE_HZ, abs=20)
        scenes = [e for e in said.events if isinstance(e, ev.Progress) and e.stage == "scene"]
        assert [(s.scene, s.status) for s in scenes] == [
            (1, "accepted"), (2, "rejected"), (3, "accepted"), (4, "accepted")
        ]  # fmt: skip
        assert scenes[1].reason and scenes[1].scope_score < 1
        moving = next(e for e in said.events if isinstance(e, ev.Progress) and e.stage == "moving")
        assert moving.t_mono < scenes[3].t_mono  # it moved before the last part was made


@pytest.mark.long
def test_a_text_barges_into_a_story_and_a_stop_ends_one(run):
    with run.client() as robot, run.client() as other:
        scenes = [SceneOf(text="clap your hands"), SceneOf(text="bow")]
        events = robot.events_of(Story(id="endless", scenes=scenes, loop=True))
        while getattr(next(events), "stage", "") != "moving":
            pass
        time.sleep(1.0)
        said = other.say("nod", seconds=1.0)
        assert said.done is not None and keeps_to_its_path(said.done)
        rest = list(events)
        assert isinstance(rest[-1], ev.Cancelled) and rest[-1].by == f"say {said.id}"
        again = other.story(["wave", "bow"], loop=True, wait=False)
        other.wait_for("moving", timeout_s=30)
        other.stop()
        assert other.status().command is None and other.status().state == "holding"
        assert again.events


def test_a_story_outlives_its_generator(run):
    """Killed in the middle: the robot brakes and holds, and goes on where the story was when there is a new one."""
    with run.client() as robot:
        events = robot.events_of(Story(id="long", scenes=[SceneOf(text="clap your hands", seconds=2.0)] * 3), 100)
        while getattr(next(events), "stage", "") != "moving":
            pass
        os.kill(child_pid(run, "daemon.generator.process"), signal.SIGKILL)
        heard = list(events)
        assert isinstance(heard[-1], ev.Done), heard[-1]
        assert [e.scene for e in heard if isinstance(e, ev.Progress) and e.scene is not None][-1] == 3
        assert heard[-1].frames == pytest.approx((3 * 2.0 + 2 * 0.4) * RATE_HZ, abs=30)


@pytest.mark.long
def test_a_frozen_generator_is_started_again_and_the_motion_goes_on(run):
    """The soak run freezes and kills it in every state (tests/end_to_end/test_recorder_and_generator_lost.py)."""
    with run.client() as robot:
        bring_to(robot, "moving")
        os.kill(child_pid(run, "daemon.generator.process"), signal.SIGSTOP)
        within(12, "noticed", lambda: not robot.status().generator.startswith("ready"))
        assert robot.status().state in STAYS["moving"]
        assert robot.gesture("nod").done  # the library needs no generator
        within(60, "back", lambda: robot.status().generator.startswith("ready"))
        assert robot.say("nod twice").done


@pytest.mark.long
def test_a_text_goes_on_from_what_is_played(run):
    """It takes over in the middle of a motion, within all limits; that it is the motion of that prefix is tested with the
    generator's process (tests/daemon/generator/test_generator_process.py).
    """
    with run.client() as robot, run.client() as other:
        events = other.events_of(Say(id="up", text="raise both arms", seconds=9.0, seed=1))
        while getattr(next(events), "stage", "") != "moving":
            pass
        time.sleep(1.5)
        said = robot.say("clap your hands", seed=4, prefix_s=1.6)
        assert isinstance(list(events)[-1], ev.Cancelled)
        assert said.done is not None and keeps_to_its_path(said.done)
        with pytest.raises(ValueError, match="prefix_s"):
            robot.say("clap your hands", prefix_s=0.4, when="after")


@pytest.mark.long
def test_poses_are_met_in_time(run):
    with run.client() as robot:
        robot.gesture("raise_left", hold=True)
        held = robot.wait_for("idle", "holding", timeout_s=20).goal_rad
        robot.say("bow", seconds=2.0)
        said = robot.inbetween([KeyPoseOf(at_s=1.0, standing=True), KeyPoseOf(at_s=2.5, gesture="raise_left")])
        assert said.done is not None and said.done.frames == pytest.approx(2.5 * RATE_HZ, abs=15)
        reached = robot.wait_for("idle", "holding", timeout_s=20).goal_rad
        assert max(abs(a - b) for a, b in zip(held, reached, strict=True)) < 0.15
        with pytest.raises(RefusedError) as caught:
            robot.inbetween([KeyPoseOf(at_s=1.0, gesture="raise_left", time_s=9.0)])
        assert caught.value.code == "bad_keyframes"


@pytest.mark.long
def test_an_edit_of_one_arm_moves_that_arm_and_a_bad_one_says_why(run):
    with run.client() as robot:
        first = robot.gesture("wave_right")
        plan = first.events[0].plan_id
        done = robot.edit("raise your left arm", plan=plan, parts=["left_arm"]).done
        assert done is not None and done.frames == pytest.approx(first.done.frames, abs=15)
        assert done.shown == "shown" and "raises the left hand" in done.seen, done
        assert robot.edit("nod", command=first.id, start_s=0.6).done
        for fields, code in (
            ({"command": first.id, "start_s": 1.0, "end_s": 1.4}, "not_reached"),
            ({"plan": plan, "parts": ["tail"]}, "bad_edit"),
            ({"plan": plan, "start_s": 9.0}, "bad_edit"),
            ({"plan": 9999}, "unknown_motion"),
            ({"command": "never"}, "unknown_motion"),
            ({"gesture": "nothing_like_it"}, "unknown_gesture"),
            ({"file": "missing.npz"}, "bad_file"),
            ({"file": "../../etc/passwd"}, "bad_file"),
        ):
            with pytest.raises(RefusedError) as caught:
                robot.edit("bow", **fields)
            assert caught.value.code == code, caught.value
        with pytest.raises(RefusedError) as caught:
            robot.edit("walk to the window", plan=plan)
        assert caught.value.code == "out_of_scope"


@pytest.mark.long
def test_what_was_played_is_played_again_and_so_is_a_file(run):
    with run.client() as robot:
        first = robot.say("nod twice", seconds=2.0)
        again = robot.replay(plan=first.events[0].plan_id)
        assert again.done is not None and again.done.frames == pytest.approx(first.done.frames, abs=15)
        assert robot.replay(command=first.id, tempo=2.0).done.frames < 0.7 * first.done.frames
        with loaded_once():
            assert main(["generate", "bow", "--seconds", "2", "--out", str(run.motions / "bow.npz")]) == 0
        assert robot.replay(file="bow.npz").done.frames == pytest.approx(2.0 * RATE_HZ, abs=15)
        (run.motions / "broken.npz").write_bytes(b"no motion")
        for file in ("broken.npz", "../bow.npz", "nothing.npz"):
            with pytest.raises(RefusedError) as caught:
                robot.replay(file=file)
            assert caught.value.code == "bad_file"


@pytest.mark.long
def test_the_commands_of_the_shell(run, tmp_path):
    story = run.mmmd("story", "nod", "bow", "--tempo", "2")
    assert story.returncode == 0 and "scene 2: bow" in story.stdout and "done" in story.stdout
    assert run.mmmd("inbetween", "bow@0.8", "standing@1.6").returncode == 0
    assert run.mmmd("edit", "gesture:nod", "shake your head").returncode == 0
    for bad in (["story"], ["story", ""], ["story", "a", "--hold"], ["inbetween", "bow"], ["edit", "plan:x", "bow"]):
        assert run.mmmd(*bad).returncode == 2, bad
    scenes = tmp_path / "s.jsonl"
    scenes.write_text('{"text": "nod", "seconds": 1}\n{"txt": "bow"}\n')
    assert "line 2" in run.mmmd("story", "--scenes", str(scenes)).stderr


@pytest.mark.long
def test_a_story_that_is_replaced_from_asyncio(run):
    import asyncio

    from daemon.client import AsyncClient

    async def main() -> None:
        async with AsyncClient(run.endpoints) as robot:
            telling = asyncio.create_task(robot.story(["clap your hands", "bow"], loop=True))
            await robot.wait_for("moving", timeout_s=30)
            assert (await robot.edit("bow", gesture="nod")).done
            with pytest.raises(CancelledByError, match="edit"):
                await telling
            assert (await robot.inbetween([KeyPoseOf(at_s=1.0, standing=True)])).done

    asyncio.run(main())
