"""Whether a motion meets what is expected of a gesture's limb, arm and direction, each judged as the gesture's family shows it.

The corpus's own performance of every gesture meets all of them (`tests/mmm_core/evaluation/test_expected_by_corpus.py`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.recognition import checks
from mmm_core.recognition.sign_tables import DIRECTED
from mmm_core.recognition.signs import shows

_TRUNK_GOES_ALONG = ("look_back", "breathe")
"""Families in which the trunk turns or bends, too, as far as a trunk that is moved by itself."""
_OTHER_ARM_HELPS = ("dab", "disco", "superhero")
"""Families that name one arm and move both."""
_BY_SIGN = frozenset(family for family, _ in DIRECTED) - {"point"}
"""Families in which each direction has a sign of its own."""
_OTHER = {"left": "right", "right": "left"}
_ARMS_OF = {"alternating": "both"}


class Expected(Protocol):
    """A gesture that is expected of a motion; side and direction are empty where they are left open."""

    @property
    def family(self) -> str: ...
    @property
    def limb(self) -> str: ...
    @property
    def side(self) -> str: ...
    @property
    def direction(self) -> str: ...


def is_seen(s: PostureFeatures, expected: Expected, neighbours: Iterable[Expected]) -> bool:
    """Whether a part of a motion shows a gesture: its limb, arm and direction, and its sign if a neighbour may share these."""
    if not moves(s, expected.family, expected.limb):
        return False
    if expected.side and not acts_with(s, expected.family, expected.side):
        return False
    if expected.direction and not goes(s, expected.family, expected.side, expected.direction):
        return False
    alike = any(_may_look_alike(other, expected) for other in neighbours)
    return not alike or shows(s, expected.family, expected.side, expected.direction)


def moves(s: PostureFeatures, family: str, limb: str) -> bool:
    """Whether the limb that moves most clearly is that of the gesture."""
    found = checks.limb(s)
    return found == limb or (family in _TRUNK_GOES_ALONG and found == "trunk")


def acts_with(s: PostureFeatures, family: str, side: str) -> bool:
    """Whether the arms that act are the gesture's: "left", "right", "both" or "alternating"."""
    if family in _OTHER_ARM_HELPS and side in _OTHER:
        return s.arms == "both" and shows(s, family, side) and not shows(s, family, _OTHER[side])
    return s.arms == ("both" if side == "alternating" else side)


def goes(s: PostureFeatures, family: str, side: str, direction: str) -> bool:
    """Whether the gesture goes in its direction."""
    if family in _BY_SIGN:
        return shows(s, family, side, direction)
    return checks.direction(s, family) == direction


def _may_look_alike(one: Expected, other: Expected) -> bool:
    """Whether gestures may have limb, arm and direction in common; an arm or direction that is left open may be any."""
    arms = {_ARMS_OF.get(expected.side, expected.side) for expected in (one, other)}
    ways = {one.direction, other.direction}
    return one != other and one.limb == other.limb and all(len(said) == 1 or "" in said for said in (arms, ways))
