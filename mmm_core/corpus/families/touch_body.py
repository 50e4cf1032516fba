"""Hands that meet each other, the arms or the trunk: chest, belly, hips, back."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import ALL, BOTH, ONE, Family, Gesture
from mmm_core.corpus.families.strokes import arms_to, circle, keep, loops, pair_to, repeat, still, strokes
from mmm_core.corpus.reach import ELBOW_OUT, beside, reach
from mmm_core.corpus.score import SIDE, Score
from mmm_core.recognition.places import BELLY, HEART, HIP, LOWER_BACK, OTHER_SHOULDER, STERNUM

_ABOVE, _BELOW = reach((-0.12, -0.19, 0.22), (0.6, -0.7, 0.1)), reach((-0.14, -0.24, 0.15), (0.6, -0.8, 0.0))
_X_HANDS = reach((-0.1, 0.02, 0.3), (0.5, -0.8, 0.0))


def _cross(score: Score, g: Gesture) -> None:
    """Folded arms: one forearm over the other, either way round."""
    lead = "left" if score.rng.random() < 0.5 else "right"
    pair_to(score, Gesture(g.family, lead, tempo=g.tempo), _ABOVE, _BELOW)
    keep(score, g, (0.8, 2.2))


def _beat_chest(score: Score, g: Gesture) -> None:
    fist, away = reach((0.03, -0.12, 0.13), ELBOW_OUT), reach((0.2, -0.08, 0.33), ELBOW_OUT)
    arms_to(score, g, away)
    repeat(score, g, fist, away, 0.6)


TOUCH_BODY: dict[str, Family] = {
    "cross_arms": Family(_cross, sides=BOTH, holds=True),
    "cross_hands_x": Family(still(_X_HANDS), sides=BOTH, holds=True),
    "hands_on_hips": Family(still(reach(HIP, ELBOW_OUT, -0.3), via=SIDE), holds=True),
    "behind_back": Family(still(reach(LOWER_BACK, (0.8, -0.3, -0.6)), via=SIDE), holds=True),
    "heart": Family(still(reach(HEART, (0.6, -0.8, 0.0), 0.2)), sides=ONE, holds=True),
    "beat_chest": Family(_beat_chest, sides=ALL, counts=(3, 4)),
    "sternum_fist": Family(
        strokes(reach(beside(STERNUM, 0.06, 0.02, 0.12)), reach(beside(STERNUM, -0.02, 0.03, -0.07)), 0.7),
        sides=ONE,
        counts=(2, 3),
    ),
    "belly_rub": Family(loops(circle(BELLY, 0.075, "front"), 0.95), sides=ONE, counts=(2, 3)),
    "hold_belly": Family(still(reach(BELLY, (0.9, -0.4, -0.1))), holds=True),
    "touch_shoulder": Family(still(reach(OTHER_SHOULDER, (0.5, -0.4, 0.8))), holds=True),
    "pray": Family(still(reach((0.035, -0.14, 0.24), (0.9, -0.45, 0.0))), sides=BOTH, holds=True),
    "rub_hands": Family(
        strokes(reach((0.035, -0.22, 0.20), (0.8, -0.6, 0)), reach((0.035, -0.22, 0.30), (0.8, -0.6, 0)), 0.5),
        sides=BOTH,
        counts=(3, 4),
    ),
    "clasp_hands": Family(still(reach((0.02, -0.32, 0.22), (0.8, -0.6, -0.1))), sides=BOTH, holds=True),
    "watch_time": Family(
        still(reach((0.02, -0.17, 0.34), (0.9, -0.5, 0.0), -0.7), head=(0.1, 0.3, 0.0)), sides=ONE, holds=True
    ),
}
