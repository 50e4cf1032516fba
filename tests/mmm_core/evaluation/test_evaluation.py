"""The checks are right on what is right, and wrong on what is mirrored, absent or something else."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.heldout import Probe
from mmm_core.corpus.synthesis import ClipSpec, synthesise_spec
from mmm_core.evaluation.probes import judge
from mmm_core.evaluation.reconstruction import shown
from mmm_core.motion.features import mirror
from mmm_core.recognition import checks
from tests.support.sizes import few_and_long

LIMB_FAMILIES = (
    "wave", "raise", "point", "clap", "bow", "nod", "shake_head", "look", "tilt_head", "lean",
    "twist", "cross_arms", "hands_on_hips", "salute", "punch", "stop", "t_pose", "hands_up", "think", "heart", "beckon",
)  # fmt: skip

SHOWN_AS = {"alternating": "both"}

COUNTED = ("wave", "clap", "nod", "bow", "punch", "beckon")

DIRECTED = ("look", "point", "lean", "twist", "tilt_head")


def gestures(name: str, n: int = 12) -> list[tuple[Gesture, np.ndarray]]:
    """Clips of one family in all its sides, counts and directions."""
    made, family = [], FAMILIES[name]
    for i in range(n):
        rng = np.random.default_rng((7, i))
        side = family.sides[i % len(family.sides)] if family.sides else ""
        where = family.directions[i % len(family.directions)] if family.directions else ""
        clip = synthesise_spec(ClipSpec((Gesture(name, side, 1 + i % 4 if family.counts else 1, where),)), rng)
        if clip is not None:
            made.append((clip.spec.gestures[0], clip.features))
    return made


@pytest.mark.parametrize("name", few_and_long(["wave", "bow", "clap"], LIMB_FAMILIES))
def test_side_and_limb_are_seen_on_motions_that_are_right(name: str) -> None:
    found = [(g, shown(f)) for g, f in gestures(name)]
    assert sum(checks.limb(s) == FAMILIES[name].limb for _, s in found) >= len(found) - 1
    if FAMILIES[name].sides:
        assert sum(s.arms == SHOWN_AS.get(g.side, g.side) for g, s in found) >= len(found) - 1


@pytest.mark.parametrize("name", few_and_long(["wave"], ["wave", "raise", "salute", "stop"]))
def test_a_mirrored_motion_fails_the_side(name: str) -> None:
    other = {"left": "right", "right": "left", "both": "both", "alternating": "both"}
    found = [(g, shown(mirror(f))) for g, f in gestures(name)]
    assert sum(s.arms == other[g.side] for g, s in found) >= len(found) - 1


@pytest.mark.parametrize("name", few_and_long(["punch", "nod"], COUNTED))
def test_counts_are_seen(name: str) -> None:
    found = [
        (g.count, checks.count(shown(f), name))
        for g, f in gestures(name, 16)
        if g.side in ("left", "right", "") or FAMILIES[name].sides == ("both",)
    ]
    assert sum(c is not None and abs(c - asked) <= 1 for asked, c in found) >= 0.9 * len(found), found
    assert sum(c == asked for asked, c in found) >= 0.7 * len(found), found


@pytest.mark.parametrize("name", few_and_long(["lean"], DIRECTED))
def test_directions_are_seen_and_turn_round_in_a_mirror(name: str) -> None:
    made = gestures(name, 24)
    assert sum(checks.direction(shown(f), name) == g.direction for g, f in made) >= 0.9 * len(made)
    sideways = [(g, f) for g, f in made if g.direction in ("left", "right")]
    assert sum(checks.direction(shown(mirror(f)), name) == g.direction for g, f in sideways) == 0


def test_standing_still_shows_nothing() -> None:
    for i in range(5):
        clip = synthesise_spec(ClipSpec((Gesture("stand"),)), np.random.default_rng(i))
        assert clip is not None
        assert checks.limb(shown(clip.features)) == ""


@pytest.mark.parametrize(("first", "second"), few_and_long(
    [(Gesture("look", direction="left"), Gesture("look", direction="right"))],
    [(Gesture("raise", "left"), Gesture("bow")), (Gesture("bow"), Gesture("raise", "right")),
     (Gesture("nod", count=2), Gesture("clap", "both", 3)), (Gesture("raise", "left"), Gesture("raise", "right"))],
))  # fmt: skip
def test_order_is_seen_and_the_other_order_is_not(first: Gesture, second: Gesture) -> None:
    def probe(a: Gesture, b: Gesture) -> Probe:
        then = Probe("", b.family, FAMILIES[b.family].limb, b.side, None, b.direction)
        return Probe("", a.family, FAMILIES[a.family].limb, a.side, None, a.direction, then=then)

    made = [synthesise_spec(ClipSpec((first, second)), np.random.default_rng(i)) for i in range(8)]
    seen = [shown(clip.features) for clip in made if clip is not None]
    assert sum(judge(probe(first, second), s)["order"] for s in seen) >= len(seen) - 1
    assert not any(judge(probe(second, first), s)["order"] for s in seen)


@pytest.mark.parametrize("seconds", few_and_long([1.0], [1.0, 3.0, 5.0]))
def test_holds_are_seen(seconds: float) -> None:
    for name, side, where in (
        ("raise", "left", ""),
        ("t_pose", "both", ""),
        ("look", "", "left"),
        ("lean", "", "right"),
    ):
        probe = Probe("", name, FAMILIES[name].limb, side, None, where, hold_s=seconds)
        longer = Probe("", name, FAMILIES[name].limb, side, None, where, hold_s=seconds + 3)
        for seed in range(4):
            gesture = Gesture(name, side, direction=where, hold_s=seconds)
            clip = synthesise_spec(ClipSpec((gesture,)), np.random.default_rng(seed))
            assert clip is not None
            assert judge(probe, shown(clip.features))["hold"]
            assert not judge(longer, shown(clip.features))["hold"]


@pytest.mark.parametrize("name", few_and_long(["clap", "nod"], ["wave", "clap", "nod", "shake_head", "punch"]))
def test_slow_and_fast_are_told_apart(name: str) -> None:
    side = {"clap": "both", "wave": "right", "punch": "left"}.get(name, "")
    for tempo, word, other in ((0.65, "slow", "fast"), (1.4, "fast", "slow")):
        for seed in range(4):
            clip = synthesise_spec(ClipSpec((Gesture(name, side, 4, tempo=tempo),)), np.random.default_rng(seed))
            assert clip is not None
            limb = FAMILIES[name].limb
            assert judge(Probe("", name, limb, side, tempo=word), shown(clip.features))["tempo"]
            assert not judge(Probe("", name, limb, side, tempo=other), shown(clip.features))["tempo"]
