"""Random sequences of commands against a model of the robot: one state and one ending after each, never one of several.

The model is written here by hand from DESIGN and docs/states.md; it knows no table of the daemon's. Motions either go round
without end, so that nothing but a command ends them, or are waited for to their end.
"""

from __future__ import annotations

import random
import time
import uuid
from collections import Counter
from collections.abc import Callable

import pytest

from daemon.client import CancelledByError, Client, RefusedError
from daemon.wire.requests import Edit, Gesture, Inbetween, KeyPoseOf, Play, Replay, Say, SceneOf, Story, tag_of
from daemon.wire.status import StateEvent
from tests.support.harness import running_daemon

pytestmark = [pytest.mark.timeout(150), pytest.mark.realtime]
PLAYS = ("say", "gesture", "story", "edit", "inbetween", "replay")
OTHERS = ("lease", "arm", "park", "stop", "torque_off", "estop", "reset", "look", "idle", "cancel", "record")
AFTER = {
    "arm": {"limp": "idle", "idle": "idle", "moving": "moving", "holding": "holding"},
    "park": {"limp": "limp", "idle": "limp", "moving": "limp", "holding": "limp"},
    "stop": {"limp": "limp", "idle": "idle", "moving": "holding", "holding": "holding", "estop": "estop"},
    "torque_off": {"limp": "limp", "idle": "limp", "moving": "limp", "holding": "limp"},
    "estop": {"limp": "estop", "idle": "estop", "moving": "estop", "holding": "estop", "estop": "estop"},
    "reset": {"limp": "limp", "idle": "idle", "moving": "moving", "holding": "holding", "estop": "limp"},
}
"""Verb -> the state before -> the state it ends in when nobody interferes; where there is none it is refused."""
ENDS_MOTION = ("park", "stop", "torque_off", "estop", "cancel")
WAY_OUT = {"limp": "arm", "estop": "reset"}
SEED, STEPS = 2091, 16
"""In so few steps this sequence has 15 of the 17 verbs, each that ends a motion while the robot moves among them."""
FRESH_STEPS = 25
WITHIN_S = 12.0
"""Longest for a state to come: arming, or parking from far away, on a busy machine."""
SETTLED_CYCLES = 10


