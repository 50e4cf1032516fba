"""The length predictors: what they learn, and that older checkpoints keep theirs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmm_core.inference.checkpoint import load_model, save_model
from mmm_core.model.length import LengthClassifier, LogNormalLength
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import MAX_TOKENS
from mmm_core.training.batches import CaptionStates, TokenCorpus
from mmm_core.training.run import Run, Schedule
from mmm_core.training.transformer_training import train_length

DIM = 32
N_TOKENS = (7, 12, 30, 49)


def corpus_of_lengths() -> TokenCorpus:
    """Four captions, each always of one number of tokens; every clip begins with two tokens of another motion."""
    rng = np.random.default_rng(0)
    n_words = np.array([3, 5, 4, 6])
    words = torch.from_numpy(rng.normal(size=(int(n_words.sum()), DIM)).astype(np.float16))
    sentences = torch.from_numpy(rng.normal(size=(4, DIM)).astype(np.float16))
    ids = [torch.zeros(n + 2, 3, dtype=torch.long) for n in N_TOKENS]
    states = CaptionStates(words, n_words, sentences)
    return TokenCorpus(ids, [[i] for i in range(4)], states, np.zeros(4, bool), np.full(4, 2))


def test_the_classifier_learns_each_captions_number_of_tokens(tmp_path: Path) -> None:
    corpus = corpus_of_lengths()
    predictor = train_length(corpus, Schedule(steps=40, learning_rate=3e-3), Run(tmp_path))
    assert predictor.n_tokens(corpus.captions.gather([0, 1, 2, 3])) == list(N_TOKENS)


@pytest.mark.parametrize("kind", [LengthClassifier, LogNormalLength])
def test_padding_does_not_change_a_length(kind: type[LengthClassifier] | type[LogNormalLength]) -> None:
    torch.manual_seed(1)
    predictor = kind(DIM).eval()
    alone = TextStates(torch.randn(1, 4, DIM), torch.ones(1, 4, dtype=torch.bool), torch.randn(1, DIM))
    padded = TextStates(
        torch.cat([alone.words, torch.randn(1, 3, DIM)], 1),
        torch.tensor([[True] * 4 + [False] * 3]),
        alone.sentence,
    )
    assert predictor.n_tokens(alone) == predictor.n_tokens(padded)
    assert 1 <= predictor.n_tokens(alone)[0] <= MAX_TOKENS


def test_a_checkpoint_keeps_the_kind_of_its_length_predictor(tmp_path: Path) -> None:
    model, path = load_model(), tmp_path / "model.safetensors"
    text_dim = model.transformer.config.text_dim
    states = TextStates(torch.randn(2, 5, text_dim), torch.ones(2, 5, dtype=torch.bool), torch.randn(2, text_dim))
    for kind in (LengthClassifier, LogNormalLength):
        torch.manual_seed(2)
        length = kind(text_dim).eval()
        made = replace(model, length=length)
        save_model(path, made, half=False)
        again = load_model(path)
        assert type(again.length) is kind
        assert again.length.n_tokens(states) == length.n_tokens(states)
