"""The gesture families: how each is performed. A function writes one gesture into a score; docs/corpus.md shows how to add one.

Poses are (outward, up, forward) in the chest frame; see `mmm_core.corpus.score`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mmm_core.corpus.score import ArmPose, Score, Vector

Limb = str
"""arm, head or trunk: what a viewer sees move."""


@dataclass(frozen=True)
class Gesture:
    """One gesture of a clip.

    Attributes:
        family: a key of `FAMILIES`.
        side: left, right, both, or "" where the family has none.
        count: repetitions; 1 where the family does not repeat.
        direction: left, right, up, down, forward, ...; "" where the family has none.
        tempo: 1 is usual, above it faster.
        size: 1 is usual, above it larger.
    """

    family: str
    side: str = ""
    count: int = 1
    direction: str = ""
    tempo: float = 1.0
    size: float = 1.0

    @property
    def arms(self) -> tuple[str, ...]:
        """Channels of the arms that act."""
        return {"left": ("left",), "right": ("right",)}.get(self.side, ("left", "right"))


@dataclass(frozen=True)
class Family:
    """What a family of gestures is made of.

    Attributes:
        perform: writes the gesture into a score.
        limb: what is seen to move.
        sides: sides it can have; empty when it has none.
        counts: whether it can be repeated a number of times.
        directions: directions it can have.
        holds: whether it ends in a pose that may be kept.
    """

    perform: Callable[[Score, Gesture], None]
    limb: Limb = "arm"
    sides: tuple[str, ...] = ("left", "right", "both")
    counts: bool = False
    directions: tuple[str, ...] = ()
    holds: bool = False


def _vary(rng: np.random.Generator, v: Vector, amount: float = 0.05) -> Vector:
    x = np.asarray(v, float) + rng.normal(0, amount, 3)
    return (float(x[0]), float(x[1]), float(x[2]))


def _pose(score: Score, pose: ArmPose, amount: float = 0.05) -> ArmPose:
    """The pose, slightly different each time."""
    rng = score.rng
    return ArmPose(_vary(rng, pose.upper, amount), _vary(rng, pose.fore, amount), pose.twist_rad + rng.normal(0, 0.08))


def _reach_s(score: Score, g: Gesture, usual: float = 0.65) -> float:
    return usual * score.rng.uniform(0.85, 1.2) / g.tempo


def _arms(score: Score, g: Gesture, pose: ArmPose, duration_s: float | None = None, amount: float = 0.05) -> None:
    """Bring the acting arms to a pose."""
    posed = _pose(score, pose, amount)
    score.move(duration_s or _reach_s(score, g), **dict.fromkeys(g.arms, posed))


def _repeat(score: Score, g: Gesture, out: ArmPose, back: ArmPose, cycle_s: float = 0.66) -> None:
    """`count` strokes to `out` and back; strokes differ a little, cycles are never shorter than half a second."""
    rng = score.rng
    cycle = max(0.5, cycle_s / g.tempo * rng.uniform(0.9, 1.1))
    for _ in range(g.count):
        there = cycle * rng.uniform(0.47, 0.53)
        _arms(score, g, out, there, 0.03)
        _arms(score, g, back, max(0.25, cycle - there), 0.03)


def _still(pose: ArmPose, usual_s: tuple[float, float] = (0.7, 2.0)) -> Callable[[Score, Gesture], None]:
    """A family that takes a pose and keeps it a while."""

    def perform(score: Score, g: Gesture) -> None:
        _arms(score, g, pose)
        score.hold(score.rng.uniform(*usual_s))

    return perform


def _strokes(ready: ArmPose, out: ArmPose, cycle_s: float = 0.66) -> Callable[[Score, Gesture], None]:
    """A family that takes a pose and repeats a stroke from it."""

    def perform(score: Score, g: Gesture) -> None:
        _arms(score, g, ready)
        _repeat(score, g, out, ready, cycle_s)

    return perform


def _wave(score: Score, g: Gesture) -> None:
    rng, s = score.rng, g.size
    high = rng.random() < 0.35
    upper: Vector = (0.55, 0.55, 0.45) if high else (0.75, -0.15, 0.5)
    _arms(score, g, ArmPose(upper, (0.1, 0.97, 0.2)))
    cycle = max(0.5, 0.62 / g.tempo)
    for _ in range(g.count):
        out = ArmPose(upper, (0.12 + 0.6 * s, 0.85, 0.2))
        inward = ArmPose(upper, (0.12 - 0.45 * s, 0.9, 0.2))
        _arms(score, g, out, cycle * 0.5 * rng.uniform(0.92, 1.08), 0.03)
        _arms(score, g, inward, cycle * 0.5 * rng.uniform(0.92, 1.08), 0.03)


def _punch(score: Score, g: Gesture) -> None:
    rng, s = score.rng, g.size
    guard = ArmPose((0.25, -0.75, 0.3), (-0.15, 0.75, 0.65), 0.3)
    strike = ArmPose((0.1, -0.05, 1.0), (-0.08, 0.05 * s, 1.0), -0.8)
    if g.side == "both":  # one after the other
        score.move(_reach_s(score, g, 0.5), left=_pose(score, guard), right=_pose(score, guard))
        first = rng.integers(2)
        for i in range(g.count):
            arm = ("left", "right")[(first + i) % 2]
            score.move(0.26 / g.tempo**0.5, **{arm: _pose(score, strike, 0.03)})
            score.move(0.32 / g.tempo**0.5, **{arm: _pose(score, guard, 0.03)})
        return
    _arms(score, g, guard, _reach_s(score, g, 0.5))
    for _ in range(g.count):
        _arms(score, g, strike, 0.27 / g.tempo**0.5, 0.03)
        _arms(score, g, guard, 0.35 / g.tempo**0.5, 0.03)


_POINT = {
    "forward": ArmPose((0.12, -0.08, 1), (0.02, 0.05, 1)),
    "up": ArmPose((0.2, 0.9, 0.3), (0.05, 1, 0.1)),
    "down": ArmPose((0.25, -0.75, 0.6), (0.1, -0.75, 0.65)),
    "out": ArmPose((1, 0.02, 0.15), (1, 0.05, 0.12)),
    "across": ArmPose((-0.35, -0.1, 0.9), (-0.9, 0.05, 0.45)),
    "self": ArmPose((0.35, -0.75, 0.45), (-0.75, 0.35, -0.1)),
}


def _point(score: Score, g: Gesture) -> None:
    key = g.direction
    if key in ("left", "right"):
        key = "out" if g.side == key else "across"
    if g.direction in ("left", "right") and score.rng.random() < 0.5:
        yaw = (1 if g.direction == "left" else -1) * score.rng.uniform(0.2, 0.5)
        score.move(0.001, head=score.now("head"))
        posed = _pose(score, _POINT[key], 0.04)
        score.move(_reach_s(score, g), **dict.fromkeys(g.arms, posed), head=(yaw, 0.0, 0.0))  # type: ignore[arg-type]
    else:
        _arms(score, g, _POINT[key], amount=0.04)
    score.hold(score.rng.uniform(0.6, 1.8))


def _clap(score: Score, g: Gesture) -> None:
    overhead = g.direction == "up"
    if overhead:
        together, apart = ArmPose((0.0, 0.85, 0.45), (-0.66, 0.74, 0.1)), ArmPose((0.45, 0.8, 0.4), (0.2, 0.95, 0.15))
    else:
        together = ArmPose((0.05, -0.75, 0.6), (-0.71, 0.25, 0.65), 0.2)
        apart = ArmPose((0.35, -0.75, 0.5), (0.1 + 0.12 * g.size, 0.25, 0.9), 0.2)
    score.move(_reach_s(score, g), left=apart, right=apart)
    cycle = max(0.5, 0.56 / g.tempo)
    for _ in range(g.count):
        close = cycle * score.rng.uniform(0.42, 0.5)
        score.move(close, left=together, right=together)
        score.move(cycle - close, left=apart, right=apart)


def _bow(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        depth = np.deg2rad(38) * g.size * score.rng.uniform(0.85, 1.15)
        score.move(_reach_s(score, g, 0.85), trunk=(0.0, depth, 0.0), head=(0.0, 0.3 * depth, 0.0))
        score.hold(score.rng.uniform(0.15, 0.7))
        score.move(_reach_s(score, g, 0.85), trunk=(0.0, 0.0, 0.0), head=(0.0, 0.0, 0.0))


def _nod(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        depth = np.deg2rad(23) * g.size * score.rng.uniform(0.9, 1.15)
        half = max(0.25, 0.32 / g.tempo)
        score.move(half, head=(0.0, depth, 0.0))
        score.move(half * score.rng.uniform(1.0, 1.15), head=(0.0, score.rng.uniform(-0.06, 0.02), 0.0))


def _shake(score: Score, g: Gesture) -> None:
    first = 1 if score.rng.random() < 0.5 else -1
    angle = np.deg2rad(30) * g.size
    half = max(0.26, 0.33 / g.tempo)
    score.move(half * 0.7, head=(first * angle * score.rng.uniform(0.9, 1.1), 0.0, 0.0))
    for _ in range(g.count):
        score.move(half, head=(-first * angle * score.rng.uniform(0.9, 1.1), 0.0, 0.0))
        score.move(half, head=(first * angle * score.rng.uniform(0.9, 1.1), 0.0, 0.0))
    score.move(half * 0.7, head=(0.0, 0.0, 0.0))


_SIGN = {"left": 1.0, "right": -1.0}


def _turned(channel: str, low_deg: float, high_deg: float, axis: int) -> Callable[[Score, Gesture], None]:
    """Turn head or trunk about one axis towards a side and keep it."""

    def perform(score: Score, g: Gesture) -> None:
        angle = np.deg2rad(score.rng.uniform(low_deg, high_deg)) * _SIGN[g.direction] * g.size
        target = [0.0, 0.0, 0.0]
        target[axis] = angle
        score.move(_reach_s(score, g, 0.6), **{channel: np.array(target)})
        score.hold(score.rng.uniform(0.5, 1.6))

    return perform


def _look(score: Score, g: Gesture) -> None:
    if g.direction in _SIGN:
        yaw = np.deg2rad(score.rng.uniform(42, 62)) * _SIGN[g.direction]
        target = (yaw, score.rng.uniform(-0.08, 0.08), 0.0)
        trunk = (0.15 * yaw, 0.0, 0.0)
    else:
        pitch = np.deg2rad(score.rng.uniform(28, 40)) * {"up": -1.0, "down": 1.0}[g.direction]
        target, trunk = (0.0, pitch, 0.0), (0.0, 0.08 * pitch, 0.0)
    score.move(_reach_s(score, g, 0.55), head=target, trunk=trunk)
    score.hold(score.rng.uniform(0.5, 1.6))


def _look_around(score: Score, g: Gesture) -> None:
    first = 1 if score.rng.random() < 0.5 else -1
    for side in (first, -first):
        yaw = side * np.deg2rad(score.rng.uniform(40, 58))
        score.move(_reach_s(score, g, 0.8), head=(yaw, 0.0, 0.0), trunk=(0.15 * yaw, 0.0, 0.0))
        score.hold(score.rng.uniform(0.2, 0.6))


def _lean(score: Score, g: Gesture) -> None:
    angle = np.deg2rad(score.rng.uniform(16, 24)) * g.size
    target = {
        "left": (0.0, 0.0, angle),
        "right": (0.0, 0.0, -angle),
        "forward": (0.0, angle, 0.0),
        "back": (0.0, -0.6 * angle, 0.0),
    }
    score.move(_reach_s(score, g, 0.75), trunk=target[g.direction])
    score.hold(score.rng.uniform(0.5, 1.5))


def _cross(score: Score, g: Gesture) -> None:
    above = ArmPose((-0.1, -0.8, 0.6), (-0.93, 0.28, 0.25))
    below = ArmPose((-0.1, -0.83, 0.5), (-0.95, 0.12, 0.2))
    left_above = score.rng.random() < 0.5
    pair = {"left": above if left_above else below, "right": below if left_above else above}
    score.move(_reach_s(score, g, 0.8), **pair)  # type: ignore[arg-type]
    score.hold(score.rng.uniform(0.8, 2.2))


def _shrug(score: Score, g: Gesture) -> None:
    palms = ArmPose((0.3, -0.85, 0.25), (0.65, 0.15, 0.7), 1.0)
    for _ in range(g.count):
        score.move(
            _reach_s(score, g, 0.42),
            shrug=1.0 * g.size,
            left=palms,
            right=palms,
            head=(0.0, 0.0, score.rng.uniform(-0.15, 0.15)),
        )
        score.hold(score.rng.uniform(0.2, 0.6))
        score.move(_reach_s(score, g, 0.42), shrug=0.0, **({} if g.count == 1 else {"head": (0.0, 0.0, 0.0)}))


def _circle(score: Score, g: Gesture) -> None:
    """Straight arms draw circles in the side plane, forward or backward over the top."""
    steps = 8
    turn = 1.0 if g.direction != "back" else -1.0
    period = max(0.9, 1.25 / g.tempo)
    wide = 0.55 * g.size
    _arms(score, g, ArmPose((0.8, -wide, 0.1), (0.8, -wide, 0.1)), amount=0.0)
    for i in range(1, g.count * steps + 1):
        a = 2 * np.pi * i / steps
        v: Vector = (0.8, -wide * float(np.cos(a)), 0.1 + turn * -wide * float(np.sin(a)))
        _arms(score, g, ArmPose(v, v), period / steps, 0.0)


def _flap(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.85, -0.5, 0.1), (0.8, -0.6, 0.1)), ArmPose((0.85, 0.45 * g.size, 0.1), (0.9, 0.3, 0.1))
    score.move(_reach_s(score, g), left=low, right=low)
    _repeat(score, Gesture(g.family, "both", g.count, tempo=g.tempo, size=g.size), high, low, 0.8)


def _go_away(score: Score, g: Gesture) -> None:
    near, far = ArmPose((0.4, -0.6, 0.6), (-0.2, 0.5, 0.75)), ArmPose((0.35, -0.3, 0.9), (0.2, -0.1, 1.0))
    _strokes(near, far, 0.75)(score, g)


def _conduct(score: Score, g: Gesture) -> None:
    up, down = ArmPose((0.4, -0.4, 0.75), (0.05, 0.75, 0.7)), ArmPose((0.45, -0.6, 0.6), (0.2, -0.05, 0.95))
    _strokes(up, down, 0.75)(score, g)


def _drum(score: Score, g: Gesture) -> None:
    up, down = ArmPose((0.3, -0.85, 0.3), (0.0, 0.45, 0.9)), ArmPose((0.3, -0.88, 0.3), (0.0, -0.15, 1.0))
    score.move(_reach_s(score, g), left=_pose(score, up), right=_pose(score, up))
    first = score.rng.integers(2)
    for i in range(g.count):
        arm = ("left", "right")[(first + i) % 2]
        score.move(0.26, **{arm: down})
        score.move(0.28, **{arm: up})


def _hug(score: Score, g: Gesture) -> None:
    wide = ArmPose((0.85, -0.15, 0.45), (0.75, 0.1, 0.65), 0.4)
    score.move(_reach_s(score, g, 0.75), left=wide, right=wide)
    score.hold(score.rng.uniform(0.2, 0.7))
    if g.direction == "in":
        closed = ArmPose((0.25, -0.3, 0.85), (-0.85, 0.0, 0.5))
        score.move(_reach_s(score, g, 0.75), left=closed, right=closed)
        score.hold(score.rng.uniform(0.3, 1.0))


def _cheer(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.5, 0.45, 0.45), (0.05, 0.98, 0.05)), ArmPose((0.3, 0.92, 0.2), (0.1, 1.0, 0.05))
    score.move(_reach_s(score, g, 0.6), left=low, right=low)
    _repeat(score, Gesture(g.family, "both", g.count, tempo=g.tempo), high, low, 0.62)


def _hands_up(score: Score, g: Gesture) -> None:
    pose = _pose(score, ArmPose((0.28, 0.92, 0.15), (0.1, 0.98, 0.08)))
    score.move(_reach_s(score, g, 0.85), left=pose, right=pose)
    score.hold(score.rng.uniform(0.7, 2.0))


def _arms_down(score: Score, g: Gesture) -> None:
    """The one family that starts away from rest: the acting arms come down to the sides."""
    start = _pose(score, ArmPose((0.5, 0.1, 0.75), (0.35, 0.3, 0.85))).vector()
    for arm in g.arms:
        score.keys[arm] = [(0.0, start)]
    score.hold(score.rng.uniform(0.1, 0.3))
    score.move(_reach_s(score, g, 0.8), **{arm: score.rest[arm] for arm in g.arms})
    score.hold(score.rng.uniform(0.3, 1.2))


def _stand(score: Score, g: Gesture) -> None:
    score.hold(score.rng.uniform(1.2, 3.0))


def _twist_trunk(score: Score, g: Gesture) -> None:
    _turned("trunk", 26, 40, 0)(score, g)


_BECKON_READY = ArmPose((0.35, -0.6, 0.65), (0.05, 0.1, 1.0), 1.2)
_BECKON_IN = ArmPose((0.35, -0.6, 0.6), (-0.15, 0.85, 0.4), 1.2)
_PUSH_READY, _PUSH_OUT = ArmPose((0.35, -0.8, 0.1), (0.0, 0.45, 0.9)), ArmPose((0.15, -0.12, 1), (0.0, 0.1, 1))
_CHEST = ArmPose((0.4, -0.8, 0.4), (-0.85, 0.42, 0.2), 0.2)
_ARM_ONE = ("left", "right")

FAMILIES: dict[str, Family] = {
    "wave": Family(_wave, counts=True),
    "raise": Family(_still(ArmPose((0.22, 0.9, 0.3), (0.08, 0.98, 0.12))), sides=_ARM_ONE, holds=True),
    "arm_forward": Family(_still(ArmPose((0.1, -0.03, 1), (0.02, 0.03, 1))), holds=True),
    "arm_side": Family(_still(ArmPose((1, 0.02, 0.08), (1, 0.04, 0.1))), sides=_ARM_ONE, holds=True),
    "t_pose": Family(_still(ArmPose((1, 0.02, 0.05), (1, 0.03, 0.06))), sides=("both",), holds=True),
    "hands_up": Family(_hands_up, sides=("both",), holds=True),
    "arms_down": Family(_arms_down),
    "point": Family(_point, sides=_ARM_ONE, directions=("left", "right", "forward", "up", "down", "self"), holds=True),
    "clap": Family(_clap, sides=("both",), counts=True, directions=("", "up")),
    "bow": Family(_bow, "trunk", sides=(), counts=True),
    "nod": Family(_nod, "head", sides=(), counts=True),
    "shake_head": Family(_shake, "head", sides=(), counts=True),
    "tilt_head": Family(_turned("head", 20, 30, 2), "head", (), directions=("left", "right"), holds=True),
    "look": Family(_look, "head", sides=(), directions=("left", "right", "up", "down"), holds=True),
    "look_around": Family(_look_around, "head", sides=()),
    "lean": Family(_lean, "trunk", sides=(), directions=("left", "right", "forward", "back"), holds=True),
    "twist": Family(_twist_trunk, "trunk", sides=(), directions=("left", "right"), holds=True),
    "cross_arms": Family(_cross, sides=("both",), holds=True),
    "hands_on_hips": Family(_still(ArmPose((0.72, -0.68, -0.12), (-0.75, -0.6, 0.25))), holds=True),
    "shrug": Family(_shrug, sides=("both",), counts=True),
    "salute": Family(_still(ArmPose((0.78, 0.12, 0.4), (-0.85, 0.52, -0.1), -0.3)), sides=_ARM_ONE, holds=True),
    "beckon": Family(_strokes(_BECKON_READY, _BECKON_IN, 0.7), sides=_ARM_ONE, counts=True),
    "stop": Family(_still(ArmPose((0.2, -0.25, 0.95), (0.02, 0.62, 0.8), -0.6)), holds=True),
    "punch": Family(_punch, counts=True),
    "arm_circle": Family(_circle, counts=True, directions=("forward", "back")),
    "flap": Family(_flap, sides=("both",), counts=True),
    "hug": Family(_hug, sides=("both",), directions=("", "in"), holds=True),
    "pray": Family(_still(ArmPose((0.15, -0.85, 0.45), (-0.8, 0.42, 0.42))), sides=("both",), holds=True),
    "think": Family(_still(ArmPose((0.12, -0.72, 0.62), (-0.55, 0.82, -0.1))), sides=_ARM_ONE, holds=True),
    "heart": Family(_still(_CHEST), sides=_ARM_ONE, holds=True),
    "go_away": Family(_go_away, sides=_ARM_ONE, counts=True),
    "conduct": Family(_conduct, counts=True),
    "drum": Family(_drum, sides=("both",), counts=True),
    "push": Family(_strokes(_PUSH_READY, _PUSH_OUT, 1.0), counts=True),
    "pull": Family(_strokes(_PUSH_OUT, _PUSH_READY, 1.0), counts=True),
    "drink": Family(_still(ArmPose((0.35, -0.55, 0.7), (-0.67, 0.72, -0.15), 0.4), (0.5, 1.2)), sides=_ARM_ONE),
    "phone": Family(_still(ArmPose((0.5, -0.68, 0.4), (-0.5, 0.83, -0.22), 0.3)), sides=_ARM_ONE, holds=True),
    "facepalm": Family(_still(ArmPose((0.3, -0.2, 0.9), (-0.66, 0.65, -0.35))), sides=_ARM_ONE, holds=True),
    "behind_head": Family(_still(ArmPose((0.85, 0.5, 0.05), (-0.6, 0.45, -0.5))), holds=True),
    "flex": Family(_still(ArmPose((1, 0.05, 0.1), (-0.15, 0.98, 0.1), 0.5)), holds=True),
    "cheer": Family(_cheer, sides=("both",), counts=True),
    "offer": Family(_still(ArmPose((0.3, -0.75, 0.5), (0.15, 0.05, 1.0), 1.3)), holds=True),
    "stand": Family(_stand, "", sides=()),
}  # fmt: skip
