"""`mmmd gesture teach` as a person uses it: a hand leads the limp arms of simulated servos, and the robot shows it afterwards."""

from __future__ import annotations

import importlib
import io
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from daemon.client import RefusedError
from daemon.gestures.library import GestureLibrary
from daemon.wire.requests import KeyPoseOf
from retarget.pipeline import Retargeter
from tests.support.harness import MMMD, RunningDaemon
from tests.support.robot_states import ROBOT, Servos, SharedDaemon, within
from tests.support.sizes import few_and_long

pytestmark = [pytest.mark.realtime, pytest.mark.timeout(180)]
EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "inbetween_taught.py"
RIGHT_ROLL, RIGHT_ELBOW = (ROBOT.joint_names.index(f"right_{part}") for part in ("shoulder_roll", "elbow"))


def raised(share: float) -> np.ndarray:
    """The park pose with the right arm lifted to the side by a share of 60 degrees, its elbow bent."""
    q = ROBOT.park_rad.copy()
    out = 1 if ROBOT.position_max_rad[RIGHT_ROLL] > -ROBOT.position_min_rad[RIGHT_ROLL] else -1
    q[RIGHT_ROLL] += out * share * np.deg2rad(60)
    q[RIGHT_ELBOW] += share * np.deg2rad(50)
    return q


UP_AND_DOWN = [raised((1 - np.cos(2 * np.pi * k / 50)) / 2) for k in range(51)]
"""Poses of a hand that lifts the arm and lowers it again in 2.5 s, 20 a second."""


