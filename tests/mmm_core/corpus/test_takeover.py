"""Motions that begin in the middle of another: smooth, given where they begin, and trained on for what follows alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.synthesis import ClipSpec, synthesise, synthesise_spec
from mmm_core.corpus.takeover import SEEN_TOKENS, synthesise_takeover
from mmm_core.inference.checkpoint import load_model, load_text_encoder
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.training.fresh import FreshClips, FreshRecipe
from mmm_core.training.transformer_training import Batches, Corruption, corrupt, learnt

HAND = [20, 21]


@pytest.mark.parametrize("seed", range(6))
def test_a_takeover_leads_smoothly_into_the_gesture_of_its_text(seed: int) -> None:
    """No jump where one gesture ends, no faster than gestures are, and at the end the pose that the gesture alone ends with."""
    clip, n_seen = synthesise_takeover(np.random.default_rng(seed))
    assert SEEN_TOKENS[0] <= n_seen <= SEEN_TOKENS[1] and len(clip.features) <= MAX_TOKENS * FRAMES_PER_TOKEN
    assert len(clip.features) % FRAMES_PER_TOKEN == 0 and clip.captions
    cut = n_seen * FRAMES_PER_TOKEN
    step_m = np.linalg.norm(np.diff(clip.body.joints_m[:, HAND], axis=0), axis=-1).max(1)
    assert step_m[cut - 3 : cut + 3].max() < 0.25, "metres in a twentieth of a second"
    alone = synthesise_spec(ClipSpec(clip.spec.gestures, clip.spec.parallel), np.random.default_rng(0), BEAT_S)
    assert alone is not None
    n = min(len(alone.features), len(clip.features) - cut)
    apart_m = np.abs(alone.body.joints_m[:n, HAND] - clip.body.joints_m[cut : cut + n, HAND]).max((1, 2))
    assert apart_m[-1] < 0.1 and apart_m.min() < 0.03


def test_many_takeovers_begin_away_from_rest() -> None:
    rest = synthesise(np.random.default_rng(0), BEAT_S, {"stand": 1.0}, 1.0).body.joints_m[0, HAND]
    made = [synthesise_takeover(np.random.default_rng((5, i))) for i in range(20)]
    away_m = [np.abs(c.body.joints_m[FRAMES_PER_TOKEN * n, HAND] - rest).max() for c, n in made]
    assert np.mean(np.array(away_m) > 0.15) > 0.5


def test_seen_tokens_are_neither_hidden_nor_learnt() -> None:
    K, n_tokens, n_seen = 32, torch.tensor([12, 9, 12]), torch.tensor([5, 0, 11])
    ids = torch.full((3, 14, 3), K + 1)
    for row, n in enumerate(n_tokens.tolist()):
        ids[row, :n], ids[row, n] = 7, K
    masked = 0
    for seed in range(20):
        out = corrupt(ids, n_tokens, K, Corruption(cell_share=0.5), torch.Generator().manual_seed(seed), None, n_seen)
        assert all(torch.equal(out[row, :n], ids[row, :n]) for row, n in enumerate(n_seen.tolist()))
        assert (out == K + 2).any(-1).any(-1).all(), "something is masked in every motion"
        masked += int((out[0, 5:12] == K + 2).all())
    assert masked < 20
    assert learnt(14, n_tokens, n_seen).sum(1).tolist() == [7, 9, 1]


@pytest.mark.long
def test_rounds_keep_how_much_of_a_clip_is_seen(tmp_path: Path) -> None:
    model, encoder = load_model(), load_text_encoder()
    how = FreshRecipe(clips=3, first=6, every=2, rounds=1, captions=1, takeover_share=1.0)
    made, corpus = (
        FreshClips(how, tmp_path, model.tokenizer, encoder, 3).corpus(0) for _ in range(2)
    )  # and read again
    assert (corpus.seen(range(6)) >= SEEN_TOKENS[0]).all()
    assert corpus.seen(range(6)).tolist() == made.seen(range(6)).tolist()
    *_, n_seen, text = Batches(corpus, 60, 0.0).draw(torch.Generator().manual_seed(1), model.transformer.config)
    assert (n_seen >= SEEN_TOKENS[0]).all() and len(text.sentence) == len(n_seen)