class Sequence:
    """The model, and the daemon that has to agree with it after each step.

    Attributes:
        state: limp, idle, moving, holding or estop.
        must_arm: whether a motion may not arm the robot.
        playing: the motion that goes round, None for none.
        told: what was done, for the message of a failure.
        tried: how often each verb was given in each state.
    """

    def __init__(self, client: Client, rng: random.Random) -> None:
        self._client, self._rng = client, rng
        self.state, self.must_arm = "limp", False
        self.playing: Play | None = None
        self.told: list[str] = []
        self.tried: Counter[tuple[str, str]] = Counter()
        self._newest_id = ""
        self._stirs = False

    def step(self) -> None:
        """One command that is drawn by chance, and what has to come of it."""
        verb = self._draw()
        self.tried[verb, self.state] += 1
        self.told.append(f"{verb} in {self.state}")
        if verb in PLAYS:
            self._play(verb)
        elif verb in AFTER:
            self._control(verb)
        else:
            getattr(self, f"_{verb}")()
        self._agree()

    def _draw(self) -> str:
        """What was done least in this state; half of the time what leads to motion, or what ends it."""
        verbs = (*PLAYS, *OTHERS)
        if self._rng.random() < 0.5:
            if self.state == "moving":
                verbs = ENDS_MOTION
            else:
                verbs = PLAYS if self._moves else (WAY_OUT[self.state],)
        least = min(self.tried[verb, self.state] for verb in verbs)
        return self._rng.choice([verb for verb in verbs if self.tried[verb, self.state] == least])

    @property
    def _moves(self) -> bool:
        """Whether a motion is taken now."""
        return self.state != "estop" and not (self.state == "limp" and self.must_arm)

    def _play(self, verb: str) -> None:
        endless = self._rng.random() < 0.6
        request = self._request(verb, endless)
        if not self._moves:
            self._refused("wrong_state", lambda: self._client.play(request, wait=False))
            return
        said = self._client.play(request, wait=not endless, timeout_s=WITHIN_S + 20)
        self._newest_id = self._newest_id if verb == "story" else request.id  # a story cannot be played once more
        before, self.playing = self.playing, request if endless else None
        if endless:
            self._until("moves", lambda s: s.command is not None and s.command.id == request.id)
        else:
            assert said.done is not None, self.told
        self.state = "moving" if endless else "idle"
        if before is not None:
            self._cancelled(before, f"{tag_of(request)} {request.id}")

    def _request(self, verb: str, endless: bool) -> Play:
        """A motion with options drawn by chance."""
        r = self._rng
        options = {
            "id": uuid.UUID(int=r.getrandbits(128)).hex, "loop": endless, "mirror": r.random() < 0.5,
            "tempo": r.uniform(0.8, 2.0), "amplitude": r.uniform(0.3, 1.2),
        }  # fmt: skip
        if verb == "gesture" or (verb == "replay" and not self._newest_id):
            return Gesture(name=r.choice(("nod", "wave_right", "bow")), **options)
        if verb == "story":
            return Story(scenes=[SceneOf(text="wave", seconds=0.6), SceneOf(text="left", seconds=0.6)], **options)
        if verb == "edit":
            return Edit(text="left", gesture="nod", parts=["left_arm"], **options)
        if verb == "inbetween":
            return Inbetween(poses=[KeyPoseOf(at_s=0.4, gesture="bow"), KeyPoseOf(at_s=1.0, standing=True)], **options)
        if verb == "replay":
            return Replay(command=self._newest_id, **options)
        return Say(text=r.choice(("wave", "left")), seconds=r.uniform(0.4, 1.5), **options)

    def _lease(self) -> None:
        def hold() -> str:
            with self._client.stream("sequence", timeout_s=WITHIN_S) as stream:
                for k in range(5):
                    stream.send({"r_shoulder_pitch": 0.02 * k})
                    time.sleep(0.01)
            return stream.news.id

        if not self._moves:
            self._refused("wrong_state", hold)
            return
        lease_id = hold()  # which returns once it is done
        before, self.playing, self.state = self.playing, None, "idle"
        if before is not None:
            self._cancelled(before, f"lease {lease_id}")

    def _control(self, verb: str) -> None:
        following = AFTER[verb].get(self.state)
        if following is None:
            self._refused("wrong_state", lambda: getattr(self._client, verb)(wait=False))
            return
        getattr(self._client, verb)(wait=False)
        if verb == "stop" and self.state == "idle" and self._stirs:  # braking from a small movement is told as holding
            self._settle()
            following = self._client.status().state
            assert following in ("idle", "holding"), self.told
        self.must_arm = (self.must_arm or verb in ("torque_off", "estop")) and verb != "arm"
        self._ended(verb)
        self.state = following

    def _cancel(self) -> None:
        if self.playing is None:
            self._refused("not_running", self._client.cancel)
            return
        self._client.cancel(self._rng.choice(("", self.playing.id)))
        self._ended("cancel")
        self.state = "holding"

    def _record(self) -> None:
        if self._newest_id:
            self._client.record("sequence", replace=True)
        else:
            self._refused("bad_gesture", lambda: self._client.record("sequence"))

    def _look(self) -> None:
        self._client.look(self._rng.uniform(-40, 40))
        self._stirs = True

    def _idle(self) -> None:
        self._client.idle(self._rng.random() < 0.7)
        self._stirs = True

    def _ended(self, verb: str) -> None:
        if verb in ENDS_MOTION and self.playing is not None:
            before, self.playing = self.playing, None
            self._cancelled(before, verb.replace("_", " "))

    def _cancelled(self, request: Play, by: str) -> None:
        """The same id again is the same command: its events up to the last are told once more."""
        with pytest.raises(CancelledByError) as caught:
            self._client.play(request, timeout_s=5.0)
        assert caught.value.by == by, self.told

    def _refused(self, code: str, ask: Callable[[], object]) -> None:
        with pytest.raises(RefusedError) as caught:
            ask()
        assert caught.value.code == code, self.told

    def _agree(self) -> None:
        """The daemon comes to the model's state and stays there."""
        self._until(self.state, lambda s: s.state == self.state)
        if self._rng.random() < 0.3:
            time.sleep(self._rng.uniform(0, 1.5))
        self._settle()
        status = self._client.status()
        assert (status.state, status.must_arm) == (self.state, self.must_arm), self.told
        assert (status.command.id if status.command else None) == (self.playing.id if self.playing else None), self.told
        assert not status.waiting, self.told

    def _settle(self) -> None:
        """Wait until the bus process has surely taken what it was told, and the front has heard of it."""
        begun = self._client.status().bus_info["cycles"]
        self._until("cycles", lambda s: s.bus_info["cycles"] > begun + SETTLED_CYCLES)

    def _until(self, what: str, reached: Callable[[StateEvent], bool]) -> None:
        end_s = time.monotonic() + WITHIN_S
        while not reached(status := self._client.status()):
            assert time.monotonic() < end_s, (what, status.state, status.reason, self.told)
            time.sleep(0.02)


@pytest.mark.parametrize(
    ("seed", "steps"),
    [
        pytest.param(SEED, STEPS, marks=pytest.mark.long),
        pytest.param(None, FRESH_STEPS, id="fresh", marks=pytest.mark.soak),
    ],
)
def test_random_sequences_keep_to_the_model(seed, steps, tmp_path):
    drawn = seed or random.SystemRandom().randrange(10**6)
    with running_daemon("--gestures", str(tmp_path)) as daemon, daemon.client() as client:
        sequence = Sequence(client, random.Random(drawn))
        sequence.told.append(f"seed {drawn}")
        for _ in range(steps):
            sequence.step()
        client.estop()
        client.reset()
        assert seed is None or all(sequence.tried[verb, "moving"] for verb in ENDS_MOTION), sequence.told
        assert "cannot follow" not in daemon.said, sequence.told


@pytest.mark.long
def test_a_stop_of_a_limp_robot_is_over_once_it_is_armed():
    """It was told as holding, and idle movements never began: the stop of before counted for what came after."""
    with running_daemon() as daemon, daemon.client() as client:
        client.stop()
        client.arm()
        assert client.wait_for("idle", "holding", timeout_s=10).state == "idle"
