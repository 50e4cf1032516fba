"""Performances that many families share: taking a pose, repeating a stroke, going round a path."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mmm_core.corpus.families.gesture import Gesture, Perform
from mmm_core.corpus.reach import ELBOW_DOWN, reach
from mmm_core.corpus.score import FRONT, ArmPose, Score, Vector
from mmm_core.motion.skeleton import Array

SHORTEST_CYCLE_S = 0.5
"""Seconds of the shortest cycle; faster ones are lost between tokens of four frames, and no servo follows them."""
SIGN = {"left": 1.0, "right": -1.0}
"""Sign of the sideways axis for each arm."""


def vary(score: Score, pose: ArmPose, amount: float = 0.05) -> ArmPose:
    """The pose, varied a little at random."""
    x = score.rng.normal(0, 1, 7)
    u, f = pose.upper, pose.fore
    return ArmPose(
        (u[0] + amount * x[0], u[1] + amount * x[1], u[2] + amount * x[2]),
        (f[0] + amount * x[3], f[1] + amount * x[4], f[2] + amount * x[5]),
        pose.twist_rad + 0.08 * x[6],
    )


def between(a: ArmPose, b: ArmPose, share: float) -> ArmPose:
    """The pose at `share` of the distance from `a` to `b`; a share above 1 goes beyond `b`."""
    v = a.vector() + share * (b.vector() - a.vector())
    return ArmPose((v[0], v[1], v[2]), (v[3], v[4], v[5]), float(v[6]))


def reach_s(score: Score, g: Gesture, *poses: ArmPose | Array) -> float:
    """Seconds that the acting arms take to `poses`: more for longer distances (Fitts 1954), by tempo, a little at random."""
    far = 0.0
    for pose in poses:
        to = pose.vector() if isinstance(pose, ArmPose) else pose
        for arm in g.arms:
            now = score.now(arm)
            far = max(far, 1 - now[:3] @ to[:3], 1 - now[3:6] @ to[3:6])
    angle = np.arccos(1 - min(far, 2.0))
    return in_beats(score, float((0.36 + 0.2 * angle) * score.rng.uniform(0.88, 1.2) / g.tempo))


def turn_s(score: Score, g: Gesture, usual_s: float = 0.6) -> float:
    """Seconds that head or trunk take to turn."""
    return in_beats(score, usual_s * score.rng.uniform(0.85, 1.2) / g.tempo)


def in_beats(score: Score, duration_s: float) -> float:
    """Seconds of a movement: with a beat the next longer whole number of beats, at least two; else `duration_s`."""
    if not score.beat_s:
        return duration_s
    return score.beat_s * max(2, int(np.ceil(duration_s / score.beat_s - 0.25)))


def arms_to(
    score: Score, g: Gesture, pose: ArmPose, duration_s: float = 0.0, amount: float = 0.05, via: Vector = FRONT
) -> None:
    """Move the acting arms to a pose."""
    posed = vary(score, pose, amount)
    score.move(duration_s or reach_s(score, g, posed), via, **dict.fromkeys(g.arms, posed))


def pair_to(score: Score, g: Gesture, lead: ArmPose, other: ArmPose, duration_s: float = 0.0) -> None:
    """Move the leading arm and the other one to poses of their own."""
    a, b = vary(score, lead, 0.03), vary(score, other, 0.03)
    both = {g.lead: a, ("left" if g.lead == "right" else "right"): b}
    score.move(duration_s or reach_s(score, Gesture(g.family, "both", tempo=g.tempo), a, b), **both)


def keep(score: Score, g: Gesture, usual_s: tuple[float, float] = (0.7, 2.0)) -> None:
    """Hold for the gesture's time, or for a usual one."""
    score.hold(g.hold_s or score.pause_s(*usual_s))


def cycle_s(score: Score, g: Gesture, usual_s: float, least_s: float = SHORTEST_CYCLE_S) -> float:
    """Seconds of one cycle at the gesture's tempo, at least `least_s`; with a beat a whole number of beats, at least three."""
    if score.beat_s:
        return score.beat_s * max(3, int(np.ceil(max(least_s, usual_s / g.tempo) / score.beat_s - 0.05)))
    return max(least_s, usual_s / g.tempo * score.rng.uniform(0.93, 1.08))


