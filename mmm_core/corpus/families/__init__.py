"""The gesture families, by what they are about; docs/corpus.md shows how to add one."""

from mmm_core.corpus.families.gesture import Family, Gesture, Words
from mmm_core.corpus.families.head import HEAD
from mmm_core.corpus.families.play import PLAY
from mmm_core.corpus.families.poses import POSES
from mmm_core.corpus.families.social import SOCIAL
from mmm_core.corpus.families.sport import SPORT
from mmm_core.corpus.families.touch import TOUCH
from mmm_core.corpus.families.trunk import TRUNK
from mmm_core.corpus.families.work import WORK

FAMILIES: dict[str, Family] = {**SOCIAL, **POSES, **TOUCH, **HEAD, **TRUNK, **SPORT, **WORK, **PLAY}

MIMED = frozenset((*SPORT, *WORK, *PLAY))
"""Families that act something out: one may also ask to pretend them."""

__all__ = ["FAMILIES", "MIMED", "Family", "Gesture", "Words"]
