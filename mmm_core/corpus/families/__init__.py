"""The gesture families, in files by subject; docs/corpus.md shows how to add one."""

from dataclasses import replace

from mmm_core.corpus.families.directing import DIRECTING
from mmm_core.corpus.families.gesture import Family, Gesture, Words
from mmm_core.corpus.families.head import HEAD
from mmm_core.corpus.families.phrases import read_phrases
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


def _with_phrases(name: str, family: Family) -> Family:
    words, directed = read_phrases(name)
    return replace(family, words=words, directed=directed)


FAMILIES: dict[str, Family] = {
    name: _with_phrases(name, family)
    for name, family in sorted((name, family) for table in _TABLES for name, family in table.items())
}
"""The families in the order of their names, so that the draws of a seed do not depend on the file of a family."""

MIMED = frozenset((*SPORT, *WORK, *PLAY))
"""Families that act something out, for which a sentence may also ask to pretend."""

__all__ = ["FAMILIES", "MIMED", "Family", "Gesture", "Words"]
