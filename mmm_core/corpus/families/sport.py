"""Sport and fighting: punches, throwing, catching, swimming, running arms."""

from __future__ import annotations

import numpy as np

from mmm_core.corpus.families.gesture import ALL, ANY, BOTH, ONE, Family, Gesture, Perform
from mmm_core.corpus.families.strokes import (
    arms_to,
    cycle_s,
    keep,
    loops,
    pair_to,
    reach_s,
    strokes,
    vary,
)
from mmm_core.corpus.reach import ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector

_GUARD = ArmPose((0.25, -0.75, 0.3), (-0.15, 0.75, 0.65), 0.3)
_STRIKES = {
    "punch": ArmPose((0.1, -0.05, 1.0), (-0.08, 0.05, 1.0), -0.8),
    "hook": ArmPose((0.75, 0.0, 0.7), (-0.8, 0.06, 0.6), -0.8),
    "uppercut": ArmPose((0.05, -0.3, 0.95), (-0.12, 0.97, 0.35), 1.0),
}
_WIND_UP = {
    "punch": _GUARD,
    "hook": ArmPose((0.9, -0.4, 0.0), (0.25, 0.3, 0.9), -0.3),
    "uppercut": ArmPose((0.3, -0.9, -0.2), (0.0, -0.1, 1.0), 0.6),
}


def _strike(kind: str) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        """The acting arm winds up from the guard, strikes, and goes back; two arms take turns."""
        ready, strike = _WIND_UP[kind], _STRIKES[kind]
        both = g.side in ("both", "alternating")
        arms_to(score, g, _GUARD if both else ready, amount=0.03)
        first = int(score.rng.integers(2))
        for i in range(g.count):
            score.to_beat()
            arms = (("left", "right")[(first + i) % 2],) if both else g.arms
            if both and kind != "punch":
                score.move(0.24 / g.tempo**0.5, **dict.fromkeys(arms, vary(score, ready, 0.02)))
            turn = (1 if arms[0] == "right" else -1) * 0.13 * g.size
            posed = vary(score, strike, 0.03)
            score.move(0.27 / g.tempo**0.5, **dict.fromkeys(arms, posed), trunk=(turn, 0.03, 0.0))
            back = vary(score, _GUARD if both else ready, 0.03)
            score.move(0.34 / g.tempo**0.5, **dict.fromkeys(arms, back), trunk=(0.0, 0.0, 0.0))

    return perform


def _throw(wind_up: ArmPose, release: ArmPose, after: ArmPose) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        """The arm winds up with the shoulder back, releases, and follows through."""
        side = 0.0 if g.side == "both" else 1.0 if g.lead == "right" else -1.0
        for _ in range(g.count):
            score.to_beat()
            posed = vary(score, wind_up, 0.03)
            score.move(
                1.05 * reach_s(score, g, posed), SIDE, **dict.fromkeys(g.arms, posed), trunk=(-0.22 * side, -0.05, 0.0)
            )
            fast = 0.24 / g.tempo**0.5
            score.move(fast, **dict.fromkeys(g.arms, release), trunk=(0.1 * side, 0.06, 0.0))
            score.move(1.2 * fast, **dict.fromkeys(g.arms, vary(score, after, 0.03)), trunk=(0.22 * side, 0.12, 0.0))
            score.hold(score.rng.uniform(0.1, 0.4))

    return perform


