"""Motions built from kinematics, and a peer that serves them over the generator's protocol: for tests of the front.

The peer speaks for a model whose answer is known; the daemon under test is the real one.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import zmq

from daemon.generator.generated import Generated, motion_from
from daemon.generator.messages import BetweenMessage, EditMessage, GenerateMessage, SceneMessage, UnfitRequestError
from daemon.generator.process import serve
from daemon.network.keys import Doorkeeper, KeyFolder, serve_curve
from mmm_core.motion.motion import Motion
from mmm_core.motion.skeleton import BONE_LENGTHS_M, JOINT_NAMES, PARENTS

LET_GO = threading.Event()
"""A motion whose draft was played may come."""

FPS = 20.0
DOWN = {"hip": (1, -0.3, 0), "knee": (0, -1, 0), "ankle": (0, -1, 0), "foot": (0, -0.2, 1), "collar": (0.6, 0.8, 0),
        "shoulder": (1, 0, 0), "elbow": (0.1, -1, 0), "wrist": (0, -1, 0.1)}  # fmt: skip


def raised_arm(
    text: str = "raise your right arm", seconds: float = 1.0, angle_rad: float = 1.2, side: str = "right"
) -> Motion:
    """A person who stands and lifts one straight arm sideways and lowers it, on a minimum-jerk path."""
    T = max(2, round(seconds * FPS))
    phase = np.linspace(0, 1, T)
    up = 1 - np.abs(2 * phase - 1)
    lift = angle_rad * (10 * up**3 - 15 * up**4 + 6 * up**5)
    joints = np.zeros((T, 22, 3))
    joints[:, 0, 1] = 0.95
    for j, p in enumerate(PARENTS[1:], 1):
        name_side, _, part = JOINT_NAMES[j].partition("_")
        direction = np.tile(np.array(DOWN[part] if part else (0, 1, 0.05), float), (T, 1))
        if part in ("elbow", "wrist") and name_side == side:
            direction = np.stack([np.sin(0.1 + lift), -np.cos(0.1 + lift), 0.1 * np.ones(T)], -1)
        if name_side == "right":
            direction[:, 0] *= -1
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        joints[:, j] = joints[:, p] + BONE_LENGTHS_M[j] * direction
    return motion_of(joints, text)


def motion_of(joints: np.ndarray, text: str, status: str = "accepted", score: float = 0.9) -> Motion:
    T = len(joints)
    return Motion(
        joints_m=joints.astype(np.float32), fps=FPS, head_quat_wxyz=np.tile(np.array([1, 0, 0, 0], np.float32), (T, 1)),
        forearm_twist_rad=np.zeros((T, 2), np.float32), features=np.zeros((T, 263), np.float32),
        tokens=np.zeros(max(1, T // 4), np.int64), text=text, seed=0, status=status, scope_score=score,
    )  # fmt: skip


def generate(text: str, seed: int, seconds: float | None) -> Generated:
    """Raises an arm for any text but a few that misbehave on purpose."""
    if "somersault" in text:
        return Generated(
            motion_of(np.zeros((0, 22, 3)), text, "rejected", 0.1), "", "needs the legs", {"text": 1.0}, "k"
        )
    if "broken" in text:
        raise ValueError("the model broke")
    if "slow" in text:
        time.sleep(0.3)
    if "short" in text:
        return Generated(motion_of(np.zeros((1, 22, 3)), text), "", "", {}, "k")
    side = "left" if "left" in text else "right"
    motion = raised_arm(text, seconds or 0.8, 0.8, side)
    return Generated(motion, f"raise the {side} arm (0.90)", "", {"decode": 2.0}, "kinematic")


class KinematicMaker:
    """Answers every kind of request by the motion that `answer` gives for its text."""

    def __init__(self, answer: Callable[[str, int, float | None], Generated] = generate) -> None:
        self._answer = answer

    def generate(self, request: GenerateMessage) -> Iterator[Generated]:
        """What it is to go on from is told by `understood`: how long that is, and which wrist is higher at its end.

        Of a text with "drafted" in it there is a draft of half the way up and half the length, and half a second later the
        motion; with "lost" the motion never comes, with "held" once `LET_GO` is set.
        """
        made = self._answer(request.text, request.seed, request.seconds)
        if request.before is not None:
            before = motion_from(request.before)
            higher = ("left", "right")[int(before.joints_m[-1, 20, 1] < before.joints_m[-1, 21, 1])]
            shown = f"{len(before.joints_m)} frames, {higher} arm up, {request.prefix_s:g} s of them"
            made = replace(made, understood=f"{made.understood} after {shown}")
        elif request.draft and "drafted" in request.text:
            n_frames = len(made.motion.joints_m)
            lower = self._answer(request.text, request.seed, n_frames / FPS / 2).motion
            yield replace(made, motion=lower, draft_of=n_frames)
            if "lost" in request.text:
                raise ValueError("lost after the draft")
            if "held" not in request.text:
                time.sleep(0.5)
            elif not LET_GO.wait(5.0):
                raise ValueError("nobody let go")
        yield made

    def scene(self, request: SceneMessage) -> Generated:
        """One motion a scene; `told` counts them, and a generator that does not get it back refuses."""
        told = int(request.told or b"0")
        if request.text is None:
            return Generated(raised_arm("", 0.4, 0.1), "", "", {}, "kinematic", b"end")
        made = self._answer(request.text, request.seed, request.seconds)
        return replace(made, told=str(told + 1).encode())

    def edit(self, request: EditMessage) -> Generated:
        """As long as the original; what is edited where is told by `understood`."""
        original = motion_from(request.motion)
        if "tail" in request.parts:
            raise UnfitRequestError("bad_edit", "the part 'tail' was asked for", "left_arm, right_arm, rest")
        made = self._answer(request.text, request.seed, original.duration_s)
        where = f"{'+'.join(request.parts) or 'all'} {request.start_s:g}-{request.end_s}"
        return replace(made, understood=f"{original.text}: {where}")

    def between(self, request: BetweenMessage) -> Generated:
        """A raised arm of the right length, whatever the poses are; the front leads it through them."""
        assert len(motion_from(request.poses).joints_m) == len(request.at_s)
        made = self._answer(request.text or "right", request.seed, max(request.at_s))
        return replace(made, understood=f"{len(request.at_s)} poses until {request.at_s[-1]:g} s")


class KinematicGenerator:
    """Serves `generate` at an endpoint, in a thread; behind CURVE where there are `keys`."""

    def __init__(
        self,
        endpoint: str,
        answer: Callable[[str, int, float | None], Generated] = generate,
        keys: KeyFolder | None = None,
    ) -> None:
        self.endpoint = endpoint
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.ROUTER)
        self._doorkeeper = None
        if keys is not None:
            self._doorkeeper = Doorkeeper(self._context, keys)
            serve_curve(self._socket, keys)
        self._socket.bind(endpoint)
        self._stopping = threading.Event()
        self._thread = threading.Thread(
            target=serve,
            args=(self._socket, KinematicMaker(answer), "kinematic", lambda: not self._stopping.is_set()),
            daemon=True,
        )
        self._thread.start()

    def close(self) -> None:
        self._stopping.set()
        self._thread.join(5)
        if self._doorkeeper is not None:
            self._doorkeeper.close()
        self._context.destroy(linger=0)
