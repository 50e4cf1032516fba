"""Work and everyday things: pushing, pulling, lifting, knocking, wiping, painting, stirring, typing, turning."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture, Perform
from mmm_core.corpus.families.strokes import (
    arms_to,
    circle,
    cycle_s,
    loops,
    pair_to,
    reach_s,
    repeat,
    strokes,
    vary,
)
from mmm_core.corpus.reach import ELBOW_DOWN, ELBOW_OUT, reach
from mmm_core.corpus.score import ArmPose, Score

_PUSH_READY, _PUSH_OUT = (
    ArmPose((0.35, -0.8, 0.1), (0.0, 0.45, 0.9), -0.5),
    ArmPose((0.15, -0.12, 1), (0.0, 0.1, 1), -0.5),
)
_PULL_FAR, _PULL_NEAR = ArmPose((0.15, -0.15, 1), (0.0, 0.05, 1)), ArmPose((0.35, -0.75, -0.35), (-0.05, 0.25, 0.95))
_KEY_UP, _KEY_DOWN = (
    ArmPose((0.3, -0.88, 0.35), (-0.15, 0.28, 0.95), -1.0),
    ArmPose((0.3, -0.88, 0.35), (-0.15, -0.06, 1.0), -1.0),
)


def taps(up: ArmPose, down: ArmPose, beat_s: float, spread: float = 0.0) -> Perform:
    """The hands, held low in front, tap in turns; `spread` moves them sideways sometimes."""

    def perform(score: Score, g: Gesture) -> None:
        start = {a: vary(score, up, 0.02) for a in g.arms}
        score.move(reach_s(score, g, up), **start)
        first = int(score.rng.integers(2))
        beat = max(0.26, beat_s / g.tempo)
        for i in range(2 * g.count):
            score.to_beat()
            arm = ("left", "right")[(first + i) % 2] if len(g.arms) == 2 else g.arms[0]
            if len(g.arms) == 1 and i % 2:
                continue
            aside = score.rng.normal(0, spread)
            shifted = [ArmPose(p.upper, (p.fore[0] + aside, p.fore[1], p.fore[2]), p.twist_rad) for p in (down, up)]
            score.move(0.5 * beat * (2 if len(g.arms) == 1 else 1), **{arm: shifted[0]})
            score.move(0.5 * beat * (2 if len(g.arms) == 1 else 1), **{arm: shifted[1]})

    return perform


def _lift(score: Score, g: Gesture) -> None:
    """Both hands fetch something from below and bring it up."""
    low, high = (
        ArmPose((0.2, -0.85, 0.45), (-0.08, -0.7, 0.7), 0.4),
        ArmPose((0.15, 0.3, 0.95), (-0.05, 0.55, 0.85), 0.4),
    )
    for _ in range(g.count):
        score.to_beat()
        posed = vary(score, low, 0.02)
        duration = reach_s(score, g, posed)
        score.move(duration, **dict.fromkeys(g.arms, posed), trunk=(0.0, 0.3 * g.size, 0.0), head=(0.0, 0.1, 0.0))
        score.hold(score.rng.uniform(0.1, 0.3))
        up = vary(score, high, 0.03)
        score.move(
            1.4 * reach_s(score, g, up), **dict.fromkeys(g.arms, up), trunk=(0.0, -0.03, 0.0), head=(0.0, 0.0, 0.0)
        )
        score.hold(score.rng.uniform(0.2, 0.6))


def _pick(score: Score, g: Gesture) -> None:
    """A hand reaches up, closes, and comes down to a basket."""
    for _ in range(g.count):
        score.to_beat()
        arms_to(score, g, ArmPose((0.25, 0.72, 0.6), (0.1, 0.9, 0.4)), amount=0.06)
        score.hold(0.12)
        arms_to(score, g, ArmPose((0.3, -0.8, 0.45), (-0.1, -0.1, 0.95)), amount=0.03)
        score.hold(0.1)


def _climb(score: Score, g: Gesture) -> None:
    """One hand goes over the other on a rope or ladder."""
    high, low = ArmPose((0.2, 0.6, 0.75), (0.0, 0.92, 0.35)), ArmPose((0.3, -0.55, 0.75), (-0.05, 0.6, 0.8))
    half = max(0.42, 0.62 / g.tempo)
    first = int(score.rng.integers(2))
    for i in range(g.count + 1):
        score.to_beat()
        up = ("left", "right")[(first + i) % 2]
        down = "left" if up == "right" else "right"
        score.move(half * (1.5 if i == 0 else 1), **{up: vary(score, high, 0.03), down: vary(score, low, 0.03)})


def _twist_forearm(pose: ArmPose, from_rad: float, to_rad: float, usual_s: float) -> Perform:
    """The forearm turns about its own axis, which only the 6-D channels show."""
    there, back = ArmPose(pose.upper, pose.fore, to_rad), ArmPose(pose.upper, pose.fore, from_rad)

    def perform(score: Score, g: Gesture) -> None:
        arms_to(score, g, back, amount=0.02)
        cycle = cycle_s(score, g, usual_s)
        for _ in range(g.count):
            score.to_beat()
            score.move(cycle / 2, **dict.fromkeys(g.arms, vary(score, there, 0.008)))
            score.move(cycle / 2, **dict.fromkeys(g.arms, vary(score, back, 0.008)))

    return perform


def _steer(score: Score, g: Gesture) -> None:
    """Both hands turn a wheel to one side and the other."""

    def hold(turn: float) -> dict[str, ArmPose]:
        return {"left": reach((0.17, -0.2 - turn, 0.42)), "right": reach((0.17, -0.2 + turn, 0.42))}

    score.move(reach_s(score, g, hold(0)["left"]), **hold(0.0))
    first = 1 if score.rng.random() < 0.5 else -1
    for i in range(2 * g.count):
        score.to_beat()
        score.move(max(0.4, 0.55 / g.tempo), **hold(first * (1 - 2 * (i % 2)) * 0.13 * g.size))
    score.move(0.4 / g.tempo, **hold(0.0))


def _pour(score: Score, g: Gesture) -> None:
    pose = ArmPose((0.45, -0.35, 0.8), (-0.15, 0.2, 0.95), 0.2)
    arms_to(score, g, pose, amount=0.02)
    tipped = vary(score, ArmPose((0.6, -0.2, 0.75), (-0.25, 0.0, 0.95), -1.5), 0.02)
    score.move(0.6 / g.tempo, **dict.fromkeys(g.arms, tipped))
    score.hold(score.rng.uniform(0.6, 1.3))
    score.move(0.5 / g.tempo, **dict.fromkeys(g.arms, pose))


def _saw(score: Score, g: Gesture) -> None:
    held = ArmPose((0.3, -0.85, 0.4), (-0.2, -0.25, 0.95), -0.8)
    near, far = ArmPose((0.3, -0.7, -0.65), (-0.1, -0.1, 1.0)), ArmPose((0.25, -0.75, 0.6), (-0.1, -0.3, 0.95))
    pair_to(score, g, near, held)
    repeat(score, Gesture(g.family, g.lead, g.count, tempo=g.tempo, size=g.size), far, near, 0.75)


WORK: dict[str, Family] = {
    "push": Family(strokes(_PUSH_READY, _PUSH_OUT, 1.0), sides=ANY, counts=(1,)),
    "pull": Family(strokes(_PULL_FAR, _PULL_NEAR, 1.0), sides=ANY, counts=(1, 2)),
    "lift": Family(_lift, sides=BOTH, counts=(1,)),
    "pick": Family(_pick, sides=ONE, counts=(1, 2)),
    "climb": Family(_climb, sides=BOTH, counts=(3, 4)),
    "knock": Family(
        strokes(
            ArmPose((0.35, -0.5, 0.75), (-0.02, 0.85, 0.5)), ArmPose((0.35, -0.45, 0.8), (-0.02, 0.5, 0.85)), 0.5, 0.45
        ),
        sides=ONE,
        counts=(2, 3),
    ),
    "wipe": Family(
        strokes(reach((-0.1, 0.0, 0.5), (0.9, -0.5, 0)), reach((0.38, 0.02, 0.46), (0.9, -0.5, 0)), 1.0),
        sides=ANY,
        counts=(2, 3),
    ),
    "wipe_table": Family(
        strokes(reach((-0.12, -0.34, 0.36), ELBOW_OUT, -1.0), reach((0.38, -0.34, 0.34), ELBOW_OUT, -1.0), 1.0),
        sides=ONE,
        counts=(2, 3),
    ),
    "paint": Family(
        strokes(reach((0.17, -0.25, 0.45), (0.9, -0.5, 0)), reach((0.17, 0.28, 0.45), (0.9, -0.5, 0)), 1.15),
        sides=ONE,
        counts=(2, 3),
    ),
    "draw_circle": Family(
        loops(circle((0.15, 0.0, 0.42), 0.17, "front"), 1.35, (0.9, -0.5, 0)), sides=ANY, counts=(1, 2)
    ),
    "stir": Family(loops(circle((0.1, -0.3, 0.33), 0.085, "flat"), 0.85, ELBOW_OUT, -0.5), sides=ONE, counts=(2, 3)),
    "crank": Family(loops(circle((0.12, -0.15, 0.38), 0.13, "side"), 1.0, ELBOW_OUT), sides=ONE, counts=(2, 3)),
    "roll_arms": Family(
        loops(circle((0.03, -0.2, 0.33), 0.1, "side"), 0.75, ELBOW_OUT, offset=0.5), sides=BOTH, counts=(3, 4)
    ),
    "type": Family(taps(_KEY_UP, _KEY_DOWN, 0.5), sides=BOTH, counts=(3, 4, 5)),
    "hammer": Family(
        strokes(
            ArmPose((0.4, -0.35, 0.6), (0.0, 0.98, -0.05)), ArmPose((0.3, -0.5, 0.8), (-0.05, 0.0, 1.0)), 0.75, 0.42
        ),
        sides=ONE,
        counts=(3, 4),
    ),
    "saw": Family(_saw, sides=BOTH, counts=(3, 4)),
    "sow": Family(
        strokes(reach((-0.12, -0.3, 0.25), ELBOW_DOWN), ArmPose((0.75, -0.5, 0.45), (0.85, 0.0, 0.5), -0.6), 1.1),
        sides=ONE,
        counts=(2, 3),
    ),
    "turn_key": Family(
        _twist_forearm(ArmPose((0.3, -0.75, 0.55), (-0.02, 0.15, 1.0)), -1.0, 1.0, 1.0), sides=ONE, counts=(1, 2)
    ),
    "flip_palm": Family(
        _twist_forearm(ArmPose((0.3, -0.75, 0.55), (0.08, 0.08, 1.0)), -1.1, 1.25, 1.1), sides=ANY, counts=(1, 2)
    ),
    "pour": Family(_pour, sides=ONE),
    "steer": Family(_steer, sides=BOTH, counts=(1, 2)),
}
