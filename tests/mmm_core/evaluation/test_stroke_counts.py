"""Strokes are counted as the corpus performs them, for nearly every family that has any."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import Probe
from mmm_core.evaluation.reconstruction import performed, shown
from mmm_core.evaluation.stroke_counts import count_strokes
from mmm_core.motion.posture_features import PostureFeatures
from tests.support.sizes import few_and_long

_NOT_TOLD = frozenset({"climb", "robot", "flute"})
"""Families whose strokes are not alike, or too small to be seen."""
_WITH_STROKES = sorted(name for name, family in FAMILIES.items() if family.counts and name not in _NOT_TOLD)


def _performance(name: str, n: int, seed: int) -> PostureFeatures:
    family = FAMILIES[name]
    direction = "" if "" in family.directions else (family.directions or ("",))[0]
    return shown(performed(Probe("", name, family.limb, count=n, direction=direction), seed))


def _counted(name: str, n: int, seed: int) -> int | None:
    directions = FAMILIES[name].directions
    return count_strokes(_performance(name, n, seed), name, "", "" if "" in directions else (directions or ("",))[0])


@pytest.mark.parametrize(
    "name", ["hammer", "shrug", "karate_chop", "clap", "draw_circle", "sway", "nod", "overhead_press", "breathe"]
)
@pytest.mark.parametrize("n", [1, 2, 4])
def test_as_many_strokes_are_counted_as_are_performed(name: str, n: int) -> None:
    assert _counted(name, n, 70 + n) == n


@pytest.mark.parametrize("every", few_and_long([4], [1]))
def test_nearly_all_families_are_counted_within_one_and_most_exactly(every: int) -> None:
    """The default suite counts every fourth family, the long one counts all."""
    found = {name: _counted(name, 3, 70) for name in _WITH_STROKES[::every]}
    assert {name for name, n in found.items() if n is None or abs(n - 3) > 1} == set()
    assert sum(n == 3 for n in found.values()) > 0.85 * len(found)


def test_standing_has_no_strokes_and_shows_no_gesture() -> None:
    still = _performance("stand", 1, 0)
    assert {count_strokes(still, name, "right") for name in ("hammer", "fist_pump", "salute")} == {0}
    assert count_strokes(still, "stand") is None


@pytest.mark.parametrize("name", ["salute", "dab", "drink", "high_five", "yawn", "lean", "look", "stretch"])
@pytest.mark.parametrize("n", [1, 2, 3])
def test_a_gesture_without_strokes_is_counted_as_a_whole(name: str, n: int) -> None:
    family = FAMILIES[name]
    direction = (family.directions or ("",))[0]
    once = performed(Probe("", name, family.limb, direction=direction), 3)
    assert count_strokes(shown(np.tile(once, (n, 1))), name, "", direction) == n


@pytest.mark.parametrize("name", sorted(_NOT_TOLD))
def test_what_cannot_be_told_is_not_claimed(name: str) -> None:
    assert _counted(name, 2, 70) != 2
