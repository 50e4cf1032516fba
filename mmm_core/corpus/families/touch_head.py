"""Hands at the head: brow, ears, crown, nape."""

from __future__ import annotations

from mmm_core.corpus.families.gesture import BOTH, ONE, Family
from mmm_core.corpus.families.strokes import still, strokes
from mmm_core.corpus.reach import ELBOW_UP, beside, reach
from mmm_core.corpus.score import SIDE
from mmm_core.recognition.places import BROW, CROWN, EAR, FOREHEAD, NAPE

TOUCH_HEAD: dict[str, Family] = {
    "behind_head": Family(still(reach(NAPE, (0.9, 0.3, 0.1)), via=SIDE), holds=True),
    "salute": Family(still(reach(BROW, (1.0, 0.25, 0.25), -0.3)), sides=ONE, holds=True),
    "shade_eyes": Family(
        still(reach(beside(FOREHEAD, 0.0, 0.0, 0.07), (1.0, 0.1, 0.3), -0.9), head=(0.15, -0.05, 0.0)),
        sides=ONE,
        holds=True,
    ),
    "forehead": Family(still(reach(FOREHEAD, (0.8, 0.0, 0.5))), sides=ONE, holds=True),
    "wipe_brow": Family(
        strokes(
            reach(beside(FOREHEAD, -0.07), (0.9, 0.1, 0.5)),
            reach(beside(FOREHEAD, 0.14, 0.0, -0.03), (1, 0.1, 0.3)),
            0.9,
        ),
        sides=ONE,
        counts=(1,),
    ),
    "listen": Family(
        still(reach(beside(EAR, 0.03, 0.0, 0.02), (0.9, -0.4, -0.2)), head=(0.1, 0.0, 0.12)), sides=ONE, holds=True
    ),
    "phone": Family(
        still(reach(beside(EAR, 0.01, -0.03, 0.03), (0.5, -0.85, 0.1), 0.3), (1.0, 2.4)), sides=ONE, holds=True
    ),
    "cover_ears": Family(still(reach(EAR, (0.9, 0.0, 0.2))), sides=BOTH, holds=True),
    "scratch_head": Family(
        strokes(
            reach(beside(CROWN, 0.05, 0.0, 0.03), ELBOW_UP), reach(beside(CROWN, 0.08, -0.05, -0.09), ELBOW_UP), 0.55
        ),
        sides=ONE,
        counts=(3, 4),
    ),
    "pat_head": Family(
        strokes(reach(beside(CROWN, 0.03, 0.11), ELBOW_UP), reach(CROWN, ELBOW_UP), 0.55), sides=ONE, counts=(2, 3)
    ),
}
