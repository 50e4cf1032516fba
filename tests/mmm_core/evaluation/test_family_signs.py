"""The sign of each family is seen in its own motions, not in their mirror image, and seldom in those of other families."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.synthesis import ClipSpec, draw_gesture, synthesise_spec
from mmm_core.evaluation.reconstruction import shown
from mmm_core.motion.features import mirror
from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.recognition.checks import PALM_M
from mmm_core.recognition.signs import shows
from tests.support.sizes import few_and_long


def drawn(name: str, n: int, seed: int = 3) -> list[tuple[Gesture, np.ndarray]]:
    """Clips of one family as training draws them: any side, count, tempo, size and manner."""
    made: list[tuple[Gesture, np.ndarray]] = []
    for i in range(40):
        if len(made) == n:
            break
        rng = np.random.default_rng((seed, len(name), ord(name[0]), i))
        gesture = draw_gesture(rng, (name,))
        clip = None if gesture.height else synthesise_spec(ClipSpec((gesture,)), rng)
        if clip is not None:
            made.append((gesture, clip.features))
    return made


@cache
def clips(every: int) -> list[tuple[Gesture, PostureFeatures, PostureFeatures]]:
    """A few clips of one family in `every`, each with its mirror image; and clips that stand."""
    names = dict.fromkeys((*sorted(FAMILIES)[::every], "stand"))
    return [(g, shown(f), shown(mirror(f))) for name in names for g, f in drawn(name, 3)]


def asked_side(name: str, side: str) -> str:
    """The side that a family could be asked with, given what another gesture has."""
    sides = FAMILIES[name].sides
    return side if side in sides else "both" if sides == ("both",) else ""


@cache
def seen_elsewhere(every: int, every_clip: int) -> dict[str, list[bool]]:
    """For each of these families whether its sign is seen in one clip in `every_clip` of the others."""
    names = sorted(FAMILIES)[::every]
    seen: dict[str, list[bool]] = {name: [] for name in names}
    for g, s, _ in clips(every)[::every_clip]:
        for name in names:
            if g.family != name:
                where = (FAMILIES[name].directions or ("",))[0]
                seen[name].append(shows(s, name, asked_side(name, g.side), where))
    return seen


RAISED_M = -0.45
"""Height of the wrist, in the chest frame, above which an arm is raised."""
FLATTENED = {"draw_circle": 1, "stir": 2, "crank": 1}
"""Axis of the chest frame along which a circle of each family is flattened."""


@pytest.mark.parametrize("family", FLATTENED)
def test_a_circle_that_is_pressed_flat_is_none(family: str) -> None:
    """A hand that goes to and fro, a little beside itself on the way back, turns as often as one that draws a circle."""
    circles = [(g, shown(f)) for g, f in drawn(family, 3)]
    round_ones = [(g, s) for g, s in circles if shows(s, family, g.side)]
    assert round_ones
    for g, s in round_ones:
        assert not shows(_flattened(s, FLATTENED[family]), family, g.side)


def _flattened(s: PostureFeatures, axis: int) -> PostureFeatures:
    """The motion with palms that keep an eighth of their way along an axis, while they are at the height of the gesture."""
    wrists, fore = ({side: of[side].copy() for side in of} for of in (s.wrists_m, s.fore))
    for side, wrist in wrists.items():
        raised = wrist[:, 1] > RAISED_M
        palm = wrist[raised] + PALM_M * fore[side][raised]
        wrist[raised, axis] -= (1 - 1 / 8) * (palm[:, axis] - np.median(palm[:, axis]) if raised.any() else 0.0)
    return replace(s, wrists_m=wrists)


SOME = 12
"""The default suite takes one family in so many."""
CASES = [
    *few_and_long([(name, SOME, 1) for name in sorted(FAMILIES)[::SOME]], [(name, 1, 6) for name in sorted(FAMILIES)]),
    *(pytest.param(name, 1, 1, marks=pytest.mark.soak) for name in sorted(FAMILIES)),
]


@pytest.mark.parametrize(("name", "every", "every_clip"), CASES)
def test_each_family_has_a_sign_that_sees_it_and_little_else(name: str, every: int, every_clip: int) -> None:
    """Right: own motions. Mirrored: not with the same arm. Absent: standing. Other: every other family."""
    everything = clips(every)
    own = [(g, s, m) for g, s, m in everything if g.family == name]
    assert sum(shows(s, name, g.side, g.direction) for g, s, _ in own) >= len(own) - 1
    one_sided = [(g, m) for g, _, m in own if g.side in ("left", "right")]
    assert not any(shows(m, name, g.side, g.direction) for g, m in one_sided if name not in USES_OTHER_ARM)
    family = FAMILIES[name]
    where = family.directions[0] if family.directions else ""
    if name not in ("stand", "shift"):
        absent = [s for g, s, _ in everything if g.family == "stand"]
        assert not any(shows(s, name, asked_side(name, ""), where) for s in absent)
    assert np.mean(seen_elsewhere(every, every_clip)[name]) < (0.32 if name in LOOSE else 0.12)


USES_OTHER_ARM = ("disco", "dab", "superhero")
# fmt: off
LOOSE = ("point", "beckon", "go_away", "punch", "hook", "uppercut", "karate_chop", "lift_weight", "knock", "hammer",
         "conduct", "dance_pump", "handshake", "wave", "draw_circle", "sword", "paint", "fist_pump",
         "push", "pull")
# fmt: on
"""Signs of up-and-down and to-and-fro movements, which many gestures have."""


@pytest.mark.parametrize(
    ("every", "every_clip"), [*few_and_long([(SOME, 1)], [(1, 6)]), pytest.param(1, 1, marks=pytest.mark.soak)]
)
def test_signs_together_seldom_see_what_is_not_there(every: int, every_clip: int) -> None:
    assert np.mean([np.mean(seen) for seen in seen_elsewhere(every, every_clip).values()]) < 0.06