def _catch(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        score.to_beat()
        arms_to(score, g, ArmPose((0.15, -0.25, 0.95), (-0.1, 0.12, 1.0), 0.6), 0.36 / g.tempo**0.5, 0.03)
        arms_to(score, g, reach((0.02, -0.24, 0.24), (0.7, -0.7, 0.0), 0.6), 0.4 / g.tempo**0.5, 0.03)
        score.hold(score.rng.uniform(0.25, 0.7))


def _archery(score: Score, g: Gesture) -> None:
    """The other arm holds the bow out, the leading one draws to the cheek and lets go."""
    bow = ArmPose((0.85, 0.05, 0.5), (0.85, 0.05, 0.5), -0.6)
    yaw = -0.35 if g.lead == "right" else 0.35
    for _ in range(g.count):
        score.to_beat()
        pair_to(score, g, reach((-0.3, 0.02, 0.42), ELBOW_OUT), bow)
        draw = vary(score, ArmPose((0.95, 0.1, -0.05), (-0.85, 0.15, 0.5)), 0.02)
        score.move(0.75 / g.tempo, **{g.lead: draw}, head=(-yaw, 0.0, 0.0))
        keep(score, g, (0.3, 0.9))
        loose = vary(score, ArmPose((1.0, 0.12, -0.15), (0.2, 0.75, 0.3)), 0.03)
        score.move(0.25, **{g.lead: loose})


def _golf(score: Score, g: Gesture) -> None:
    """Both hands swing one club: up beside the right shoulder, down through the middle, up on the left."""

    def grip(left: float, up: float, forward: float) -> dict[str, ArmPose]:
        return {"left": reach((left, up, forward)), "right": reach((-left + 0.04, up - 0.04, forward))}

    for _ in range(g.count):
        score.to_beat()
        score.move(0.85 / g.tempo, **grip(0.0, -0.45, 0.32), trunk=(0.0, 0.15, 0.0))
        score.move(0.8 / g.tempo, **grip(-0.27, 0.1, 0.25), trunk=(-0.4, 0.1, 0.0), head=(0.35, 0.15, 0.0))
        score.hold(score.rng.uniform(0.05, 0.25))
        score.move(0.28, **grip(0.0, -0.45, 0.33), trunk=(0.05, 0.15, 0.0))
        score.move(0.34, **grip(0.3, 0.15, 0.25), trunk=(0.45, 0.02, 0.0), head=(0.1, 0.0, 0.0))
        score.hold(score.rng.uniform(0.2, 0.6))


def _swing_arms(high: ArmPose, low: ArmPose, usual_s: float) -> Perform:
    def perform(score: Score, g: Gesture) -> None:
        """Arms swing against each other, as in walking and running."""
        half = cycle_s(score, g, usual_s) / 2
        first = int(score.rng.integers(2))
        for i in range(2 * g.count):
            if i % 2:
                score.to_beat()
            share = g.size * score.rng.uniform(0.93, 1.07)
            pose = {
                ("left", "right")[(first + i) % 2]: vary(score, high, 0.02 * share),
                ("left", "right")[(first + i + 1) % 2]: vary(score, low, 0.02 * share),
            }
            score.move(half * (1.2 if i == 0 else 1.0), **pose)

    return perform


def _crawl(phase: float) -> Vector:
    """Path of a crawl stroke: over the head forward, down in front, back along the hip."""
    a = 2 * np.pi * phase
    return (0.24, 0.06 + 0.42 * float(np.cos(a)), 0.12 + 0.38 * float(np.sin(a)))


def _breast(phase: float) -> Vector:
    """Path of a breaststroke: forward together, outward in an arc, back to the chest."""
    a = 2 * np.pi * phase
    out = 0.22 + 0.2 * float(np.sin(a)) if np.sin(a) > 0 else 0.22 + 0.17 * float(np.sin(a))
    return (out, -0.14, 0.3 + 0.2 * float(np.cos(a)))


SPORT: dict[str, Family] = {
    "punch": Family(_strike("punch"), sides=ALL, counts=(1, 2)),
    "hook": Family(_strike("hook"), sides=(*ONE, "alternating"), counts=(1, 2)),
    "uppercut": Family(_strike("uppercut"), sides=(*ONE, "alternating"), counts=(1, 2)),
    "throw": Family(
        _throw(
            ArmPose((0.75, 0.2, -0.35), (0.1, 0.9, -0.4)),
            ArmPose((0.35, 0.3, 0.85), (0.05, 0.55, 0.85)),
            ArmPose((0.0, -0.6, 0.8), (-0.35, -0.75, 0.6)),
        ),
        sides=ONE,
        counts=(1,),
    ),
    "throw_low": Family(
        _throw(
            ArmPose((0.3, -0.75, -0.6), (0.15, -0.8, -0.55)),
            ArmPose((0.12, -0.75, 0.65), (0.05, -0.5, 0.85), 1.0),
            ArmPose((0.12, -0.1, 1.0), (0.05, 0.45, 0.9), 1.0),
        ),
        sides=ONE,
        counts=(1,),
    ),
    "catch": Family(_catch, sides=ANY, counts=(1,)),
    "archery": Family(_archery, sides=BOTH, counts=(1,), holds=True),
    "sword": Family(
        strokes(
            ArmPose((0.5, 0.6, 0.5), (0.1, 0.85, -0.35)), ArmPose((0.05, -0.3, 0.95), (-0.25, -0.4, 0.9)), 0.8, 0.45
        ),
        sides=ANY,
        counts=(1, 2),
    ),
    "karate_chop": Family(
        strokes(
            ArmPose((0.75, -0.1, 0.5), (-0.55, 0.75, 0.35), 0.3),
            ArmPose((0.55, -0.45, 0.7), (0.25, -0.2, 0.95), 0.0),
            0.75,
            0.42,
        ),
        sides=ONE,
        counts=(1, 2),
    ),
    "swim_crawl": Family(loops(_crawl, 1.5, ELBOW_OUT, offset=0.5), sides=BOTH, counts=(2, 3)),
    "swim_back": Family(loops(lambda p: _crawl(-p), 1.5, ELBOW_OUT, offset=0.5), sides=BOTH, counts=(2, 3)),
    "swim_breast": Family(loops(_breast, 1.5, ELBOW_OUT, -0.6), sides=BOTH, counts=(2, 3)),
    "march_arms": Family(
        _swing_arms(
            ArmPose((0.15, -0.55, 0.8), (0.05, -0.3, 0.95)), ArmPose((0.18, -0.88, -0.4), (0.12, -0.9, -0.3)), 1.05
        ),
        sides=BOTH,
        counts=(3, 4),
    ),
    "run_arms": Family(
        _swing_arms(
            ArmPose((0.15, -0.85, 0.5), (-0.25, 0.6, 0.75)), ArmPose((0.25, -0.75, -0.6), (-0.05, -0.05, 1.0)), 0.62
        ),
        sides=BOTH,
        counts=(3, 4),
    ),
    "row": Family(
        strokes(
            ArmPose((0.15, -0.35, 0.95), (0.0, -0.05, 1.0), -0.6),
            ArmPose((0.35, -0.65, -0.4), (-0.05, 0.2, 0.95), -0.6),
            1.2,
        ),
        sides=BOTH,
        counts=(2, 3),
    ),
    "jumping_jack": Family(
        strokes(ArmPose((0.35, -0.93, 0.1), (0.35, -0.93, 0.15)), ArmPose((0.35, 0.93, 0.1), (0.1, 0.98, 0.1)), 1.15),
        sides=BOTH,
        counts=(2, 3),
    ),
    "basketball": Family(
        _throw(
            reach((0.03, 0.2, 0.26), (0.6, -0.7, 0.3)),
            ArmPose((0.1, 0.65, 0.75), (0.0, 0.9, 0.4)),
            ArmPose((0.1, 0.6, 0.8), (0.0, 0.5, 0.85)),
        ),
        sides=BOTH,
        counts=(1,),
    ),
    "tennis": Family(
        _throw(
            ArmPose((0.8, -0.45, -0.4), (0.8, -0.1, -0.5)),
            ArmPose((0.5, -0.45, 0.75), (0.5, -0.1, 0.85)),
            ArmPose((-0.2, -0.2, 0.95), (-0.75, 0.45, 0.35)),
        ),
        sides=ONE,
        counts=(1, 2),
    ),
    "golf": Family(_golf, sides=BOTH, counts=(1,)),
    "lift_weight": Family(
        strokes(
            ArmPose((0.25, -0.96, 0.05), (0.05, -0.8, 0.55), 1.0),
            ArmPose((0.25, -0.95, 0.1), (-0.02, 0.85, 0.5), 1.0),
            1.15,
        ),
        sides=ALL,
        counts=(2, 3),
    ),
    "overhead_press": Family(
        strokes(
            ArmPose((0.55, -0.78, 0.25), (0.0, 0.97, 0.2), -0.6), ArmPose((0.2, 0.93, 0.2), (0.0, 1.0, 0.05), -0.6), 1.2
        ),
        sides=BOTH,
        counts=(2, 3),
    ),
}
