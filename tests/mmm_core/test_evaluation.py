"""The checks are right on what is right, and wrong on what is mirrored, absent or something else."""

from __future__ import annotations

import re

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.grammar import known_commands
from mmm_core.corpus.heldout import PROBES
from mmm_core.corpus.synthesis import ClipSpec, synthesise, synthesise_spec
from mmm_core.evaluation import checks
from mmm_core.evaluation.checks import Shown, look_at
from mmm_core.features import mirror, recover

LIMB_FAMILIES = (
    "wave", "raise", "point", "clap", "bow", "nod", "shake_head", "look", "tilt_head", "lean",
    "twist", "cross_arms", "hands_on_hips", "salute", "punch", "stop", "t_pose", "hands_up", "think", "heart", "beckon",
)  # fmt: skip
SHOWN_AS = {"alternating": "both"}
COUNTED = ("wave", "clap", "nod", "bow", "punch", "beckon")
DIRECTED = ("look", "point", "lean", "twist", "tilt_head")


def shown(features: np.ndarray) -> Shown:
    motion = recover(features)
    return look_at(motion.joints_m, motion.head_quat_wxyz)


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


@pytest.mark.parametrize("name", LIMB_FAMILIES)
def test_side_and_limb_are_seen_on_motions_that_are_right(name: str) -> None:
    found = [(g, shown(f)) for g, f in gestures(name)]
    assert sum(checks.limb(s) == FAMILIES[name].limb for _, s in found) >= len(found) - 1
    if FAMILIES[name].sides:
        assert sum(s.arms == SHOWN_AS.get(g.side, g.side) for g, s in found) >= len(found) - 1


@pytest.mark.parametrize("name", ["wave", "raise", "salute", "stop"])
def test_a_mirrored_motion_fails_the_side(name: str) -> None:
    other = {"left": "right", "right": "left", "both": "both", "alternating": "both"}
    found = [(g, shown(mirror(f))) for g, f in gestures(name)]
    assert sum(s.arms == other[g.side] for g, s in found) >= len(found) - 1


@pytest.mark.parametrize("name", COUNTED)
def test_counts_are_seen(name: str) -> None:
    found = [
        (g.count, checks.count(shown(f), name))
        for g, f in gestures(name, 16)
        if g.side in ("left", "right", "") or FAMILIES[name].sides == ("both",)
    ]
    assert sum(c is not None and abs(c - asked) <= 1 for asked, c in found) >= 0.9 * len(found), found
    assert sum(c == asked for asked, c in found) >= 0.7 * len(found), found


@pytest.mark.parametrize("name", DIRECTED)
def test_directions_are_seen_and_turn_round_in_a_mirror(name: str) -> None:
    made = gestures(name, 44)
    assert sum(checks.direction(shown(f), name) == g.direction for g, f in made) >= 0.9 * len(made)
    sideways = [(g, f) for g, f in made if g.direction in ("left", "right")]
    assert sum(checks.direction(shown(mirror(f)), name) == g.direction for g, f in sideways) == 0


def test_standing_still_shows_nothing() -> None:
    for i in range(5):
        clip = synthesise_spec(ClipSpec((Gesture("stand"),)), np.random.default_rng(i))
        assert clip is not None
        assert checks.limb(shown(clip.features)) == ""


def test_no_probe_is_a_sentence_of_the_grammar() -> None:
    """Thousands of drawn captions and every plain phrase: the probes' words stay out of training."""

    def plain(text: str) -> str:
        return re.sub(r"[^a-z0-9 ]", "", text.lower()).strip()

    said = {plain(text) for text in known_commands()}
    for i in range(400):
        said |= {plain(text) for text in synthesise(np.random.default_rng((1, i))).captions}
    assert not said & {plain(p.text) for p in PROBES}


def test_probes_name_families_limbs_and_directions_that_exist() -> None:
    for probe in PROBES:
        assert FAMILIES[probe.family].limb == probe.limb, probe.text
        assert probe.direction in ("", *FAMILIES[probe.family].directions), probe.text
