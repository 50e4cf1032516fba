"""The loss on decoded motion: what it counts, what it leaves alone, and that a training uses it where its recipe says so."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor

from mmm_core.errors import TrainingDataError
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.model.transformer import TransformerConfig
from mmm_core.model.vqvae import VqVae, VqVaeConfig
from mmm_core.training.batches import CaptionStates, TokenCorpus
from mmm_core.training.motion_loss import DecodedError, MotionLoss, error_measure
from mmm_core.training.run import Run, Schedule
from mmm_core.training.transformer_training import train_transformer

K, L, D = 12, 16, 4


@pytest.fixture(scope="module", name="tokenizer")
def _tokenizer() -> Tokenizer:
    torch.manual_seed(3)
    return Tokenizer(TokenizerConfig(n_codes=K, code_dim=D, decoder_width=16))


def predictions(ids: Tensor, sure: float = 40.0) -> Tensor:
    """Logits (B, L, C, K) that are sure of `ids`."""
    return sure * torch.nn.functional.one_hot(ids, K).float()


def motion(seed: int = 0) -> tuple[Tensor, Tensor]:
    """Ids (2, L, 3) of two motions, and which positions are predicted (2, L).

    The second motion has ten tokens; the first three tokens of both are given.
    """
    ids = torch.randint(K, (2, L, 3), generator=torch.Generator().manual_seed(seed))
    learnt = (torch.arange(L) >= 3).expand(2, L).clone()
    ids[1, 10], ids[1, 11:], learnt[1, 10:] = K, K + 1, False
    return ids, learnt


def test_the_true_ids_have_no_error_and_others_have_one(tokenizer: Tokenizer) -> None:
    ids, learnt = motion()
    error_of = DecodedError(tokenizer, torch.device("cpu"))
    true = ids.where(ids < K, 0)
    assert error_of(predictions(true), ids, learnt) < 1e-6
    wrong = true.clone()
    wrong[0, 8, 0] = (wrong[0, 8, 0] + 1) % K
    one, all_wrong = error_of(predictions(wrong), ids, learnt), error_of(predictions((true + 1) % K), ids, learnt)
    assert 1e-6 < one < all_wrong


def test_only_predicted_positions_count(tokenizer: Tokenizer) -> None:
    ids, learnt = motion()
    error_of = DecodedError(tokenizer, torch.device("cpu"))
    logits = torch.randn(2, L, 3, K, generator=torch.Generator().manual_seed(1))
    elsewhere = logits.clone()
    elsewhere[~learnt] = torch.randn(elsewhere[~learnt].shape)
    assert torch.equal(error_of(logits, ids, learnt), error_of(elsewhere, ids, learnt))


def test_the_gradient_leads_to_the_true_motion_and_leaves_the_tokenizer(tokenizer: Tokenizer) -> None:
    ids, learnt = motion()
    error_of = DecodedError(tokenizer, torch.device("cpu"))
    logits = torch.zeros(2, L, 3, K, requires_grad=True)
    optimiser = torch.optim.Adam([logits], 0.3)
    first = error_of(logits, ids, learnt).item()
    for _ in range(150):
        optimiser.zero_grad()
        error = error_of(logits, ids, learnt)
        error.backward()
        optimiser.step()
    assert error.item() < 0.2 * first
    assert all(p.grad is None for p in tokenizer.parameters())


def test_the_released_layout_is_refused_by_name(tmp_path: Path, tokenizer: Tokenizer) -> None:
    whole = VqVae(VqVaeConfig("whole", n_codes=8, code_dim=4, width=8))
    with pytest.raises(TrainingDataError, match="motion_loss"):
        error_measure(MotionLoss(1.0), whole, Run(tmp_path))
    assert error_measure(MotionLoss(), whole, Run(tmp_path)) is None
    assert isinstance(error_measure(MotionLoss(1.0), tokenizer, Run(tmp_path)), DecodedError)


def test_a_training_has_the_loss_from_the_share_of_its_steps_on(tmp_path: Path, tokenizer: Tokenizer) -> None:
    """Until then the weights are those of a training without it, and the log says that there is none."""
    ids, _ = motion()
    captions = CaptionStates(torch.randn(4, 8).half(), np.array([2, 2]), torch.randn(2, 8).half())
    corpus = TokenCorpus([ids[0], ids[0].flip(0)], [[0], [1]], captions, np.array([True, True]))
    config = TransformerConfig(K, 3, D, width=16, n_heads=2, n_cross=1, n_self=1, text_dim=8)
    averages: dict[str, list[Tensor]] = {}
    for name, how in (("without", MotionLoss()), ("early", MotionLoss(1.0, 0.5)), ("late", MotionLoss(1.0, 1.0))):
        schedule, run = Schedule(6, warmup_steps=1), Run(tmp_path / name)
        train_transformer(corpus, tokenizer, config, schedule, run, motion_loss=how)
        averages[name] = torch.load(run.folder / "transformer.pt", weights_only=True)["averages"]
        last = list(csv.DictReader((run.folder / "transformer.csv").read_text().splitlines()))[-1]
        assert ("motion" in last) == (name != "without")
        assert name == "without" or math.isfinite(float(last["motion"])) == (name == "early")
    same = {name: all(map(torch.equal, found, averages["without"])) for name, found in averages.items()}
    assert same == {"without": True, "early": False, "late": True}
