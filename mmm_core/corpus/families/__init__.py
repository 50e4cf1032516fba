"""The gesture families, by what they are about; docs/corpus.md shows how to add one."""

from mmm_core.corpus.families.directing import DIRECTING
from mmm_core.corpus.families.gesture import Family, Gesture, Words
from mmm_core.corpus.families.head import HEAD
from mmm_core.corpus.families.play import PLAY
from mmm_core.corpus.families.poses import POSES
from mmm_core.corpus.families.social import SOCIAL
from mmm_core.corpus.families.sport import SPORT
from mmm_core.corpus.families.touch_body import TOUCH_BODY
from mmm_core.corpus.families.touch_face import TOUCH_FACE
from mmm_core.corpus.families.touch_head import TOUCH_HEAD
from mmm_core.corpus.families.trunk import TRUNK
from mmm_core.corpus.families.work import WORK

_TABLES = (SOCIAL, DIRECTING, POSES, TOUCH_BODY, TOUCH_HEAD, TOUCH_FACE, HEAD, TRUNK, SPORT, WORK, PLAY)
FAMILIES: dict[str, Family] = dict(sorted((name, family) for table in _TABLES for name, family in table.items()))
"""By name: what a seed draws does not hang on the file a family stands in."""

MIMED = frozenset((*SPORT, *WORK, *PLAY))
"""Families that act something out: one may also ask to pretend them."""

__all__ = ["FAMILIES", "MIMED", "Family", "Gesture", "Words"]