def still(pose: ArmPose, usual_s: tuple[float, float] = (0.7, 2.0), via: Vector = FRONT, **also: Vector) -> Perform:
    """The performance of a family that takes a pose and keeps it; `also` moves head or trunk, turned towards the acting side."""

    def perform(score: Score, g: Gesture) -> None:
        posed = vary(score, pose, 0.035)
        side = 0.0 if g.side == "both" else SIGN[g.lead]
        others = {name: (side * v[0], v[1], side * v[2]) for name, v in also.items()}
        score.move(reach_s(score, g, posed), via, **dict.fromkeys(g.arms, posed), **others)
        keep(score, g, usual_s)

    return perform


def repeat(
    score: Score, g: Gesture, out: ArmPose, back: ArmPose, usual_s: float = 0.66, out_share: float = 0.5
) -> None:
    """Make `count` strokes from `back` to `out` and back, varied at random unless there is a beat. Alternating arms take turns."""
    rng = score.rng
    cycle = cycle_s(score, g, usual_s)
    first = int(rng.integers(2))
    for i in range(g.count):
        score.to_beat()
        arms = (("left", "right")[(first + i) % 2],) if g.side == "alternating" else g.arms
        this = cycle * rng.uniform(0.95, 1.06)
        there = this * out_share * rng.uniform(0.94, 1.06)
        posed = vary(score, between(back, out, g.size * rng.uniform(0.93, 1.05)), 0.02)
        score.move(there, **dict.fromkeys(arms, posed))
        score.move(max(0.22, this - there), **dict.fromkeys(arms, vary(score, back, 0.02)))


def strokes(ready: ArmPose, out: ArmPose, usual_s: float = 0.66, out_share: float = 0.5) -> Perform:
    """The performance of a family that takes a pose and repeats a stroke from it."""

    def perform(score: Score, g: Gesture) -> None:
        arms_to(score, g, ready, amount=0.03)
        repeat(score, g, out, ready, usual_s, out_share)

    return perform


Path = Callable[[float], Vector]
"""Place of the palm in metres, as a function of the phase in turns: 1.25 is one and a quarter turn."""


def loops(
    path: Path, usual_s: float, elbow: Vector = ELBOW_DOWN, twist_rad: float = 0.0, offset: float = 0.0
) -> Perform:
    """The performance of a family whose palm goes round a path; a second arm is `offset` turns ahead (0.5 if arms alternate)."""

    def perform(score: Score, g: Gesture) -> None:
        middle = np.mean([path(i / 8) for i in range(8)], 0)
        turn = -1.0 if g.direction in ("back", "in") else 1.0
        shift = 0.5 if g.side == "alternating" else offset

        def pose(phase: float) -> ArmPose:
            p = middle + g.size * (np.array(path(turn * phase)) - middle)
            return reach((float(p[0]), float(p[1]), float(p[2])), elbow, twist_rad)

        start = {arm: shift if arm != g.arms[0] else 0.0 for arm in g.arms}
        score.move(reach_s(score, g, pose(0.0)), **{arm: pose(p) for arm, p in start.items()})
        duration = g.count * cycle_s(score, g, usual_s, 0.6)
        score.trace(
            duration,
            **{arm: (lambda u, p=p: pose(p + g.count * u)) for arm, p in start.items()},
        )

    return perform


def circle(middle: Vector, radius_m: float, plane: str, tall: float = 1.0) -> Path:
    """A circle about `middle`: in the "front" plane from the top outward, in "side" from the top forward, in "flat" outward."""
    a, b, c = middle

    def path(phase: float) -> Vector:
        s, k = radius_m * float(np.sin(2 * np.pi * phase)), radius_m * tall * float(np.cos(2 * np.pi * phase))
        if plane == "front":
            return (a + s, b + k, c)
        return (a, b + k, c + s) if plane == "side" else (a + s, b, c + k)

    return path
