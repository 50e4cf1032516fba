"""Showing the way: pointing, presenting, calling, sending away, traffic."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture
from mmm_core.corpus.families.strokes import (
    SIGN,
    arms_to,
    keep,
    pair_to,
    reach_s,
    repeat,
    strokes,
    turn_s,
    vary,
)
from mmm_core.corpus.score import ArmPose, Score, Vector

_POINT_AT: dict[str, Vector] = {
    "left": (1, 0.04, 0.14),
    "right": (-1, 0.04, 0.14),
    "forward": (0.02, 0.05, 1),
    "up": (0.05, 1, 0.1),
    "down": (0.1, -0.75, 0.65),
    "up left": (0.7, 0.68, 0.2),
    "up right": (-0.7, 0.68, 0.2),
    "down left": (0.72, -0.6, 0.35),
    "down right": (-0.72, -0.6, 0.35),
}
"""Directions (left, up, forward), which are turned to (outward, up, forward) for the acting arm."""
_POINT_SELF = ArmPose((0.35, -0.75, 0.45), (-0.75, 0.35, -0.1))
_POINT_BACK = ArmPose((0.65, -0.1, 0.55), (0.15, 0.7, -0.75))


def _pointing(direction: str, sign: float) -> ArmPose:
    """The pose of an arm along a direction, with the elbow bent if the arm reaches across the body."""
    if direction in ("self", "back"):
        return _POINT_SELF if direction == "self" else _POINT_BACK
    left, up, forward = _POINT_AT[direction]
    out = sign * left
    if out < -0.3:
        return ArmPose((-0.35, 0.75 * up - 0.1, 0.9), (out, up, forward + 0.25))
    lift = 0.06 if direction == "down" else 0.0
    return ArmPose((0.9 * out + 0.12, 0.95 * up - 0.05 + lift, forward + 0.1), (out, up, forward))


def _point(score: Score, g: Gesture) -> None:
    pose = vary(score, _pointing(g.direction, SIGN[g.lead]), 0.035)
    gaze = {}
    if g.direction not in ("self", "forward", "back") and score.rng.random() < 0.5:
        yaw = (SIGN["left"] if "left" in g.direction else -1.0 if "right" in g.direction else 0.0) * score.rng.uniform(
            0.2, 0.5
        )
        pitch = (-1.0 if "up" in g.direction else 1.0 if "down" in g.direction else 0.0) * score.rng.uniform(0.1, 0.3)
        gaze = {"head": (yaw, pitch, 0.0)}
    score.move(reach_s(score, g, pose), **dict.fromkeys(g.arms, pose), **gaze)
    keep(score, g, (0.6, 1.8))


def _present(score: Score, g: Gesture) -> None:
    """An open hand sweeps from the middle outward: this way, please."""
    arms_to(score, g, ArmPose((0.2, -0.75, 0.6), (-0.35, 0.15, 0.9), 0.9))
    out = vary(score, ArmPose((0.75, -0.6, 0.25), (0.95, 0.12, 0.3), 1.2), 0.03)
    yaw = SIGN[g.lead] * score.rng.uniform(0.25, 0.5)
    score.move(turn_s(score, g, 0.7), **dict.fromkeys(g.arms, out), head=(yaw, 0.05, 0.0))
    keep(score, g)


def _traffic(score: Score, g: Gesture) -> None:
    """One arm bars the way sideways, the other waves the cars through."""
    lead = g.lead
    bar = ArmPose((1, 0.05, 0.1), (1, 0.1, 0.1), -0.6)
    out, back = ArmPose((0.75, -0.25, 0.55), (0.85, 0.1, 0.5)), ArmPose((0.6, -0.3, 0.7), (-0.5, 0.72, 0.45))
    pair_to(score, g, out, bar)
    one = Gesture(g.family, lead, g.count, tempo=g.tempo, size=g.size)
    repeat(score, one, back, out, 0.85)


_BECKON_READY, _BECKON_IN = (
    ArmPose((0.35, -0.6, 0.65), (0.05, 0.1, 1.0), 1.2),
    ArmPose((0.35, -0.6, 0.6), (-0.15, 0.85, 0.4), 1.2),
)
_NEAR, _FAR = ArmPose((0.4, -0.6, 0.6), (-0.2, 0.5, 0.75), 0.4), ArmPose((0.35, -0.3, 0.9), (0.2, -0.1, 1.0), -0.8)


DIRECTING: dict[str, Family] = {
    "point": Family(_point, sides=ONE, directions=(*_POINT_AT, "self", "back"), holds=True),
    "present": Family(_present, sides=ONE, holds=True),
    "beckon": Family(strokes(_BECKON_READY, _BECKON_IN, 0.7), sides=ANY, counts=(2,)),
    "go_away": Family(strokes(_NEAR, _FAR, 0.75), sides=ANY, counts=(2,)),
    "traffic": Family(_traffic, sides=BOTH, counts=(2, 3)),
}
