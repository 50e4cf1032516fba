"""A finished model with more codes: finer ids, and a transformer that goes on from where it was."""

from __future__ import annotations

import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.synthesis import synthesise
from mmm_core.inference.checkpoint import Model, load_model
from mmm_core.training.batches import Clip
from mmm_core.training.refining import refined, settle, split
from mmm_core.training.run import Run, Schedule


@pytest.fixture(scope="module")
def clips() -> list[Clip]:
    return [Clip(synthesise(np.random.default_rng((8, i)), BEAT_S).features, ["x"], False) for i in range(24)]


@pytest.fixture(scope="module")
def models(clips: list[Clip], tmp_path_factory: pytest.TempPathFactory) -> tuple[Model, Model]:
    """The shipped model before, and with a quarter more codes, its tokenizer untrained since."""
    model = load_model()
    n_codes = model.tokenizer.config.n_codes * 5 // 4
    schedule = Schedule(steps=0, seed=1)
    return model, refined(model, clips, n_codes, schedule, Run(tmp_path_factory.mktemp("run")), 0.0)


def through(model: Model, clip: Clip) -> tuple[Tensor, Tensor]:
    """Ids (1, L, C) of a clip, and what becomes of it."""
    features = torch.from_numpy(clip.features[None])
    with torch.inference_mode():
        ids = model.tokenizer.encode(features)
        return ids, model.tokenizer.decode(ids) - features


def test_codes_are_split_where_latents_are_far_from_them() -> None:
    generator = torch.Generator().manual_seed(0)
    wide, narrow = 3 * torch.randn(300, 2, generator=generator), 0.01 * torch.randn(300, 2, generator=generator) + 20
    latents, codebook = torch.cat([wide, narrow]), torch.tensor([[0.0, 0.0], [20.0, 20.0]])
    codes = split(latents, codebook, 16)
    assert codes.shape == (16, 2)
    assert (codes.norm(dim=1) < 14).sum() >= 14
    assert torch.cdist(latents, codes).min(1).values.mean() < 0.4 * torch.cdist(latents, codebook).min(1).values.mean()


def test_codes_without_latents_go_where_the_error_is() -> None:
    latents = torch.randn(400, 2, generator=torch.Generator().manual_seed(0))
    codes = settle(latents, torch.cat([latents[:6], torch.full((6, 2), 99.0)]), iterations=4)
    assert codes.abs().max() < 6


@pytest.mark.long
def test_finer_codes_give_a_motion_back_better(models: tuple[Model, Model], clips: list[Clip]) -> None:
    before, after = (np.mean([float(through(m, c)[1].abs().mean()) for c in clips]) for m in models)
    assert after < before


@pytest.mark.long
def test_the_transformer_begins_with_what_it_knew(models: tuple[Model, Model], clips: list[Clip]) -> None:
    """It has to learn which of the split codes it is, no more: a head of no knowledge is twice as far from the old loss."""
    before, refined_model = (m.transformer for m in models)
    unlearnt = copy.deepcopy(refined_model)
    torch.nn.init.normal_(unlearnt.head.weight, std=0.02)
    losses: list[float] = []
    for model, transformer in ((models[0], before), (models[1], refined_model), (models[1], unlearnt)):
        found: list[float] = []
        for i, clip in enumerate(clips):
            ids = through(model, clip)[0]
            hidden = torch.rand(ids.shape[1], generator=torch.Generator().manual_seed(i)) < 0.3
            seen = torch.where(hidden[None, :, None], transformer.ids.mask, ids)
            with torch.inference_mode():
                logits = transformer(seen, transformer.read_text(transformer.no_text(1)))
            found.append(float(F.cross_entropy(logits[0].flatten(0, 1), ids[0].flatten())))
        losses.append(float(np.mean(found)))
    assert losses[1] - losses[0] < 0.5 * (losses[2] - losses[0]), losses


@pytest.mark.long
def test_refining_leaves_the_model_it_begins_with(clips: list[Clip], tmp_path: Path) -> None:
    model = load_model()
    held = {name: t.clone() for name, t in model.tokenizer.state_dict().items()}
    schedule = Schedule(steps=2, learning_rate=1e-4, warmup_steps=1)
    made = refined(model, clips[:8], model.tokenizer.config.n_codes + 8, schedule, Run(tmp_path), 0.0)
    assert all(torch.equal(t, held[name]) for name, t in model.tokenizer.state_dict().items())
    assert made.transformer.config == replace(model.transformer.config, n_codes=made.tokenizer.config.n_codes)
    assert (tmp_path / "refined.pt").is_file()
