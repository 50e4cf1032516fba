"""Hands at the face: chin, eyes, mouth."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import BOTH, ONE, Family, Gesture
from mmm_core.corpus.families.strokes import arms_to, still, strokes
from mmm_core.corpus.reach import ELBOW_DOWN, beside, reach
from mmm_core.corpus.score import ArmPose, Score
from mmm_core.recognition.places import CHIN, EYES, MOUTH

_KISS_OUT = ArmPose((0.2, -0.35, 0.9), (0.12, 0.15, 1.0), 1.0)


def _kiss(score: Score, g: Gesture) -> None:
    for _ in range(g.count):
        score.to_beat()
        arms_to(score, g, reach(MOUTH), amount=0.03)
        score.hold(score.rng.uniform(0.1, 0.3))
        arms_to(score, g, _KISS_OUT, amount=0.04)
        score.hold(score.rng.uniform(0.1, 0.4))


def _yawn(score: Score, g: Gesture) -> None:
    arms_to(score, g, reach(beside(MOUTH, forward_m=0.02)), amount=0.02)
    score.move(0.8 / g.tempo, trunk=(0.0, -0.09, 0.0), head=(0.0, -0.22, 0.0), shrug=0.5)
    score.hold(score.rng.uniform(0.3, 0.8))
    score.move(0.7 / g.tempo, trunk=(0.0, 0.03, 0.0), head=(0.0, 0.05, 0.0), shrug=0.0)


TOUCH_FACE: dict[str, Family] = {
    "think": Family(still(reach(CHIN, (0.3, -0.9, 0.4)), head=(0.0, 0.06, -0.07)), sides=ONE, holds=True),
    "facepalm": Family(
        still(reach(beside(EYES, 0.0, 0.0, 0.01), (0.7, -0.5, 0.6)), head=(0.0, 0.2, 0.0)), sides=ONE, holds=True
    ),
    "cover_eyes": Family(still(reach(beside(EYES, 0.02, 0.0, 0.02), (0.8, -0.3, 0.5))), sides=BOTH, holds=True),
    "kiss": Family(_kiss, counts=(1,)),
    "hush": Family(still(reach(beside(MOUTH, 0.0, -0.02, 0.02), (0.5, -0.85, 0.3))), sides=ONE, holds=True),
    "cover_mouth": Family(still(reach(beside(MOUTH, 0.0, 0.0, 0.01), (0.8, -0.5, 0.4))), holds=True),
    "yawn": Family(_yawn, sides=ONE),
    "drink": Family(
        still(reach(beside(MOUTH, 0.02, 0.0, 0.03), (0.7, -0.65, 0.3), 0.4), (0.6, 1.4), head=(0.0, -0.16, 0.0)),
        sides=ONE,
        holds=True,
    ),
    "eat": Family(
        strokes(
            reach((0.12, -0.3, 0.36), ELBOW_DOWN, 0.5),
            reach(beside(MOUTH, 0.0, -0.01, 0.02), (0.6, -0.75, 0.2), 0.6),
            1.1,
            0.48,
        ),
        sides=ONE,
        counts=(2, 3),
    ),
    "brush_teeth": Family(
        strokes(
            reach(beside(MOUTH, -0.03, 0.0, 0.03), (1, -0.2, 0.2)),
            reach(beside(MOUTH, 0.09, 0.0, 0.03), (1, -0.2, 0.2)),
            0.55,
        ),
        sides=ONE,
        counts=(4, 5),
    ),
}
