"""Music, dance and pretending: instruments, conducting, circling, flapping, robots."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture, Perform
from mmm_core.corpus.families.strokes import (
    arms_to,
    circle,
    cycle_s,
    keep,
    loops,
    pair_to,
    reach_s,
    repeat,
    still,
    strokes,
    vary,
)
from mmm_core.corpus.families.work import taps
from mmm_core.corpus.reach import ELBOW_DOWN, ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector

_DRUM_UP, _DRUM_DOWN = (
    ArmPose((0.3, -0.85, 0.3), (0.0, 0.5, 0.88), -0.9),
    ArmPose((0.3, -0.88, 0.3), (0.0, -0.15, 1.0), -0.9),
)
_PIANO_UP, _PIANO_DOWN = (
    ArmPose((0.35, -0.85, 0.4), (0.05, 0.25, 0.95), -1.0),
    ArmPose((0.35, -0.85, 0.4), (0.05, -0.08, 1.0), -1.0),
)
_OTHER = {"left": "right", "right": "left"}


def _lead_strokes(
    ready: ArmPose, out: ArmPose, other: ArmPose, usual_s: float, head: Vector = (0.0, 0.0, 0.0)
) -> Perform:
    """The leading hand repeats a stroke while the other holds its place, as with string instruments."""

    def perform(score: Score, g: Gesture) -> None:
        if head != (0.0, 0.0, 0.0):
            start_s = score.time_s
            score.move(0.5, head=head)
            score.time_s = start_s
        pair_to(score, g, ready, other)
        repeat(score, Gesture(g.family, g.lead, g.count, tempo=g.tempo, size=g.size), out, ready, usual_s)

    return perform


def _arm_circle(score: Score, g: Gesture) -> None:
    """Stretched arms draw circles in the side plane, forward over the top or in the opposite sense."""
    turn = -1.0 if g.direction == "back" else 1.0
    wide = 0.6 * g.size

    def pose(phase: float) -> ArmPose:
        a = 2 * np.pi * phase
        v = (0.8, -wide * float(np.cos(a)), 0.1 - turn * wide * float(np.sin(a)))
        return ArmPose(v, v)

    arms_to(score, g, pose(0.0), amount=0.0, via=SIDE)
    duration = g.count * cycle_s(score, g, 1.25, 0.9)
    score.trace(duration, **dict.fromkeys(g.arms, lambda u: pose(g.count * u)))


def _flap(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.85, -0.5, 0.1), (0.8, -0.6, 0.1)), ArmPose((0.85, 0.45, 0.1), (0.9, 0.3, 0.1))
    arms_to(score, g, low, via=SIDE)
    repeat(score, g, high, low, 0.8)


def _conduct(score: Score, g: Gesture) -> None:
    up, down = ArmPose((0.4, -0.4, 0.75), (0.05, 0.75, 0.7)), ArmPose((0.45, -0.6, 0.6), (0.25, -0.05, 0.95))
    arms_to(score, g, up)
    repeat(score, g, down, up, 0.75)


def _robot(score: Score, g: Gesture) -> None:
    """Right-angled arms that change places in jerks, with stops between."""
    up, down = ArmPose((0.95, -0.25, 0.1), (0.1, 0.99, 0.05)), ArmPose((0.95, -0.25, 0.1), (0.1, -0.99, 0.15))
    front = ArmPose((0.15, -0.98, 0.05), (0.0, 0.0, 1.0))
    score.move(0.4, left=front, right=front)
    score.hold(0.2)
    first = "left" if score.rng.random() < 0.5 else "right"
    for i in range(g.count):
        score.to_beat()
        a = first if i % 2 == 0 else _OTHER[first]
        score.move(0.3 / g.tempo**0.5, **{a: up, _OTHER[a]: down}, head=((0.35 if a == "left" else -0.35), 0.0, 0.0))
        score.hold(0.26 / g.tempo)


def _disco(score: Score, g: Gesture) -> None:
    """One arm points up and out, then down across the body; the other hand rests on the hip."""
    up, down = ArmPose((0.6, 0.75, 0.25), (0.6, 0.78, 0.2)), ArmPose((-0.1, -0.8, 0.6), (-0.6, -0.7, 0.4))
    hip = reach((0.17, -0.45, 0.06), ELBOW_OUT)
    pair_to(score, g, up, hip)
    one = Gesture(g.family, g.lead, g.count, tempo=g.tempo, size=g.size)
    repeat(score, one, down, up, 0.95)


def _sway_arms(score: Score, g: Gesture) -> None:
    """Both arms, stretched overhead, swing together to one side and the other, and the trunk with them."""
    first = 1.0 if score.rng.random() < 0.5 else -1.0
    half = cycle_s(score, g, 1.25) / 2
    for i in range(2 * g.count + 1):
        if i % 2:
            score.to_beat()
        side = first * (1 if i % 2 == 0 else -1) * g.size * score.rng.uniform(0.92, 1.08)
        pose = {"left": (0.2 + 0.45 * side, 0.9, 0.15), "right": (0.2 - 0.45 * side, 0.9, 0.15)}
        arms = {k: ArmPose(v, v) for k, v in pose.items()}
        score.move(reach_s(score, g, arms["left"]) if i == 0 else half, SIDE, **arms, trunk=(0.0, 0.0, 0.12 * side))


def _arm_wave(score: Score, g: Gesture) -> None:
    """A wave runs from one hand through the shoulders to the other."""
    flat = {"left": ArmPose((1, 0.0, 0.1), (1, 0.0, 0.1)), "right": ArmPose((1, 0.0, 0.1), (1, 0.0, 0.1))}
    score.move(reach_s(score, g, flat["left"]), SIDE, **flat)
    step = max(0.22, 0.27 / g.tempo)
    bump, dip = ArmPose((1, 0.4, 0.1), (0.9, -0.45, 0.1)), ArmPose((1, -0.12, 0.1), (0.9, 0.5, 0.1))
    for _ in range(g.count):
        score.to_beat()
        a = "left" if score.rng.random() < 0.5 else "right"
        for arm, pose in ((a, dip), (a, bump), (_OTHER[a], bump), (_OTHER[a], dip)):
            score.move(step, **{arm: pose, _OTHER[arm]: flat[arm]})
        score.move(1.3 * step, **flat)


def _chicken(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.45, -0.88, 0.0), (0.05, 0.75, 0.55)), ArmPose((0.97, -0.1, 0.0), (-0.45, 0.1, 0.6))
    arms_to(score, g, low)
    repeat(score, g, high, low, 0.6)


def _shake_out(score: Score, g: Gesture) -> None:
    a, b = ArmPose((0.35, -0.93, 0.05), (0.5, -0.83, 0.25)), ArmPose((0.3, -0.93, 0.15), (0.12, -0.78, 0.62))
    arms_to(score, g, a, amount=0.02)
    repeat(score, g, b, a, 0.5)


def _dab(score: Score, g: Gesture) -> None:
    side = 1.0 if g.lead == "left" else -1.0
    long, bent = ArmPose((0.85, 0.5, 0.15), (0.85, 0.52, 0.1)), ArmPose((0.0, 0.05, 1.0), (-0.8, 0.6, 0.1))
    a, b = vary(score, long, 0.03), vary(score, bent, 0.03)
    score.move(0.42 / g.tempo, **{g.lead: a, _OTHER[g.lead]: b}, head=(-0.5 * side, 0.5, 0.0))
    keep(score, g, (0.5, 1.5))


_STRUM_UP, _STRUM_DOWN = reach((-0.02, -0.22, 0.22), ELBOW_OUT), reach((0.05, -0.40, 0.22), ELBOW_OUT)
_FRETS = ArmPose((0.55, -0.7, 0.35), (0.4, 0.6, 0.6), 0.9)
_BOW_IN, _BOW_OUT = reach((-0.12, 0.06, 0.3), (0.7, -0.4, 0.3)), reach((0.3, -0.1, 0.42), (0.7, -0.5, 0.2))
_VIOLIN = ArmPose((0.45, -0.55, 0.7), (0.1, 0.62, 0.75), 1.2)

PLAY: dict[str, Family] = {
    "drum": Family(taps(_DRUM_UP, _DRUM_DOWN, 0.56), sides=BOTH, counts=(2, 3, 4)),
    "piano": Family(taps(_PIANO_UP, _PIANO_DOWN, 0.56, 0.22), sides=BOTH, counts=(3, 4)),
    "guitar": Family(_lead_strokes(_STRUM_UP, _STRUM_DOWN, _FRETS, 0.6), sides=BOTH, counts=(3, 4)),
    "violin": Family(_lead_strokes(_BOW_IN, _BOW_OUT, _VIOLIN, 1.1, (0.25, 0.1, 0.2)), sides=BOTH, counts=(2, 3)),
    "flute": Family(
        _lead_strokes(
            reach((-0.02, 0.13, 0.3), (0.8, -0.5, 0.0)),
            reach((0.0, 0.11, 0.31), (0.8, -0.5, 0.0)),
            reach((-0.02, 0.13, 0.25), (0.7, -0.6, 0.3)),
            0.7,
        ),
        sides=BOTH,
        counts=(2, 3),
    ),
    "conduct": Family(_conduct, sides=ANY, counts=(3, 4)),
    "arm_circle": Family(_arm_circle, sides=ANY, counts=(1, 2), directions=("forward", "back")),
    "flap": Family(_flap, sides=BOTH, counts=(2, 3)),
    "chicken": Family(_chicken, sides=BOTH, counts=(2, 3)),
    "robot": Family(_robot, sides=BOTH, counts=(3, 4)),
    "disco": Family(_disco, sides=ONE, counts=(2, 3)),
    "sway_arms": Family(_sway_arms, sides=BOTH, counts=(2, 3)),
    "arm_wave": Family(_arm_wave, sides=BOTH, counts=(1, 2)),
    "dance_pump": Family(
        strokes(ArmPose((0.4, -0.75, 0.4), (-0.1, 0.6, 0.75)), ArmPose((0.35, -0.3, 0.85), (0.0, 0.85, 0.5)), 0.6),
        sides=("both", "alternating"),
        counts=(3, 4),
    ),
    "dab": Family(_dab, sides=ONE, holds=True),
    "shake_out": Family(_shake_out, sides=BOTH, counts=(3, 4)),
    "heart_over_head": Family(still(reach((0.02, 0.45, 0.1), (1.0, 0.2, 0.1)), via=SIDE), sides=BOTH, holds=True),
    "binoculars": Family(still(reach((0.06, 0.25, 0.2), (0.8, -0.6, 0.1))), sides=BOTH, holds=True),
    "juggle": Family(
        loops(circle((0.2, -0.2, 0.35), 0.09, "front", 1.5), 0.75, ELBOW_DOWN, 1.0, offset=0.5),
        sides=BOTH,
        counts=(3, 4),
    ),
    "pull_hat": Family(
        strokes(reach((0.09, 0.33, 0.06), (0.9, 0.2, 0.0)), reach((0.2, 0.42, 0.22), (0.9, 0.2, 0.0)), 1.0),
        sides=ONE,
        counts=(1,),
    ),
}