class Teaching:
    """The command in a process of its own, with a person at its terminal."""

    def __init__(self, daemon: RunningDaemon, *arguments: str) -> None:
        self.said = ""
        self._process = subprocess.Popen(
            [*MMMD, "gesture", "teach", *arguments, *daemon.at],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip

    def until(self, words: str) -> None:
        """Read what is printed up to a line with these words."""
        assert self._process.stdout is not None
        while words not in self.said:
            line = self._process.stdout.readline()
            assert line, f"{words!r} was not said in {self.said!r}: {self._process.communicate(timeout=10)}"
            self.said += line

    def type(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def interrupt(self) -> None:
        self._process.send_signal(signal.SIGINT)

    def ended(self) -> tuple[int, str]:
        """Exit status and the complaints."""
        said, complaints = self._process.communicate(timeout=60)
        self.said += said
        return self._process.returncode, complaints

    def close(self) -> None:
        if self._process.poll() is None:
            self._process.kill()
        self._process.communicate()


@pytest.fixture(scope="module")
def gestures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The daemon's folder of taught gestures; it is not there before a gesture is kept."""
    return tmp_path_factory.mktemp("own") / "gestures"


@pytest.fixture(scope="module")
def module_daemon(tmp_path_factory: pytest.TempPathFactory, gestures: Path) -> Iterator[SharedDaemon]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MMMD_GESTURES", str(gestures))
        importlib.import_module(
            "scipy.signal"
        )  # `mmmd gesture teach` runs in the process that plays the servos, and must not hold it up
        made = SharedDaemon(tmp_path_factory.mktemp("shared"))
        yield made
        made.close()


@pytest.fixture
def servos(shared: SharedDaemon) -> Servos:
    return shared.servos


@pytest.fixture
def taught(shared: SharedDaemon, gestures: Path) -> Iterator[tuple[RunningDaemon, Callable]]:
    """A daemon without taught gestures; and how `teach` is begun."""
    shutil.rmtree(gestures, ignore_errors=True)
    shared.servos.bus.world.move_by_hand(ROBOT.park_rad)

    @contextmanager
    def begun(*arguments: str) -> Iterator[Teaching]:
        teaching = Teaching(shared.daemon, *arguments)
        try:
            yield teaching
        finally:
            teaching.close()

    yield shared.daemon, begun


def lead(daemon: RunningDaemon, servos, poses) -> None:
    """A hand goes on by a pose with each measurement that the daemon publishes."""
    with daemon.client() as client:
        for pose, _ in zip(poses, client.watch("v1/state"), strict=False):
            servos.bus.world.move_by_hand(pose)


def test_a_led_arm_becomes_a_gesture(taught, servos, gestures):
    daemon, begun = taught
    with begun("my_lift", "--limp", "--yes", "--text", "lifts an arm") as teaching:
        teaching.until("Enter ends it")
        lead(daemon, servos, UP_AND_DOWN[::2])
        teaching.type("")
        status, complaints = teaching.ended()
    assert status == 0, complaints
    assert "kept my_lift: gesture of" in teaching.said and "the right arm" in teaching.said
    clip = GestureLibrary(gestures).get("my_lift")
    assert (clip.side, clip.text) == ("right", "lifts an arm")
    with daemon.client() as client:
        assert client.status().state == "limp" and not servos.torque, "teaching gives no torque"
        assert next(g for g in client.capabilities().gestures if g.name == "my_lift").own


@pytest.mark.long
def test_a_led_arm_becomes_a_gesture_that_the_robot_shows(taught, servos, gestures):
    """From an armed robot to the played gesture; text cannot arm it meanwhile, and the audit of every goal is clean."""
    daemon, begun = taught
    with daemon.client() as client:
        client.arm()
        client.wait_for("idle", timeout_s=20)
        with begun("my_lift", "--limp", "--play", "--text", "lifts an arm") as teaching:
            teaching.until("it may go limp now? (yes or no)")
            assert servos.torque and "FALLS" in teaching.said and "waist_pitch" in teaching.said
            teaching.type("yes")
            teaching.until("Enter ends it")
            within(5, "no servo has torque", lambda: not servos.torque)
            lead(daemon, servos, UP_AND_DOWN)
            with pytest.raises(RefusedError, match="arm"):
                client.say("wave", wait=False)
            lead(daemon, servos, [raised(0.6)] * 3)  # it is armed from where the hand left it
            teaching.type("")
            teaching.until("let go of the robot")
            assert client.status().state == "limp" and not servos.torque
            teaching.type("yes")
            status, complaints = teaching.ended()
        assert status == 0, complaints
        assert "kept my_lift: gesture of" in teaching.said and "the right arm" in teaching.said
        clip = GestureLibrary(gestures).get("my_lift")
        assert (clip.side, clip.text) == ("right", "lifts an arm")
        shown = Retargeter(ROBOT).retarget(clip.posture.motion()).q_rad
        assert np.abs(shown - raised(1.0))[:, [RIGHT_ROLL, RIGHT_ELBOW]].max(1).min() < np.deg2rad(5)
        assert 2.0 < len(clip.posture) / clip.posture.fps
        still = np.abs(np.diff(shown, axis=0)).max(1) < np.deg2rad(0.2)
        assert max(still.argmin(), still[::-1].argmin()) < clip.posture.fps, "its still ends are cut"
        info = next(g for g in client.capabilities().gestures if g.name == "my_lift")
        assert info.own and info.side == "right"
        assert client.gesture("my_lift", mirror=True).done is not None


def test_ctrl_c_leaves_the_robot_limp_and_says_what_is_lost(taught, servos, gestures):
    daemon, begun = taught
    with begun("my_lift", "--limp", "--yes") as teaching:
        teaching.until("Enter ends it")
        lead(daemon, servos, UP_AND_DOWN[:20])
        teaching.interrupt()
        status, complaints = teaching.ended()
    assert status == 130
    assert "recorded and are NOT kept" in complaints and "only `mmmd arm` leads on" in complaints
    assert not servos.torque and not gestures.exists()
    with daemon.client() as client:
        assert client.status().state == "limp"


@pytest.mark.long
def test_ctrl_c_before_and_after_the_recording_says_what_the_robot_does(taught, servos, gestures):
    """At the question, on the way to the park pose or to rest, in the motion: safe, and nothing that was taught is lost."""
    daemon, begun = taught
    asked, plays = ("my_lift", "--limp"), ("my_lift", "--limp", "--play", "--force")
    with daemon.client() as client:
        client.arm()
        client.gesture("raise_right", hold=True)

        def stopped(teaching: Teaching, says: str, *ends: str) -> None:
            teaching.interrupt()
            status, complaints = teaching.ended()
            assert status == 130 and says in complaints and "NOT kept" not in complaints, complaints
            client.wait_for(*ends, timeout_s=20)

        with begun(*asked) as teaching:
            teaching.until("(yes or no)")
            stopped(teaching, "nothing was changed", "idle", "holding")
            assert servos.torque
        with begun(*asked) as teaching:
            teaching.until("(yes or no)")
            teaching.type("yes")
            client.wait_for("parking", timeout_s=5)
            stopped(teaching, "goes on to park", "limp")
        for moment, says, ends in (
            ("arming", "goes on slowly to its rest pose", "idle"), ("moving", "cancelled 'my_lift'", "holding"),
        ):  # fmt: skip
            with begun(*plays) as teaching:
                teaching.until("(yes or no)")
                teaching.type("yes")
                teaching.until("Enter ends it")
                lead(daemon, servos, UP_AND_DOWN)
                teaching.type("")
                teaching.until("let go of the robot")
                teaching.type("yes")
                client.wait_for(moment, timeout_s=20)
                stopped(teaching, says, ends)
    assert GestureLibrary(gestures).get("my_lift").side == "right"


@pytest.mark.parametrize("disturb", few_and_long(["estop"], ["arm"]))
def test_an_estop_or_somebody_who_arms_ends_the_recording(taught, servos, disturb):
    daemon, begun = taught
    with begun("my_lift", "--limp", "--yes", "--seconds", "30") as teaching, daemon.client() as client:
        teaching.until("move the arms; 30 s")
        lead(daemon, servos, UP_AND_DOWN[:5])
        getattr(client, disturb)()
        status, complaints = teaching.ended()
        assert status == 2 and "so the recording ended" in complaints and "NOT kept" in complaints


@pytest.mark.long
def test_a_pose_is_taught_and_gone_through(taught, servos, gestures):
    daemon, _ = taught
    lead(daemon, servos, [raised(1.0)])
    done = daemon.mmmd("gesture", "teach", "arm_out", "--limp", "--yes", "--pose", "--seconds", "1")
    assert done.returncode == 0, done.stderr
    clip = GestureLibrary(gestures).get("arm_out")
    assert len(clip.posture) == 20 and "inbetween arm_out@2" in done.stdout
    with daemon.client() as client:
        client.arm()
        client.wait_for("idle", timeout_s=20)
        for show in (
            lambda: client.gesture("arm_out", hold=True),
            lambda: client.inbetween([KeyPoseOf(at_s=1, standing=True), KeyPoseOf(at_s=2.5, gesture="arm_out")]),
        ):
            show()
            there = np.array(client.status().goal_rad)
            assert np.abs(there - raised(1.0))[[RIGHT_ROLL, RIGHT_ELBOW]].max() < np.deg2rad(5)


@pytest.mark.long
def test_the_example_goes_from_one_taught_pose_to_another(taught, servos):
    """docs/examples/inbetween_taught.py: at its end the robot is in the first pose again, and it has been in the second."""
    daemon, _ = taught
    for name, share in (("arm_low", 0.5), ("arm_high", 1.0)):
        lead(daemon, servos, [raised(share)])
        done = daemon.mmmd("gesture", "teach", name, "--limp", "--yes", "--pose", "--seconds", "1")
        assert done.returncode == 0, done.stderr
    with daemon.client() as client, daemon.client() as watcher:
        client.arm()
        client.wait_for("idle", timeout_s=20)
        example = [sys.executable, str(EXAMPLE), "arm_low", "arm_high", *daemon.at]
        process = subprocess.Popen(example, stdout=subprocess.PIPE, text=True)
        goals = []
        for _, state in watcher.watch("v1/state"):
            goals.append(state.goal_rad)
            if process.poll() is not None or len(goals) > 20 * 60:
                break
        said, _ = process.communicate(timeout=30)
    assert process.returncode == 0 and said.startswith("arm_low, arm_high and arm_low again"), said
    arm = np.array(goals)[:, [RIGHT_ROLL, RIGHT_ELBOW]]

    def nearest_deg(share: float, rows: np.ndarray) -> float:
        return np.rad2deg(np.abs(rows - raised(share)[[RIGHT_ROLL, RIGHT_ELBOW]]).max(1).min())

    assert nearest_deg(1.0, arm) < 5 and nearest_deg(0.5, arm[-1:]) < 5


REFUSED = [
    (("my_lift", "--yes"), "", 2, "waist_pitch would fall"),
    (("my_lift", "--limp"), "no", 2, "nothing was changed"),
    (("nod", "--limp", "--yes"), "", 1, "one that ships"),
    (("nod", "--limp"), "no", 1, "one that ships"),
    (("my_lift", "--limp"), None, 2, "end of input"),
    (("My Lift", "--limp"), "", 2, "a-z"),
    (("my_lift", "--limp", "--seconds", "600"), "", 2, "60 at most"),
]


@pytest.mark.parametrize("cases", few_and_long([REFUSED[:2]], [REFUSED[2:]]), ids=["limp", "other"])
def test_nothing_goes_limp_or_is_written_over_unasked(taught, servos, gestures, monkeypatch, cases):
    """A trunk that would fall, a name that is taken, a no, an end of input: refused before anything changes."""
    daemon, _ = taught
    with daemon.client() as client:
        client.arm()
        client.wait_for("idle", timeout_s=20)
        for arguments, typed, wanted, says in cases:
            monkeypatch.setattr(sys, "stdin", io.StringIO("" if typed is None else f"{typed}\n"))
            done = daemon.mmmd("gesture", "teach", *arguments)
            assert done.returncode == wanted and says in done.stderr, (arguments, done.returncode, done.stderr)
            assert client.status().state in ("idle", "holding") and servos.torque
    assert not gestures.exists()
