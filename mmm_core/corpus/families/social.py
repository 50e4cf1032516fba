"""Gestures between people: greeting, applause, joy."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ALL, ANY, BOTH, ONE, Family, Gesture
from mmm_core.corpus.families.strokes import (
    arms_to,
    cycle_s,
    keep,
    pair_to,
    reach_s,
    repeat,
    still,
    strokes,
    turn_s,
    vary,
)
from mmm_core.corpus.reach import ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score, Vector

_WAVE_HIGH, _WAVE_USUAL, _WAVE_LOW = (0.55, 0.62, 0.4), (0.75, -0.15, 0.5), (0.5, -0.8, 0.35)


def _wave(score: Score, g: Gesture) -> None:
    rng, s = score.rng, g.size
    high = g.height == "high" or (not g.height and rng.random() < 0.3)
    upper: Vector = _WAVE_HIGH if high else _WAVE_LOW if g.height == "low" else _WAVE_USUAL
    middle = ArmPose(upper, (0.12, 0.95, 0.25), -0.5)
    arms_to(score, g, middle, amount=0.03)
    cycle = cycle_s(score, g, 0.62)
    first = int(rng.integers(2))
    for i in range(g.count):
        score.to_beat()
        arms = (("left", "right")[(first + i) % 2],) if g.side == "alternating" else g.arms
        for swing in (0.14 + 0.58 * s, 0.14 - 0.45 * s):
            pose = vary(score, ArmPose(upper, (swing, 0.87, 0.22), -0.5), 0.03)
            score.move(cycle * 0.5 * rng.uniform(0.92, 1.08), **dict.fromkeys(arms, pose))


def _big_wave(score: Score, g: Gesture) -> None:
    """The whole straight arm swings overhead."""
    inner, outer = ArmPose((-0.12, 0.97, 0.2), (-0.2, 0.97, 0.12)), ArmPose((0.75, 0.65, 0.15), (0.78, 0.62, 0.1))
    arms_to(score, g, outer, via=SIDE)
    repeat(score, g, inner, outer, 0.95)


def _clap(score: Score, g: Gesture) -> None:
    if g.direction == "up":
        together, apart = reach((0.03, 0.42, 0.2), ELBOW_OUT), reach((0.27, 0.42, 0.2), ELBOW_OUT)
    else:
        together, apart = reach((0.02, -0.18, 0.32), (0.6, -0.8, 0)), reach((0.17, -0.18, 0.34), (0.6, -0.8, 0))
    arms_to(score, g, apart, amount=0.02)
    cycle = cycle_s(score, g, 0.56)
    for _ in range(g.count):
        score.to_beat()
        close = cycle * score.rng.uniform(0.42, 0.5)
        wide = g.size * score.rng.uniform(0.92, 1.08)
        away = ArmPose(apart.upper, (apart.fore[0] + 0.3 * (wide - 1), apart.fore[1], apart.fore[2]))
        score.move(close, left=together, right=together)
        score.move(cycle - close, left=away, right=away)


def _shrug(score: Score, g: Gesture) -> None:
    palms = vary(score, ArmPose((0.3, -0.85, 0.25), (0.65, 0.15, 0.7), 1.1), 0.04)
    for _ in range(g.count):
        score.to_beat()
        tilt = score.rng.uniform(-0.15, 0.15)
        up = turn_s(score, g, 0.45)
        score.move(up, shrug=1.0 * g.size, left=palms, right=palms, head=(0.0, 0.0, tilt))
        score.hold(score.rng.uniform(0.2, 0.6))
        score.move(turn_s(score, g, 0.42), shrug=0.0, **({} if g.count == 1 else {"head": (0.0, 0.0, 0.0)}))


def _hug(score: Score, g: Gesture) -> None:
    wide = vary(score, ArmPose((0.85, -0.15, 0.45), (0.75, 0.1, 0.65), 0.6), 0.04)
    score.move(reach_s(score, g, wide), left=wide, right=wide)
    if g.direction != "in":
        keep(score, g)
        return
    score.hold(score.rng.uniform(0.2, 0.5))
    pair_to(score, g, reach((-0.12, -0.1, 0.34), (0.9, 0.1, 0.4)), reach((-0.1, -0.18, 0.28), (0.9, 0.0, 0.4)))
    keep(score, g, (0.4, 1.2))


def _handshake(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.2, -0.72, 0.6), (-0.05, -0.16, 1.0)), ArmPose((0.2, -0.7, 0.62), (-0.05, 0.22, 1.0))
    arms_to(score, g, low, amount=0.03)
    repeat(score, g, high, low, 0.55)


def _fist_pump(score: Score, g: Gesture) -> None:
    high = ArmPose((0.5, 0.5, 0.5), (0.05, 0.98, 0.1))
    low = ArmPose((0.45, -0.8, 0.15), (0.02, 0.9, 0.45))
    arms_to(score, g, high)
    for i in range(g.count):
        score.to_beat()
        arms_to(score, g, low, 0.3 / g.tempo**0.5, 0.02)
        if i < g.count - 1:
            arms_to(score, g, high, 0.34 / g.tempo**0.5, 0.02)
    score.hold(score.rng.uniform(0.2, 0.5))


def _cheer(score: Score, g: Gesture) -> None:
    low, high = ArmPose((0.5, 0.45, 0.45), (0.05, 0.98, 0.05)), ArmPose((0.3, 0.92, 0.2), (0.1, 1.0, 0.05))
    score.move(reach_s(score, g, low), left=low, right=low)
    repeat(score, g, high, low, 0.62)


def _celebrate(score: Score, g: Gesture) -> None:
    """Both arms are thrown up and out and shaken, with an open chest."""
    high = vary(score, ArmPose((0.55, 0.8, 0.15), (0.45, 0.88, 0.1)), 0.04)
    score.move(0.8 * reach_s(score, g, high), left=high, right=high, trunk=(0.0, -0.08, 0.0), head=(0.0, -0.18, 0.0))
    low = ArmPose((0.6, 0.5, 0.35), (0.35, 0.9, 0.2))
    repeat(score, Gesture(g.family, "both", int(score.rng.integers(2, 5)), tempo=g.tempo), low, high, 0.55)


def _toast(score: Score, g: Gesture) -> None:
    arms_to(score, g, ArmPose((0.3, -0.8, 0.4), (-0.1, 0.55, 0.8)))
    score.hold(score.rng.uniform(0.1, 0.4))
    arms_to(score, g, ArmPose((0.15, 0.05, 0.95), (0.03, 0.42, 0.9)))
    keep(score, g, (0.5, 1.3))


SOCIAL: dict[str, Family] = {
    "wave": Family(_wave, sides=ALL, counts=(2, 3), heights=True),
    "big_wave": Family(_big_wave, sides=ANY, counts=(2, 3)),
    "clap": Family(_clap, sides=BOTH, counts=(3, 4), directions=("", "up")),
    "shrug": Family(_shrug, sides=BOTH, counts=(1,)),
    "hug": Family(_hug, sides=BOTH, directions=("", "in"), holds=True),
    "handshake": Family(_handshake, sides=ONE, counts=(2, 3)),
    "high_five": Family(still(ArmPose((0.4, 0.35, 0.7), (0.08, 0.8, 0.62), -0.4), (0.4, 1.2)), holds=True),
    "fist_bump": Family(still(ArmPose((0.2, -0.5, 0.8), (-0.02, 0.12, 1.0), -0.9), (0.3, 1.0)), sides=ONE, holds=True),
    "fist_pump": Family(_fist_pump, sides=ONE, counts=(1, 2)),
    "cheer": Family(_cheer, sides=BOTH, counts=(2, 3)),
    "celebrate": Family(_celebrate, sides=BOTH),
    "toast": Family(_toast, sides=ONE, holds=True),
    "pat_back": Family(
        strokes(
            ArmPose((0.25, -0.35, 0.9), (0.0, 0.3, 1.0), -0.8), ArmPose((0.2, -0.3, 0.95), (-0.1, -0.1, 1.0), -0.8), 0.6
        ),
        sides=ONE,
        counts=(2, 3),
    ),
}
