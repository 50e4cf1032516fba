"""Training: a cut run goes on with the same result; corruption does what it says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import nn

from mmm_core.corpus.synthesis import synthesise
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.training.batches import CaptionStates, Clip, load_clips, save_clips
from mmm_core.training.run import Run, Schedule, train
from mmm_core.training.tokenizer_training import train_tokenizer
from mmm_core.training.transformer_training import Corruption, corrupt


def loss_of(model: nn.Module, cut_at: int | None = None):
    def loss_fn(step: int, generator: torch.Generator) -> dict[str, torch.Tensor]:
        if step == cut_at:
            raise KeyboardInterrupt
        x = torch.randn(16, 3, generator=generator)
        return {"loss": (model(torch.dropout(x, 0.2, True)) - x.sum(1, keepdim=True)).square().mean()}

    return loss_fn


def fresh() -> nn.Linear:
    torch.manual_seed(0)
    return nn.Linear(3, 1)


def test_a_run_cut_at_any_step_gives_the_same_weights(tmp_path: Path) -> None:
    schedule = Schedule(steps=60, warmup_steps=5, save_every=7)
    whole = fresh()
    train(whole, loss_of(whole), schedule, Run(tmp_path / "whole"), "m")
    cut = fresh()
    with pytest.raises(KeyboardInterrupt):
        train(cut, loss_of(cut, cut_at=33), schedule, Run(tmp_path / "cut"), "m")
    again = fresh()
    train(again, loss_of(again), schedule, Run(tmp_path / "cut"), "m")
    assert torch.equal(whole.weight, again.weight)
    assert torch.equal(whole.bias, again.bias)


@pytest.mark.parametrize("module", [np, torch])
def test_what_a_killed_run_was_writing_is_not_taken_for_whole(
    tmp_path: Path, module: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Corpus and caption states: cut while they are written there is no file, and the next run makes it anew."""
    name = "savez" if module is np else "save"
    path = tmp_path / "corpus.npz"
    clips = [Clip(np.full((4, 3), i, np.float32), [f"caption {i}"], i == 1) for i in range(2)]
    states = CaptionStates(torch.ones(3, 4).half(), np.array([1, 2]), torch.ones(2, 4).half())

    def write() -> None:
        save_clips(path, clips) if module is np else states.save(path)

    def cut(*args: object, **_: object) -> None:
        next(Path(a) for a in args if isinstance(a, Path)).write_bytes(b"half of it")
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(module, name, cut)
        with pytest.raises(KeyboardInterrupt):
            write()
    assert not path.exists()
    write()
    if module is np:
        assert [c.captions for c in load_clips(path)] == [["caption 0"], ["caption 1"]]
    else:
        assert torch.equal(CaptionStates.load(path).words, states.words)
    assert [p.name for p in tmp_path.iterdir()] == ["corpus.npz"]


def test_training_learns_and_leaves_the_averaged_weights(tmp_path: Path) -> None:
    model = fresh()
    schedule = Schedule(steps=400, learning_rate=0.02, warmup_steps=5, weight_decay=0.0, ema_decay=0.9)
    train(model, loss_of(model), schedule, Run(tmp_path), "m")
    assert torch.allclose(model.weight, torch.full((1, 3), 0.8), atol=0.1), "dropout of 0.2 makes 0.8 the best weight"
    assert not model.training


def test_the_learning_rate_rises_falls_and_ends_at_its_share() -> None:
    schedule = Schedule(steps=1000, learning_rate=1.0, warmup_steps=100, final_share=0.05)
    assert schedule.rate(0) == pytest.approx(0.01)
    assert schedule.rate(99) == pytest.approx(1.0)
    assert schedule.rate(1000) == pytest.approx(0.05)


@given(st.integers(0, 500), st.integers(1, 20), st.integers(1, 20))
def test_corruption_masks_at_least_its_share_and_leaves_end_and_padding(seed: int, a: int, b: int) -> None:
    K, L = 32, 24
    ids = torch.full((2, L, 3), K + 1)
    for row, n in enumerate((a, b)):
        ids[row, :n] = torch.randint(K, (n, 3), generator=torch.Generator().manual_seed(seed))
        ids[row, n] = K
    n_tokens = torch.tensor([a, b])
    out = corrupt(ids, n_tokens, K, Corruption(masked_share=0.4), torch.Generator().manual_seed(seed))
    for row, n in enumerate((a, b)):
        masked = (out[row, :n, 0] == K + 2).sum()
        assert masked >= max(1, round(0.4 * n) - 1)
        assert (out[row, :n][out[row, :n, 0] != K + 2] < K).all()
        assert torch.equal(out[row, n:], ids[row, n:])
    whole = corrupt(ids, n_tokens, K, Corruption(full_share=1.0), torch.Generator().manual_seed(seed))
    assert all((whole[row, :n] == K + 2).all() for row, n in enumerate((a, b)))


@given(st.integers(0, 500), st.integers(2, 20))
def test_body_parts_can_be_masked_each_by_itself(seed: int, n: int) -> None:
    K, L, P = 32, 24, 3
    ids = torch.full((1, L, P), K + 1)
    ids[0, :n] = torch.randint(K, (n, P), generator=torch.Generator().manual_seed(seed))
    ids[0, n] = K
    how = Corruption(masked_share=0.5, kept_share=1.0, cell_share=1.0)
    out = corrupt(ids, torch.tensor([n]), K, how, torch.Generator().manual_seed(seed))
    masked = out[0, :n] == K + 2
    assert masked.sum() % P == 0 and masked.sum() >= P * max(1, round(0.5 * n) - 1)
    assert torch.equal(out[0, :n][~masked], ids[0, :n][~masked]) and torch.equal(out[0, n:], ids[0, n:])
    many = [corrupt(ids, torch.tensor([n]), K, how, torch.Generator().manual_seed(s))[0, :n] == K + 2 for s in range(9)]
    assert any((m.any(-1) & ~m.all(-1)).any() for m in many), "positions are masked in part"


def test_before_there_are_codes_latents_go_to_the_decoder_as_they_are(tmp_path: Path) -> None:
    """Plain steps leave the codebooks alone; then codes are laid into the latents, and the tokenizer is better than noise."""
    clips = [Clip(synthesise(np.random.default_rng(i)).features, ["x"], False) for i in range(6)]
    clips = [c for c in clips if len(c.features) >= 16]
    config = TokenizerConfig(16, 4, 16)

    def trained(steps: int, plain_steps: int, name: str) -> Tokenizer:
        schedule = Schedule(steps=steps, learning_rate=1e-3, warmup_steps=1, save_every=100)
        made = train_tokenizer(
            clips, config, schedule, Run(tmp_path / name), batch=4, window_frames=16, plain_steps=plain_steps
        )
        assert isinstance(made, Tokenizer)
        return made

    plain = trained(3, 3, "plain")
    assert [int(q.n_updates) for q in plain.books] == [0, 0, 0]
    both = trained(6, 3, "both")
    assert [int(q.n_updates) for q in both.books] == [3, 3, 3]
    latents = both.latents(both.normalise(torch.from_numpy(clips[0].features)[None]))
    for quantizer, z in zip(both.books, latents, strict=True):
        apart = torch.cdist(z[0], quantizer.codebook).min(1).values.mean()
        assert apart < z[0].norm(dim=-1).mean() + 1e-3, "codes lie among the latents"
