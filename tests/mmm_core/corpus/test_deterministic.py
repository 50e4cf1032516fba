"""Clips that their words decide alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.deterministic import synthesise_deterministic, usual_count, words_given
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.synthesis import ClipSpec, synthesise_spec
from mmm_core.inference.checkpoint import load_model, load_text_encoder
from mmm_core.language.count_words import count_asked
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.training.fresh import FreshClips, FreshRecipe, at_another_length, make_round, usual_weights


@pytest.mark.parametrize(
    "gesture", [Gesture("wave", "right", 3), Gesture("raise", "left"), Gesture("bow"), Gesture("nod", count=2)]
)
def test_the_same_gesture_is_always_the_same_motion(gesture: Gesture) -> None:
    """Without that, pauses on the beat are longer or shorter by chance."""

    def motions(*, deterministic: bool) -> set[bytes]:
        clips = [
            synthesise_spec(ClipSpec((gesture,)), np.random.default_rng(seed), BEAT_S, deterministic=deterministic)
            for seed in range(6)
        ]
        return {clip.features.tobytes() for clip in clips if clip is not None}

    assert len(motions(deterministic=True)) == 1 < len(motions(deterministic=False))


def test_words_that_the_engine_applies_itself_are_not_learnt() -> None:
    assert (
        words_given("wave with your right hand slowly", Gesture("wave", "right", usual_count("wave")))
        == "wave with your right hand"
    )
    assert (
        words_given("raise your left arm and hold it for two seconds", Gesture("raise", "left"))
        == "raise your left arm"
    )
    assert words_given("clap, then bow", Gesture("clap", "both", 3)) is None, "two commands"


def test_a_sentence_without_a_number_has_the_usual_one() -> None:
    usual = usual_count("wave")
    assert words_given("wave with your right hand", Gesture("wave", "right", usual)) is not None
    assert words_given("wave with your right hand", Gesture("wave", "right", usual + 1)) is None
    assert words_given("wave seven times with your right hand", Gesture("wave", "right", 7)) is not None


def test_a_height_that_the_engine_takes_for_a_size_is_not_learnt() -> None:
    low = Gesture("raise", "left", height="low")
    assert words_given("raise your left arm halfway", low) is None
    assert words_given("raise your left arm to shoulder height", low) == "raise your left arm to shoulder height"


def test_drawn_clips_show_one_gesture_as_their_captions_say() -> None:
    for seed in range(40):
        clip = synthesise_deterministic(np.random.default_rng(seed))
        (gesture,) = clip.spec.gestures
        assert gesture.hold_s == 0.0 and (gesture.style or gesture == replace(gesture, tempo=1.0, size=1.0))
        for caption in clip.captions:
            asked = count_asked(caption)
            assert (
                not FAMILIES[gesture.family].counts or asked in (None, gesture.count) or gesture.side == "alternating"
            )


def test_a_round_has_them_as_often_as_asked() -> None:
    how = FreshRecipe(clips=6, first=6, deterministic_share=1.0, captions=2)
    first, again = (make_round(how, 5, 0, usual_weights()) for _ in range(2))
    assert [c.captions for c in first] == [c.captions for c in again]
    assert all(np.array_equal(a.features, b.features) for a, b in zip(first, again, strict=True))
    assert all(1 <= len(c.captions) <= 2 and not c.n_seen for c in first)


@pytest.mark.long
def test_clips_of_another_length_keep_their_gesture(tmp_path: Path) -> None:
    plain, longer = (
        FreshRecipe(clips=12, first=12, deterministic_share=1.0, other_length_share=share, captions=1)
        for share in (0.0, 1.0)
    )
    rng = np.random.default_rng(2)
    clips = make_round(plain, 5, 0, usual_weights())
    for clip in clips * 3:
        other = at_another_length(clip, rng)
        n, m = len(clip.features), len(other.features)
        assert m - n == other.n_rest * FRAMES_PER_TOKEN != 0 and m // FRAMES_PER_TOKEN <= MAX_TOKENS
        assert np.array_equal(other.features[: min(n, m)], clip.features[: min(n, m)])
        assert (other.features[n:] == clip.features[-1]).all()
    model, encoder = load_model(), load_text_encoder()
    corpus, again = (FreshClips(longer, tmp_path, model.tokenizer, encoder, 3).corpus(0) for _ in range(2))
    n_tokens = np.array([len(ids) for ids in corpus.ids])
    assert (corpus.own_lengths() != n_tokens).all() and (corpus.own_lengths() >= 1).all()
    assert corpus.own_lengths().tolist() == again.own_lengths().tolist()
