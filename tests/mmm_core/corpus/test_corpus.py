"""Synthesised gestures and their sentences: what training sees of the corpus."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.grammar import caption
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.corpus.score import REST_ARM, Score
from mmm_core.corpus.stream import make_corpus
from mmm_core.corpus.synthesis import ClipSpec, draw_spec, synthesise, synthesise_spec
from mmm_core.language.mirroring import mirror_words
from mmm_core.motion.features import recover
from tests.support.sizes import few_and_long


@given(st.integers(0, 3000))
def test_every_clip_is_whole_tokens_finite_and_bounded_in_speed(seed: int) -> None:
    """An arm's ways are arcs: no wrist rushes, not even when a hanging arm is raised straight up."""
    clip = synthesise(np.random.default_rng(seed))
    assert len(clip.features) % 4 == 0
    assert 4 <= len(clip.features) <= 196
    assert np.isfinite(clip.features).all()
    joints = recover(clip.features).joints_m
    assert np.linalg.norm(np.diff(joints[:, [20, 21]], axis=0), axis=-1).max() * 20 < 7.0, "wrists, m/s"


def test_a_clip_depends_on_seed_and_number_alone() -> None:
    first, again = make_corpus(6, None, 3), make_corpus(4, None, 3)
    for a, b in zip(first[:4], again, strict=True):
        assert np.array_equal(a.features, b.features)
        assert a.captions == b.captions
    assert not np.array_equal(make_corpus(1, None, 4)[0].features, first[0].features)


@pytest.mark.parametrize("n_seeds", [1, pytest.param(4, marks=pytest.mark.soak)])
@pytest.mark.parametrize("name", few_and_long(sorted(FAMILIES)[::8], sorted(FAMILIES)))
def test_every_family_performs_and_speaks_in_all_its_forms(name: str, n_seeds: int) -> None:
    family = FAMILIES[name]
    for side in family.sides or ("",):
        for where in family.directions or ("",):
            for seed in range(n_seeds):
                spec = ClipSpec((Gesture(name, side, 2 if family.counts else 1, where),))
                clip = synthesise_spec(spec, np.random.default_rng(seed))
                assert clip is not None
                assert all(c and "{" not in c for c in clip.captions)


@given(st.integers(0, 3000))
def test_a_caption_has_no_mark_no_slot_and_single_spaces(seed: int) -> None:
    """Verbs that are bent and phrases without one, in any order: what marks them is gone in the end."""
    rng = np.random.default_rng(seed)
    spec = draw_spec(rng)
    said = caption(list(spec.gestures), spec.parallel, rng)
    assert not set(said) & set("~^{}()|")
    assert "  " not in said
    assert said == said.strip()


@given(st.integers(0, 3000))
def test_a_sentence_names_no_side_that_the_motion_has_not(seed: int) -> None:
    """A plain one-armed gesture without contrast: "left" in the words means the left arm."""
    rng = np.random.default_rng(seed)
    side = str(rng.choice(["left", "right"]))
    other = {"left": "right", "right": "left"}[side]
    words = caption([Gesture("raise", side)], False, rng).lower().replace(",", " ").replace("-", " ")
    denied = any(
        w in words
        for w in ("not ", "don't", "instead", "leave", "keep", "without", "rests", "rather", "stop", "no ", "i said")
    )
    assert other not in words.split() or denied
    named = any(sorted(word.strip(".,!:;")) == sorted(side) for word in words.split())  # a slip of the finger counts
    assert named or side == "right", "an unnamed side is the right one"


@pytest.mark.long
def test_known_commands_are_plain() -> None:
    known = known_commands(10_000)
    assert {"wave your left hand", "clap three times", "point up"} <= known
    assert not [c for c in known if "{" in c or "  " in c]


def test_sequences_and_parallels_are_drawn() -> None:
    specs = [draw_spec(np.random.default_rng(i)) for i in range(200)]
    assert {len(s.gestures) for s in specs} == {1, 2, 3}
    assert any(s.parallel for s in specs)


def test_a_score_holds_what_it_does_not_move() -> None:
    rest = {"left": REST_ARM.vector(), "head": np.zeros(3)}
    score = Score(np.random.default_rng(0), rest)
    score.hold(0.5)
    score.move(1.0, head=(1.0, 0.0, 0.0))
    times = np.array([0.0, 0.5, 1.0, 1.5, 3.0])
    assert np.allclose(score.sample("head", times)[:, 0], [0, 0, 0.5, 1, 1])
    assert np.allclose(score.sample("left", times), rest["left"])


@pytest.mark.parametrize(
    ("said", "mirrored"),
    [
        ("waves the left hand", "waves the right hand"),
        ("Left arm up", "Right arm up"),
        ("turns right right away", "turns left right away"),
        ("he left the room with his left hand up", "he left the room with his right hand up"),
        ("the hand on the left hip, then on the right", "the hand on the right hip, then on the left"),
        ("walks clockwise", "walks counterclockwise"),
        ("walks counter-clockwise", "walks clockwise"),
        ("is all right", "is all right"),
        ("raises its right arm right after", "raises its left arm right after"),
        ("with the hand on the left hip on the right", "with the hand on the right hip on the left"),
        ("puts the right hand on the left hip, right away", "puts the left hand on the right hip, right away"),
        ("he left the room waving", "he left the room waving"),
        ("they left, then turned left", "they left, then turned right"),
        ("is left standing, left hand up", "is left standing, right hand up"),
        ("what is left of the left arm", "what is left of the right arm"),
        ("the person's left hand is left out", "the person's right hand is left out"),
        ("turn right right there", "turn left right there"),
        ("right as he raises the left arm", "right as he raises the right arm"),
        ("right in front of him, the left hand", "right in front of him, the right hand"),
        ("it serves him right", "it serves him right"),
        ("you are right, wave with the left hand", "you are right, wave with the right hand"),
        ("the right way to wave", "the right way to wave"),
        ("a right angle with the left elbow", "a right angle with the right elbow"),
        ("leaves to the left", "leaves to the right"),
        ("has left to the right", "has left to the left"),
        ("a right-handed punch", "a left-handed punch"),
        ("the leftmost finger", "the rightmost finger"),
        ("circles anti-clockwise", "circles clockwise"),
        ("clockwise, then counter clockwise", "counterclockwise, then clockwise"),
        ("LEFT arm! Right arm!", "RIGHT arm! Left arm!"),
        ("bright light, upright posture, copyright", "bright light, upright posture, copyright"),
        ("the hand is right", "the hand is right"),
        ("the arm is to the right", "the arm is to the left"),
        ("his right arm is left of his head", "his left arm is right of his head"),
    ],
)
def test_words_of_a_mirrored_clip(said: str, mirrored: str) -> None:
    assert mirror_words(said) == mirrored
