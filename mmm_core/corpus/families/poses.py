"""Arm poses that are taken and kept: raised, stretched, lowered, held out."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ANY, BOTH, ONE, Family, Gesture
from mmm_core.corpus.families.strokes import arms_to, keep, pair_to, reach_s, still, vary
from mmm_core.corpus.reach import ELBOW_OUT, reach
from mmm_core.corpus.score import SIDE, ArmPose, Score
from mmm_core.recognition.places import HIP

_UP = ArmPose((0.22, 0.9, 0.3), (0.08, 0.98, 0.12))
_HALF_UP = ArmPose((0.2, -0.05, 0.97), (0.08, 0.3, 0.95))
_SIDEWAYS = ArmPose((1, 0.02, 0.08), (1, 0.04, 0.1), -0.6)
_WIDE_UP = ArmPose((0.62, 0.75, 0.12), (0.62, 0.78, 0.08))


def _raise(score: Score, g: Gesture) -> None:
    pose = _HALF_UP if g.height == "low" else _UP
    arms_to(score, g, pose, amount=0.035, via=SIDE if score.rng.random() < 0.25 else (0.35, 0.0, 0.95))
    keep(score, g)


def _hands_up(score: Score, g: Gesture) -> None:
    pose = vary(score, ArmPose((0.28, 0.92, 0.15), (0.1, 0.98, 0.08)))
    via = SIDE if score.rng.random() < 0.3 else (0.35, 0.0, 0.95)
    score.move(reach_s(score, g, pose), via, left=pose, right=pose)
    keep(score, g)


def _arms_down(score: Score, g: Gesture) -> None:
    """The acting arms start raised and come down to the sides."""
    start = vary(score, _UP if score.rng.random() < 0.4 else ArmPose((0.5, 0.1, 0.75), (0.35, 0.3, 0.85))).vector()
    for arm in g.arms:
        score.start_at(arm, start)
    score.hold(score.rng.uniform(0.1, 0.3))
    duration = reach_s(score, g, score.rest[g.arms[0]])
    score.move(duration, SIDE if score.rng.random() < 0.3 else (0.4, 0, 0.9), **{a: score.rest[a] for a in g.arms})
    score.hold(score.rng.uniform(0.3, 1.2))


def _stretch(score: Score, g: Gesture) -> None:
    """Both arms stretch overhead; in a direction to a side the trunk bends with them."""
    side = {"left": 1.0, "right": -1.0}.get(g.direction, 0.0)
    pose = vary(score, ArmPose((0.12, 0.97, 0.12), (-0.18, 0.97, 0.08), 0.8), 0.03)
    duration = 1.2 * reach_s(score, g, pose)
    score.move(duration, SIDE, left=pose, right=pose, trunk=(0.0, -0.05, 0.0), head=(0.0, -0.1, 0.0))
    if side:
        score.move(reach_s(score, g) * 1.6, trunk=(0.0, 0.0, side * score.rng.uniform(0.26, 0.36) * g.size))
    keep(score, g, (0.6, 1.6))


def _superhero(score: Score, g: Gesture) -> None:
    pair_to(score, g, ArmPose((0.15, 0.72, 0.68), (0.02, 0.72, 0.7), -0.8), reach(HIP, ELBOW_OUT))
    keep(score, g)


POSES: dict[str, Family] = {
    "raise": Family(_raise, sides=ONE, holds=True, heights=True),
    "hands_up": Family(_hands_up, sides=BOTH, holds=True),
    "arms_down": Family(_arms_down, starts_away=True),
    "arm_forward": Family(still(ArmPose((0.1, -0.03, 1), (0.02, 0.03, 1), -0.5)), holds=True),
    "zombie": Family(
        still(ArmPose((0.12, 0.02, 1), (-0.02, -0.08, 1), -0.9), trunk=(0.0, 0.08, 0.0), head=(0.0, -0.05, 0.22)),
        sides=BOTH,
        holds=True,
    ),
    "arm_side": Family(still(_SIDEWAYS, via=SIDE), sides=ONE, holds=True),
    "t_pose": Family(still(_SIDEWAYS, via=SIDE), sides=BOTH, holds=True),
    "stretch": Family(_stretch, sides=BOTH, directions=("up", "left", "right"), holds=True),
    "victory": Family(still(_WIDE_UP, via=SIDE), sides=BOTH, holds=True),
    "superhero": Family(_superhero, sides=ONE, holds=True),
    "flex": Family(still(ArmPose((1, 0.05, 0.1), (-0.15, 0.98, 0.1), 0.5), via=SIDE), holds=True),
    "stop": Family(still(ArmPose((0.2, -0.25, 0.95), (0.02, 0.62, 0.8), -0.6)), holds=True),
    "oath": Family(still(ArmPose((0.7, -0.68, 0.15), (0.22, 0.95, 0.2), -0.4)), sides=ONE, holds=True),
    "offer": Family(still(ArmPose((0.3, -0.75, 0.5), (0.15, 0.05, 1.0), 1.3)), sides=ANY, holds=True),
    "carry": Family(still(ArmPose((0.25, -0.9, 0.25), (-0.12, 0.02, 1.0), 1.0)), sides=BOTH, holds=True),
    "block": Family(still(ArmPose((0.35, -0.25, 0.9), (-0.35, 0.93, 0.15), 0.3)), holds=True),
}
